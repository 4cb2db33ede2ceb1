//! Who is near: a uniform grid of robots, rebuilt each tick without allocating, and a fixed grid of wall edges.

use crate::geometry::{Bounds, Edge, Polygon, Walls, length_squared};
use grn_core::geometry::{Point, Vector};

/// The most cells a side of a small swarm's grid; a swarm spread wider gets larger cells.
const SMALL_SIDE: usize = 64;

/// The most cells a side for so many robots: four cells a robot, so that neither many robots share a cell nor many cells are
/// cleared for each.
fn most_side(robots: usize) -> usize {
    SMALL_SIDE.max(2 * robots.isqrt())
}

/// Robots sorted by cell. Coordinates are kept beside the sorted order, each in an array of its own.
#[derive(Debug)]
pub struct Grid {
    reach: f64,
    most_side: usize,
    low: Point<f64>,
    per_cell: f64,
    columns: usize,
    rows: usize,
    starts: Vec<u32>,
    /// By the order in which robots are given.
    cells: Vec<u32>,
    robots: Vec<u16>,
    xs: Vec<f64>,
    ys: Vec<f64>,
}

impl Grid {
    /// A grid that finds what lies within `reach` metres.
    pub fn new(reach: f64, robots: usize) -> Self {
        let most_side = most_side(robots);
        Grid {
            reach,
            most_side,
            low: Vector::ZERO,
            per_cell: 0.0,
            columns: 1,
            rows: 1,
            starts: Vec::with_capacity(most_side * most_side + 2),
            cells: Vec::with_capacity(robots),
            robots: vec![0; robots],
            xs: vec![0.0; robots],
            ys: vec![0.0; robots],
        }
    }

    /// Sorts these robots, given by number and place, by where they are; at most as many as the grid was made for.
    pub fn rebuild(&mut self, robots: impl Iterator<Item = (u16, Point<f64>)> + Clone) {
        let bounds = Bounds::around(robots.clone().map(|(_, position)| position));
        let Bounds { low, high } = bounds.unwrap_or(Bounds { low: Vector::ZERO, high: Vector::ZERO });
        let extent = high - low;
        // Slightly larger than the reach, so that rounding cannot put a neighbour two cells away.
        let cell = (self.reach * 1.000_001).max(extent.x.max(extent.y) / (self.most_side - 1) as f64);
        self.low = low;
        self.per_cell = 1.0 / cell;
        self.columns = (extent.x * self.per_cell) as usize + 1;
        self.rows = (extent.y * self.per_cell) as usize + 1;
        self.starts.clear();
        self.starts.resize(self.columns * self.rows + 2, 0);
        self.cells.clear();
        for (_, position) in robots.clone() {
            let (column, row) = self.column_row(position);
            let cell = row * self.columns + column;
            self.cells.push(cell as u32);
            self.starts[cell + 2] += 1;
        }
        let mut sum = 0;
        for start in &mut self.starts {
            sum += *start;
            *start = sum;
        }
        for ((robot, position), &cell) in robots.zip(&self.cells) {
            let next = cell as usize + 1;
            let place = self.starts[next] as usize;
            self.starts[next] += 1;
            self.robots[place] = robot;
            self.xs[place] = position.x;
            self.ys[place] = position.y;
        }
    }

    #[inline]
    fn column_row(&self, position: Point<f64>) -> (usize, usize) {
        // By way of i32, to which floating-point numbers are converted in fewer instructions.
        let cell = |metres: f64, cells: usize| ((metres * self.per_cell) as i32).clamp(0, cells as i32 - 1) as usize;
        (cell(position.x - self.low.x, self.columns), cell(position.y - self.low.y, self.rows))
    }

    /// Calls `candidate(robot, squared distance)` for every robot within the grid's reach of `position`, and for others
    /// near them.
    #[inline]
    pub fn around(&self, position: Point<f64>, mut candidate: impl FnMut(u16, f64)) {
        // A position outside the grid counts as one in the nearest cell; what it reaches is in that cell or beside it.
        let (column, row) = self.column_row(position);
        let first = column.saturating_sub(1);
        let last = (column + 1).min(self.columns - 1);
        for row in row.saturating_sub(1)..(row + 2).min(self.rows) {
            let from = self.starts[row * self.columns + first] as usize;
            let range = from..self.starts[row * self.columns + last + 1] as usize;
            let (xs, ys, robots) = (&self.xs[range.clone()], &self.ys[range.clone()], &self.robots[range]);
            for ((&x, &y), &robot) in xs.iter().zip(ys).zip(robots) {
                let (dx, dy) = (x - position.x, y - position.y);
                candidate(robot, dx * dx + dy * dy);
            }
        }
    }

    /// Calls `found(robot, squared distance)` for every robot whose squared distance from `position` is at most `limit`,
    /// which is at most the square of the grid's reach.
    #[inline]
    pub fn within(&self, position: Point<f64>, limit: f64, mut found: impl FnMut(u16, f64)) {
        self.around(position, |robot, squared| {
            if squared <= limit {
                found(robot, squared);
            }
        });
    }
}

/// Wall edges by the cells they can be felt from; those of walls that may move are kept apart.
#[derive(Debug)]
pub struct WallIndex {
    reach: f64,
    low: Point<f64>,
    per_cell: f64,
    columns: usize,
    rows: usize,
    starts: Vec<u32>,
    edges: Vec<Edge>,
    moving: Vec<(Bounds, Vec<Edge>)>,
}

impl WallIndex {
    /// The most cells a side.
    const SIDE: f64 = 256.0;

    /// An index of the edges within `reach` metres.
    pub fn new(walls: &Walls, reach: f64) -> Self {
        let mut index = WallIndex {
            reach,
            low: Vector::ZERO,
            per_cell: 0.0,
            columns: 0,
            rows: 0,
            starts: vec![0],
            edges: Vec::new(),
            moving: Vec::new(),
        };
        index.set_moving(walls);
        let Some(bounds) = walls.fixed().iter().map(Polygon::bounds).reduce(Bounds::joined) else { return index };
        let margin = Vector::new(reach, reach);
        index.low = bounds.low - margin;
        let extent = bounds.high + margin - index.low;
        let cell = reach.max(extent.x.max(extent.y) / Self::SIDE);
        index.per_cell = 1.0 / cell;
        index.columns = (extent.x * index.per_cell) as usize + 1;
        index.rows = (extent.y * index.per_cell) as usize + 1;
        // No point of a cell is farther from its centre than half the diagonal, here rounded up.
        let limit = reach + cell * 0.71;
        let all: Vec<Edge> = walls.fixed().iter().flat_map(|polygon| polygon.edges().iter().copied()).collect();
        for row in 0..index.rows {
            for column in 0..index.columns {
                let centre = index.low + Vector::new(column as f64 + 0.5, row as f64 + 0.5) * cell;
                let near = |edge: &&Edge| length_squared(edge.nearest(centre) - centre) <= limit * limit;
                index.edges.extend(all.iter().filter(near));
                index.starts.push(index.edges.len() as u32);
            }
        }
        index
    }

    /// Takes the moving walls as they are now; the fixed ones must be those that it was made for.
    pub fn set_moving(&mut self, walls: &Walls) {
        let margin = Vector::new(self.reach, self.reach);
        let felt_in = |bounds: Bounds| Bounds { low: bounds.low - margin, high: bounds.high + margin };
        self.moving.clear();
        self.moving.extend(walls.moving().iter().map(|wall| (felt_in(wall.bounds()), wall.edges().to_vec())));
    }

    /// Every edge within the index's reach of `position`, and perhaps others.
    #[inline]
    pub fn near(&self, position: Point<f64>) -> impl Iterator<Item = &Edge> {
        let moving = self.moving.iter().filter(move |(felt_in, _)| felt_in.contains(position));
        self.near_fixed(position).iter().chain(moving.flat_map(|(_, edges)| edges))
    }

    #[inline]
    fn near_fixed(&self, position: Point<f64>) -> &[Edge] {
        let x = (position.x - self.low.x) * self.per_cell;
        let y = (position.y - self.low.y) * self.per_cell;
        if !(x >= 0.0 && y >= 0.0 && x < self.columns as f64 && y < self.rows as f64) {
            return &[];
        }
        let cell = y as usize * self.columns + x as usize;
        &self.edges[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Component, Stream};
    use crate::scenario::Scenario;

    #[test]
    fn the_grid_finds_what_brute_force_finds() {
        let mut stream = Stream::new(3, Component::Placement, 0);
        for (count, extent, reach) in
            [(120, 1.0, 0.12), (120, 1.0, 0.7), (120, 100.0, 0.5), (120, 0.0, 0.1), (3000, 16.0, 0.12)]
        {
            let positions: Vec<Point<f64>> = (0..count)
                .map(|_| Vector::new(stream.symmetric() * extent, stream.symmetric() * extent / 3.0))
                .collect();
            let mut grid = Grid::new(reach, positions.len());
            for _ in 0..2 {
                grid.rebuild((0..).zip(positions.iter().copied()));
            }
            // From places in the grid and from outside it.
            let outside = (0..40).map(|_| Vector::new(stream.symmetric() * 2.0 * extent, stream.symmetric() * extent));
            for here in positions.iter().copied().chain(outside.collect::<Vec<_>>()) {
                let mut found = Vec::new();
                grid.within(here, reach * reach, |robot, squared| found.push((robot, squared)));
                found.sort_by_key(|f| f.0);
                let expected: Vec<(u16, f64)> =
                    (0..).zip(&positions).map(|(i, &p)| (i, length_squared(p - here))).collect();
                let expected: Vec<_> = expected.into_iter().filter(|e| e.1 <= reach * reach).collect();
                assert_eq!(found, expected);
            }
        }
        let mut empty = Grid::new(0.5, 3);
        empty.rebuild(core::iter::empty());
        empty.within(Vector::ZERO, 0.25, |robot, _| panic!("{robot}"));
    }

    #[test]
    fn the_index_misses_no_edge_within_reach() {
        let text = include_str!("../../scenarios/compound-channel.toml");
        let walls = Scenario::parse(text).unwrap().scaled(0.25).fixed_walls().clone();
        let index = WallIndex::new(&walls, 0.1);
        let mut stream = Stream::new(4, Component::Placement, 0);
        let (mut near, mut empty) = (0, 0);
        for _ in 0..20_000 {
            let p = Vector::new(stream.unit() * 8.0 - 0.5, stream.unit() * 8.0 - 0.5);
            let candidates: Vec<&Edge> = index.near(p).collect();
            empty += usize::from(candidates.is_empty());
            for edge in walls.polygons().flat_map(|polygon| polygon.edges()) {
                if length_squared(edge.nearest(p) - p) <= 0.01 {
                    near += 1;
                    assert!(candidates.contains(&edge));
                }
            }
        }
        assert!(near > 1000 && empty > 10_000, "{near} {empty}");
        assert!(WallIndex::new(&Walls::default(), 0.1).near(Vector::ZERO).next().is_none());
    }
}
