//! Evolves gene-regulatory-network controllers and tells what they are worth: the host side of grn.

// These panic where nobody can hear them; the command line has its own way to speak.
#![deny(clippy::print_stdout, clippy::print_stderr, clippy::dbg_macro)]

pub mod campaign;
pub mod cli;
pub mod deploy;
pub mod describe;
pub mod eh_grn;
#[cfg(unix)]
pub mod emulation;
pub mod evolve;
pub mod figures;
pub mod files;
pub mod objective;
pub mod objectives;
pub mod port;
pub mod published;
pub mod report;
pub mod run;
pub mod search;
pub mod simulation;
pub mod slot_file;
pub mod statistics;
pub mod tree;
pub mod variation;
