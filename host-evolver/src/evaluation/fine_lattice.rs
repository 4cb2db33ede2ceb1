//! A finer lattice, on which doubtful topology is decided.

use super::lanes::{Lanes, WIDTH};
use super::lattice::{LATTICE_STEP, Lattice, Site};
use std::sync::OnceLock;

/// Spacing of the fine lattice, metres.
pub(super) const FINE_STEP: f64 = LATTICE_STEP / 4.0;

/// x1 is kept for this many snapshots, which takes 5 KB a run of eight nodes; more would cost more memory than they save
/// time.
pub(super) const MOST_KEPT_SNAPSHOTS: usize = 64;

/// What is the same for every model at eight nodes.
#[derive(Debug)]
pub(super) struct Run {
    pub(super) clearance: [f64; WIDTH],
    pub(super) sites: [Site; WIDTH],
    pub(super) x2: Lanes,
    /// At each of the first [`MOST_KEPT_SNAPSHOTS`].
    pub(super) x1: Vec<OnceLock<Lanes>>,
}

/// Room for the inputs at all nodes, of which none is computed yet. Threads share it: whoever computes a value, it is the same.
pub(super) fn no_runs(fine: &Lattice) -> Vec<OnceLock<Box<Run>>> {
    fine.nodes().step_by(WIDTH).map(|_| OnceLock::new()).collect()
}
