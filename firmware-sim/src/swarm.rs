//! The world in motion: robots with brains, bodies, sensors and radio, around targets on their paths.
//!
//! How a frame, 1/32 s, goes:
//!
//! 1. Once a second a base station, if there is one, says which robots are to be out.
//! 2. Each robot perceives the world as the last frame left it whenever its clock says so, its brain answers, and it drives on.
//!    This depends on no other robot's part of the frame, so it may happen in any order, and on several threads at once.
//! 3. Overlaps are resolved, targets and walls move on, and the new state is recorded.
//!
//! What a brain broadcasts in a frame is heard in the next one at the earliest.

mod ailments;
mod base;
mod evasion;
mod outcome;
mod part;
mod placement;
mod unit;

use crate::base_station::{BaseRecord, Circumference};
use crate::body::Pose;
use crate::brain::Brain;
use crate::config::SwarmConfig;
use crate::contacts::{ContactCounts, Contacts, Solid};
use crate::faults::{Fault, FaultPlan};
use crate::grid::{Grid, WallIndex};
use crate::lab::FaultKind;
use crate::localisation::Tracker;
use crate::proximity::{ProximityRing, ROBOT_REACH, WALL_REACH};
use crate::radio::Ether;
use crate::scenario::{Course, OBSTACLE_SPACING, PERCEPTION_RANGE, Scenario, Scene};
use crate::trace::{Frame, Observer, RobotState};
use crate::units::{micrometres, unit_q14};
use base::BaseStation;
use core::fmt;
use core::ops::ControlFlow;
use evasion::Evasions;
use grn_core::geometry::Point;
use grn_core::robot::epuck2::TICKS_PER_SECOND;
use grn_input::InputError;
pub use outcome::{Outcome, Progress, StepError};
use part::{CROWD, Numbered, PART, Part};
use rayon::prelude::*;
use std::sync::Arc;
use unit::{Surroundings, Unit};

/// The farthest coordinate a percept and a message can tell, metres.
const MAX_COORDINATE: f64 = 32.767;

/// A swarm in a world. All lengths in real metres.
pub struct Swarm<B> {
    config: SwarmConfig,
    world: Scenario,
    course: Course,
    /// Targets and walls at the present moment.
    scene: Scene,
    evasions: Evasions,
    /// Places on the outlines of walls that mothers may see: those of fixed walls, then those of others at the present moment.
    samples: Vec<Point<f64>>,
    fixed_samples: usize,
    wall_index: WallIndex,
    tracker: Tracker,
    ring: ProximityRing,
    units: Vec<Unit<B>>,
    parts: Vec<Part>,
    poses: Vec<Pose>,
    /// Where robots were at the beginning of the frame.
    positions: Vec<Point<f64>>,
    near: Vec<(u16, u16)>,
    grid: Grid,
    ether: Ether,
    contacts: Contacts,
    tick: u64,
    faults: FaultPlan,
    /// Who is carried away when, the next one last.
    carried: Vec<Fault>,
    base: Option<BaseStation>,
    recorded: Recorded,
}

/// The present moment as observers see it.
#[derive(Default)]
struct Recorded {
    targets_um: Vec<Option<[i32; 2]>>,
    robots: Vec<RobotState>,
    contacts: ContactCounts,
}

impl<B> fmt::Debug for Swarm<B> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("Swarm");
        shown.field("config", &self.config).field("frame", &self.tick).field("positions", &self.positions);
        shown.finish_non_exhaustive()
    }
}

/// Whether a swarm can be set up in a scenario's world at the configured scale.
///
/// # Errors
/// As [`Swarm::new`].
pub fn check(scenario: &Scenario, config: &SwarmConfig) -> Result<(), InputError> {
    set_up(scenario, config).map(|_| ())
}

/// Ticks until the world has taken its course.
pub fn arrival_tick(course: &Course) -> u64 {
    (course.end_s() * f64::from(TICKS_PER_SECOND)).ceil() as u64
}

/// The world in real metres, where the robots start, and what goes wrong until the targets have arrived.
fn set_up(scenario: &Scenario, config: &SwarmConfig) -> Result<(Scenario, Vec<Pose>, FaultPlan), InputError> {
    config.check()?;
    let world = scenario.scaled(config.scale);
    let extent = world.extent();
    let farthest = [extent.low, extent.high].into_iter().fold(0.0, |far: f64, p| far.max(p.x.abs()).max(p.y.abs()));
    let reach = MAX_COORDINATE - 1.0;
    if farthest > reach {
        let most = config.scale * reach / farthest;
        let way_out = format!(
            "the world reaches to {farthest:.1} m, but robots can tell 31.7 m only; a scale up to {most:.3} is possible"
        );
        return Err(InputError::new("scale", config.scale, way_out));
    }
    let poses = placement::starting(&world, config)?;
    let faults = FaultPlan::drawn(&config.lab, config.seed, arrival_tick(&Course::of(&world, config)))?;
    Ok((world, poses, faults))
}

impl<B: Brain> Swarm<B> {
    /// The scenario's world at the configured scale, with robots where it says that they begin, else at random places behind the first
    /// target's start, each with the brain that `brain` gives for its number.
    ///
    /// # Errors
    /// [`InputError`] when the configuration fails [`SwarmConfig::check`], the scaled world is larger than ±32.767 m,
    /// the robots find no room, or a base station is to send them, which needs a pattern.
    pub fn new(scenario: &Scenario, config: SwarmConfig, brain: impl FnMut(usize) -> B) -> Result<Self, InputError> {
        Self::with_pattern(scenario, config, None, brain)
    }

    /// The same with a pattern of this circumference, as a base station needs it; without one the circumference is not used.
    ///
    /// # Errors
    /// As of [`new`](Self::new).
    pub fn with_pattern(
        scenario: &Scenario,
        config: SwarmConfig,
        circumference: Option<Arc<Circumference>>,
        mut brain: impl FnMut(usize) -> B,
    ) -> Result<Self, InputError> {
        let (world, poses, faults) = set_up(scenario, &config)?;
        let lab = &config.lab;
        let positions: Vec<Point<f64>> = poses.iter().map(|pose| pose.position).collect();
        let base = BaseStation::of(lab, circumference, &faults, &positions, world.targets().len())?;
        let n = lab.robots.count;
        let samples = scenario.fixed_walls().boundary_samples(OBSTACLE_SPACING);
        let samples: Vec<Point<f64>> = samples.into_iter().map(|p| p * config.scale).collect();
        let scene = Scene::of(&world, 0.0);
        let tracker = Tracker::new(&lab.localisation);
        let ether = Ether::new(&lab.radio, config.seed, n);
        let unit = |(robot, faults)| Unit::new(robot, brain(robot), &config, faults, &tracker, &ether, samples.len());
        let units: Vec<Unit<B>> = faults.by_robot(n).into_iter().enumerate().map(unit).collect();
        let mut swarm = Swarm {
            wall_index: WallIndex::new(scene.walls(), WALL_REACH),
            course: Course::of(&world, &config),
            scene,
            evasions: Evasions::new(world.targets().len()),
            fixed_samples: samples.len(),
            ring: ProximityRing::new(&lab.proximity),
            parts: units.chunks(PART).map(|_| Part::default()).collect(),
            units,
            positions,
            poses,
            samples,
            tracker,
            near: Vec::with_capacity(n * 16),
            // A frame's motion and pushes stay below the margin that this leaves around touching distance.
            grid: Grid::new(ROBOT_REACH, n),
            ether,
            contacts: Contacts::new(n),
            tick: 0,
            carried: faults.faults().iter().filter(|fault| fault.kind == FaultKind::Carried).rev().copied().collect(),
            faults,
            base,
            recorded: Recorded { robots: vec![RobotState::default(); n], ..Recorded::default() },
            world,
            config,
        };
        swarm.sample_moving_walls();
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

    /// Targets and walls as they are now, in real metres.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Frames simulated so far.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// What goes wrong in the run.
    pub fn faults(&self) -> &FaultPlan {
        &self.faults
    }

    /// What the base station did, if there is one.
    pub fn base_record(&self) -> Option<&BaseRecord> {
        self.base.as_ref().map(|base| &base.record)
    }

    /// Where robots are and look now.
    pub fn poses(&self) -> &[Pose] {
        &self.poses
    }

    /// The brains, by robot number.
    pub fn brains(&self) -> impl ExactSizeIterator<Item = &B> {
        self.units.iter().map(|unit| &unit.brain)
    }

    /// The present moment.
    pub fn frame(&self) -> Frame<'_> {
        let Recorded { targets_um, robots, contacts } = &self.recorded;
        let off_duty = self.base.as_ref().map_or(&[][..], BaseStation::off_duty);
        Frame { tick: self.tick, targets_um, robots, off_duty, contacts: *contacts }
    }

    /// The tick at which all targets have arrived: settling time plus travelling time, rounded up.
    pub fn arrival_tick(&self) -> u64 {
        arrival_tick(&self.course)
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

    /// One frame.
    ///
    /// # Errors
    /// [`StepError`] when a brain fails; of several, that of the robot with the lowest number. The frame is broken off then,
    /// and the swarm cannot go on.
    pub fn step(&mut self) -> Result<(), StepError> {
        self.carry_away();
        self.send_and_call();
        self.grid.rebuild((0..).zip(self.positions.iter().copied()));
        self.ether.begin(self.tick, &self.positions);
        self.think_and_drive()?;
        self.near.clear();
        for part in &self.parts {
            for (robot, letter) in &part.letters {
                self.ether.send(usize::from(*robot), letter);
                if let (Some(base), Some(report)) = (&mut self.base, letter.target()) {
                    base.hear(report, self.tick);
                }
            }
            self.near.extend_from_slice(&part.near);
        }
        let solid = Solid {
            walls: self.scene.walls(),
            index: &self.wall_index,
            targets: self.scene.targets(),
            target_radius: self.config.lab.bodies.target_radius_m,
        };
        let counts = self.contacts.resolve(&mut self.poses, &self.near, &solid);
        for (position, pose) in self.positions.iter_mut().zip(&self.poses) {
            *position = pose.position;
        }
        self.tick += 1;
        self.move_world();
        self.record(counts);
        Ok(())
    }

    fn carry_away(&mut self) {
        while let Some(fault) = self.carried.pop_if(|next| next.from <= self.tick) {
            let robot = fault.robot;
            let pose = placement::carried(
                &self.world,
                self.scene.walls(),
                &self.poses,
                self.poses[robot],
                &mut fault.stream(),
            );
            self.poses[robot] = pose;
            self.positions[robot] = pose.position;
        }
    }

    /// The base station decides once a second.
    fn send_and_call(&mut self) {
        if let Some(base) = &mut self.base
            && self.tick.is_multiple_of(u64::from(TICKS_PER_SECOND))
        {
            base.decide(self.tick, &self.positions, self.scene.targets(), &mut self.units);
        }
    }

    fn think_and_drive(&mut self) -> Result<(), StepError> {
        let around = Surroundings {
            lab: &self.config.lab,
            frame: self.tick,
            positions: &self.positions,
            scene: &self.scene,
            samples: &self.samples,
            sight_m: PERCEPTION_RANGE * self.config.scale,
            grid: &self.grid,
            wall_index: &self.wall_index,
            tracker: &self.tracker,
            ring: &self.ring,
            ether: &self.ether,
        };
        let one = |(number, (part, ((units, poses), states))): Numbered<'_, B>| {
            part.frame(number * PART, units, poses, states, &around)
        };
        let states = &mut self.recorded.robots;
        if self.units.len() < CROWD {
            let robots = self.units.chunks_mut(PART).zip(self.poses.chunks_mut(PART)).zip(states.chunks_mut(PART));
            return self.parts.iter_mut().zip(robots).enumerate().try_for_each(one);
        }
        let robots = self.units.par_chunks_mut(PART).zip(self.poses.par_chunks_mut(PART));
        let parts = self.parts.par_iter_mut().zip(robots.zip(states.par_chunks_mut(PART))).enumerate();
        // Whoever fails first in time, the one with the lowest number is named.
        parts.filter_map(|part| one(part).err()).min_by_key(|error| error.robot).map_or(Ok(()), Err)
    }

    /// Targets and walls as they are in this frame.
    fn move_world(&mut self) {
        self.scene.move_to(&self.world, self.course.time_at(self.tick as f64 / f64::from(TICKS_PER_SECOND)));
        if self.world.walls_change() {
            self.wall_index.set_moving(self.scene.walls());
            self.sample_moving_walls();
        }
        let step = self.config.target_speed_m_per_s / f64::from(TICKS_PER_SECOND);
        self.evasions.step(&self.world, &mut self.scene, &self.positions, step);
    }

    fn sample_moving_walls(&mut self) {
        let spacing = OBSTACLE_SPACING * self.config.scale;
        self.samples.truncate(self.fixed_samples);
        self.samples.extend(self.scene.walls().moving().iter().flat_map(|wall| wall.boundary_samples(spacing)));
    }

    fn record(&mut self, contacts: ContactCounts) {
        let um = |p: Point<f64>| [micrometres(p.x), micrometres(p.y)];
        self.recorded.targets_um.clear();
        self.recorded.targets_um.extend(self.scene.targets().iter().map(|target| target.map(um)));
        for (state, pose) in self.recorded.robots.iter_mut().zip(&self.poses) {
            state.position_um = um(pose.position);
            state.heading_q14 = [unit_q14(pose.heading.x), unit_q14(pose.heading.y)];
        }
        self.recorded.contacts = contacts;
    }
}

#[cfg(test)]
mod tests;
