//! Percept, command and message as C has them.

use crate::status::GrnStatus;
use grn_core::robot::epuck2::{PROXIMITY_SENSORS, TICKS_PER_SECOND};
use grn_core::robot::message::MAX_REPORTED_OBSTACLES;
use grn_core::robot::percept::{MAX_HEARD, MAX_SEEN_OBSTACLES, MAX_TARGETS, NOMINAL_TICK_US};
use grn_core::robot::{Command, Fix, Heard, Message, Millimetres, ObstacleReport, Percept, Sighting, TargetReport};
use heapless::Vec;

/// How often grn_tick is to be called.
pub const GRN_TICKS_PER_SECOND: usize = 32;
/// The time from one tick to the next, microseconds, if ticks come on time.
pub const GRN_NOMINAL_TICK_US: u32 = 31_250;
/// How many proximity sensors the ring has.
pub const GRN_PROXIMITY_SENSORS: usize = 8;
/// The most targets in a percept.
pub const GRN_MAX_TARGETS: usize = 4;
/// The most obstacle points in a percept.
pub const GRN_MAX_SEEN_OBSTACLES: usize = 8;
/// The most messages in a percept.
pub const GRN_MAX_HEARD: usize = 8;
/// The most obstacle points in a message.
pub const GRN_MAX_REPORTED_OBSTACLES: usize = 4;
/// The bytes of a blob's identity.
pub const GRN_IDENTITY_BYTES: usize = 8;

// Numbers in the header, because cbindgen does not look into other crates; held to those of the core.
const _: () = assert!(GRN_TICKS_PER_SECOND == TICKS_PER_SECOND as usize);
const _: () = assert!(GRN_NOMINAL_TICK_US == NOMINAL_TICK_US);
const _: () = assert!(GRN_PROXIMITY_SENSORS == PROXIMITY_SENSORS);
const _: () = assert!(GRN_MAX_TARGETS == MAX_TARGETS);
const _: () = assert!(GRN_MAX_SEEN_OBSTACLES == MAX_SEEN_OBSTACLES);
const _: () = assert!(GRN_MAX_HEARD == MAX_HEARD);
const _: () = assert!(GRN_MAX_REPORTED_OBSTACLES == MAX_REPORTED_OBSTACLES);

// No structure has padding: what would be padding is named `reserved`, so that every byte is written and the bytes of a
// structure can be compared, kept and sent. `layout.rs` holds sizes and offsets.

/// A position in the world, millimetres, within 32767 either way.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GrnMillimetres {
    /// East.
    pub x: i16,
    /// North.
    pub y: i16,
}

/// A target seen with the robot's own sensors.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GrnSighting {
    /// Which target: targets can be told apart.
    pub target: u8,
    /// 0; not read.
    pub reserved: u8,
    /// Where it is.
    pub position: GrnMillimetres,
}

/// A target as somebody knows it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GrnTargetReport {
    /// Which target.
    pub target: u8,
    /// 0; not read.
    pub reserved0: u8,
    /// Where the sender expects it at the time of sending.
    pub position: GrnMillimetres,
    /// Its velocity, millimetres per second: east, north.
    pub velocity: [i8; 2],
    /// Ticks since it was seen, over all relays; 255 means at least that.
    pub age: u8,
    /// 0; not read.
    pub reserved1: u8,
}

/// An obstacle point as somebody knows it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GrnObstacleReport {
    /// A point on the obstacle's boundary.
    pub position: GrnMillimetres,
    /// Units of 8 ticks since it was seen, over all relays; 255 means at least that.
    pub age: u8,
    /// 0; not read.
    pub reserved: u8,
}

/// What robots tell each other by radio: who and where I am, and some of what I know.
///
/// To be sent, use grn_message_write, whose bytes are fewer, the same on all machines, and protected by a checksum.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GrnMessage {
    /// Number of the robot that sends, unique in the swarm.
    pub sender: u16,
    /// Where it is.
    pub position: GrnMillimetres,
    /// 0 if it tells of no target; then "target" is not read.
    pub has_target: u8,
    /// 0; not read.
    pub reserved0: u8,
    /// One of the targets it knows, in turn.
    pub target: GrnTargetReport,
    /// How many of "obstacles" there are, from 0 to GRN_MAX_REPORTED_OBSTACLES.
    pub obstacle_count: u8,
    /// 0; not read.
    pub reserved1: u8,
    /// Some of the obstacle points it knows, in turn.
    pub obstacles: [GrnObstacleReport; GRN_MAX_REPORTED_OBSTACLES],
}

/// A message received by radio.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GrnHeard {
    /// What was said.
    pub message: GrnMessage,
    /// How long it was on its way as far as the radio knows, milliseconds; 0 if that is not known.
    pub age_ms: u16,
}

/// What a localisation system says of the robot: where it was and how it looked when that was measured.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GrnFix {
    /// Own position in the world, micrometres: east, north; each within 32767000 either way.
    pub position: [i32; 2],
    /// Own heading as (cos, sin), in units of 2^-14, anticlockwise from east: 16384, 0 is east, 0, 16384 is north. The
    /// length of this vector may be a 32nd off 16384, that is from 15872 to 16896.
    pub heading: [i16; 2],
    /// How long ago it was measured, milliseconds; 0 if that is not known.
    pub age_ms: u16,
    /// 0; not read.
    pub reserved: [u8; 2],
}

/// Everything a robot perceives in one tick.
///
/// Begin every tick with GRN_PERCEPT_NOTHING or grn_percept_nothing, then put in what is perceived. Zeros mean something
/// else than nothing: obstacles that touch the robot on all sides; grn_tick refuses them, because no time has elapsed.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GrnPercept {
    /// Time since the last tick, microseconds, from 1000 to 250000; GRN_NOMINAL_TICK_US if ticks come on time.
    pub elapsed_us: u32,
    /// Where the robot is, if the localisation system has said so since the last tick.
    pub fix: GrnFix,
    /// Free distance in front of each proximity sensor, from the body's edge, in units of 0.1 mm; UINT16_MAX when
    /// nothing is in range (5 cm). Bearings from the heading, degrees, left positive: -17, -50, -90, -150, 150, 90, 50, 17.
    pub proximity: [u16; GRN_PROXIMITY_SENSORS],
    /// 0 if there is no new fix; then "fix" is not read.
    pub has_fix: u8,
    /// How many of "targets" there are, from 0 to GRN_MAX_TARGETS.
    pub target_count: u8,
    /// Targets seen with own sensors (mother robots).
    pub targets: [GrnSighting; GRN_MAX_TARGETS],
    /// How many of "obstacles" there are, from 0 to GRN_MAX_SEEN_OBSTACLES.
    pub obstacle_count: u8,
    /// How many of "heard" there are, from 0 to GRN_MAX_HEARD.
    pub heard_count: u8,
    /// Points on obstacles seen with own sensors (mother robots).
    pub obstacles: [GrnMillimetres; GRN_MAX_SEEN_OBSTACLES],
    /// Messages received since the last tick; of more, the strongest. The robot's own, which some radios give back, are
    /// ignored.
    pub heard: [GrnHeard; GRN_MAX_HEARD],
}

/// What a robot does until the next tick.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GrnCommand {
    /// Left wheel, motor steps per second (0.1288 mm each), forward positive, within 1100 either way.
    pub left: i16,
    /// Right wheel, likewise.
    pub right: i16,
    /// 1 if there is a message to broadcast in this tick, else 0.
    pub has_broadcast: u8,
    /// 0.
    pub reserved: u8,
    /// The message; all zero without one.
    pub broadcast: GrnMessage,
}

impl From<GrnMillimetres> for Millimetres {
    fn from(GrnMillimetres { x, y }: GrnMillimetres) -> Self {
        Millimetres { x, y }
    }
}

impl From<Millimetres> for GrnMillimetres {
    fn from(Millimetres { x, y }: Millimetres) -> Self {
        GrnMillimetres { x, y }
    }
}

impl From<GrnSighting> for Sighting {
    fn from(GrnSighting { target, position, reserved: _ }: GrnSighting) -> Self {
        Sighting { target, position: position.into() }
    }
}

impl From<GrnTargetReport> for TargetReport {
    fn from(report: GrnTargetReport) -> Self {
        let GrnTargetReport { target, reserved0: _, position, velocity, age, reserved1: _ } = report;
        TargetReport { target, position: position.into(), velocity, age }
    }
}

impl From<TargetReport> for GrnTargetReport {
    fn from(TargetReport { target, position, velocity, age }: TargetReport) -> Self {
        GrnTargetReport { target, reserved0: 0, position: position.into(), velocity, age, reserved1: 0 }
    }
}

impl From<GrnObstacleReport> for ObstacleReport {
    fn from(GrnObstacleReport { position, age, reserved: _ }: GrnObstacleReport) -> Self {
        ObstacleReport { position: position.into(), age }
    }
}

impl From<ObstacleReport> for GrnObstacleReport {
    fn from(ObstacleReport { position, age }: ObstacleReport) -> Self {
        GrnObstacleReport { position: position.into(), age, reserved: 0 }
    }
}

impl From<GrnFix> for Fix {
    fn from(GrnFix { position, heading, age_ms, reserved: _ }: GrnFix) -> Self {
        Fix { position, heading, age_ms }
    }
}

impl TryFrom<&GrnHeard> for Heard {
    type Error = GrnStatus;

    fn try_from(GrnHeard { message, age_ms }: &GrnHeard) -> Result<Self, GrnStatus> {
        Ok(Heard { message: message.try_into()?, age_ms: *age_ms })
    }
}

impl TryFrom<&GrnMessage> for Message {
    type Error = GrnStatus;

    fn try_from(message: &GrnMessage) -> Result<Self, GrnStatus> {
        let mut obstacles = Vec::new();
        fill(&mut obstacles, &message.obstacles, message.obstacle_count, GrnStatus::TooManyReported, |&report| {
            Ok(report.into())
        })?;
        Ok(Message {
            sender: message.sender,
            position: message.position.into(),
            target: (message.has_target != 0).then(|| message.target.into()),
            obstacles,
        })
    }
}

impl From<Message> for GrnMessage {
    fn from(message: Message) -> Self {
        let mut obstacles = [GrnObstacleReport::default(); GRN_MAX_REPORTED_OBSTACLES];
        for (slot, report) in obstacles.iter_mut().zip(&message.obstacles) {
            *slot = (*report).into();
        }
        GrnMessage {
            sender: message.sender,
            position: message.position.into(),
            has_target: message.target.is_some().into(),
            reserved0: 0,
            target: message.target.map(Into::into).unwrap_or_default(),
            obstacle_count: message.obstacles.len() as u8,
            reserved1: 0,
            obstacles,
        }
    }
}

impl GrnPercept {
    /// What GRN_PERCEPT_NOTHING is in C.
    pub fn nothing() -> Self {
        GrnPercept {
            elapsed_us: GRN_NOMINAL_TICK_US,
            fix: GrnFix::default(),
            proximity: [u16::MAX; GRN_PROXIMITY_SENSORS],
            has_fix: 0,
            target_count: 0,
            targets: [GrnSighting::default(); GRN_MAX_TARGETS],
            obstacle_count: 0,
            heard_count: 0,
            obstacles: [GrnMillimetres::default(); GRN_MAX_SEEN_OBSTACLES],
            heard: [GrnHeard::default(); GRN_MAX_HEARD],
        }
    }

    /// Puts it into a percept in which nothing is perceived, in place: on the chip's stack it is large.
    pub(crate) fn tell(&self, percept: &mut Percept) -> Result<(), GrnStatus> {
        // By name, so that a field that a percept gets is missed here.
        let Percept { fix, elapsed_us, proximity, targets, obstacles, heard } = percept;
        *fix = (self.has_fix != 0).then(|| self.fix.into());
        *elapsed_us = self.elapsed_us;
        *proximity = self.proximity;
        fill(targets, &self.targets, self.target_count, GrnStatus::TooManyTargets, |&sighting| Ok(sighting.into()))?;
        fill(obstacles, &self.obstacles, self.obstacle_count, GrnStatus::TooManyObstacles, |&point| Ok(point.into()))?;
        fill(heard, &self.heard, self.heard_count, GrnStatus::TooManyHeard, |heard| heard.try_into())
    }
}

impl From<Command> for GrnCommand {
    fn from(Command { left, right, broadcast }: Command) -> Self {
        let has_broadcast = broadcast.is_some().into();
        let broadcast = broadcast.map(Into::into).unwrap_or_default();
        GrnCommand { left, right, has_broadcast, reserved: 0, broadcast }
    }
}

/// Converts the first `count` of `items` into `list`; `excess` if there are not so many.
fn fill<C, T, const N: usize>(
    list: &mut Vec<T, N>,
    items: &[C; N],
    count: u8,
    excess: GrnStatus,
    convert: impl Fn(&C) -> Result<T, GrnStatus>,
) -> Result<(), GrnStatus> {
    let counted = items.get(..usize::from(count)).ok_or(excess)?;
    counted.iter().try_for_each(|item| list.push(convert(item)?).map_err(|_| excess))
}
