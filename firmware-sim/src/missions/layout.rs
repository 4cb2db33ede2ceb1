//! What is drawn of a mission, in a plane of its own: the way begins at the origin and goes east, obstacles stand beside it.

use grn_core::geometry::{Point, Vector};

/// How an obstacle moves: what a point of it follows, by how much it has turned there, and when it is there.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Moves {
    pub path: Vec<Point<f64>>,
    /// Degrees, counter-clockwise; empty if it does not turn.
    pub turn_deg: Vec<f64>,
    /// From 0 to 1; empty for constant speed along the path.
    pub times: Vec<f64>,
}

/// What an obstacle is.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    Wall(Vec<Point<f64>>),
    Disc(Point<f64>, f64),
}

/// An obstacle and how it moves; with an empty path it stands still.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Obstacle {
    pub shape: Shape,
    pub moves: Moves,
}

impl Obstacle {
    pub fn fixed(shape: Shape) -> Obstacle {
        Obstacle { shape, moves: Moves::default() }
    }

    /// A box that stands still.
    pub fn block(low: [f64; 2], high: [f64; 2]) -> Obstacle {
        Obstacle::fixed(block(low, high))
    }
}

pub(super) fn block([west, south]: [f64; 2], [east, north]: [f64; 2]) -> Shape {
    let corners = [[west, south], [east, south], [east, north], [west, north]];
    Shape::Wall(corners.map(|[x, y]| Vector::new(x, y)).to_vec())
}

/// A way for targets and the obstacles beside it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layout {
    /// The corners of the way, of which every target goes a part.
    pub way: Vec<Point<f64>>,
    pub obstacles: Vec<Obstacle>,
    /// South-west and north-east corner of the region.
    pub region: [Point<f64>; 2],
}

/// Puts a layout into the region of a scenario, which begins at [0, 0]: mirrored or not, turned by quarters of a whole turn, so that no
/// direction is special.
pub(super) struct Orientation {
    low: Point<f64>,
    size: [f64; 2],
    mirrored: bool,
    quarters: usize,
}

impl Orientation {
    pub fn new(layout: &Layout, mirrored: bool, quarters: usize) -> Orientation {
        let [low, high] = layout.region;
        Orientation { low, size: [high.x - low.x, high.y - low.y], mirrored, quarters: quarters % 4 }
    }

    /// The sides of the region.
    pub fn region(&self) -> [f64; 2] {
        let [width, height] = self.size;
        if self.quarters.is_multiple_of(2) { [width, height] } else { [height, width] }
    }

    /// Where a point of the layout is, to a tenth of a millimetre: what is left of sums of centimetres is rounding.
    pub fn point(&self, point: Point<f64>) -> Point<f64> {
        let [width, height] = self.size;
        let Point { x, y } = point - self.low;
        let y = if self.mirrored { height - y } else { y };
        let [x, y] = match self.quarters {
            0 => [x, y],
            1 => [height - y, x],
            2 => [width - x, height - y],
            _ => [y, width - x],
        };
        let rounded = |metres: f64| (metres * 1e4).round() / 1e4;
        Vector::new(rounded(x), rounded(y))
    }

    /// What a turn of the layout is.
    pub fn turn(&self, degrees: f64) -> f64 {
        if self.mirrored && degrees != 0.0 { -degrees } else { degrees }
    }
}
