//! Which edges can be nearest where: a grid over the walls and their surroundings.

use super::{Bounds, Edge, Polygon, length_squared};
use grn_core::geometry::{Point, Vector};

/// Cells along either axis, and along either side of a block of them that is looked at first.
const CELLS: usize = 128;
const BLOCK: usize = 8;
/// How far the grid reaches beyond the walls, in extents of the walls.
const MARGIN: f64 = 0.25;
/// Covers rounding when distances to a cell's centre are compared.
const SLACK: f64 = 1e-9;

/// For each cell the edges of which one is nearest to each of its points, in the walls' order.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct NearestEdges {
    low: Point<f64>,
    per_cell: Vector<f64>,
    edges: Vec<Edge>,
    /// Where each cell's candidates begin, and the end of the last one's.
    starts: Vec<u32>,
    candidates: Vec<u32>,
    /// Whether a cell lies outside all walls as a whole.
    outside: Vec<bool>,
}

impl NearestEdges {
    /// The grid of some walls; none without walls.
    pub(super) fn of(polygons: &[Polygon]) -> Option<NearestEdges> {
        let bounds = polygons.iter().map(Polygon::bounds).reduce(Bounds::joined)?;
        let extent = bounds.high - bounds.low;
        let low = bounds.low - extent * MARGIN;
        let cell = extent * ((1.0 + 2.0 * MARGIN) / CELLS as f64);
        let edges: Vec<Edge> = polygons.iter().flat_map(Polygon::edges).copied().collect();
        let mut grid = NearestEdges {
            low,
            per_cell: Vector::new(1.0 / cell.x, 1.0 / cell.y),
            edges,
            starts: vec![0],
            candidates: Vec::new(),
            outside: Vec::with_capacity(CELLS * CELLS),
        };
        let centre_of = |column: usize, row: usize, size: usize| {
            let half = size as f64 / 2.0;
            low + Vector::new((column as f64 + half) * cell.x, (row as f64 + half) * cell.y)
        };
        let half = (cell * 0.5).length();
        let all: Vec<u32> = (0..grid.edges.len() as u32).collect();
        let mut blocks = Vec::new();
        for row in 0..CELLS {
            if row % BLOCK == 0 {
                let centres = (0..CELLS).step_by(BLOCK).map(|column| centre_of(column, row, BLOCK));
                blocks = centres.map(|centre| grid.nearest_within(centre, half * BLOCK as f64, &all).0).collect();
            }
            for column in 0..CELLS {
                let centre = centre_of(column, row, 1);
                let (candidates, nearest) = grid.nearest_within(centre, half, &blocks[column / BLOCK]);
                grid.candidates.extend(candidates);
                grid.starts.push(grid.candidates.len() as u32);
                grid.outside.push(nearest > half && !polygons.iter().any(|polygon| polygon.contains(centre)));
            }
        }
        Some(grid)
    }

    /// Those edges of some that may be nearest to a point within `radius` of `centre`, and the distance of the nearest to it.
    fn nearest_within(&self, centre: Point<f64>, radius: f64, among: &[u32]) -> (Vec<u32>, f64) {
        let distance = |edge: u32| (self.edges[edge as usize].nearest(centre) - centre).length();
        let distances: Vec<(u32, f64)> = among.iter().map(|&edge| (edge, distance(edge))).collect();
        let nearest = distances.iter().map(|(_, distance)| *distance).fold(f64::INFINITY, f64::min);
        let reach = nearest + 2.0 * radius + SLACK * (nearest + radius);
        (distances.iter().filter(|(_, distance)| *distance <= reach).map(|(edge, _)| *edge).collect(), nearest)
    }

    fn cell(&self, point: Point<f64>) -> Option<usize> {
        let (column, row) = ((point.x - self.low.x) * self.per_cell.x, (point.y - self.low.y) * self.per_cell.y);
        let fits = |place: f64| place >= 0.0 && place < CELLS as f64;
        (fits(column) && fits(row)).then(|| row as usize * CELLS + column as usize)
    }

    /// The nearest point of any outline and the squared distance to it, if the grid reaches there.
    pub(super) fn nearest(&self, point: Point<f64>) -> Option<(Point<f64>, f64)> {
        Some(self.nearest_in(self.cell(point)?, point))
    }

    /// The same, if the grid tells that the point is outside all walls.
    pub(super) fn nearest_outside(&self, point: Point<f64>) -> Option<(Point<f64>, f64)> {
        let cell = self.cell(point).filter(|&cell| self.outside[cell])?;
        Some(self.nearest_in(cell, point))
    }

    fn nearest_in(&self, cell: usize, point: Point<f64>) -> (Point<f64>, f64) {
        let candidates = &self.candidates[self.starts[cell] as usize..self.starts[cell + 1] as usize];
        let mut best = (point, f64::INFINITY);
        for &edge in candidates {
            let candidate = self.edges[edge as usize].nearest(point);
            let squared = length_squared(point - candidate);
            if squared < best.1 {
                best = (candidate, squared);
            }
        }
        best
    }
}
