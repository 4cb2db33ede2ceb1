//! One robot in the world: body, senses, clock and brain.

use super::ailments::Ailments;
use crate::body::{BodyParameters, Drive, Pose};
use crate::brain::{Brain, BrainError};
use crate::config::SwarmConfig;
use crate::far_sense::{Eye, FarSense, Seen};
use crate::faults::Fault;
use crate::geometry::length_squared;
use crate::grid::{Grid, WallIndex};
use crate::lab::Laboratory;
use crate::localisation::{PoseError, Track, Tracker};
use crate::proximity::{ALL_FREE, Gains, ProximityRing, ROBOT_REACH, WALL_REACH};
use crate::radio::{Ether, Letter, Obstruction, Receiver};
use crate::random::{Component, Stream};
use crate::scenario::Scene;
use crate::timing::{Clock, FRAME_US};
use grn_core::geometry::Point;
use grn_core::robot::Percept;
use grn_core::robot::epuck2::{BODY_RADIUS, MAX_WHEEL_SPEED, PROXIMITY_SENSORS};

/// What all robots perceive: the world as the last frame left it. Nothing in it changes while they think, so they may do so in any
/// order, or at once.
pub(super) struct Surroundings<'a> {
    pub lab: &'a Laboratory,
    pub frame: u64,
    pub positions: &'a [Point<f64>],
    pub scene: &'a Scene,
    pub samples: &'a [Point<f64>],
    pub sight_m: f64,
    pub grid: &'a Grid,
    pub wall_index: &'a WallIndex,
    pub tracker: &'a Tracker,
    pub ring: &'a ProximityRing,
    pub ether: &'a Ether,
}

/// A robot.
pub(super) struct Unit<B> {
    number: usize,
    pub brain: B,
    pub wheels: [i16; 2],
    ailments: Ailments,
    drive: Drive,
    clock: Clock,
    track: Track,
    receiver: Receiver,
    far_sense: Option<FarSense>,
    gains: Gains,
    noise: Stream,
    slip: Stream,
}

impl<B: Brain> Unit<B> {
    /// Robot number `number` of this swarm, at its start.
    pub fn new(
        number: usize,
        brain: B,
        config: &SwarmConfig,
        faults: Vec<Fault>,
        tracker: &Tracker,
        ether: &Ether,
        samples: usize,
    ) -> Self {
        let SwarmConfig { seed, ref lab, .. } = *config;
        Unit {
            number,
            brain,
            wheels: [0; 2],
            ailments: Ailments::new(faults),
            drive: Drive::new(&BodyParameters::drawn(&lab.wheels, seed, number)),
            clock: Clock::new(&lab.timing, seed, number),
            track: tracker.track(seed, number),
            receiver: ether.receiver(number),
            far_sense: (number < lab.robots.mothers).then(|| FarSense::new(samples)),
            gains: Gains::drawn(lab.proximity.gain, seed, number),
            noise: Stream::new(seed, Component::Sensors, number),
            slip: Stream::new(seed, Component::Wheels, number),
        }
    }

    /// One frame from `pose` on: thinks whenever its clock says so, and drives on in between. What it broadcasts, if anything;
    /// `near` becomes the robots so near that bodies can meet.
    ///
    /// # Errors
    /// The brain's.
    pub fn frame(
        &mut self,
        pose: &mut Pose,
        around: &Surroundings<'_>,
        near: &mut Vec<u16>,
    ) -> Result<Option<Letter>, BrainError> {
        let begin = around.frame * FRAME_US;
        let end = begin + FRAME_US;
        self.find_near(pose, around, near);
        if self.ailments.change_in(around.frame) {
            if self.ailments.update(around.frame) {
                self.brain.reboot()?;
            }
            self.track.jump(self.ailments.now().jump);
        }
        around.tracker.measure(&mut self.track, begin, pose);
        if self.ailments.now().off {
            self.miss(around, end);
            return Ok(None);
        }
        let slip = self.slip_of_this_frame(around);
        let (mut now, mut letter) = (begin, None);
        while self.clock.next_us() < end {
            let next = self.clock.next_us();
            self.drive_on(pose, next - now, slip);
            now = next;
            letter = self.think(pose, around, near, now)?.or(letter);
        }
        self.drive_on(pose, end - now, slip);
        Ok(letter)
    }

    /// Passes a frame switched off: what came to it meanwhile is gone when it is on again.
    fn miss(&mut self, around: &Surroundings<'_>, end_us: u64) {
        self.wheels = [0; 2];
        while self.clock.next_us() < end_us {
            self.clock.tick();
        }
        around.tracker.newest(&mut self.track, end_us);
        around.ether.miss(&mut self.receiver);
    }

    fn find_near(&self, pose: &Pose, around: &Surroundings<'_>, near: &mut Vec<u16>) {
        near.clear();
        let own = self.number as u16;
        around.grid.within(pose.position, ROBOT_REACH * ROBOT_REACH, |other, _| {
            if other != own {
                near.push(other);
            }
        });
    }

    /// For each wheel, how far it rolls as a share of what it should.
    fn slip_of_this_frame(&mut self, around: &Surroundings<'_>) -> [f64; 2] {
        let noise = around.lab.wheels.noise;
        let mut slip = if noise > 0.0 { [(); 2].map(|()| 1.0 + noise * self.slip.normal()) } else { [1.0; 2] };
        for (slip, stuck) in slip.iter_mut().zip(self.ailments.now().stuck) {
            *slip = if stuck { 0.0 } else { *slip };
        }
        slip
    }

    fn drive_on(&self, pose: &mut Pose, time_us: u64, slip: [f64; 2]) {
        if time_us == 0 {
            return;
        }
        let share = time_us as f64 / FRAME_US as f64;
        let [left, right] = self.drive.rolled(self.wheels);
        *pose = self.drive.advanced(*pose, [left * share * slip[0], right * share * slip[1]]);
    }

    fn think(
        &mut self,
        pose: &Pose,
        around: &Surroundings<'_>,
        near: &[u16],
        now_us: u64,
    ) -> Result<Option<Letter>, BrainError> {
        let mut percept = Percept::nothing();
        self.perceive(pose, around, near, now_us, &mut percept);
        let command = self.brain.tick(&percept)?;
        self.wheels = [command.left, command.right].map(|speed| speed.clamp(-MAX_WHEEL_SPEED, MAX_WHEEL_SPEED));
        let broadcast = command.broadcast.filter(|_| !self.ailments.now().without_radio);
        Ok(broadcast.map(|message| Letter::of(&message, now_us)))
    }

    /// Fills an empty percept, in its place: it is large.
    fn perceive(&mut self, pose: &Pose, around: &Surroundings<'_>, near: &[u16], now_us: u64, percept: &mut Percept) {
        percept.elapsed_us = self.clock.tick();
        percept.fix = around.tracker.newest(&mut self.track, now_us);
        if self.far_sense.is_some() {
            Seen { targets: percept.targets, obstacles: percept.obstacles } = self.far(pose.position, around);
        }
        percept.proximity = self.proximity(pose, around, near);
        if self.ailments.now().without_radio {
            around.ether.miss(&mut self.receiver);
        } else {
            let obstruction = Obstruction { walls: around.scene.walls(), positions: around.positions };
            around.ether.deliver(&mut self.receiver, pose.position, now_us, &obstruction, &mut percept.heard);
        }
    }

    fn far(&mut self, position: Point<f64>, around: &Surroundings<'_>) -> Seen {
        let Some(far_sense) = &mut self.far_sense else { return Seen::default() };
        let sighting = &around.lab.sighting;
        let error = if sighting.own_pose_error { self.track.error() } else { PoseError::NONE };
        let eye = Eye { position, range: around.sight_m, error, noise_m: sighting.noise_m };
        far_sense.look(&eye, around.scene.targets(), around.samples, &mut self.noise)
    }

    fn proximity(&mut self, pose: &Pose, around: &Surroundings<'_>, near: &[u16]) -> [u16; PROXIMITY_SENSORS] {
        let mut free = ALL_FREE;
        for &other in near {
            around.ring.sense_body(pose, around.positions[usize::from(other)], BODY_RADIUS, &mut free);
        }
        for edge in around.wall_index.near(pose.position) {
            if length_squared(edge.nearest(pose.position) - pose.position) <= WALL_REACH * WALL_REACH {
                around.ring.sense_edge(pose, edge, &mut free);
            }
        }
        let target_radius = around.lab.bodies.target_radius_m;
        if target_radius > 0.0 {
            for &target in around.scene.targets().iter().flatten() {
                around.ring.sense_body(pose, target, target_radius, &mut free);
            }
        }
        self.ailments.now().readings(around.ring.readings(&free, &self.gains, &mut self.noise))
    }
}
