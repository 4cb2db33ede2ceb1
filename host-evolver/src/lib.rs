//! Evolves gene-regulatory-network controllers and tells what they are worth: the host side of grn.

pub mod evolve;
pub mod objective;
pub mod published;
pub mod report;
pub mod search;
pub mod tree;
pub mod variation;
