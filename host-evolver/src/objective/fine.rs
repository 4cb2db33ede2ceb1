//! A finer lattice, on which doubtful topology is decided.

use super::lanes::{Lanes, WIDTH};
use super::lattice::{Edge, Lattice, Medium, NodeIndex, Site};
use super::world::{LATTICE_STEP, Snapshot, World, is_crease};
use std::sync::atomic::{AtomicU64, Ordering};

/// Spacing of the fine lattice, metres.
const FINE_STEP: f64 = LATTICE_STEP / 4.0;

/// The fine lattice and those distances to the walls that were asked for so far, by whichever thread.
#[derive(Debug)]
pub(super) struct FineLattice {
    lattice: Lattice,
    /// The bits of the clearance at each node; 0 where it is not known yet.
    clearance: Vec<AtomicU64>,
}

impl FineLattice {
    pub(super) fn over(region: [f64; 2]) -> FineLattice {
        let lattice = Lattice::over(region, FINE_STEP);
        let clearance = lattice.nodes().map(|_| AtomicU64::new(0)).collect();
        FineLattice { lattice, clearance }
    }
}

/// The fine lattice as a medium: inputs are computed when asked for.
#[derive(Clone, Copy)]
pub(super) struct Computed<'w>(pub &'w World);

impl Medium for Computed<'_> {
    const KEEPS_INPUTS: bool = false;
    fn world(&self) -> &World {
        self.0
    }
    fn lattice(&self) -> &Lattice {
        &self.0.fine.lattice
    }
    fn inputs(&self, snapshot: &Snapshot, first: NodeIndex) -> [Lanes; 2] {
        let points: [_; WIDTH] = std::array::from_fn(|lane| self.lattice().point(first + lane));
        let clearance = std::array::from_fn(|lane| self.clearance(first + lane));
        [self.0.x1_at_all(snapshot, &points), self.0.x2_at_all(Lanes(clearance))]
    }
    fn inputs_at(&self, snapshot: &Snapshot, node: NodeIndex) -> [f64; 2] {
        self.0.inputs_at(snapshot, self.lattice().point(node))
    }
    fn clearance(&self, node: NodeIndex) -> f64 {
        let known = &self.0.fine.clearance[node];
        // Every thread would find the same bits, so it does not matter who stores them first.
        match known.load(Ordering::Relaxed) {
            0 => {
                let clearance = self.0.clearance_at(self.lattice().point(node));
                known.store(clearance.to_bits(), Ordering::Relaxed);
                clearance
            }
            bits => f64::from_bits(bits),
        }
    }
    fn site(&self, node: NodeIndex) -> Site {
        Site::of(self.lattice(), node, self.clearance(node))
    }
    fn is_creased(&self, edge: Edge) -> bool {
        let middle = self.0.clearance_at(self.along(edge, 0.5));
        is_crease(self.clearance(edge.from), middle, self.clearance(edge.to))
    }
}
