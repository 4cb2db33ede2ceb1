//! The world in motion: robots with brains, bodies, sensors and radio, around targets on their paths.
//!
//! One tick, 1/32 s: every robot perceives the world as the last tick left it, every brain answers, then all bodies move
//! at once, overlaps are resolved, the targets move on, and the new state is recorded. What a brain broadcasts in tick t
//! is heard in tick t + 1.

mod placement;

use crate::body::{BodyParameters, Drive, Pose};
use crate::brain::{Brain, BrainError};
use crate::config::{ConfigError, SwarmConfig};
use crate::contacts::{ContactCounts, Contacts};
use crate::geometry::{Walls, length_squared};
use crate::grid::{Grid, WallIndex};
use crate::radio::Radio;
use crate::random::{Component, Stream};
use crate::scenario::{PERCEPTION_RANGE, Scenario};
use crate::sensors::{
    ALL_FREE, FarSense, FreeDistances, ProximityRing, ROBOT_REACH, Seen, WALL_REACH, localise, micrometres, unit_q14,
};
use crate::trace::{Frame, Observer, RobotState};
use core::fmt;
use core::ops::ControlFlow;
use grn_core::geometry::Point;
use grn_core::robot::Percept;
use grn_core::robot::epuck2::{MAX_WHEEL_SPEED, TICKS_PER_SECOND};
use grn_core::robot::percept::NOMINAL_TICK_US;

/// The farthest coordinate a percept and a message can tell, metres.
const MAX_COORDINATE: f64 = 32.767;

/// How far a run has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Ticks simulated since the swarm was made.
    pub tick: u64,
    /// The tick at which this run ends.
    pub end: u64,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// All ticks are simulated.
    Finished,
    /// The callback asked to stop.
    Interrupted,
}

/// A brain failed.
#[derive(Debug)]
pub struct StepError {
    /// Whose brain.
    pub robot: usize,
    /// In which tick.
    pub tick: u64,
    /// Why.
    pub source: BrainError,
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "robot {} gave no command in tick {}: {}", self.robot, self.tick, self.source)
    }
}

impl core::error::Error for StepError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        Some(&self.source)
    }
}

/// A swarm in a world. All lengths in real metres.
pub struct Swarm<B> {
    config: SwarmConfig,
    world: Scenario,
    samples: Vec<Point<f64>>,
    wall_index: WallIndex,
    brains: Vec<B>,
    /// The first tick without a robot, if it breaks down.
    stop_ticks: Vec<Option<u64>>,
    drives: Vec<Drive>,
    poses: Vec<Pose>,
    positions: Vec<Point<f64>>,
    wheels: Vec<[i16; 2]>,
    noise: Vec<Stream>,
    far_senses: Vec<FarSense>,
    ring: ProximityRing,
    free: Vec<FreeDistances>,
    near: Vec<(u16, u16)>,
    grid: Grid,
    radio: Radio,
    contacts: Contacts,
    targets: Vec<Point<f64>>,
    tick: u64,
    recorded: Recorded,
}

/// The present moment as observers see it.
#[derive(Default)]
struct Recorded {
    targets_um: Vec<[i32; 2]>,
    robots: Vec<RobotState>,
    contacts: ContactCounts,
}

impl<B> fmt::Debug for Swarm<B> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("Swarm");
        shown.field("config", &self.config).field("tick", &self.tick).field("poses", &self.poses);
        shown.finish_non_exhaustive()
    }
}

/// Whether a swarm can be set up in a scenario's world at the configured scale.
///
/// # Errors
/// As [`Swarm::new`].
pub fn check(scenario: &Scenario, config: &SwarmConfig) -> Result<(), ConfigError> {
    set_up(scenario, config).map(|_| ())
}

/// The world in real metres, and where the robots start.
fn set_up(scenario: &Scenario, config: &SwarmConfig) -> Result<(Scenario, Vec<Pose>), ConfigError> {
    config.check()?;
    let world = scenario.scaled(config.scale);
    let walls = world.walls().bounds().into_iter().flat_map(|bounds| [bounds.low, bounds.high]);
    let extent = world.paths().iter().flat_map(|path| path.points().iter().copied()).chain(walls);
    let farthest = extent.fold(world.region()[0].max(world.region()[1]), |far, p| far.max(p.x.abs()).max(p.y.abs()));
    let reach = MAX_COORDINATE - 1.0;
    if farthest > reach {
        let most = config.scale * reach / farthest;
        return Err(ConfigError {
            field: "scale",
            value: config.scale.to_string(),
            expected: format!(
                "the world reaches to {farthest:.1} m, but robots can tell 31.7 m only; a scale up to {most:.3} is possible"
            ),
        });
    }
    let poses = placement::scattered(&world, config.robots, config.seed).ok_or_else(|| ConfigError {
        field: "robots",
        value: config.robots.to_string(),
        expected: format!(
            "so many robots find no room in the region at scale {}; fewer robots, a larger scale or a larger region are needed",
            config.scale
        ),
    })?;
    Ok((world, poses))
}

impl<B: Brain> Swarm<B> {
    /// The scenario's world at the configured scale, with robots at random places behind the first target's start, each
    /// with the brain that `brain` gives for its number.
    ///
    /// # Errors
    /// [`ConfigError`] when the configuration fails [`SwarmConfig::check`], the scaled world is larger than ±32.767 m, or
    /// the robots find no room.
    pub fn new(
        scenario: &Scenario,
        config: SwarmConfig,
        mut brain: impl FnMut(usize) -> B,
    ) -> Result<Self, ConfigError> {
        let (world, poses) = set_up(scenario, &config)?;
        let n = config.robots;
        let drives = (0..n).map(|robot| {
            let mut stream = Stream::new(config.seed, Component::Variation, robot);
            let mut factor = || 1.0 + config.variation * stream.symmetric();
            Drive::new(&BodyParameters::varied([factor(), factor(), factor()]))
        });
        let samples: Vec<Point<f64>> = scenario.boundary_samples().into_iter().map(|p| p * config.scale).collect();
        let mut swarm = Swarm {
            wall_index: WallIndex::new(world.walls(), WALL_REACH),
            brains: (0..n).map(&mut brain).collect(),
            stop_ticks: config.stop_ticks(),
            drives: drives.collect(),
            positions: poses.iter().map(|pose| pose.position).collect(),
            poses,
            wheels: vec![[0; 2]; n],
            noise: (0..n).map(|robot| Stream::new(config.seed, Component::Sensors, robot)).collect(),
            far_senses: (0..config.mothers).map(|_| FarSense::new(samples.len())).collect(),
            samples,
            ring: ProximityRing::default(),
            free: vec![ALL_FREE; n],
            near: Vec::with_capacity(n * 16),
            // A tick's motion and pushes stay below the margin that this leaves around touching distance.
            grid: Grid::new(ROBOT_REACH, n),
            radio: Radio::new(config.radio, config.seed, n),
            contacts: Contacts::new(n),
            targets: world.targets_at(0.0),
            tick: 0,
            recorded: Recorded::default(),
            world,
            config,
        };
        swarm.record(ContactCounts::default());
        Ok(swarm)
    }

    /// The configuration.
    pub fn config(&self) -> &SwarmConfig {
        &self.config
    }

    /// The scenario in real metres.
    pub fn world(&self) -> &Scenario {
        &self.world
    }

    /// The walls in real metres.
    pub fn walls(&self) -> &Walls {
        self.world.walls()
    }

    /// Ticks simulated so far.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// Where robots are and look now.
    pub fn poses(&self) -> &[Pose] {
        &self.poses
    }

    /// Where targets are now.
    pub fn targets(&self) -> &[Point<f64>] {
        &self.targets
    }

    /// The brains, by robot number.
    pub fn brains(&self) -> &[B] {
        &self.brains
    }

    /// The present moment.
    pub fn frame(&self) -> Frame<'_> {
        let Recorded { targets_um, robots, contacts } = &self.recorded;
        Frame { tick: self.tick, targets_um, robots, contacts: *contacts }
    }

    /// The tick at which all targets have arrived: settling time plus travelling time, rounded up.
    pub fn arrival_tick(&self) -> u64 {
        ((self.config.settle_s + self.travel_s()) * f64::from(TICKS_PER_SECOND)).ceil() as u64
    }

    fn travel_s(&self) -> f64 {
        self.world.longest_path() / self.config.target_speed_m_per_s
    }

    /// Simulates up to the tick `end`. `observer` sees the start, if nothing has been simulated yet, and the world after
    /// every tick. `watch` is called before each simulated second and at the end, and may stop the run.
    ///
    /// # Errors
    /// [`StepError`] when a brain fails; the observer has then seen the last whole tick.
    pub fn run(
        &mut self,
        end: u64,
        observer: &mut (impl Observer + ?Sized),
        mut watch: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Outcome, StepError> {
        if self.tick == 0 {
            observer.observe(&self.frame());
        }
        while self.tick < end {
            let whole_second = self.tick.is_multiple_of(u64::from(TICKS_PER_SECOND));
            if whole_second && watch(Progress { tick: self.tick, end }).is_break() {
                return Ok(Outcome::Interrupted);
            }
            self.step()?;
            observer.observe(&self.frame());
        }
        let _ = watch(Progress { tick: self.tick, end });
        Ok(Outcome::Finished)
    }

    /// One tick.
    ///
    /// # Errors
    /// [`StepError`] when a brain fails. No body has moved then, but the brains of robots with lower numbers have already
    /// computed this tick.
    pub fn step(&mut self) -> Result<(), StepError> {
        self.sense_neighbours();
        let messages: Result<(), StepError> = (0..self.brains.len()).try_for_each(|robot| self.think(robot));
        messages?;
        self.radio.tick_over();
        for ((pose, drive), &[left, right]) in self.poses.iter_mut().zip(&self.drives).zip(&self.wheels) {
            *pose = drive.advanced(*pose, left, right);
        }
        let counts = self.contacts.resolve(&mut self.poses, &self.near, self.world.walls(), &self.wall_index);
        for (position, pose) in self.positions.iter_mut().zip(&self.poses) {
            *position = pose.position;
        }
        self.tick += 1;
        self.move_targets();
        self.record(counts);
        Ok(())
    }

    /// Finds the pairs near each other, and what every proximity ring sees.
    fn sense_neighbours(&mut self) {
        self.grid.rebuild((0..).zip(self.positions.iter().copied()));
        self.radio.locate(&self.positions);
        self.free.fill(ALL_FREE);
        self.near.clear();
        for (robot, pose) in self.poses.iter().enumerate() {
            let free = &mut self.free[robot];
            self.grid.within(pose.position, ROBOT_REACH * ROBOT_REACH, |other, _| {
                let other_index = usize::from(other);
                if other_index != robot {
                    self.ring.sense_robot(pose, self.positions[other_index], free);
                    if robot < other_index {
                        self.near.push((robot as u16, other));
                    }
                }
            });
            for edge in self.wall_index.near(pose.position) {
                let nearest = edge.nearest(pose.position);
                if length_squared(nearest - pose.position) <= WALL_REACH * WALL_REACH {
                    self.ring.sense_edge(pose, edge, free);
                }
            }
        }
    }

    /// One robot's percept and its brain's answer.
    fn think(&mut self, robot: usize) -> Result<(), StepError> {
        if self.stop_ticks[robot].is_some_and(|stop| self.tick >= stop) {
            self.wheels[robot] = [0, 0];
            return Ok(());
        }
        let (pose, noise, stream) = (&self.poses[robot], &self.config.noise, &mut self.noise[robot]);
        let fix = Some(localise(pose, noise, stream));
        let proximity = ProximityRing::quantised(&self.free[robot], noise.proximity_m, stream);
        let range = PERCEPTION_RANGE * self.config.scale;
        let look = |sense: &mut FarSense| sense.look(pose.position, range, &self.targets, &self.samples, noise, stream);
        let Seen { targets, obstacles } = self.far_senses.get_mut(robot).map(look).unwrap_or_default();
        let heard = self.radio.deliver(robot, pose.position);
        let percept = Percept { fix, elapsed_us: NOMINAL_TICK_US, proximity, targets, obstacles, heard };
        let fault = |source| StepError { robot, tick: self.tick, source };
        let command = self.brains[robot].tick(&percept).map_err(fault)?;
        self.wheels[robot] = [command.left, command.right].map(|s| s.clamp(-MAX_WHEEL_SPEED, MAX_WHEEL_SPEED));
        self.radio.send(robot, command.broadcast.as_ref());
        Ok(())
    }

    fn move_targets(&mut self) {
        let travelled = self.tick as f64 / f64::from(TICKS_PER_SECOND) - self.config.settle_s;
        let fraction = if travelled > 0.0 { travelled / self.travel_s() } else { 0.0 };
        for (target, path) in self.targets.iter_mut().zip(self.world.paths()) {
            *target = path.at(fraction);
        }
    }

    fn record(&mut self, contacts: ContactCounts) {
        let um = |p: Point<f64>| [micrometres(p.x), micrometres(p.y)];
        let robots = self.poses.iter().zip(&self.wheels).map(|(pose, &wheels)| RobotState {
            position_um: um(pose.position),
            heading_q14: [unit_q14(pose.heading.x), unit_q14(pose.heading.y)],
            wheels,
        });
        self.recorded.targets_um.clear();
        self.recorded.targets_um.extend(self.targets.iter().map(|&target| um(target)));
        self.recorded.robots.clear();
        self.recorded.robots.extend(robots);
        self.recorded.contacts = contacts;
    }
}

#[cfg(test)]
mod tests;
