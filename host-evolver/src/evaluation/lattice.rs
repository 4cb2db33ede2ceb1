//! Square lattices over a world: nodes, edges, neighbours.

use super::lanes::WIDTH;
use grn_core::geometry::{Point, Vector};
use std::ops::Range;

/// Spacing of the lattice, metres. Contours are refined between its nodes; only topology is decided on it.
pub const LATTICE_STEP: f64 = firmware_sim::scenario::limits::LATTICE[0];
/// An edge of the lattice is creased if the distance to the walls in its middle is this far from the ends' mean, metres.
const CREASE: f64 = 0.004;
/// How far a lattice reaches beyond the scenario's region, metres. A pattern that gets there is open.
const MARGIN: f64 = firmware_sim::scenario::limits::LATTICE[1];

/// A lattice node's place in row-major order.
pub(super) type NodeIndex = usize;

/// East, north, west, south.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Direction(u8);

impl Direction {
    pub(super) const ALL: [Direction; 4] = [Direction(0), Direction(1), Direction(2), Direction(3)];

    pub(super) const EAST: Direction = Direction(0);
    pub(super) const NORTH: Direction = Direction(1);

    pub(super) const fn index(self) -> usize {
        self.0 as usize
    }

    pub(super) const fn unit(self) -> Vector<f64> {
        [Vector::new(1.0, 0.0), Vector::new(0.0, 1.0), Vector::new(-1.0, 0.0), Vector::new(0.0, -1.0)][self.index()]
    }

    /// A quarter turn clockwise.
    pub(super) const fn right(self) -> Direction {
        Direction((self.0 + 3) & 3)
    }

    /// A quarter turn anticlockwise.
    pub(super) const fn left(self) -> Direction {
        Direction((self.0 + 1) & 3)
    }
}

/// A square lattice over a scenario's region and a margin around it.
///
/// The length of a row is a multiple of [`WIDTH`], so that eight aligned nodes can be computed together. Nodes on the
/// border count as outside every pattern, so neighbours are only ever needed of nodes that have all four.
#[derive(Clone, Debug)]
pub(super) struct Lattice {
    origin: Point<f64>,
    step: f64,
    columns: usize,
    rows: usize,
}

impl Lattice {
    pub(super) fn over(region: [f64; 2], step: f64) -> Lattice {
        let count = |length: f64| ((length + 2.0 * MARGIN) / step).ceil() as usize + 1;
        let columns = count(region[0]).next_multiple_of(WIDTH);
        Lattice { origin: Vector::new(-MARGIN, -MARGIN), step, columns, rows: count(region[1]) }
    }

    /// So many nodes to each side of `centre`, which is in the middle of a cell; a few more along rows.
    pub(super) fn around(centre: Point<f64>, step: f64, reach: usize) -> Lattice {
        let (columns, rows) = ((2 * reach).next_multiple_of(WIDTH), 2 * reach);
        let to_middle = |count: usize| (count as f64 - 1.0) / 2.0 * step;
        Lattice { origin: centre - Vector::new(to_middle(columns), to_middle(rows)), step, columns, rows }
    }

    pub(super) fn nodes(&self) -> Range<NodeIndex> {
        0..self.columns * self.rows
    }

    pub(super) fn step(&self) -> f64 {
        self.step
    }

    pub(super) fn point(&self, node: NodeIndex) -> Point<f64> {
        // Processors divide short numbers faster.
        let (node, columns) = (node as u32, self.columns as u32);
        let offset = Vector::new(f64::from(node % columns), f64::from(node / columns));
        self.origin + offset * self.step
    }

    /// The points of eight nodes from `first` on, a multiple of eight: they are in one row.
    pub(super) fn run(&self, first: NodeIndex) -> [Point<f64>; WIDTH] {
        let (column, row) = (first % self.columns, first / self.columns);
        let offsets: [_; WIDTH] = std::array::from_fn(|lane| Vector::new((column + lane) as f64, row as f64));
        offsets.map(|offset| self.origin + offset * self.step)
    }

    /// The next node in a direction from a node that is not on the border.
    pub(super) fn neighbour(&self, node: NodeIndex, direction: Direction) -> NodeIndex {
        match direction.0 {
            0 => node + 1,
            1 => node + self.columns,
            2 => node - 1,
            _ => node - self.columns,
        }
    }

    /// How many nodes lie between a node and the lattice's border, along rows or columns; 0 on the border.
    pub(super) fn depth(&self, node: NodeIndex) -> usize {
        let (column, row) = (node % self.columns, node / self.columns);
        column.min(row).min(self.columns - 1 - column).min(self.rows - 1 - row)
    }

    /// The corners of the cell that holds `point`, nearest first; none outside the lattice.
    pub(super) fn cell_around(&self, point: Point<f64>) -> Option<[NodeIndex; 4]> {
        let place = (point - self.origin) * (1.0 / self.step);
        let (column, row) = (place.x.floor(), place.y.floor());
        let fits = |value: f64, count: usize| value >= 0.0 && value + 1.0 < count as f64;
        if !fits(column, self.columns) || !fits(row, self.rows) {
            return None;
        }
        let corner = row as usize * self.columns + column as usize;
        let (east, north) = (place.x - column > 0.5, place.y - row > 0.5);
        // From the near to the far side along each axis; the longer way first decides between the two in the middle.
        let (near_x, far_x) = if east { (1, 0) } else { (0, 1) };
        let (near_y, far_y) = if north { (self.columns, 0) } else { (0, self.columns) };
        let off_centre = |place: f64| (place - place.floor() - 0.5).abs();
        let middle = if off_centre(place.x) <= off_centre(place.y) {
            [far_x + near_y, near_x + far_y]
        } else {
            [near_x + far_y, far_x + near_y]
        };
        Some([near_x + near_y, middle[0], middle[1], far_x + far_y].map(|offset| corner + offset))
    }

    /// A node next to `point`, for looking up what varies slowly; `None` outside the lattice.
    pub(super) fn beside(&self, point: Point<f64>) -> Option<NodeIndex> {
        let place = (point - self.origin) * (1.0 / self.step);
        let (column, row) = (place.x.round(), place.y.round());
        let fits = |value: f64, count: usize| value >= 0.0 && value < count as f64;
        (fits(column, self.columns) && fits(row, self.rows)).then(|| row as usize * self.columns + column as usize)
    }
}

/// An edge of the lattice, from one node to its neighbour.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) from: NodeIndex,
    pub(super) to: NodeIndex,
}

/// What a pattern meets at a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Site {
    /// Open space.
    Open,
    /// Open space beside something of the walls that the lattice may not show.
    Beside,
    /// A wall, or the last node before the border: a pattern that holds it leaks.
    Leak,
    /// The lattice's border: outside every pattern.
    Border,
}

impl Site {
    pub(super) fn of(lattice: &Lattice, node: NodeIndex, clearance: f64, is_beside: bool) -> Site {
        match lattice.depth(node) {
            0 => Site::Border,
            1 => Site::Leak,
            _ if clearance <= 0.0 => Site::Leak,
            _ if is_beside => Site::Beside,
            _ => Site::Open,
        }
    }
}

/// Whether the clearance in the middle of an edge is far from what it is at the ends.
pub(super) fn is_crease(start: f64, middle: f64, end: f64) -> bool {
    ((start + end) * 0.5 - middle).abs() > CREASE
}
