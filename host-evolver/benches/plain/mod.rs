//! The pattern the plain way, to hold the fast way to: a fine grid filled node by node with the scalar formula, then
//! marching squares. Shared by the benchmark and the test of contours.

use grn_core::geometry::{Point, Vector};
use grn_core::scalar::Arithmetic;
use host_evolver::evaluation::{CANDIDATES_PER_RING, Model, Snapshot, World};
use std::collections::{BTreeMap, BTreeSet};

/// What a plain grid shows.
#[derive(Clone, Debug, Default)]
pub struct Plain {
    /// Closed contours around components that hold a target.
    pub rings: Vec<Vec<Point<f64>>>,
    /// For each target whether a closed component holds it.
    pub enclosed: Vec<bool>,
    /// Whether some component reaches the grid's border but no wall: a larger grid would tell more.
    pub cut_off: bool,
}

/// A square grid filled with a model's pattern error and the clearance.
struct Grid {
    low: Point<f64>,
    step: f64,
    columns: usize,
    rows: usize,
    errors: Vec<f64>,
    clearance: Vec<f64>,
}

/// The pattern on a grid over the box from `low` to `high`.
pub fn trace(world: &World, model: &Model, snapshot: &Snapshot, [low, high]: [Point<f64>; 2], step: f64) -> Plain {
    let grid = Grid::fill(world, model, snapshot, [low, high], step);
    let mut plain = Plain::default();
    let mut components: Vec<(BTreeSet<usize>, bool)> = Vec::new();
    for &target in &snapshot.targets {
        let [x1, x2] = world.inputs_at(snapshot, target);
        let start = if model.error(x1, x2) >= 0.0 { grid.start(target) } else { None };
        let Some(start) = start else {
            plain.enclosed.push(false);
            continue;
        };
        let known = components.iter().find(|(nodes, _)| nodes.contains(&start)).map(|(_, closed)| *closed);
        let closed = known.unwrap_or_else(|| {
            let nodes = grid.component(start);
            let in_wall = nodes.iter().any(|&node| grid.clearance[node] <= 0.0);
            let at_border = nodes.iter().any(|&node| grid.is_on_border(node));
            plain.cut_off |= at_border && !in_wall;
            let closed = !in_wall && !at_border;
            if closed {
                plain.rings.extend(grid.rings(&nodes));
            }
            components.push((nodes, closed));
            closed
        });
        plain.enclosed.push(closed);
    }
    plain
}

impl Grid {
    fn fill(world: &World, model: &Model, snapshot: &Snapshot, [low, high]: [Point<f64>; 2], step: f64) -> Grid {
        let count = |length: f64| (length / step).ceil() as usize + 1;
        let (columns, rows) = (count(high.x - low.x), count(high.y - low.y));
        let mut grid = Grid { low, step, columns, rows, errors: Vec::new(), clearance: Vec::new() };
        for node in 0..columns * rows {
            let point = grid.point(node);
            let x1 = snapshot.targets.iter().map(|&t| world.field().target_concentration((point - t).length())).sum();
            let clearance = snapshot.walls().signed_distance(point);
            let near = clearance.is_finite();
            let x2 = if near { world.field().obstacle_concentration(clearance.max(0.0)) } else { 0.0 };
            grid.errors.push(model.error(x1, x2));
            grid.clearance.push(clearance);
        }
        grid
    }

    fn point(&self, node: usize) -> Point<f64> {
        self.low + Vector::new((node % self.columns) as f64, (node / self.columns) as f64) * self.step
    }

    fn is_on_border(&self, node: usize) -> bool {
        let (column, row) = (node % self.columns, node / self.columns);
        column == 0 || row == 0 || column + 1 == self.columns || row + 1 == self.rows
    }

    /// The nearest inside corner of the cell that holds `target`.
    fn start(&self, target: Point<f64>) -> Option<usize> {
        let place = (target - self.low) * (1.0 / self.step);
        let corner = place.y as usize * self.columns + place.x as usize;
        let corners = [corner, corner + 1, corner + self.columns, corner + self.columns + 1];
        let inside = corners.into_iter().filter(|&node| self.errors[node] >= 0.0);
        inside.min_by(|&a, &b| (self.point(a) - target).length().total_cmp(&(self.point(b) - target).length()))
    }

    /// All inside nodes joined to `start`: along the grid, or across a cell whose middle is inside.
    fn component(&self, start: usize) -> BTreeSet<usize> {
        let mut nodes = BTreeSet::from([start]);
        let mut open = vec![start];
        while let Some(node) = open.pop() {
            if self.is_on_border(node) {
                continue;
            }
            let across = |dx: isize, dy: isize| node.wrapping_add_signed(dy * self.columns as isize + dx);
            let straight = [across(1, 0), across(-1, 0), across(0, 1), across(0, -1)];
            let diagonal =
                [(1, 1), (1, -1), (-1, 1), (-1, -1)].map(|(dx, dy)| (across(dx, dy), across(dx, 0), across(0, dy)));
            let joined =
                diagonal.into_iter().filter(|&(far, a, b)| self.middle([node, far, a, b]) >= 0.0).map(|(far, ..)| far);
            for next in straight.into_iter().chain(joined) {
                if self.errors[next] >= 0.0 && nodes.insert(next) {
                    open.push(next);
                }
            }
        }
        nodes
    }

    fn middle(&self, corners: [usize; 4]) -> f64 {
        corners.iter().map(|&corner| self.errors[corner]).sum::<f64>() / 4.0
    }

    /// Marching squares around the given nodes, none on the border: closed contours with the inside to the left.
    fn rings(&self, nodes: &BTreeSet<usize>) -> Vec<Vec<Point<f64>>> {
        let mut next = BTreeMap::new();
        let touched: BTreeSet<usize> =
            nodes.iter().flat_map(|&n| [n, n - 1, n - self.columns, n - self.columns - 1]).collect();
        for cell in touched {
            // Corners anticlockwise; a segment starts where one goes from inside to outside and ends at the next return.
            let corners = [cell, cell + 1, cell + self.columns + 1, cell + self.columns];
            let inside = corners.map(|corner| nodes.contains(&corner));
            let joined = self.middle(corners) >= 0.0;
            let leaving = |i: usize| inside[i] && !inside[(i + 1) % 4];
            let crossing = |i: usize| {
                let (a, b) = (corners[i], corners[(i + 1) % 4]);
                (a.min(b), a.max(b))
            };
            for i in (0..4).filter(|&i| leaving(i)) {
                let returns: Vec<usize> =
                    (1..4).map(|k| (i + k) % 4).filter(|&j| !inside[j] && inside[(j + 1) % 4]).collect();
                // With two returns: around the outside corner if the middle is inside, else around the inside corner.
                let end = if joined { returns[0] } else { returns[returns.len() - 1] };
                next.insert(crossing(i), crossing(end));
            }
        }
        let mut rings = Vec::new();
        while let Some((start, mut at)) = next.pop_first() {
            let mut ring = vec![self.zero(start)];
            while at != start {
                ring.push(self.zero(at));
                let Some(after) = next.remove(&at) else { break };
                at = after;
            }
            rings.push(ring);
        }
        rings
    }

    fn zero(&self, (a, b): (usize, usize)) -> Point<f64> {
        let t = self.errors[a] / (self.errors[a] - self.errors[b]);
        self.point(a) + (self.point(b) - self.point(a)) * t
    }
}

/// (f2, violation) of one snapshot by the paper's formula on the plain contour.
pub fn evaluate(world: &World, snapshot: &Snapshot, plain: &Plain) -> [f64; 2] {
    let ring = world.scenario().ring();
    let sig = |x: f64, theta: f64| (ring.steepness * (x - theta)).logistic();
    let lost = plain.enclosed.iter().filter(|&&enclosed| !enclosed).count() as f64 / plain.enclosed.len() as f64;
    let points: Vec<_> = plain.rings.iter().flat_map(|ring| spread(ring, CANDIDATES_PER_RING)).collect();
    if points.is_empty() {
        return [2.0, lost];
    }
    let mean = |sources: &[Point<f64>], term: &dyn Fn(f64) -> f64| {
        let pairs = points.iter().flat_map(|&p| sources.iter().map(move |&source| (p - source).length()));
        pairs.map(term).sum::<f64>() / (points.len() * sources.len().max(1)) as f64
    };
    let to_targets = mean(&snapshot.targets, &|d| sig(d, ring.d_max) + sig(ring.d_min, d));
    let to_obstacles = mean(&snapshot.obstacle_points, &|d| sig(ring.d_obstacle, d));
    let close = points.iter().filter(|&&p| snapshot.walls().signed_distance(p) < 0.05).count() as f64;
    [to_targets + to_obstacles, lost + close / points.len() as f64]
}

/// `count` points at equal arc length along a closed polyline.
fn spread(ring: &[Point<f64>], count: usize) -> Vec<Point<f64>> {
    let length = |place: usize| (ring[(place + 1) % ring.len()] - ring[place]).length();
    let spacing = (0..ring.len()).map(length).sum::<f64>() / count as f64;
    let (mut points, mut passed) = (Vec::new(), 0.0);
    for place in 0..ring.len() {
        let chord = ring[(place + 1) % ring.len()] - ring[place];
        while points.len() < count && points.len() as f64 * spacing <= passed + length(place) {
            let t = if length(place) > 0.0 { (points.len() as f64 * spacing - passed) / length(place) } else { 0.0 };
            points.push(ring[place] + chord * t);
        }
        passed += length(place);
    }
    points
}
