//! On one lattice: flood the inside component of a target, then follow its edge.

use super::candidates::thinned;
use super::corners::with_corners;
use super::error_table::ErrorTable;
use super::lanes::{Lanes, WIDTH};
use super::lattice::{Direction, Edge, NodeIndex, Site};
use super::medium::Medium;
use super::model::Model;
use super::world::Snapshot;
use grn_core::geometry::Point;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A ring's points are at least this far apart, in lattice steps.
const CLOSEST_POINTS: f64 = 0.25;

/// What a flood found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Component {
    /// It is bounded all around.
    Closed,
    /// It touches a wall or the lattice's border.
    Leaks,
}

/// A model at a snapshot, as the follower looks at it.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) model: &'a Model,
    pub(super) snapshot: &'a Snapshot,
    /// Where to look nodes up, if the table is accurate enough for this model.
    pub(super) table: Option<&'a ErrorTable>,
}

/// A crossing of the contour: from an inside node to an outside neighbour.
type Crossing = (NodeIndex, Direction);

/// Floods and follows components on one lattice; keeps its working memory from one to the next.
///
/// Between two calls of [`Follower::begin`] every call must be given the same view.
pub(super) struct Follower<M> {
    medium: M,
    /// The pattern error at each node, minus infinity on the border; valid where `known` is the current view's number.
    errors: Vec<f64>,
    known: Vec<u32>,
    view: u32,
    /// The last explored component that holds each node; 0 for none.
    components: Vec<u32>,
    component: u32,
    components_before: u32,
    /// Directions in which the contour has been followed across the edge to that neighbour, as bits.
    followed: Vec<u8>,
    flood: Vec<NodeIndex>,
    /// What [`Follower::finds_leak`] looks at next, with the distance to the walls.
    frontier: BinaryHeap<Reverse<(i32, NodeIndex)>>,
    crossings: Vec<Crossing>,
    edges: Vec<Edge>,
}

impl<M: Medium> Follower<M> {
    pub(super) fn new(medium: M) -> Self {
        let nodes = medium.lattice().nodes().len();
        Follower {
            medium,
            errors: vec![0.0; nodes],
            known: vec![0; nodes],
            view: 0,
            components: vec![0; nodes],
            component: 0,
            components_before: 0,
            followed: vec![0; nodes],
            flood: Vec::new(),
            frontier: BinaryHeap::new(),
            crossings: Vec::new(),
            edges: Vec::new(),
        }
    }

    /// Forgets the last model and snapshot.
    pub(super) fn begin(&mut self) {
        if self.view == u32::MAX || self.component > u32::MAX / 2 {
            self.known.fill(0);
            self.components.fill(0);
            (self.view, self.component) = (0, 0);
        }
        self.view += 1;
        self.components_before = self.component;
    }

    /// The node next to `target` from which its component can be flooded: nearest first, error at least `threshold`.
    pub(super) fn start(&mut self, target: Point<f64>, threshold: f64, view: View<'_>) -> Option<NodeIndex> {
        let corners = self.medium.lattice().cell_around(target)?;
        corners.into_iter().find(|&node| self.error(node, view) >= threshold)
    }

    /// The number of the last explored component; numbers count up from 1.
    pub(super) fn last_component(&self) -> u32 {
        self.component
    }

    /// Whether a component was explored since the beginning.
    pub(super) fn is_current(&self, component: u32) -> bool {
        component > self.components_before
    }

    /// The number of the last explored component that holds a node; 0 for none.
    pub(super) fn component_of(&self, node: NodeIndex) -> u32 {
        self.components[node]
    }

    /// The pattern error at a node; nodes on the border count as outside.
    #[inline(always)]
    fn error(&mut self, node: NodeIndex, view: View<'_>) -> f64 {
        if self.known[node] == self.view { self.errors[node] } else { self.find(node, view) }
    }

    #[inline(never)]
    fn find(&mut self, node: NodeIndex, view: View<'_>) -> f64 {
        match view.table {
            Some(table) if M::KEEPS_INPUTS => {
                let [x1, x2] = self.medium.inputs_at(view.snapshot, node);
                self.know(node, table.at(x1, x2), view);
            }
            _ => self.compute_run(node - node % WIDTH, view),
        }
        self.errors[node]
    }

    #[inline(never)]
    fn compute_run(&mut self, first: NodeIndex, view: View<'_>) {
        let [x1, x2] = self.medium.inputs(view.snapshot, first);
        let errors = view.table.and_then(|table| table.sure_at(x1, x2)).unwrap_or_else(|| view.model.errors(x1, x2));
        for (lane, error) in errors.0.into_iter().enumerate() {
            self.know(first + lane, error, view);
        }
    }

    fn know(&mut self, node: NodeIndex, error: f64, view: View<'_>) {
        self.errors[node] =
            if self.medium.site(view.snapshot, node) == Site::Border { f64::NEG_INFINITY } else { error };
        self.known[node] = self.view;
    }

    fn is_inside(&mut self, node: NodeIndex, view: View<'_>) -> bool {
        self.error(node, view) >= 0.0
    }

    /// Whether a leak of the component of `start` at the given threshold is among the first `most` nodes when those
    /// nearest to walls are looked at first. It labels what it sees.
    pub(super) fn finds_leak(&mut self, start: NodeIndex, threshold: f64, most: usize, view: View<'_>) -> bool {
        self.component += 1;
        self.frontier.clear();
        self.approach(start, view);
        for _ in 0..most {
            let Some(Reverse((_, node))) = self.frontier.pop() else { return false };
            if self.medium.site(view.snapshot, node) == Site::Leak {
                return true;
            }
            for direction in Direction::ALL {
                let neighbour = self.medium.lattice().neighbour(node, direction);
                if self.components[neighbour] != self.component && self.error(neighbour, view) >= threshold {
                    self.approach(neighbour, view);
                }
            }
        }
        false
    }

    fn approach(&mut self, node: NodeIndex, view: View<'_>) {
        self.components[node] = self.component;
        let millimetres = (self.medium.clearance(view.snapshot, node) * 1e3) as i32;
        self.frontier.push(Reverse((millimetres, node)));
    }

    /// Lets the closed component labelled last grow down to the given threshold; stops at the first leak.
    pub(super) fn widen(&mut self, threshold: f64, view: View<'_>) -> Component {
        let crossings = std::mem::take(&mut self.crossings);
        for &(node, direction) in &crossings {
            let beyond = self.medium.lattice().neighbour(node, direction);
            if self.errors[beyond] >= threshold {
                self.join(beyond);
            }
        }
        self.crossings = crossings;
        self.flood_at(threshold, view)
    }

    fn flood_at(&mut self, threshold: f64, view: View<'_>) -> Component {
        while let Some(node) = self.flood.pop() {
            if self.medium.site(view.snapshot, node) == Site::Leak {
                return Component::Leaks;
            }
            for direction in Direction::ALL {
                let neighbour = self.medium.lattice().neighbour(node, direction);
                if self.components[neighbour] != self.component && self.error(neighbour, view) >= threshold {
                    self.join(neighbour);
                }
            }
        }
        Component::Closed
    }

    /// Labels the component of `start` and collects where its edge crosses the lattice. May stop at the first leak.
    pub(super) fn label(&mut self, start: NodeIndex, stop_at_leak: bool, view: View<'_>) -> Component {
        self.flood_from(start);
        let mut found = Component::Closed;
        self.crossings.clear();
        while let Some(node) = self.flood.pop() {
            if self.medium.site(view.snapshot, node) == Site::Leak {
                found = Component::Leaks;
                if stop_at_leak {
                    return found;
                }
            }
            let neighbours = Direction::ALL.map(|direction| self.medium.lattice().neighbour(node, direction));
            let inside = neighbours
                .map(|neighbour| self.components[neighbour] == self.component || self.is_inside(neighbour, view));
            if inside == [true; 4] {
                neighbours.into_iter().for_each(|neighbour| self.join(neighbour));
                continue;
            }
            self.followed[node] = 0;
            for direction in Direction::ALL {
                let (neighbour, right) = (neighbours[direction.index()], direction.right());
                if inside[direction.index()] {
                    self.join(neighbour);
                    continue;
                }
                self.crossings.push((node, direction));
                if !inside[right.index()] {
                    let diagonal = self.diagonal(node, direction);
                    if self.is_inside(diagonal, view) && self.is_joined_across(node, direction, view) {
                        self.join(diagonal);
                    }
                }
            }
        }
        found
    }

    fn flood_from(&mut self, start: NodeIndex) {
        self.component += 1;
        self.flood.clear();
        self.join(start);
    }

    fn join(&mut self, node: NodeIndex) {
        if self.components[node] != self.component {
            self.components[node] = self.component;
            self.flood.push(node);
        }
    }

    /// The node across the cell that lies ahead and to the right of a node that is not on the border.
    fn diagonal(&self, node: NodeIndex, direction: Direction) -> NodeIndex {
        // Both steps are taken from `node`: one of the nodes between may be on the border.
        let lattice = self.medium.lattice();
        lattice.neighbour(node, direction) + lattice.neighbour(node, direction.right()) - node
    }

    /// Whether the middle of the cell ahead and to the right is inside: then its two inside corners are joined.
    fn is_joined_across(&mut self, node: NodeIndex, direction: Direction, view: View<'_>) -> bool {
        let lattice = self.medium.lattice();
        let ahead = lattice.neighbour(node, direction);
        let aside = lattice.neighbour(node, direction.right());
        let mut corners = [node, ahead, aside, self.diagonal(node, direction)];
        // In one order, whichever corner asks: all must get the same answer to the last bit.
        corners.sort_unstable();
        let mut middle = [0.0; 2];
        for corner in corners {
            for (sum, input) in middle.iter_mut().zip(self.medium.inputs_at(view.snapshot, corner)) {
                *sum += input / 4.0;
            }
        }
        view.model.error(middle[0], middle[1]) >= 0.0
    }

    /// Follows every edge of the component labelled last, each a closed contour with the inside to its right.
    pub(super) fn follow(&mut self, view: View<'_>, loops: &mut Vec<Vec<Point<f64>>>) {
        let crossings = std::mem::take(&mut self.crossings);
        for &(node, direction) in &crossings {
            if self.followed[node] & (1 << direction.index()) == 0 {
                self.walk((node, direction), view);
                loops.push(self.refined(view));
            }
        }
        self.crossings = crossings;
    }

    /// Collects the edges that one closed contour crosses, in order.
    fn walk(&mut self, start: Crossing, view: View<'_>) {
        self.edges.clear();
        let (mut node, mut direction) = start;
        loop {
            self.followed[node] |= 1 << direction.index();
            self.edges.push(Edge { from: node, to: self.medium.lattice().neighbour(node, direction) });
            (node, direction) = self.next_crossing(node, direction, view);
            if (node, direction) == start {
                return;
            }
        }
    }

    /// Marching squares in the cell to the right of the edge `node` → `direction`, whose far end is outside.
    fn next_crossing(&mut self, node: NodeIndex, direction: Direction, view: View<'_>) -> Crossing {
        let right = direction.right();
        let aside = self.medium.lattice().neighbour(node, right);
        let across = self.diagonal(node, direction);
        let aside_inside = self.is_inside(aside, view);
        let across_inside = self.is_inside(across, view);
        if across_inside && (aside_inside || self.is_joined_across(node, direction, view)) {
            (across, direction.left())
        } else if aside_inside {
            (aside, direction)
        } else {
            (node, right)
        }
    }

    /// Where the contour crosses the collected edges: from the chord, one evaluation, then the parabola through three
    /// points.
    fn refined(&self, view: View<'_>) -> Vec<Point<f64>> {
        let error = |point| {
            let [x1, x2] = self.medium.world().inputs_at(view.snapshot, point);
            view.model.error(x1, x2)
        };
        let mut points = Vec::with_capacity(self.edges.len());
        for edges in self.edges.chunks(WIDTH) {
            let filled = std::array::from_fn(|lane| edges[lane.min(edges.len() - 1)]);
            let inner = filled.map(|edge| self.errors[edge.from]);
            // A border node's error is minus infinity: the chord then is 0, the inner node itself.
            let outer = filled.map(|edge| self.errors[edge.to]);
            let chord = Lanes(std::array::from_fn(|lane| inner[lane] / (inner[lane] - outer[lane])));
            let [x1, x2] = self.medium.inputs_along(view.snapshot, &filled, chord);
            let middle = view.model.errors(x1, x2);
            points.extend(edges.iter().enumerate().map(|(lane, &edge)| {
                let t = if self.medium.is_creased(view.snapshot, edge) {
                    root_between(inner[lane], outer[lane], |t| error(self.medium.along(edge, t)))
                } else {
                    parabola_root([0.0, chord.0[lane], 1.0], [inner[lane], middle.0[lane], outer[lane]])
                };
                self.medium.along(edge, t)
            }));
        }
        let ring = thinned(points, self.medium.lattice().step() * CLOSEST_POINTS);
        let errors = |points: &[Point<f64>; WIDTH]| {
            let [x1, x2] = self.medium.world().inputs_at_all(view.snapshot, points);
            view.model.errors(x1, x2)
        };
        with_corners(ring, |point| self.medium.world().is_at_crease(view.snapshot, point), errors)
    }
}

/// The root in [0, 1] by inverse quadratic interpolation of three points whose values fall strictly through 0, else the
/// middle point.
fn parabola_root(t: [f64; 3], [a, b, c]: [f64; 3]) -> f64 {
    if !(a > b && b > c && c.is_finite()) {
        return t[1];
    }
    let root =
        t[0] * b * c / ((a - b) * (a - c)) + t[1] * a * c / ((b - a) * (b - c)) + t[2] * a * b / ((c - a) * (c - b));
    if (0.0..=1.0).contains(&root) { root } else { t[1] }
}

/// The root in [0, 1] of a function with the given values at 0 and 1, by false position with halving (Illinois).
fn root_between(start: f64, end: f64, f: impl Fn(f64) -> f64) -> f64 {
    const STEPS: usize = 5;
    if !end.is_finite() {
        return 0.0;
    }
    let (mut a, mut b) = ((0.0, start), (1.0, end));
    for _ in 0..STEPS {
        let t = b.0 - b.1 * (b.0 - a.0) / (b.1 - a.1);
        let value = f(t);
        if (value < 0.0) == (b.1 < 0.0) {
            a.1 *= 0.5;
        } else {
            a = b;
        }
        b = (t, value);
    }
    b.0
}
