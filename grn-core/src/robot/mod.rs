//! The robot: percept → controller → wheel command, the radio messages between robots and their bytes, the link to a host, and the slots
//! that blobs are flashed to.
//!
//! Everything that crosses the controller's border is made of integers in stated units, so that a percept can be
//! recorded, sent over a wire and replayed bit for bit, and a robot without a floating-point unit needs none.

mod avoidance;
mod clock;
pub mod controller;
mod drive;
pub mod epuck2;
mod knowledge;
pub mod link;
mod localisation;
pub mod message;
mod motion;
mod neighbours;
mod obstacles;
pub mod parts;
pub mod percept;
mod position;
pub mod radio;
pub mod slots;

pub use controller::{Controller, LoadError};
pub use message::{Message, ObstacleReport, TargetReport};
pub use percept::{Command, Fix, Heard, Percept, PerceptError, Sighting};
pub use position::Millimetres;
