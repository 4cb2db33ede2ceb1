//! What evolved models are compared with in closed loop: a circle that knows nothing of obstacles, and rules that owe nothing to gene
//! regulation.
//!
//! They live beside the simulation and not in `grn-core`: no robot is flashed with them. What a robot knows they take from
//! `grn-core` all the same (localisation, messages, neighbours, reflexes), so that only the decision where to go differs.

mod circle;
pub mod rule_ring;

pub use circle::{circle, circle_blob};
