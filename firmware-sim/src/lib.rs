//! Software-in-the-loop simulation: a world around robots that run `grn-core` unchanged.
//!
//! What a robot may know and do is [`Percept`](grn_core::robot::Percept) and [`Command`](grn_core::robot::Command);
//! everything else in here is the simulator's knowledge. Results are the same bits on every machine: single-threaded,
//! seeded, and without the platform's transcendental functions.

pub mod geometry;
pub mod scenario;

pub use scenario::{Scenario, ScenarioError};
