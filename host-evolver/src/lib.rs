//! Evolves gene-regulatory-network controllers and tells what they are worth: the host side of grn.

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
pub mod sectors;
pub mod simulation;
pub mod slot_file;
pub mod statistics;
pub mod tree;
pub mod variation;
