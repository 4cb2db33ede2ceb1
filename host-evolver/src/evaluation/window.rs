//! A small lattice around one target, at one snapshot, for patterns that are smaller than what other lattices show.

use super::fine_lattice::Run;
use super::lanes::{Lanes, WIDTH};
use super::lattice::{Edge, Lattice, NodeIndex, Site};
use super::medium::{Medium, is_creased_or_blurred, run};
use super::world::{Snapshot, World};
use grn_core::geometry::Point;

/// So many nodes lie to each side of the target.
const REACH: usize = 40;

/// Everything known at the nodes around a target. It may only be asked about the snapshot it was made for.
pub(super) struct Window<'w> {
    world: &'w World,
    lattice: Lattice,
    runs: Vec<(Run, Lanes)>,
}

impl<'w> Window<'w> {
    /// Around `target`, with nodes `step` metres apart.
    pub(super) fn new(world: &'w World, snapshot: &Snapshot, target: Point<f64>, step: f64) -> Self {
        let lattice = Lattice::around(target, step, REACH);
        let known = |first| {
            let x1 = world.x1_at_all(snapshot, &lattice.run(first));
            (run(world, &snapshot.ground, &lattice, first, 0), x1)
        };
        Window { world, runs: lattice.nodes().step_by(WIDTH).map(known).collect(), lattice }
    }
}

impl Medium for Window<'_> {
    const KEEPS_INPUTS: bool = false;
    fn world(&self) -> &World {
        self.world
    }
    fn lattice(&self) -> &Lattice {
        &self.lattice
    }
    fn inputs(&self, _: &Snapshot, first: NodeIndex) -> [Lanes; 2] {
        let (run, x1) = &self.runs[first / WIDTH];
        [*x1, run.x2]
    }
    fn inputs_at(&self, _: &Snapshot, node: NodeIndex) -> [f64; 2] {
        let (run, x1) = &self.runs[node / WIDTH];
        [x1.0[node % WIDTH], run.x2.0[node % WIDTH]]
    }
    fn clearance(&self, _: &Snapshot, node: NodeIndex) -> f64 {
        self.runs[node / WIDTH].0.clearance[node % WIDTH]
    }
    fn site(&self, _: &Snapshot, node: NodeIndex) -> Site {
        self.runs[node / WIDTH].0.sites[node % WIDTH]
    }
    fn is_creased(&self, snapshot: &Snapshot, edge: Edge) -> bool {
        is_creased_or_blurred(self, snapshot, edge)
    }
}
