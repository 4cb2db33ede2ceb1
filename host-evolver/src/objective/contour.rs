//! On one lattice: flood the inside component of a target, then follow its edge.

use super::lattice::{Medium, NodeIndex};
use super::model::Model;
use super::world::Snapshot;
use grn_core::geometry::Point;

const DIRECTIONS: [u8; 4] = [0, 1, 2, 3];

/// The next direction clockwise.
const fn right_of(direction: u8) -> u8 {
    (direction + 3) & 3
}

/// What is known of a lattice node in the current moment.
#[derive(Clone, Copy, Default)]
struct Cell {
    error: f64,
    epoch: u32,
    /// The component it belongs to, from 1; 0 for none yet.
    component: u16,
    /// Directions in which the contour has been followed across the edge to that neighbour.
    followed: u8,
}

/// What a flood found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Component {
    /// It is bounded all around.
    Closed,
    /// It touches a wall or the lattice's border.
    Leaks,
}

/// Floods and follows components on one lattice; keeps its working memory from one to the next.
///
/// The functions between two calls of [`Follower::begin`] must be given the same model and snapshot.
pub(super) struct Follower<M> {
    medium: M,
    cells: Vec<Cell>,
    epoch: u32,
    flood: Vec<NodeIndex>,
    crossings: Vec<(NodeIndex, u8)>,
    components: u16,
}

impl<M: Medium> Follower<M> {
    pub(super) fn new(medium: M) -> Self {
        let cells = vec![Cell::default(); medium.lattice().nodes().len()];
        Follower { medium, cells, epoch: 0, flood: Vec::new(), crossings: Vec::new(), components: 0 }
    }

    /// Forgets the last model and moment.
    pub(super) fn begin(&mut self) {
        self.epoch += 1;
        self.components = 0;
    }

    /// The node next to `target` from which its component can be flooded: nearest first, error at least `threshold`.
    pub(super) fn start(
        &mut self,
        target: Point<f64>,
        threshold: f64,
        model: &Model,
        snapshot: &Snapshot,
    ) -> Option<NodeIndex> {
        let corners = self.medium.lattice().cell_around(target);
        corners.into_iter().find(|&node| self.error(node, model, snapshot) >= threshold)
    }

    /// How many components were explored since the beginning.
    pub(super) fn components(&self) -> u16 {
        self.components
    }

    /// The number of the last explored component that holds a node, from 1; 0 for none.
    pub(super) fn component_of(&self, node: NodeIndex) -> u16 {
        self.cells[node].component
    }

    fn error(&mut self, node: NodeIndex, model: &Model, snapshot: &Snapshot) -> f64 {
        if self.cells[node].epoch != self.epoch {
            let [x1, x2] = self.medium.inputs(snapshot, node);
            let error = model.error(x1, x2);
            self.cells[node] = Cell { error, epoch: self.epoch, component: 0, followed: 0 };
        }
        self.cells[node].error
    }

    fn is_inside(&mut self, node: Option<NodeIndex>, model: &Model, snapshot: &Snapshot) -> bool {
        node.is_some_and(|node| self.error(node, model, snapshot) >= 0.0)
    }

    /// Whether the component of `start` at the given threshold is closed; stops at the first leak.
    pub(super) fn probe(&mut self, start: NodeIndex, threshold: f64, model: &Model, snapshot: &Snapshot) -> Component {
        self.components += 1;
        let label = self.components;
        let mut found = Component::Closed;
        self.flood_from(start, label);
        while let Some(node) = self.flood.pop() {
            let neighbours = DIRECTIONS.map(|direction| self.medium.lattice().neighbour(node, direction));
            if self.medium.clearance(node) <= 0.0 || neighbours.contains(&None) {
                found = Component::Leaks;
                break;
            }
            for neighbour in neighbours.into_iter().flatten() {
                if self.error(neighbour, model, snapshot) >= threshold {
                    self.join(Some(neighbour), label);
                }
            }
        }
        found
    }

    /// Labels the component of `start` and collects where its edge crosses the lattice. May stop at the first leak.
    pub(super) fn label(
        &mut self,
        start: NodeIndex,
        stop_at_leak: bool,
        model: &Model,
        snapshot: &Snapshot,
    ) -> Component {
        self.components += 1;
        let label = self.components;
        let mut found = Component::Closed;
        self.crossings.clear();
        self.flood_from(start, label);
        while let Some(node) = self.flood.pop() {
            let neighbours = DIRECTIONS.map(|direction| self.medium.lattice().neighbour(node, direction));
            if self.medium.clearance(node) <= 0.0 || neighbours.contains(&None) {
                found = Component::Leaks;
                if stop_at_leak {
                    break;
                }
            }
            let inside = neighbours.map(|neighbour| self.is_inside(neighbour, model, snapshot));
            for direction in DIRECTIONS {
                let side = usize::from(direction);
                if inside[side] {
                    self.join(neighbours[side], label);
                    continue;
                }
                self.crossings.push((node, direction));
                let right = right_of(direction);
                if !inside[usize::from(right)] {
                    let diagonal = neighbours[side].and_then(|next| self.medium.lattice().neighbour(next, right));
                    if self.is_inside(diagonal, model, snapshot)
                        && self.is_joined_across(node, direction, model, snapshot)
                    {
                        self.join(diagonal, label);
                    }
                }
            }
        }
        found
    }

    fn flood_from(&mut self, start: NodeIndex, label: u16) {
        self.flood.clear();
        self.flood.push(start);
        self.cells[start].component = label;
    }

    fn join(&mut self, node: Option<NodeIndex>, label: u16) {
        if let Some(node) = node
            && self.cells[node].component != label
        {
            self.cells[node].component = label;
            self.flood.push(node);
        }
    }

    /// Whether the middle of the cell to the right of `node` → `direction` is inside: joins its two inside corners.
    fn is_joined_across(&self, node: NodeIndex, direction: u8, model: &Model, snapshot: &Snapshot) -> bool {
        let right = right_of(direction);
        let lattice = self.medium.lattice();
        let ahead = lattice.neighbour(node, direction);
        let aside = lattice.neighbour(node, right);
        let across = ahead.and_then(|ahead| lattice.neighbour(ahead, right));
        let corners = [Some(node), ahead, aside, across];
        let inputs = corners.iter().flatten().map(|&corner| self.medium.inputs(snapshot, corner));
        let [x1, x2] = inputs.fold([0.0; 2], |sum, inputs| [sum[0] + inputs[0] / 4.0, sum[1] + inputs[1] / 4.0]);
        model.error(x1, x2) >= 0.0
    }

    /// Follows every edge of the component labelled last.
    pub(super) fn follow(&mut self, model: &Model, snapshot: &Snapshot, loops: &mut Vec<Vec<Point<f64>>>) {
        let crossings = std::mem::take(&mut self.crossings);
        for &(node, direction) in &crossings {
            if self.cells[node].followed & (1 << direction) == 0 {
                loops.push(self.follow_one((node, direction), model, snapshot));
            }
        }
        self.crossings = crossings;
    }

    /// Walks along one closed contour with the inside to the left, from crossing to crossing.
    fn follow_one(&mut self, start: (NodeIndex, u8), model: &Model, snapshot: &Snapshot) -> Vec<Point<f64>> {
        let mut points = Vec::new();
        let (mut node, mut direction) = start;
        loop {
            self.cells[node].followed |= 1 << direction;
            points.push(self.crossing_point(node, direction, model, snapshot));
            (node, direction) = self.next_crossing(node, direction, model, snapshot);
            if (node, direction) == start {
                return points;
            }
        }
    }

    /// Marching squares in the cell to the right of the edge `node` → `direction`, whose far end is outside.
    fn next_crossing(&mut self, node: NodeIndex, direction: u8, model: &Model, snapshot: &Snapshot) -> (NodeIndex, u8) {
        let lattice = self.medium.lattice();
        let right = right_of(direction);
        let aside = lattice.neighbour(node, right);
        let across = aside.and_then(|aside| lattice.neighbour(aside, direction));
        let aside_inside = self.is_inside(aside, model, snapshot);
        let across_inside = self.is_inside(across, model, snapshot);
        match (aside, across) {
            (_, Some(across))
                if across_inside && (aside_inside || self.is_joined_across(node, direction, model, snapshot)) =>
            {
                (across, (right + 2) & 3)
            }
            (Some(aside), _) if aside_inside => (aside, direction),
            _ => (node, right),
        }
    }

    /// Where the pattern crosses the edge: from the chord, one exact evaluation, then the parabola through three points.
    fn crossing_point(&self, node: NodeIndex, direction: u8, model: &Model, snapshot: &Snapshot) -> Point<f64> {
        let Some(outer) = self.medium.lattice().neighbour(node, direction) else {
            return self.medium.lattice().point(node);
        };
        let (inner_error, outer_error) = (self.cells[node].error, self.cells[outer].error);
        let chord = inner_error / (inner_error - outer_error);
        let [x1, x2] = self.medium.inputs_between(snapshot, node, outer, chord);
        let t = parabola_root([0.0, chord, 1.0], [inner_error, model.error(x1, x2), outer_error]);
        self.medium.between(node, outer, t)
    }
}

/// The root in [0, 1] of the parabola through three points, the first value ≥ 0 and the last < 0; inverse quadratic
/// interpolation where the values fall strictly, else the chord's guess.
fn parabola_root(t: [f64; 3], v: [f64; 3]) -> f64 {
    if !(v[0] > v[1] && v[1] > v[2]) {
        return t[1];
    }
    let [a, b, c] = v;
    let root =
        t[0] * b * c / ((a - b) * (a - c)) + t[1] * a * c / ((b - a) * (b - c)) + t[2] * a * b / ((c - a) * (c - b));
    if (0.0..=1.0).contains(&root) { root } else { t[1] }
}
