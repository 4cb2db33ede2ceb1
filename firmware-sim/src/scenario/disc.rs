//! Round obstacles.

use crate::geometry::Polygon;
use grn_core::geometry::Point;

/// A disc that is solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Its middle, metres.
    pub centre: Point<f64>,
    /// Its radius, metres, positive.
    pub radius: f64,
}

impl Disc {
    /// What the program takes for it: [`Polygon::disc`].
    pub fn outline(&self) -> Polygon {
        Polygon::disc(self.centre, self.radius)
    }

    #[must_use]
    pub(super) fn scaled(&self, factor: f64) -> Disc {
        Disc { centre: self.centre * factor, radius: self.radius * factor }
    }
}
