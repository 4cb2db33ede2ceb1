//! A finer lattice, on which doubtful topology is decided.

use super::lanes::{Lanes, WIDTH};
use super::lattice::{Edge, Lattice, Medium, NodeIndex, Site};
use super::world::{LATTICE_STEP, Snapshot, World, is_crease};
use std::sync::OnceLock;

/// Spacing of the fine lattice, metres.
const FINE_STEP: f64 = LATTICE_STEP / 4.0;

/// The fine lattice and what was asked for so far, by whichever thread: every thread would find the same.
#[derive(Debug)]
pub(super) struct FineLattice {
    lattice: Lattice,
    runs: Vec<OnceLock<Box<Run>>>,
}

/// At so many moments x1 is kept, which takes 5 KB a run; for more it would not pay.
const MOST_KEPT_MOMENTS: usize = 64;

/// What no model changes at eight nodes.
#[derive(Debug)]
struct Run {
    clearance: [f64; WIDTH],
    sites: [Site; WIDTH],
    x2: Lanes,
    /// At each of the first [`MOST_KEPT_MOMENTS`].
    x1: Vec<OnceLock<Lanes>>,
}

impl FineLattice {
    pub(super) fn over(region: [f64; 2]) -> FineLattice {
        let lattice = Lattice::over(region, FINE_STEP);
        let runs = lattice.nodes().step_by(WIDTH).map(|_| OnceLock::new()).collect();
        FineLattice { lattice, runs }
    }
}

/// The fine lattice as a medium: inputs are computed when asked for.
#[derive(Clone, Copy)]
pub(super) struct Computed<'w>(pub &'w World);

impl Computed<'_> {
    /// The run that holds a node.
    fn run(&self, node: NodeIndex) -> &Run {
        self.0.fine.runs[node / WIDTH].get_or_init(|| {
            let first = node - node % WIDTH;
            let clearance = self.lattice().run(first).map(|point| self.0.clearance_at(point));
            let site = |lane: usize| Site::of(self.lattice(), first + lane, clearance[lane]);
            Box::new(Run {
                clearance,
                sites: std::array::from_fn(site),
                x2: self.0.x2_at_all(Lanes(clearance)),
                x1: vec![OnceLock::new(); self.0.snapshots().len().min(MOST_KEPT_MOMENTS)],
            })
        })
    }
}

impl Medium for Computed<'_> {
    const KEEPS_INPUTS: bool = false;
    fn world(&self) -> &World {
        self.0
    }
    fn lattice(&self) -> &Lattice {
        &self.0.fine.lattice
    }
    fn inputs(&self, snapshot: &Snapshot, first: NodeIndex) -> [Lanes; 2] {
        let run = self.run(first);
        let x1 = || self.0.x1_at_all(snapshot, &self.lattice().run(first));
        [run.x1.get(snapshot.place).map_or_else(x1, |kept| *kept.get_or_init(x1)), run.x2]
    }
    fn inputs_at(&self, snapshot: &Snapshot, node: NodeIndex) -> [f64; 2] {
        self.0.inputs_at(snapshot, self.lattice().point(node))
    }
    fn clearance(&self, node: NodeIndex) -> f64 {
        self.run(node).clearance[node % WIDTH]
    }
    fn site(&self, node: NodeIndex) -> Site {
        self.run(node).sites[node % WIDTH]
    }
    fn is_creased(&self, edge: Edge) -> bool {
        let middle = self.0.clearance_at(self.along(edge, 0.5));
        is_crease(self.clearance(edge.from), middle, self.clearance(edge.to))
    }
}
