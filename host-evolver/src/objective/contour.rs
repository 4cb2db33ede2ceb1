//! From a model and a moment to the pattern: flood the inside component of each target, then follow its edge.

use super::model::Model;
use super::world::{NodeIndex, Snapshot, World};
use grn_core::geometry::Point;

const DIRECTIONS: [u8; 4] = [0, 1, 2, 3];

/// The next direction clockwise.
const fn right_of(direction: u8) -> u8 {
    (direction + 3) & 3
}

/// The pattern of one model at one moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contours {
    /// Closed contours that bound an inside component holding a target; metres, first point not repeated.
    pub rings: Vec<Vec<Point<f64>>>,
    /// Outlines of components that leak; only filled when asked for.
    pub leaks: Vec<Vec<Point<f64>>>,
    /// For each target whether a closed component holds it.
    pub enclosed: Vec<bool>,
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

#[derive(Clone, Copy, PartialEq)]
enum Component {
    Closed,
    Leaks,
}

/// Traces patterns; keeps its working memory from one to the next.
pub struct Tracer<'w> {
    world: &'w World,
    cells: Vec<Cell>,
    epoch: u32,
    flood: Vec<NodeIndex>,
    crossings: Vec<(NodeIndex, u8)>,
    components: Vec<Component>,
    outline_leaks: bool,
}

impl<'w> Tracer<'w> {
    /// A tracer for one world.
    pub fn new(world: &'w World) -> Self {
        Tracer {
            world,
            cells: vec![Cell::default(); world.lattice.nodes().len()],
            epoch: 0,
            flood: Vec::new(),
            crossings: Vec::new(),
            components: Vec::new(),
            outline_leaks: false,
        }
    }

    /// A tracer that also fills [`Contours::leaks`], for drawing.
    pub fn with_leaks(world: &'w World) -> Self {
        Tracer { outline_leaks: true, ..Self::new(world) }
    }

    /// The pattern of `model` at `snapshot`, which must belong to the tracer's world.
    pub fn trace(&mut self, model: &Model, snapshot: &Snapshot) -> Contours {
        self.epoch += 1;
        self.components.clear();
        let mut contours = Contours::default();
        for &target in &snapshot.targets {
            let enclosed = self.component_holding(target, model, snapshot, &mut contours);
            contours.enclosed.push(enclosed == Some(Component::Closed));
        }
        contours
    }

    /// The component that holds `target`, flooded and followed unless it is known; `None` if the target is outside.
    fn component_holding(
        &mut self,
        target: Point<f64>,
        model: &Model,
        snapshot: &Snapshot,
        contours: &mut Contours,
    ) -> Option<Component> {
        let [x1, x2] = self.world.inputs_at(snapshot, target);
        if model.error(x1, x2) < 0.0 {
            return None;
        }
        let corners = self.world.lattice.cell_around(target);
        let start = corners.into_iter().find(|&node| self.error(node, model, snapshot) >= 0.0)?;
        if let Some(known) = usize::from(self.cells[start].component).checked_sub(1) {
            return self.components.get(known).copied();
        }
        let found = self.flood(start, model, snapshot);
        self.components.push(found);
        match found {
            Component::Closed => self.follow_all(model, snapshot, &mut contours.rings),
            Component::Leaks if self.outline_leaks => self.follow_all(model, snapshot, &mut contours.leaks),
            Component::Leaks => {}
        }
        Some(found)
    }

    fn error(&mut self, node: NodeIndex, model: &Model, snapshot: &Snapshot) -> f64 {
        let cell = &mut self.cells[node];
        if cell.epoch != self.epoch {
            let error = model.error(snapshot.x1[node], self.world.x2[node]);
            *cell = Cell { error, epoch: self.epoch, component: 0, followed: 0 };
        }
        cell.error
    }

    fn is_inside(&mut self, node: Option<NodeIndex>, model: &Model, snapshot: &Snapshot) -> bool {
        node.is_some_and(|node| self.error(node, model, snapshot) >= 0.0)
    }

    /// Labels the component of `start` and collects where its edge crosses the lattice. Ends early at a leak, unless
    /// leaks are to be outlined.
    fn flood(&mut self, start: NodeIndex, model: &Model, snapshot: &Snapshot) -> Component {
        let world = self.world;
        let label = self.components.len() as u16 + 1;
        let mut found = Component::Closed;
        self.crossings.clear();
        self.flood.clear();
        self.flood.push(start);
        self.cells[start].component = label;
        while let Some(node) = self.flood.pop() {
            let neighbours = DIRECTIONS.map(|direction| world.lattice.neighbour(node, direction));
            if world.is_in_wall(node) || neighbours.contains(&None) {
                found = Component::Leaks;
                if !self.outline_leaks {
                    return found;
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
                    let diagonal = neighbours[side].and_then(|next| world.lattice.neighbour(next, right));
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

    fn join(&mut self, node: Option<NodeIndex>, label: u16) {
        if let Some(node) = node
            && self.cells[node].component == 0
        {
            self.cells[node].component = label;
            self.flood.push(node);
        }
    }

    /// Whether the middle of the cell to the right of `node` → `direction` is inside: joins its two inside corners.
    fn is_joined_across(&self, node: NodeIndex, direction: u8, model: &Model, snapshot: &Snapshot) -> bool {
        let right = right_of(direction);
        let lattice = &self.world.lattice;
        let ahead = lattice.neighbour(node, direction);
        let aside = lattice.neighbour(node, right);
        let across = ahead.and_then(|ahead| lattice.neighbour(ahead, right));
        let corners = [Some(node), ahead, aside, across];
        let mean = |values: &[f64]| corners.iter().flatten().map(|&corner| values[corner]).sum::<f64>() / 4.0;
        model.error(mean(&snapshot.x1), mean(&self.world.x2)) >= 0.0
    }

    /// Follows every edge of the component just flooded.
    fn follow_all(&mut self, model: &Model, snapshot: &Snapshot, loops: &mut Vec<Vec<Point<f64>>>) {
        let crossings = std::mem::take(&mut self.crossings);
        for &(node, direction) in &crossings {
            if self.cells[node].followed & (1 << direction) == 0 {
                loops.push(self.follow((node, direction), model, snapshot));
            }
        }
        self.crossings = crossings;
    }

    /// Walks along one closed contour with the inside to the left, from crossing to crossing.
    fn follow(&mut self, start: (NodeIndex, u8), model: &Model, snapshot: &Snapshot) -> Vec<Point<f64>> {
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
        let lattice = &self.world.lattice;
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
        let Some(outer) = self.world.lattice.neighbour(node, direction) else {
            return self.world.lattice.point(node);
        };
        let (inner_error, outer_error) = (self.cells[node].error, self.cells[outer].error);
        let chord = inner_error / (inner_error - outer_error);
        let [x1, x2] = self.world.inputs_between(snapshot, node, outer, chord);
        let t = parabola_root([0.0, chord, 1.0], [inner_error, model.error(x1, x2), outer_error]);
        self.world.between(node, outer, t)
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
