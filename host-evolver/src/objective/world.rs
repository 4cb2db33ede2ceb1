//! A scenario prepared for judging many models: morphogens on a lattice, which no model changes.

use firmware_sim::geometry::Walls;
use firmware_sim::scenario::Scenario;
use grn_core::field::Field;
use grn_core::geometry::{Point, Vector};
use std::ops::Range;

/// Spacing of the lattice, metres. Contours are refined between its nodes; only topology is decided on it.
pub const LATTICE_STEP: f64 = 0.125;
/// How far the lattice reaches beyond the scenario's region, metres. A pattern that gets there is open.
const MARGIN: f64 = 5.0;
/// Stands for "no wall near": every kernel is 0 there.
const FAR: f64 = 1e3;

/// A lattice node's place in row-major order.
pub(super) type NodeIndex = usize;

/// The lattice over a scenario's region and its margin.
#[derive(Clone, Debug)]
pub(super) struct Lattice {
    origin: Point<f64>,
    columns: usize,
    rows: usize,
}

impl Lattice {
    fn over(region: [f64; 2]) -> Lattice {
        let count = |length: f64| ((length + 2.0 * MARGIN) / LATTICE_STEP).ceil() as usize + 1;
        Lattice { origin: Vector::new(-MARGIN, -MARGIN), columns: count(region[0]), rows: count(region[1]) }
    }

    pub(super) fn nodes(&self) -> Range<NodeIndex> {
        0..self.columns * self.rows
    }

    pub(super) fn point(&self, node: NodeIndex) -> Point<f64> {
        let offset = Vector::new((node % self.columns) as f64, (node / self.columns) as f64);
        self.origin + offset * LATTICE_STEP
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
        let place = (point - self.origin) * (1.0 / LATTICE_STEP);
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
    fn beside(&self, point: Point<f64>) -> Option<NodeIndex> {
        let place = (point - self.origin) * (1.0 / LATTICE_STEP);
        let (column, row) = (place.x.round(), place.y.round());
        let fits = |value: f64, count: usize| value >= 0.0 && value < count as f64;
        (fits(column, self.columns) && fits(row, self.rows)).then(|| row as usize * self.columns + column as usize)
    }
}

/// One moment of a scenario.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// Where the targets are, metres.
    pub targets: Vec<Point<f64>>,
    /// What the mother robots perceive of the walls, metres.
    pub obstacle_points: Vec<Point<f64>>,
    /// x1 at each lattice node.
    pub(super) x1: Vec<f64>,
}

/// A scenario with its morphogens.
#[derive(Clone, Debug)]
pub struct World {
    scenario: Scenario,
    field: Field<f64>,
    snapshots: Vec<Snapshot>,
    pub(super) lattice: Lattice,
    /// Signed distance to the nearest wall at each node, negative inside, at most [`FAR`].
    clearance: Vec<f64>,
    /// x2 at each node.
    pub(super) x2: Vec<f64>,
}

impl World {
    /// Prepares a scenario: a few hundredths of a second.
    pub fn new(scenario: Scenario) -> World {
        let morphogen = scenario.morphogen();
        let field = Field::new(morphogen.kernel, morphogen.target_width, morphogen.obstacle_width);
        let lattice = Lattice::over(scenario.region());
        let clearance: Vec<f64> =
            lattice.nodes().map(|node| scenario.walls().signed_distance(lattice.point(node)).min(FAR)).collect();
        let x2 = clearance.iter().map(|&clearance| x2_at(&field, scenario.walls(), clearance)).collect();
        let snapshots = scenario.snapshot_targets().into_iter().map(|targets| Snapshot {
            x1: lattice.nodes().map(|node| x1_at(&field, &targets, lattice.point(node))).collect(),
            obstacle_points: scenario.obstacle_points(&targets),
            targets,
        });
        World { field, snapshots: snapshots.collect(), clearance, x2, lattice, scenario }
    }

    /// The scenario it was made from.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// Kernel and widths.
    pub fn field(&self) -> &Field<f64> {
        &self.field
    }

    /// The moments models are judged at.
    pub fn snapshots(&self) -> &[Snapshot] {
        &self.snapshots
    }

    pub(super) fn is_in_wall(&self, node: NodeIndex) -> bool {
        self.clearance[node] <= 0.0
    }

    /// The point at the fraction `t` of the way between two nodes.
    pub(super) fn between(&self, from: NodeIndex, to: NodeIndex, t: f64) -> Point<f64> {
        let start = self.lattice.point(from);
        start + (self.lattice.point(to) - start) * t
    }

    /// (x1, x2) at the fraction `t` of the way between two neighbouring nodes. x1 is exact; x2 takes the distance to the
    /// walls as linear between the nodes, which it is beside a straight wall.
    pub(super) fn inputs_between(&self, snapshot: &Snapshot, from: NodeIndex, to: NodeIndex, t: f64) -> [f64; 2] {
        let clearance = self.clearance[from] + (self.clearance[to] - self.clearance[from]) * t;
        let x1 = x1_at(&self.field, &snapshot.targets, self.between(from, to, t));
        [x1, x2_at(&self.field, self.scenario.walls(), clearance)]
    }

    /// (x1, x2) at any point, exactly.
    pub fn inputs_at(&self, snapshot: &Snapshot, point: Point<f64>) -> [f64; 2] {
        let clearance = self.scenario.walls().signed_distance(point);
        [x1_at(&self.field, &snapshot.targets, point), x2_at(&self.field, self.scenario.walls(), clearance)]
    }

    /// Whether `point` is nearer than `distance` metres to a wall.
    pub(super) fn is_closer_than(&self, point: Point<f64>, distance: f64) -> bool {
        // Distance changes by at most a metre a metre, and the node beside is less than one lattice step away.
        let surely_clear =
            self.lattice.beside(point).is_some_and(|node| self.clearance[node] - LATTICE_STEP > distance);
        !surely_clear && self.scenario.walls().signed_distance(point) < distance
    }
}

fn x1_at(field: &Field<f64>, targets: &[Point<f64>], point: Point<f64>) -> f64 {
    targets.iter().map(|&target| field.target_concentration((point - target).length())).sum()
}

fn x2_at(field: &Field<f64>, walls: &Walls, clearance: f64) -> f64 {
    if walls.is_empty() { 0.0 } else { field.obstacle_concentration(clearance.max(0.0)) }
}
