//! What a robot knows of the world: its own sightings and what others broadcast, with their age.

use super::clock::{Pace, ticks_of};
use super::epuck2::TICKS_PER_SECOND;
use super::message::{BROADCAST_PERIOD, MAX_REPORTED_OBSTACLES, ObstacleReport, TargetReport};
use super::neighbours::{Neighbour, Neighbours};
use super::obstacles::ObstacleMap;
use super::percept::{Heard, MAX_TARGETS, Percept, Sighting};
use super::position::{metres, millimetres};
use crate::bounded::filled;
use crate::geometry::{Point, Vector};
use crate::scalar::Scalar;
use heapless::Vec;

/// A target nobody has seen for 5 s is forgotten; one sighting more than 255 ticks old cannot be reported.
const FORGET_TARGET_TICKS: u8 = 5 * TICKS_PER_SECOND as u8;
/// Obstacle ages are counted in units of 8 ticks; that often neighbours are forgotten, too.
const OBSTACLE_AGE_UNIT: u32 = 8;

/// Everything known, in world metres, extrapolated to the current tick.
#[derive(Clone, Debug)]
pub struct Knowledge<S> {
    targets: Vec<KnownTarget<S>, MAX_TARGETS>,
    obstacles: ObstacleMap<S>,
    neighbours: Neighbours<S>,
}

/// A target as this robot knows it.
#[derive(Clone, Copy, Debug)]
pub struct KnownTarget<S> {
    /// Which target.
    pub target: u8,
    /// Expected position now.
    pub position: Point<S>,
    /// Estimated velocity, metres per second.
    pub velocity: Vector<S>,
    age: u8,
}

impl<S: Scalar> Knowledge<S> {
    pub fn new() -> Self {
        Knowledge { targets: Vec::new(), obstacles: ObstacleMap::new(), neighbours: Neighbours::new() }
    }

    pub fn targets(&self) -> &[KnownTarget<S>] {
        &self.targets
    }

    /// The obstacle points of which one is the nearest.
    pub fn obstacles(&self) -> &[Point<S>] {
        self.obstacles.near()
    }

    pub fn neighbours(&self) -> &Neighbours<S> {
        &self.neighbours
    }

    /// Whether what pushes the robot at `here` this way can be a neighbour or a wall that it knows.
    pub fn knows_what_pushes(&self, here: Point<S>, push: Vector<S>) -> bool {
        let seen_from = self.neighbours.seen_from(here);
        let pushes = |neighbour: &Neighbour<S>| {
            let offset = neighbour.offset(seen_from);
            // Within 45° of the way it pushes.
            offset.cross(push).abs() < offset.dot(push)
        };
        let mut close_neighbours = self.neighbours.known().iter().filter(|neighbour| neighbour.was_close());
        let on_this_side = |&point: &Point<S>| (here - point).dot(push) > S::ZERO;
        close_neighbours.any(pushes) || (self.obstacles.is_close() && self.obstacles().iter().any(on_this_side))
    }

    /// Lets everything known grow older, up to the clock's tick `now`: targets move on, and the neighbours with the
    /// robot's own target, whose `velocity` (metres per second) is given. The robot is at `here`.
    pub fn grow_older(&mut self, pace: &Pace<S>, now: u32, velocity: Vector<S>, here: Point<S>) {
        self.neighbours.carry(velocity * pace.seconds);
        let mut oldest = 0;
        for target in &mut self.targets {
            target.age = target.age.saturating_add(pace.ticks as u8);
            target.position = target.position + target.velocity * pace.seconds;
            oldest = oldest.max(target.age);
        }
        if oldest > FORGET_TARGET_TICKS {
            self.targets.retain(|target| target.age <= FORGET_TARGET_TICKS);
        }
        // One of the ticks that have begun is a multiple of the unit.
        let last = now.wrapping_sub(1);
        if last % OBSTACLE_AGE_UNIT < pace.ticks {
            self.obstacles.grow_older(millimetres(here));
            self.neighbours.forget(last);
        }
    }

    /// Takes in the percept of robot number `own` in tick `now`; it is at `here`, and its own target moves at `velocity`.
    ///
    /// Of the messages heard in a tick, only one has its obstacle points learned. That bounds the time of a tick, and costs
    /// little: walls stand still, so the other points can be learned when they are told again.
    /// Some radios (a broadcast over UDP, for one) give the robot its own messages back; it ignores them. It would
    /// otherwise take itself for a neighbour that it must keep away from.
    pub fn update(&mut self, percept: &Percept, here: Point<S>, own: u16, now: u32, velocity: Vector<S>) {
        let here = millimetres(here);
        for sighting in &percept.targets {
            self.see_target(*sighting);
        }
        for &position in &percept.obstacles {
            self.obstacles.learn(&ObstacleReport { position, age: 0 });
        }
        let mut own_messages = 0;
        for &Heard { ref message, age_ms } in &percept.heard {
            if message.sender == own {
                own_messages += 1;
                continue;
            }
            if let Some(report) = &message.target {
                self.hear_of_target(report, age_ms);
            }
            let mut carried = self.neighbours.carried();
            if age_ms > 0 {
                carried = carried - velocity * seconds(age_ms);
            }
            self.neighbours.meet(message.sender, message.position, carried, here, now);
        }
        let turn = whose_turn(now, percept.heard.len() - own_messages);
        let chosen = match own_messages {
            0 => percept.heard.get(turn),
            _ => percept.heard.iter().filter(|heard| heard.message.sender != own).nth(turn),
        };
        for report in chosen.into_iter().flat_map(|heard| &heard.message.obstacles) {
            self.obstacles.learn(report);
        }
        self.obstacles.find_near();
    }

    /// An alpha-beta filter: sightings correct the position by 2/5 and the velocity by 1/32 of the surprise per tick.
    fn see_target(&mut self, sighting: Sighting) {
        let seen = metres(sighting.position);
        match self.targets.iter_mut().find(|known| known.target == sighting.target) {
            Some(known) => {
                let surprise = seen - known.position;
                known.position = known.position + surprise * S::from_ratio(2, 5);
                known.velocity = known.velocity + surprise * S::from_ratio(i32::from(TICKS_PER_SECOND), 32);
                known.age = 0;
            }
            None => {
                let known = KnownTarget { target: sighting.target, position: seen, velocity: Vector::ZERO, age: 0 };
                // A fifth target does not fit and is left out: percepts hold at most four.
                let _ = self.targets.push(known);
            }
        }
    }

    /// A report replaces what the robot knows of that target if it is more recent.
    ///
    /// It is older by the time it was on its way, and by one tick at least: else robots would tell each other for ever
    /// what nobody sees any more.
    fn hear_of_target(&mut self, report: &TargetReport, age_ms: u16) {
        let on_its_way = if age_ms == 0 { 1 } else { ticks_of(age_ms).clamp(1, u32::from(u8::MAX)) as u8 };
        let age = report.age.saturating_add(on_its_way);
        let known = self.targets.iter_mut().find(|known| known.target == report.target);
        if age > FORGET_TARGET_TICKS || known.as_ref().is_some_and(|known| age >= known.age) {
            return;
        }
        let [east, north] = report.velocity.map(|mm| S::from_millionths(i32::from(mm) * 1000));
        let (velocity, mut position) = (Vector::new(east, north), metres(report.position));
        if age_ms > 0 {
            position = position + velocity * seconds(age_ms);
        }
        let told = KnownTarget { target: report.target, position, velocity, age };
        match known {
            Some(known) => *known = told,
            None => {
                let _ = self.targets.push(told);
            }
        }
    }

    /// What to tell the others: one target in turn, and obstacle points in turn, own sightings first.
    pub fn report(&self, turn: u32, percept: &Percept) -> (Option<TargetReport>, Vec<ObstacleReport, 4>) {
        let target = nth_in_turn(&self.targets, turn).map(|known| TargetReport {
            target: known.target,
            position: millimetres(known.position),
            velocity: [known.velocity.x, known.velocity.y]
                .map(|metres| metres.times_to_i32(1000).clamp(-127, 127) as i8),
            age: known.age,
        });
        let first = turn.wrapping_mul(MAX_REPORTED_OBSTACLES as u32);
        let turns = (0..MAX_REPORTED_OBSTACLES as u32).map(|k| first.wrapping_add(k));
        let obstacles = if percept.obstacles.is_empty() {
            let count = self.obstacles.known().len();
            filled(turns.take(count).filter_map(|turn| nth_in_turn(self.obstacles.known(), turn)).copied())
        } else {
            let count = percept.obstacles.len();
            let seen = turns.take(count).filter_map(|turn| nth_in_turn(&percept.obstacles, turn));
            filled(seen.map(|&position| ObstacleReport { position, age: 0 }))
        };
        (target, obstacles)
    }
}

/// Which one of so many messages has its obstacle points learned in tick `now`.
///
/// Robots speak periodically, so the same ones are heard together again and again, and each repeats its points with a
/// period of its own. If the choice were periodic too, the periods could match and some points would never be learned.
/// Multiples of the golden ratio, modulo 1, are spread evenly and have no period.
fn whose_turn(now: u32, messages: usize) -> usize {
    const GOLDEN_RATIO_Q32: u32 = 0x9e37_79b9;
    let share = (now / BROADCAST_PERIOD).wrapping_mul(GOLDEN_RATIO_Q32);
    ((u64::from(share) * messages as u64) >> u32::BITS) as usize
}

/// Milliseconds as seconds.
fn seconds<S: Scalar>(milliseconds: u16) -> S {
    S::from_millionths(i32::from(milliseconds) * 1000)
}

fn nth_in_turn<T>(items: &[T], turn: u32) -> Option<&T> {
    let index = turn.checked_rem(items.len() as u32)?;
    items.get(index as usize)
}
