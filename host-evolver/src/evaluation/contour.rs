//! On one lattice: flood the inside component of a target, then follow its edge.

use super::lanes::WIDTH;
use super::lattice::{Direction, Edge, NodeIndex, Site};
use super::medium::Medium;
use super::refine::refined;
use super::view::View;
use super::world::World;
use grn_core::geometry::Point;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Topology is in doubt if raising or lowering the level by this pattern error changes it: a necking or a gap that shallow
/// can hide within one cell of the coarse lattice.
pub(super) const DOUBT: f64 = 0.02;

/// What a flood found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Component {
    /// It is bounded all around.
    Closed,
    /// It touches a wall or the lattice's border.
    Leaks,
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
    /// Whether the last explored component is not what the coarse lattice shows, and whether it may touch a wall unseen.
    misled: bool,
    may_touch: bool,
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
            misled: false,
            may_touch: false,
            followed: vec![0; nodes],
            flood: Vec::new(),
            frontier: BinaryHeap::new(),
            crossings: Vec::new(),
            edges: Vec::new(),
        }
    }

    pub(super) fn world(&self) -> &World {
        self.medium.world()
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

    /// The node next to `target` from which its component can be flooded: nearest first, error at least `threshold`, and
    /// not behind a wall.
    pub(super) fn start(&mut self, target: Point<f64>, threshold: f64, view: View<'_>) -> Option<NodeIndex> {
        let corners = self.medium.lattice().cell_around(target)?;
        corners
            .into_iter()
            .find(|&node| self.error(node, view) >= threshold && !self.is_behind_wall(node, target, view))
    }

    fn is_behind_wall(&self, node: NodeIndex, target: Point<f64>, view: View<'_>) -> bool {
        let way = self.medium.lattice().point(node) - target;
        let length = way.length();
        let is_near = self.medium.clearance(view.snapshot, node) < length;
        let meets_wall = |along| view.snapshot.walls().ray(target, along, length).is_some();
        is_near && way.direction().is_some_and(meets_wall)
    }

    /// Whether the last explored component is not what the coarse lattice shows: a wall passes through it between two nodes,
    /// or x2 changes too fast for the lattice.
    pub(super) fn is_misled(&self) -> bool {
        self.misled
    }

    /// Whether the last explored component may touch a wall that the coarse lattice does not show.
    pub(super) fn may_touch(&self) -> bool {
        self.may_touch
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
        (self.misled, self.may_touch) = (false, false);
        self.frontier.clear();
        self.approach(start, view);
        for _ in 0..most {
            let Some(Reverse((_, node))) = self.frontier.pop() else { return false };
            let blocked = match self.medium.site(view.snapshot, node) {
                Site::Leak => return true,
                site => self.blocked(node, site, threshold, view),
            };
            for direction in Direction::ALL {
                let neighbour = self.medium.lattice().neighbour(node, direction);
                let is_new = self.components[neighbour] != self.component && !blocked[direction.index()];
                if is_new && self.error(neighbour, view) >= threshold {
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
            let blocked = match self.medium.site(view.snapshot, node) {
                Site::Leak => return Component::Leaks,
                site => self.blocked(node, site, threshold, view),
            };
            for direction in Direction::ALL {
                let neighbour = self.medium.lattice().neighbour(node, direction);
                let is_new = self.components[neighbour] != self.component && !blocked[direction.index()];
                if is_new && self.error(neighbour, view) >= threshold {
                    self.join(neighbour);
                }
            }
        }
        Component::Closed
    }

    /// In which directions a wall that the lattice does not show lies between a node of a component and its neighbour. It is noted
    /// if the neighbour is inside, too, and if the component would hold a point of the walls beside the node.
    #[inline(always)]
    fn blocked(&mut self, node: NodeIndex, site: Site, threshold: f64, view: View<'_>) -> [bool; 4] {
        if site == Site::Beside { self.look_beside(node, threshold, view) } else { [false; 4] }
    }

    #[cold]
    fn look_beside(&mut self, node: NodeIndex, threshold: f64, view: View<'_>) -> [bool; 4] {
        let ground = &view.snapshot.ground;
        self.misled |= self.medium.clearance(view.snapshot, node) < ground.blurred;
        let Some(beside) = ground.beside(node) else { return [false; 4] };
        for direction in Direction::ALL.into_iter().filter(|direction| beside.blocked[direction.index()]) {
            self.misled |= self.error(self.medium.lattice().neighbour(node, direction), view) >= threshold;
        }
        let error = |&point: &Point<f64>| {
            let [x1, x2] = self.medium.world().inputs_at(view.snapshot, point);
            view.model.error(x1, x2)
        };
        // Between two crossings a wall may come a little nearer to a target than there.
        let crossed = beside.crossings.iter().any(|crossing| error(crossing) >= -DOUBT);
        self.may_touch |= crossed || beside.vertices.iter().any(|vertex| error(vertex) >= 0.0);
        beside.blocked
    }

    /// Labels the component of `start` and collects where its edge crosses the lattice. May stop at the first leak.
    pub(super) fn label(&mut self, start: NodeIndex, stop_at_leak: bool, view: View<'_>) -> Component {
        self.flood_from(start);
        let mut found = Component::Closed;
        self.crossings.clear();
        while let Some(node) = self.flood.pop() {
            let site = self.medium.site(view.snapshot, node);
            if site == Site::Leak {
                found = Component::Leaks;
                if stop_at_leak {
                    return found;
                }
            }
            let blocked = self.blocked(node, site, 0.0, view);
            let neighbours = Direction::ALL.map(|direction| self.medium.lattice().neighbour(node, direction));
            let mut inside = neighbours
                .map(|neighbour| self.components[neighbour] == self.component || self.is_inside(neighbour, view));
            if blocked != [false; 4] {
                inside = std::array::from_fn(|direction| inside[direction] && !blocked[direction]);
            }
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
        (self.misled, self.may_touch) = (false, false);
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
        let between_walls = [ahead, aside].iter().all(|&node| self.medium.site(view.snapshot, node) == Site::Leak);
        // Whether they meet in the middle the coarse lattice cannot tell.
        self.may_touch |= between_walls;
        if between_walls && !M::KEEPS_INPUTS {
            return false;
        }
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
                loops.push(refined(&self.medium, &self.edges, &self.errors, view));
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
}
