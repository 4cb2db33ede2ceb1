//! The robot: percept → controller → wheel command, and the radio messages between robots.
//!
//! Everything that crosses the controller's border is made of integers in stated units, so that a percept can be
//! recorded, sent over a wire and replayed bit for bit, and a robot without a floating-point unit needs none.

pub mod epuck2;
pub mod message;
pub mod percept;

pub use message::{Message, TargetReport};
pub use percept::{Command, Millimetres, Percept, Sighting};
