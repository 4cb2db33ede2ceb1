//! Evolves gene-regulatory-network controllers and tells what they are worth: the host side of grn.

pub mod campaign;
pub mod cli;
#[cfg(unix)]
pub mod emulation;
pub mod evaluation;
pub mod evolve;
pub mod figures;
pub mod files;
pub mod model;
pub mod quoting;
pub mod run;
pub mod sectors;
pub mod simulation;
pub mod slot_file;
