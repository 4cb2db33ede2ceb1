//! Missions: worlds drawn at random, each of a class and for a swarm of its own, that a swarm can pass by construction.
//!
//! How a mission is drawn:
//!
//! 1. Its number of targets, of robots, the clearance of the way and whether walls block radio, as `sampling` allows.
//! 2. `obstacles` lays out what its class puts beside the way, in a plane of its own, `layout` turns and mirrors it into a region.
//! 3. Several targets go one behind the other; each goes a part of the same way, and all pass all obstacles.
//! 4. `robots` places the robots behind the targets.

mod class;
mod draw;
mod layout;
mod mission;
mod obstacles;
mod robots;
pub mod sampling;

pub use class::{Class, UnknownClass};
pub use mission::Mission;
pub use sampling::Sampling;
