//! Lattices over a world, and the inputs of a model at their nodes.

use super::lanes::{Lanes, WIDTH};
use super::world::{Snapshot, World};
use grn_core::geometry::{Point, Vector};
use std::ops::Range;

/// How far a lattice reaches beyond the scenario's region, metres. A pattern that gets there is open.
const MARGIN: f64 = 5.0;

/// A lattice node's place in row-major order.
pub(super) type NodeIndex = usize;

/// East, north, west, south.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Direction(u8);

impl Direction {
    pub(super) const ALL: [Direction; 4] = [Direction(0), Direction(1), Direction(2), Direction(3)];

    pub(super) const fn index(self) -> usize {
        self.0 as usize
    }

    /// A quarter turn clockwise.
    pub(super) const fn right(self) -> Direction {
        Direction((self.0 + 3) & 3)
    }

    /// A quarter turn anticlockwise.
    pub(super) const fn left(self) -> Direction {
        Direction((self.0 + 1) & 3)
    }
}

/// A square lattice over a scenario's region and a margin around it.
///
/// Rows are a whole number of lanes long, so that aligned runs of nodes can be computed together. Nodes on the border
/// count as outside every pattern; only from the others are neighbours asked for.
#[derive(Clone, Debug)]
pub(super) struct Lattice {
    origin: Point<f64>,
    step: f64,
    columns: usize,
    rows: usize,
}

impl Lattice {
    pub(super) fn over(region: [f64; 2], step: f64) -> Lattice {
        let count = |length: f64| ((length + 2.0 * MARGIN) / step).ceil() as usize + 1;
        let columns = count(region[0]).next_multiple_of(WIDTH);
        Lattice { origin: Vector::new(-MARGIN, -MARGIN), step, columns, rows: count(region[1]) }
    }

    pub(super) fn nodes(&self) -> Range<NodeIndex> {
        0..self.columns * self.rows
    }

    pub(super) fn step(&self) -> f64 {
        self.step
    }

    pub(super) fn point(&self, node: NodeIndex) -> Point<f64> {
        let offset = Vector::new((node % self.columns) as f64, (node / self.columns) as f64);
        self.origin + offset * self.step
    }

    /// The next node in a direction from a node that is not on the border.
    pub(super) fn neighbour(&self, node: NodeIndex, direction: Direction) -> NodeIndex {
        match direction.0 {
            0 => node + 1,
            1 => node + self.columns,
            2 => node - 1,
            _ => node - self.columns,
        }
    }

    pub(super) fn is_on_border(&self, node: NodeIndex) -> bool {
        let (column, row) = (node % self.columns, node / self.columns);
        column == 0 || row == 0 || column + 1 == self.columns || row + 1 == self.rows
    }

    /// The corners of the cell that holds `point`, nearest first; empty outside the lattice.
    pub(super) fn cell_around(&self, point: Point<f64>) -> Vec<NodeIndex> {
        let place = (point - self.origin) * (1.0 / self.step);
        let (column, row) = (place.x.floor(), place.y.floor());
        let fits = |value: f64, count: usize| value >= 0.0 && value + 1.0 < count as f64;
        if !fits(column, self.columns) || !fits(row, self.rows) {
            return Vec::new();
        }
        let corner = row as usize * self.columns + column as usize;
        let mut corners = vec![corner, corner + 1, corner + self.columns, corner + self.columns + 1];
        corners.sort_by(|&a, &b| {
            let distance = |node| (self.point(node) - point).length();
            distance(a).total_cmp(&distance(b)).then(a.cmp(&b))
        });
        corners
    }

    /// A node next to `point`, for looking up what varies slowly; `None` outside the lattice.
    pub(super) fn beside(&self, point: Point<f64>) -> Option<NodeIndex> {
        let place = (point - self.origin) * (1.0 / self.step);
        let (column, row) = (place.x.round(), place.y.round());
        let fits = |value: f64, count: usize| value >= 0.0 && value < count as f64;
        (fits(column, self.columns) && fits(row, self.rows)).then(|| row as usize * self.columns + column as usize)
    }
}

/// An edge of the lattice, from one node to its neighbour.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) from: NodeIndex,
    pub(super) to: NodeIndex,
}

/// A lattice with what models need to know at its nodes.
pub(super) trait Medium {
    fn world(&self) -> &World;
    fn lattice(&self) -> &Lattice;
    /// (x1, x2) at eight nodes from `first` on, a multiple of eight.
    fn inputs(&self, snapshot: &Snapshot, first: NodeIndex) -> [Lanes; 2];
    /// (x1, x2) at one node.
    fn inputs_at(&self, snapshot: &Snapshot, node: NodeIndex) -> [f64; 2];
    /// Signed distance to the nearest wall, metres, negative inside.
    fn clearance(&self, node: NodeIndex) -> f64;
    /// Whether a pattern that holds this node leaks: it is in a wall, or at the border.
    fn is_leak(&self, node: NodeIndex) -> bool;

    /// Whether the node is on the lattice's border.
    fn is_on_border(&self, node: NodeIndex) -> bool {
        self.lattice().is_on_border(node)
    }

    /// The point at the fraction `t` of the way along an edge.
    fn along(&self, edge: Edge, t: f64) -> Point<f64> {
        let start = self.lattice().point(edge.from);
        start + (self.lattice().point(edge.to) - start) * t
    }

    /// (x1, x2) at fractions of the way along eight edges. x1 is exact; x2 takes the distance to the walls as linear
    /// along an edge, which it is beside a straight wall.
    fn inputs_along(&self, snapshot: &Snapshot, edges: &[Edge; WIDTH], t: Lanes) -> [Lanes; 2] {
        let points = std::array::from_fn(|lane| self.along(edges[lane], t.0[lane]));
        let clearance = std::array::from_fn(|lane| {
            let (from, to) = (self.clearance(edges[lane].from), self.clearance(edges[lane].to));
            from + (to - from) * t.0[lane]
        });
        [self.world().x1_at_all(snapshot, &points), self.world().x2_at_all(Lanes(clearance))]
    }
}

/// The world's own lattice, whose inputs are kept.
#[derive(Clone, Copy)]
pub(super) struct Kept<'w>(pub &'w World);

impl Medium for Kept<'_> {
    fn world(&self) -> &World {
        self.0
    }
    fn lattice(&self) -> &Lattice {
        &self.0.lattice
    }
    fn inputs(&self, snapshot: &Snapshot, first: NodeIndex) -> [Lanes; 2] {
        let run = |values: &[f64]| Lanes(std::array::from_fn(|lane| values[first + lane]));
        [run(&snapshot.x1), run(&self.0.x2)]
    }
    fn inputs_at(&self, snapshot: &Snapshot, node: NodeIndex) -> [f64; 2] {
        [snapshot.x1[node], self.0.x2[node]]
    }
    fn is_on_border(&self, node: NodeIndex) -> bool {
        self.0.leaks[node] && self.0.lattice.is_on_border(node)
    }
    fn clearance(&self, node: NodeIndex) -> f64 {
        self.0.clearance[node]
    }
    fn is_leak(&self, node: NodeIndex) -> bool {
        self.0.leaks[node]
    }
}

/// A finer lattice, whose inputs are computed when asked for.
pub(super) struct Computed<'w> {
    world: &'w World,
    lattice: Lattice,
}

impl<'w> Computed<'w> {
    pub(super) fn new(world: &'w World, step: f64) -> Self {
        Computed { world, lattice: Lattice::over(world.scenario().region(), step) }
    }
}

impl Medium for Computed<'_> {
    fn world(&self) -> &World {
        self.world
    }
    fn lattice(&self) -> &Lattice {
        &self.lattice
    }
    fn inputs(&self, snapshot: &Snapshot, first: NodeIndex) -> [Lanes; 2] {
        let points = std::array::from_fn(|lane| self.lattice.point(first + lane));
        let clearance = points.map(|point| self.world.clearance_at(point));
        [self.world.x1_at_all(snapshot, &points), self.world.x2_at_all(Lanes(clearance))]
    }
    fn inputs_at(&self, snapshot: &Snapshot, node: NodeIndex) -> [f64; 2] {
        self.world.inputs_at(snapshot, self.lattice.point(node))
    }
    fn clearance(&self, node: NodeIndex) -> f64 {
        self.world.clearance_at(self.lattice.point(node))
    }
    fn is_leak(&self, node: NodeIndex) -> bool {
        next_to_border(&self.lattice, node) || self.clearance(node) <= 0.0
    }
}

/// Whether some neighbour of a node is on the border.
pub(super) fn next_to_border(lattice: &Lattice, node: NodeIndex) -> bool {
    lattice.is_on_border(node)
        || Direction::ALL.into_iter().any(|direction| lattice.is_on_border(lattice.neighbour(node, direction)))
}
