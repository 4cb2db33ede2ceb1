//! What evolved models are compared with in closed loop: controllers that owe nothing to gene regulation.
//!
//! They live beside the simulation and not in `grn-core`: no robot is flashed with them. What a robot knows they take from
//! `grn-core` all the same (localisation, messages, neighbours, reflexes), so that only the decision where to go differs.

pub mod rule_ring;
