//! A ring by plain rules, written independently of the morphogen M.
//!
//! What a robot does in every tick, each rule of which is common in swarm robotics:
//!
//! 1. It accompanies the nearest target that it knows, and moves with it. Mothers that see several share them out.
//! 2. It goes to the ring of radius (d_min + d_max) / 2 around that target; where an obstacle that it knows stands in its bearing, only as
//!    far out as its body has room before it, or outside of it if that is within d_max and the robot is outside already. So the ring is
//!    dented where walls are, and becomes long and slim in a corridor.
//! 3. It goes to the middle between the neighbours ahead and behind on the ring, as far as it hears any: so robots spread
//!    along it whatever their number (Flocchini, Prencipe and Santoro 2008, *Self-deployment of mobile sensors on a ring*).
//! 4. It keeps apart from whoever comes too near.
//! 5. It approaches no obstacle that it knows more closely than its body needs, and slides along it, no slower: where the target's way
//!    carries it against a wall, or it is left behind, to its target's side. So it goes through a door instead of being left before it.
//! 6. Localisation, what it knows and tells, and the reflex on proximity sensors are those of every other robot. One that is farther than
//!    d_max goes around whatever it feels, as robots do on their way home.
//!
//! Lengths follow from the world's ring and the robot's body, and no number was fitted. The rules 2, 5 and 6 were chosen looking at six
//! worlds of `scenarios/adaptive`: there this is the best that we could make of a ring, not a first guess.

use super::circle_blob;
use crate::realities::{Robustness, try_each};
use crate::simulation::{Setting, Simulation, SimulationError, run};
use core::f32::consts::PI;
use firmware_sim::brain::{Brain, BrainError};
use firmware_sim::config::SwarmConfig;
use firmware_sim::scenario::{Morphogen, Ring, Scenario};
use firmware_sim::trace::Observer;
use grn_core::blob::{Blob, Gains};
use grn_core::field::Kernel;
use grn_core::geometry::{Point, Vector};
use grn_core::robot::epuck2::BODY_RADIUS;
use grn_core::robot::parts::{Avoidance, Clock, Drive, Knowledge, KnownTarget, Localisation, Pace, Pose, metres};
use grn_core::robot::{Command, Millimetres, Percept};
use grn_core::scalar::NumberType;
use std::ops::{ControlFlow, RangeInclusive};
use std::sync::atomic::{AtomicBool, Ordering};

/// How fast a robot goes to its ring, or to its place at home, per metre of distance, 1/s.
const TO_RING: f32 = 1.0;
/// How fast it goes to the middle between its neighbours, per metre, 1/s.
const TO_MIDDLE: f32 = 1.0;
/// Neighbours on one side that are farther than this, seen from the target, are not taken for the next one; where none is nearer
/// one is expected there, so that robots on an arc spread to close it. Radians.
const NEXT: f32 = PI / 2.0;
/// Whose distance from the target is at most this share of the radius is on the ring.
const ON_RING: f32 = 1.5;
/// Free distance that robots want around their bodies, metres: that at which the reflex on proximity sensors begins to push.
const FREE: f32 = 0.03;
/// Neighbours nearer than this, from centre to centre, push, metres.
const APART: f32 = 2.0 * BODY_RADIUS as f32 + FREE;
/// An obstacle is not approached more closely than this, from the robot's centre, metres.
const FROM_OBSTACLES: f32 = BODY_RADIUS as f32 + FREE;
/// How fast it may be approached, per metre above that distance, 1/s.
const APPROACH: f32 = 2.0;
/// A robot is carried against an obstacle if its target moves within 60° of the way there: the cosine.
const CARRIED: f32 = 0.5;

/// The rules on one robot.
#[derive(Clone, Debug)]
pub struct RuleRing {
    robot: u16,
    /// Of the ring, real metres.
    radius: f32,
    /// d_max: the farthest from a target that a robot is to be, real metres.
    farthest: f32,
    /// Whether it was farther in the last tick.
    has_strayed: bool,
    /// Fastest, metres per second.
    cruise: f32,
    clock: Clock,
    localisation: Localisation<f32>,
    knowledge: Knowledge<f32>,
    avoidance: Avoidance<f32>,
    drive: Drive<f32>,
    /// Where the robot was when it last knew.
    here: Point<f32>,
    /// Velocity of the target it accompanies, metres per second.
    swarm_velocity: Vector<f32>,
}

impl RuleRing {
    /// On robot number `robot`, for a ring of this radius and this d_max in real metres; as fast and as agile as robots with a blob.
    pub fn new(robot: u16, radius: f32, farthest: f32) -> Self {
        let Gains { cruise, turn, .. } = Gains::default();
        RuleRing {
            robot,
            radius,
            farthest,
            has_strayed: false,
            cruise,
            clock: Clock::default(),
            localisation: Localisation::new(),
            knowledge: Knowledge::new(),
            avoidance: Avoidance::new(cruise),
            drive: Drive::new(turn),
            here: Vector::ZERO,
            swarm_velocity: Vector::ZERO,
        }
    }

    fn act(&mut self, percept: &Percept, home: Option<Millimetres>) -> Command {
        let pace: Pace<f32> = self.clock.advance(percept.elapsed_us);
        let pose = self.localisation.update(percept);
        self.here = pose.map_or(self.here, |pose| pose.position);
        let now = self.clock.tick();
        self.knowledge.grow_older(&pace, now, self.swarm_velocity, self.here);
        let Some(Pose { heading, .. }) = pose else {
            self.localisation.drive(0, 0);
            return Command::default();
        };
        self.knowledge.update(percept, self.here, self.robot, [now, pace.ticks], self.swarm_velocity);
        let wanted = match home {
            None => self.accompany(percept, &pace),
            Some(home) => (metres(home) - self.here) * pace.held(TO_RING),
        };
        let map = (home.is_none() && !self.has_strayed).then_some((self.here, &self.knowledge));
        let wanted = wanted.limited(self.cruise);
        let velocity = self.avoidance.velocity(wanted, &percept.proximity, heading, map, pace.ticks);
        let (left, right) = self.drive.wheels(velocity, heading, &pace);
        self.localisation.drive(left, right);
        let broadcast = self.knowledge.message(self.robot, self.here, [now, pace.ticks], percept);
        Command { left, right, broadcast }
    }

    /// The velocity that the rules give, metres per second.
    fn accompany(&mut self, percept: &Percept, pace: &Pace<f32>) -> Vector<f32> {
        let Some(target) = self.own_target(percept) else {
            self.swarm_velocity = Vector::ZERO;
            return Vector::ZERO;
        };
        self.swarm_velocity = target.velocity;
        let (distance, outwards) = (self.here - target.position).polar().unwrap_or((0.0, Vector::new(1.0, 0.0)));
        self.has_strayed = distance > self.farthest;
        let place = self.place(target.position, outwards, distance);
        let to_ring = outwards * ((place.distance - distance) * pace.held(TO_RING));
        let along = self.to_middle(target.position, outwards) * pace.held(TO_MIDDLE);
        let (to_ring, to_middle) =
            (to_ring.limited(self.cruise), (outwards.turned_left() * along).limited(self.cruise));
        let velocity = target.velocity + to_ring + to_middle + self.apart();
        self.held_off(velocity.limited(self.cruise), &target, place.is_outside)
    }

    /// The nearest target; of those that a mother sees, her share.
    fn own_target(&self, percept: &Percept) -> Option<KnownTarget<f32>> {
        let known = self.knowledge.targets();
        let turn = usize::from(self.robot).checked_rem(percept.targets.len());
        let seen = turn.and_then(|turn| percept.targets.get(turn));
        let own = seen.and_then(|seen| known.iter().find(|target| target.target == seen.target));
        let distance = |target: &KnownTarget<f32>| (target.position - self.here).square();
        own.or_else(|| known.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))).copied()
    }

    /// Where the robot is to be in this direction from the target, itself at this `distance`: on the ring, or as near to it as known
    /// obstacles leave room.
    fn place(&self, target: Point<f32>, outwards: Vector<f32>, distance: f32) -> Place {
        let obstacles = self.knowledge.obstacles();
        // Walls that reach beyond d_max are not gone around.
        let end_within = obstacles.iter().all(|&point| (point - target).length() + FROM_OBSTACLES < self.farthest);
        let (mut least, mut most) = (0.0_f32, self.farthest);
        for &point in obstacles {
            let offset = point - target;
            let (along, across) = (offset.dot(outwards), offset.cross(outwards));
            let square = FROM_OBSTACLES * FROM_OBSTACLES - across * across;
            if along <= 0.0 || square <= 0.0 {
                continue;
            }
            let half = libm::sqrtf(square);
            if end_within && distance > along {
                least = least.max(along + half);
            } else {
                most = most.min(along - half);
            }
        }
        Place { distance: self.radius.max(least).min(most).max(0.0), is_outside: least > 0.0 }
    }

    /// How far to the left, seen from the target, the middle between both neighbours on the ring is, metres.
    fn to_middle(&self, target: Point<f32>, outwards: Vector<f32>) -> f32 {
        let (mut left, mut right) = (NEXT * self.radius, NEXT * self.radius);
        for offset in self.offsets() {
            let from_target = self.here - offset - target;
            let bearing = libm::atan2f(outwards.cross(from_target), outwards.dot(from_target));
            if from_target.length() > ON_RING * self.radius || bearing.abs() > NEXT {
                continue;
            }
            let side = if bearing > 0.0 { &mut left } else { &mut right };
            *side = side.min(offset.length());
        }
        (left - right) / 2.0
    }

    /// From each neighbour to this robot, metres.
    fn offsets(&self) -> impl Iterator<Item = Vector<f32>> {
        let neighbours = self.knowledge.neighbours();
        let seen_from = neighbours.seen_from(self.here);
        neighbours.known().iter().map(move |neighbour| neighbour.offset(seen_from))
    }

    /// The velocity away from neighbours that are too near, metres per second.
    fn apart(&self) -> Vector<f32> {
        let pushes = self.offsets().filter_map(Vector::polar).filter(|(distance, _)| *distance < APART);
        pushes.fold(Vector::ZERO, |sum, (distance, away)| sum + away * (self.cruise * (1.0 - distance / APART)))
    }

    /// The velocity without what of it leads too fast towards the nearest known obstacle: the robot slides along it, no slower. Where
    /// the obstacle is about to come between it and its target, or has come already, it slides to the target's side.
    fn held_off(&self, velocity: Vector<f32>, target: &KnownTarget<f32>, is_outside: bool) -> Vector<f32> {
        let offsets = self.knowledge.obstacles().iter().filter_map(|&point| (self.here - point).polar());
        let Some((distance, away)) = offsets.min_by(|a, b| a.0.total_cmp(&b.0)) else { return velocity };
        let (approach, most) = (-velocity.dot(away), APPROACH * (distance - FROM_OBSTACLES));
        if approach <= most {
            return velocity;
        }
        let is_carried = !is_outside && -target.velocity.dot(away) > CARRIED * target.velocity.length();
        let (way, speed) = if is_carried || self.has_strayed {
            (target.position - self.here, self.cruise)
        } else {
            (velocity, velocity.length())
        };
        let along = (way - away * way.dot(away)).direction().unwrap_or(Vector::ZERO);
        along * speed - away * most
    }
}

/// Where a robot is to be, in its bearing from the target.
struct Place {
    /// From the target, metres.
    distance: f32,
    /// Whether an obstacle is between them that the robot passes on its outer side.
    is_outside: bool,
}

impl Brain for RuleRing {
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
        percept.check().map_err(BrainError::new)?;
        Ok(self.act(percept, None))
    }

    fn tick_home(&mut self, percept: &Percept, home: Millimetres) -> Result<Command, BrainError> {
        percept.check().map_err(BrainError::new)?;
        Ok(self.act(percept, Some(home)))
    }

    fn reboot(&mut self) -> Result<(), BrainError> {
        *self = RuleRing::new(self.robot, self.radius, self.farthest);
        Ok(())
    }
}

/// The radius that the rules aim at, in the metres of the scenario.
pub fn radius(Ring { d_min, d_max, .. }: Ring) -> f64 {
    (d_min + d_max) / 2.0
}

/// Runs the rules on every robot, in `f32`, as [`simulate`](crate::simulation::simulate) runs a blob. The run is measured
/// against the [blob of the circle](circle_blob) of that radius, whose identity it bears.
///
/// # Errors
/// [`SimulationError`]; `Ok(None)` if `watch` stopped it.
pub fn simulate(
    scenario: &Scenario,
    config: SwarmConfig,
    observer: &mut dyn Observer,
    watch: impl FnMut(f64) -> ControlFlow<()>,
) -> Result<Option<Simulation>, SimulationError> {
    let (ring, scale) = (scenario.ring(), config.scale);
    let ruler = ruler(radius(ring), scale as f32)?;
    let [real_radius, farthest] = [radius(ring), ring.d_max].map(|length| (length * scale) as f32);
    let brain = |robot: usize| RuleRing::new(robot as u16, real_radius, farthest);
    run(&Setting::new(&ruler, scenario, &config)?, config, NumberType::F32, brain, observer, watch)
}

/// The circle that runs are measured against. σ_t is half the radius, so narrow that circles around two targets hardly bulge towards each
/// other.
fn ruler(radius: f64, scale: f32) -> Result<Blob, SimulationError> {
    let target_width = radius / 2.0;
    circle_blob(
        radius,
        &Morphogen { kernel: Kernel::Gaussian, target_width, obstacle_width: target_width, level: 0.5 },
        scale,
    )
}

/// [`simulate`] in these realities, as [`try_all`](crate::realities::try_all) tries a blob.
///
/// # Errors
/// [`SimulationError`]; `Ok(None)` if `stop` was set.
pub fn try_all(
    scenario: &Scenario,
    config: &SwarmConfig,
    numbers: RangeInclusive<u64>,
    stop: &AtomicBool,
) -> Result<Option<Robustness>, SimulationError> {
    let watch = |_| if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    try_each(config, numbers, &|reality| simulate(scenario, reality, &mut (), watch))
}

#[cfg(test)]
mod tests;
