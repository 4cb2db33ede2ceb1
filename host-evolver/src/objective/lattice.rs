//! Lattices over a world, and the inputs of a model at their nodes.

use super::world::{Snapshot, World};
use grn_core::geometry::{Point, Vector};
use std::ops::Range;

/// How far a lattice reaches beyond the scenario's region, metres. A pattern that gets there is open.
const MARGIN: f64 = 5.0;

/// A lattice node's place in row-major order.
pub(super) type NodeIndex = usize;

/// A square lattice over a scenario's region and a margin around it.
#[derive(Clone, Debug)]
pub(super) struct Lattice {
    origin: Point<f64>,
    pub(super) step: f64,
    columns: usize,
    rows: usize,
}

impl Lattice {
    pub(super) fn over(region: [f64; 2], step: f64) -> Lattice {
        let count = |length: f64| ((length + 2.0 * MARGIN) / step).ceil() as usize + 1;
        Lattice { origin: Vector::new(-MARGIN, -MARGIN), step, columns: count(region[0]), rows: count(region[1]) }
    }

    pub(super) fn nodes(&self) -> Range<NodeIndex> {
        0..self.columns * self.rows
    }

    pub(super) fn point(&self, node: NodeIndex) -> Point<f64> {
        let offset = Vector::new((node % self.columns) as f64, (node / self.columns) as f64);
        self.origin + offset * self.step
    }

    /// The next node to the east (0), north (1), west (2) or south (3); `None` beyond the lattice.
    pub(super) fn neighbour(&self, node: NodeIndex, direction: u8) -> Option<NodeIndex> {
        let column = node % self.columns;
        match direction {
            0 => (column + 1 < self.columns).then(|| node + 1),
            1 => Some(node + self.columns).filter(|&north| north < self.columns * self.rows),
            2 => (column > 0).then(|| node - 1),
            _ => node.checked_sub(self.columns),
        }
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

/// A lattice with what models need to know at its nodes.
pub(super) trait Medium {
    fn world(&self) -> &World;
    fn lattice(&self) -> &Lattice;
    /// (x1, x2) at a node.
    fn inputs(&self, snapshot: &Snapshot, node: NodeIndex) -> [f64; 2];
    /// Signed distance to the nearest wall, metres, negative inside.
    fn clearance(&self, node: NodeIndex) -> f64;

    /// The point at the fraction `t` of the way between two nodes.
    fn between(&self, from: NodeIndex, to: NodeIndex, t: f64) -> Point<f64> {
        let start = self.lattice().point(from);
        start + (self.lattice().point(to) - start) * t
    }

    /// (x1, x2) at the fraction `t` of the way between two neighbouring nodes. x1 is exact; x2 takes the distance to the
    /// walls as linear between the nodes, which it is beside a straight wall.
    fn inputs_between(&self, snapshot: &Snapshot, from: NodeIndex, to: NodeIndex, t: f64) -> [f64; 2] {
        let clearance = self.clearance(from) + (self.clearance(to) - self.clearance(from)) * t;
        let point = self.between(from, to, t);
        [self.world().x1_at(snapshot, point), self.world().x2_at(clearance)]
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
    fn inputs(&self, snapshot: &Snapshot, node: NodeIndex) -> [f64; 2] {
        [snapshot.x1[node], self.0.x2[node]]
    }
    fn clearance(&self, node: NodeIndex) -> f64 {
        self.0.clearance[node]
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
    fn inputs(&self, snapshot: &Snapshot, node: NodeIndex) -> [f64; 2] {
        self.world.inputs_at(snapshot, self.lattice.point(node))
    }
    fn clearance(&self, node: NodeIndex) -> f64 {
        self.world.clearance_at(self.lattice.point(node))
    }
}
