//! Walls that a lattice does not show, because they lie between its nodes: thin ones, small ones, tips.

use super::lattice::{Direction, Lattice, NodeIndex};
use firmware_sim::geometry::{Polygon, Walls};
use grn_core::geometry::{Point, Vector};
use std::collections::BTreeMap;

/// Half a step and a little: one of an edge's ends is at least this near to a wall that crosses it.
const HALF: f64 = 0.5 + 1e-9;
/// Coordinates of nodes and walls that should be equal differ by less than this, metres.
const ROUNDING: f64 = 1e-9;
/// A place so far behind a wall's surface is in the wall, metres.
const JUST_WITHIN: f64 = 1e-5;

/// What lies beside a node in the open.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Beside {
    /// Whether a wall crosses the edge in each direction, though its other end is in the open, too.
    pub blocked: [bool; 4],
    /// Where walls cross those edges.
    pub crossings: Vec<Point<f64>>,
    /// The walls' vertices in the cells around.
    pub vertices: Vec<Point<f64>>,
}

/// What a lattice hides of the walls, given the clearance at each node; only nodes in the open have something beside them.
pub(super) fn hidden_from(walls: &Walls, lattice: &Lattice, clearance: &[f64]) -> BTreeMap<NodeIndex, Beside> {
    let mut hidden: BTreeMap<NodeIndex, Beside> = BTreeMap::new();
    let is_open = |node: NodeIndex| clearance[node] > 0.0 && lattice.depth(node) > 0;
    for vertex in walls.polygons().flat_map(Polygon::vertices) {
        for node in lattice.cell_around(*vertex).into_iter().flatten().filter(|&node| is_open(node)) {
            hidden.entry(node).or_default().vertices.push(*vertex);
        }
    }
    for node in lattice.nodes().filter(|&node| clearance[node] < lattice.step() && is_open(node)) {
        for direction in Direction::ALL {
            let (point, step) = (lattice.point(node), lattice.step());
            if is_open(lattice.neighbour(node, direction))
                && let Some(distance) = entry(walls, point, direction, step - ROUNDING)
            {
                let beside = hidden.entry(node).or_default();
                beside.blocked[direction.index()] = true;
                beside.crossings.push(point + direction.unit() * distance);
            }
        }
    }
    hidden
}

/// How far in a direction from `start`, metres, a wall is entered within `reach`; it is not if the way only leads along its surface.
fn entry(walls: &Walls, start: Point<f64>, direction: Direction, reach: f64) -> Option<f64> {
    let distance = walls.ray(start, direction.unit(), reach)?;
    let within = start + direction.unit() * (distance + JUST_WITHIN);
    (walls.signed_distance(within) < -ROUNDING).then_some(distance)
}

/// Whether a node in the open of a lattice, at `point`, stands for a wall that no node shows: the nearer end of each edge that
/// a wall crosses does, and the node nearest to a vertex of which all nodes around are in the open. So nothing passes
/// through a wall from node to node, and walls are at most half a step from where they should be.
pub(super) fn stands_for_wall(walls: &Walls, lattice: &Lattice, point: Point<f64>) -> bool {
    let step = lattice.step();
    let is_open = |east: f64, north: f64| walls.signed_distance(point + Vector::new(east, north)) > 0.0;
    let is_crossed = |&direction: &Direction| {
        let way = direction.unit() * step;
        entry(walls, point, direction, step * HALF).is_some() && is_open(way.x, way.y)
    };
    let is_hidden = |vertex: &Point<f64>| {
        let offset = *vertex - point;
        let is_nearest = offset.x.abs() <= step * HALF && offset.y.abs() <= step * HALF;
        let (east, north) = (step.copysign(offset.x), step.copysign(offset.y));
        is_nearest && is_open(east, 0.0) && is_open(0.0, north) && is_open(east, north)
    };
    let on_surface = walls.signed_distance(point) < ROUNDING;
    let mut vertices = walls.polygons().flat_map(Polygon::vertices);
    Direction::ALL.iter().any(is_crossed) || (!on_surface && vertices.any(is_hidden))
}
