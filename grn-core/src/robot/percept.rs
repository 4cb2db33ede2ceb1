//! What the controller is told each tick and what it answers.

use super::epuck2::PROXIMITY_SENSORS;
use super::message::Message;
use super::position::Millimetres;
use heapless::Vec;
use serde::{Deserialize, Serialize};

/// The most targets a robot sees or keeps in mind.
pub const MAX_TARGETS: usize = 4;
/// The most obstacle points a robot's own sensors report in one tick.
pub const MAX_SEEN_OBSTACLES: usize = 8;
/// The most messages delivered to a robot in one tick; a radio keeps the strongest.
pub const MAX_HEARD: usize = 8;

/// A target seen with the robot's own sensors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sighting {
    /// Which target: targets can be told apart.
    pub target: u8,
    /// Where it is.
    pub position: Millimetres,
}

/// Everything a robot perceives in one tick.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Percept {
    /// Own position in the world, micrometres.
    pub position: [i32; 2],
    /// Own heading as (cos, sin), in units of 2^-14.
    pub heading: [i16; 2],
    /// Free distance in front of each proximity sensor, from the body's edge, in units of 0.1 mm; `u16::MAX` when
    /// nothing is in range. Bearings as in [`PROXIMITY_BEARINGS_DEG`](super::epuck2::PROXIMITY_BEARINGS_DEG).
    pub proximity: [u16; PROXIMITY_SENSORS],
    /// Targets seen with own sensors (mother robots).
    pub targets: Vec<Sighting, MAX_TARGETS>,
    /// Points on obstacles seen with own sensors (mother robots).
    pub obstacles: Vec<Millimetres, MAX_SEEN_OBSTACLES>,
    /// Messages received since the last tick. The robot's own, which some radios give back, are ignored.
    pub heard: Vec<Message, MAX_HEARD>,
}

/// What a robot does until the next tick.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Command {
    /// Left wheel, steps per second, forward positive, within ±1100.
    pub left: i16,
    /// Right wheel, steps per second, forward positive, within ±1100.
    pub right: i16,
    /// What to broadcast in this tick, if anything.
    pub broadcast: Option<Message>,
}
