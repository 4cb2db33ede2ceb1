//! The controller: one tick from percept to command.

use super::avoidance::Avoidance;
use super::clock::{Clock, Pace};
use super::drive::Drive;
use super::epuck2::TICKS_PER_SECOND;
use super::knowledge::{Knowledge, KnownTarget};
use super::localisation::{Localisation, Pose};
use super::motion::{Motion, PatternHere};
use super::percept::{Command, NOMINAL_TICK_US, Percept, PerceptError};
use super::position::{Millimetres, metres};
use crate::blob::{Blob, Identity};
use crate::dynamics::{Expression, Step};
use crate::field::{Field, Morphogens};
use crate::geometry::{Point, Vector};
use crate::network::{DEFAULT_GENES, Network};
use crate::pattern::{NoPattern, Pattern};
use crate::scalar::{Dual, Scalar};
use core::fmt;
use heapless::Vec;

/// The most RK4 steps in one tick.
const MAX_STEPS_PER_TICK: f32 = 64.0;

/// Why a valid blob cannot drive this robot.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LoadError {
    /// The model does not tell targets from empty space.
    NoPattern(NoPattern),
    /// The pattern around a lone target has no edge within 8 σ_t.
    NoRing,
    /// Time scale, tick and integration step do not give 1 to 64 whole RK4 steps in a tick.
    StepsPerTick(f32),
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LoadError::NoPattern(error) => error.fmt(f),
            LoadError::NoRing => write!(f, "the model's pattern does not close around a lone target"),
            LoadError::StepsPerTick(steps) => write!(
                f,
                "time_scale and step give {steps} RK4 steps in a tick of 1/{TICKS_PER_SECOND} s; choose them so that it \
                 is a whole number from 1 to {MAX_STEPS_PER_TICK}"
            ),
        }
    }
}

impl core::error::Error for LoadError {}

/// A controller running on one robot.
///
/// Equal blobs and equal percepts give equal commands, bit for bit, on every machine.
#[derive(Clone, Debug)]
pub struct Controller<S, const N: usize = DEFAULT_GENES> {
    robot: u16,
    identity: Identity,
    network: Network<S, N>,
    pattern: Pattern<S>,
    field: Field<S>,
    step: Step,
    steps_per_tick: u8,
    /// GRN time that is not integrated yet, in microseconds times `steps_per_tick`.
    owed: u32,
    expression: Expression<S, N>,
    knowledge: Knowledge<S>,
    motion: Motion<S>,
    drive: Drive<S>,
    avoidance: Avoidance<S>,
    clock: Clock,
    localisation: Localisation<S>,
    /// Where the robot was when it last knew.
    here: Point<S>,
    /// Velocity of the target it accompanies, metres per second.
    swarm_velocity: Vector<S>,
}

impl<S: Scalar, const N: usize> Controller<S, N> {
    /// Loads a blob for robot number `robot`, all genes silent and nothing known.
    ///
    /// # Errors
    /// See [`LoadError`].
    #[inline(never)]
    pub fn new(blob: &Blob<N>, robot: u16) -> Result<Self, LoadError> {
        let network = blob.network.cast();
        let pattern = Pattern::of(&network, S::from_f32(blob.level_fraction)).map_err(LoadError::NoPattern)?;
        let field = blob.field.field(blob.scale);
        let ring_radius = pattern.free_space_radius(&network, &field).ok_or(LoadError::NoRing)?;
        Ok(Controller {
            robot,
            identity: blob.identity(),
            network,
            pattern,
            field,
            step: blob.step,
            steps_per_tick: steps_per_tick(blob.time_scale, blob.step)?,
            owed: 0,
            expression: Expression::silent(),
            knowledge: Knowledge::new(),
            motion: Motion::new(&blob.gains, ring_radius),
            drive: Drive::new(S::from_f32(blob.gains.turn)),
            avoidance: Avoidance::new(S::from_f32(blob.gains.cruise)),
            clock: Clock::default(),
            localisation: Localisation::new(),
            here: Vector::ZERO,
            swarm_velocity: Vector::ZERO,
        })
    }

    /// The same controller for another robot of the swarm, which saves loading the blob once more.
    #[must_use]
    pub fn on_robot(self, robot: u16) -> Self {
        Controller { robot, ..self }
    }

    /// The identity of the blob that runs.
    pub fn identity(&self) -> Identity {
        self.identity
    }

    /// The level of the pattern morphogen M at the robot, as its genes express it now: 0 before the first target is known,
    /// then about 0 to 1. A last gene XNOR may take it a little below 0, a last gene XOR a little above 1.
    pub fn morphogen(&self) -> S {
        self.expression.morphogen(&self.network)
    }

    /// One control tick, nominally every 1/32 s: perceive, express genes, move.
    ///
    /// While the robot does not know where it is, before the first fix and after half a second without one, it stands still and
    /// is silent.
    ///
    /// # Errors
    /// [`PerceptError`] if no robot can perceive this. Then this was no tick: nothing has changed, and
    /// the robot is to stop its wheels.
    pub fn tick(&mut self, percept: &Percept) -> Result<Command, PerceptError> {
        self.act(percept, None)
    }

    /// The same for a robot whose base station calls it home: it drives there, straight on and around what its proximity sensors
    /// feel. Its genes rest meanwhile; it goes on to perceive and to tell, so that others make way for it. In any later tick
    /// it may be called to another place, or go back to the pattern.
    ///
    /// # Errors
    /// As of [`tick`](Self::tick).
    pub fn tick_home(&mut self, percept: &Percept, home: Millimetres) -> Result<Command, PerceptError> {
        self.act(percept, Some(home))
    }

    // Not inlined: two copies of a tick would not fit beside each other into a small flash.
    #[inline(never)]
    fn act(&mut self, percept: &Percept, home: Option<Millimetres>) -> Result<Command, PerceptError> {
        percept.check()?;
        let pace = self.clock.advance(percept.elapsed_us);
        let pose = self.localisation.update(percept);
        self.here = pose.map_or(self.here, |pose| pose.position);
        let (here, now) = (self.here, self.clock.tick());
        self.knowledge.grow_older(&pace, now, self.swarm_velocity, here);
        let Some(Pose { heading, .. }) = pose else {
            self.localisation.drive(0, 0);
            return Ok(Command::default());
        };
        self.knowledge.update(percept, here, self.robot, [now, pace.ticks], self.swarm_velocity);
        let wanted = match home {
            None => self.wanted_velocity(here, percept, &pace),
            Some(home) => self.motion.velocity_to(metres(home) - here, &pace),
        };
        let map = home.is_none().then_some((here, &self.knowledge));
        let velocity = self.avoidance.velocity(wanted, &percept.proximity, heading, map, pace.ticks);
        let (left, right) = self.drive.wheels(velocity, heading, &pace);
        self.localisation.drive(left, right);
        let ticks = [self.clock.tick(), pace.ticks];
        Ok(Command { left, right, broadcast: self.knowledge.message(self.robot, here, ticks, percept) })
    }

    fn wanted_velocity(&mut self, here: Point<S>, percept: &Percept, pace: &Pace<S>) -> Vector<S> {
        let steps = self.steps_due(percept.elapsed_us);
        let targets = self.knowledge.targets();
        let distance = |target: &KnownTarget<S>| (target.position - here).square();
        let nearest = targets.iter().reduce(|a, b| if distance(b) < distance(a) { b } else { a });
        let Some(&nearest) = nearest else {
            self.swarm_velocity = Vector::ZERO;
            return Vector::ZERO;
        };
        let own = self.own_target(percept).and_then(|own| targets.iter().find(|target| target.target == own));
        let own = own.copied().unwrap_or(nearest);
        let known = targets.iter().map(|target| target.position);
        let morphogens = self.field.at(here, known, self.knowledge.obstacles());
        let Morphogens { x1, x2, .. } = morphogens;
        let mut rest = Vec::new();
        self.network.steady_levels([Dual::input(x1, 0), Dual::input(x2, 1)], &mut rest);
        let slopes = rest.last().map_or([S::ZERO; 2], |morphogen| morphogen.gradient);
        self.expression.advance(&self.network, [x1, x2], &rest, self.step, steps);
        let pattern_here = PatternHere {
            error: self.pattern.error(self.expression.morphogen(&self.network)),
            gradient: self.pattern.error_gradient(slopes, &morphogens),
        };
        // The pattern here is that around another target: it does not tell the way to the own one.
        let pattern_here = (own.target == nearest.target).then_some(&pattern_here);
        self.swarm_velocity = own.velocity;
        self.motion.velocity(here, pattern_here, &own, self.knowledge.neighbours(), pace)
    }

    /// How many RK4 steps the time since the last tick and what it left over are.
    fn steps_due(&mut self, elapsed_us: u32) -> u8 {
        let owed = self.owed + elapsed_us * u32::from(self.steps_per_tick);
        self.owed = owed % NOMINAL_TICK_US;
        (owed / NOMINAL_TICK_US).min(MAX_STEPS_PER_TICK as u32) as u8
    }

    /// A robot accompanies the nearest target. Those that see several themselves share them out by their own numbers:
    /// if all mother robots followed one target, the others would get out of sight and lose their robots.
    fn own_target(&self, percept: &Percept) -> Option<u8> {
        let turn = usize::from(self.robot).checked_rem(percept.targets.len())?;
        percept.targets.get(turn).map(|sighting| sighting.target)
    }
}

fn steps_per_tick(time_scale: f32, step: Step) -> Result<u8, LoadError> {
    let steps = time_scale / f32::from(TICKS_PER_SECOND) / step.seconds::<f32>();
    let whole = steps as u8;
    if (1.0..=MAX_STEPS_PER_TICK).contains(&steps) && f32::from(whole) == steps {
        Ok(whole)
    } else {
        Err(LoadError::StepsPerTick(steps))
    }
}

#[cfg(test)]
mod tests;
