//! Evolves gene-regulatory-network controllers and tells what they are worth: the host side of grn.

// These panic where nobody can hear them; the command line has its own way to speak.
#![deny(clippy::print_stdout, clippy::print_stderr, clippy::dbg_macro)]

pub mod baselines;
pub mod campaign;
pub mod cli;
pub mod cluster;
#[cfg(unix)]
pub mod emulation;
pub mod evaluation;
pub mod evolve;
pub mod faults;
pub mod figures;
pub mod files;
pub mod missions;
pub mod model;
pub mod pattern_length;
pub mod quoting;
pub mod realities;
pub mod record;
pub mod results;
pub mod run;
pub mod sectors;
pub mod simulation;
pub mod slot_file;
pub mod survey;
