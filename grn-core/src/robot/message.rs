//! What robots tell each other by radio.

use super::position::Millimetres;
use heapless::Vec;
use serde::{Deserialize, Serialize};

/// Ticks between two broadcasts of a robot: a quarter of a second, in which it moves 3 cm. Robots take turns by their
/// numbers, so that they do not all broadcast in the same tick.
pub(super) const BROADCAST_PERIOD: u32 = 8;
/// The most obstacle points in one message.
pub const MAX_REPORTED_OBSTACLES: usize = 4;

/// A target as somebody knows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TargetReport {
    /// Which target.
    pub target: u8,
    /// Where the sender expects it at the time of sending.
    pub position: Millimetres,
    /// Its velocity, millimetres per second, (east, north).
    pub velocity: [i8; 2],
    /// Ticks since it was seen, over all relays; 255 means at least that.
    pub age: u8,
}

/// An obstacle point as somebody knows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ObstacleReport {
    /// A point on the obstacle's boundary.
    pub position: Millimetres,
    /// Units of 8 ticks since it was seen, over all relays; 255 means at least that.
    pub age: u8,
}

/// A broadcast: who and where I am, and some of what I know.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Message {
    /// Number of the robot that sends, unique in the swarm.
    pub sender: u16,
    /// Where it is.
    pub position: Millimetres,
    /// One of the targets it knows, in turn.
    pub target: Option<TargetReport>,
    /// Some of the obstacle points it knows, in turn.
    pub obstacles: Vec<ObstacleReport, MAX_REPORTED_OBSTACLES>,
}
