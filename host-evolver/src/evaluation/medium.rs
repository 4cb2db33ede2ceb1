//! A lattice with the inputs of models at its nodes: stored for the coarse lattice, computed on demand for the fine one.

use super::fine_lattice::{MOST_KEPT_SNAPSHOTS, Run};
use super::ground::Ground;
use super::hidden::stands_for_wall;
use super::lanes::{Lanes, WIDTH};
use super::lattice::{Edge, Lattice, NodeIndex, Site, is_crease};
use super::world::{Snapshot, World};
use grn_core::geometry::Point;
use std::sync::OnceLock;

/// A lattice with what models need to know at its nodes.
pub(super) trait Medium {
    /// Whether the inputs at all nodes are stored, so that reading them costs nothing.
    const KEEPS_INPUTS: bool;
    fn world(&self) -> &World;
    fn lattice(&self) -> &Lattice;
    /// (x1, x2) at eight nodes from `first` on, a multiple of eight.
    fn inputs(&self, snapshot: &Snapshot, first: NodeIndex) -> [Lanes; 2];
    /// (x1, x2) at one node.
    fn inputs_at(&self, snapshot: &Snapshot, node: NodeIndex) -> [f64; 2];
    /// Signed distance to the nearest wall, metres, negative inside.
    fn clearance(&self, snapshot: &Snapshot, node: NodeIndex) -> f64;
    /// What a pattern meets at a node.
    fn site(&self, snapshot: &Snapshot, node: NodeIndex) -> Site;

    /// Whether the distance to the walls is far from linear along an edge.
    fn is_creased(&self, snapshot: &Snapshot, edge: Edge) -> bool;

    /// The point at the fraction `t` of the way along an edge.
    fn along(&self, edge: Edge, t: f64) -> Point<f64> {
        let start = self.lattice().point(edge.from);
        start + (self.lattice().point(edge.to) - start) * t
    }

    /// (x1, x2) at fractions of the way along eight edges. x1 is exact; x2 takes the distance to the walls as linear
    /// along an edge, which it is beside a straight wall; other edges are
    /// [creased](Medium::is_creased).
    fn inputs_along(&self, snapshot: &Snapshot, edges: &[Edge; WIDTH], t: Lanes) -> [Lanes; 2] {
        let points = std::array::from_fn(|lane| self.along(edges[lane], t.0[lane]));
        let clearance = std::array::from_fn(|lane| {
            let (from, to) = (self.clearance(snapshot, edges[lane].from), self.clearance(snapshot, edges[lane].to));
            from + (to - from) * t.0[lane]
        });
        [self.world().x1_at_all(snapshot, &points), self.world().x2_at_all(&snapshot.ground, Lanes(clearance))]
    }
}

/// Whether an edge is creased, or x2 changes so fast along it that one evaluation does not find where the contour crosses it.
pub(super) fn is_creased_or_blurred<M: Medium>(medium: &M, snapshot: &Snapshot, edge: Edge) -> bool {
    let ends = [edge.from, edge.to].map(|node| medium.clearance(snapshot, node));
    let middle = || snapshot.ground.clearance_at(medium.along(edge, 0.5));
    ends[0].min(ends[1]) < snapshot.ground.blurred || is_crease(ends[0], middle(), ends[1])
}

/// The coarse lattice, with stored inputs.
#[derive(Clone, Copy)]
pub(super) struct Kept<'w>(pub &'w World);

impl Medium for Kept<'_> {
    const KEEPS_INPUTS: bool = true;
    fn world(&self) -> &World {
        self.0
    }
    fn lattice(&self) -> &Lattice {
        &self.0.coarse
    }
    fn inputs(&self, snapshot: &Snapshot, first: NodeIndex) -> [Lanes; 2] {
        [0, 1].map(|input| Lanes(std::array::from_fn(|lane| f64::from(snapshot.inputs[first + lane][input]))))
    }
    fn inputs_at(&self, snapshot: &Snapshot, node: NodeIndex) -> [f64; 2] {
        snapshot.inputs[node].map(f64::from)
    }
    fn clearance(&self, snapshot: &Snapshot, node: NodeIndex) -> f64 {
        snapshot.ground.clearance[node]
    }
    fn site(&self, snapshot: &Snapshot, node: NodeIndex) -> Site {
        snapshot.ground.sites[node]
    }
    fn is_creased(&self, snapshot: &Snapshot, edge: Edge) -> bool {
        let along_rows = edge.from.abs_diff(edge.to) == 1;
        snapshot.ground.creases[edge.from.min(edge.to)][usize::from(!along_rows)]
    }
}

/// The fine lattice: inputs are computed on demand and then kept.
#[derive(Clone, Copy)]
pub(super) struct Computed<'w>(pub &'w World);

impl Computed<'_> {
    /// The run that holds a node.
    fn run<'s>(&self, snapshot: &'s Snapshot, node: NodeIndex) -> &'s Run {
        let ground = &*snapshot.ground;
        ground.runs[node / WIDTH].get_or_init(|| {
            let snapshots = ground.snapshots.min(MOST_KEPT_SNAPSHOTS);
            Box::new(run(self.0, ground, self.lattice(), node - node % WIDTH, snapshots))
        })
    }
}

/// What is known at eight nodes from `first` on of a lattice that is fine enough to be believed, where a node may stand for
/// a wall that no node shows; with room for x1 at so many snapshots.
pub(super) fn run(world: &World, ground: &Ground, lattice: &Lattice, first: NodeIndex, snapshots: usize) -> Run {
    let points = lattice.run(first);
    let clearance = points.map(|point| ground.clearance_at(point));
    let is_wall: [bool; WIDTH] = std::array::from_fn(|lane| {
        let is_near = clearance[lane] > 0.0 && clearance[lane] < lattice.step();
        is_near && stands_for_wall(ground.walls(), lattice, points[lane])
    });
    let to_wall = std::array::from_fn(|lane| if is_wall[lane] { 0.0 } else { clearance[lane] });
    Run {
        clearance,
        sites: std::array::from_fn(|lane| Site::of(lattice, first + lane, to_wall[lane], false)),
        // Where x2 changes slowly it is left as it is beside the wall.
        x2: world.x2_at_all(ground, Lanes(if ground.blurred > 0.0 { to_wall } else { clearance })),
        x1: vec![OnceLock::new(); snapshots],
    }
}

impl Medium for Computed<'_> {
    const KEEPS_INPUTS: bool = false;
    fn world(&self) -> &World {
        self.0
    }
    fn lattice(&self) -> &Lattice {
        &self.0.fine
    }
    fn inputs(&self, snapshot: &Snapshot, first: NodeIndex) -> [Lanes; 2] {
        let run = self.run(snapshot, first);
        let x1 = || self.0.x1_at_all(snapshot, &self.lattice().run(first));
        [run.x1.get(snapshot.nth).map_or_else(x1, |kept| *kept.get_or_init(x1)), run.x2]
    }
    fn inputs_at(&self, snapshot: &Snapshot, node: NodeIndex) -> [f64; 2] {
        let [x1, _] = self.0.inputs_at(snapshot, self.lattice().point(node));
        [x1, self.run(snapshot, node).x2.0[node % WIDTH]]
    }
    fn clearance(&self, snapshot: &Snapshot, node: NodeIndex) -> f64 {
        self.run(snapshot, node).clearance[node % WIDTH]
    }
    fn site(&self, snapshot: &Snapshot, node: NodeIndex) -> Site {
        self.run(snapshot, node).sites[node % WIDTH]
    }
    fn is_creased(&self, snapshot: &Snapshot, edge: Edge) -> bool {
        is_creased_or_blurred(self, snapshot, edge)
    }
}
