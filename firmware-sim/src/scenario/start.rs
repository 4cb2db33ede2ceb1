//! Where robots begin.

use super::Disc;
use super::limits::{DISC_RADIUS, MAX_POINTS};
use super::points::{checked_point, checked_points};
use super::tables::StartTable;
use crate::geometry::Walls;
use grn_core::geometry::Point;
use grn_input::InputError;

/// Where robots begin, if the world says so.
#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    /// At random places in this disc.
    Within(Disc),
    /// The first robot at the first of these places, and so on; at least one, at most [`MAX_POINTS`].
    At(Vec<Point<f64>>),
}

impl Start {
    /// The start of a file, in a world of this region, metres, whose walls are these at time 0.
    pub(super) fn checked(table: StartTable, region: [f64; 2], walls: &Walls) -> Result<Start, InputError> {
        let StartTable { centre, radius, positions } = table;
        let (start, places) = match (centre, radius, positions) {
            (Some(centre), Some(radius), None) => {
                let centre = checked_point("start.centre", centre, region, 0.0)?;
                DISC_RADIUS.check("start.radius", radius)?;
                (Start::Within(Disc { centre, radius }), vec![("start.centre".to_owned(), centre)])
            }
            (None, None, Some(positions)) => {
                let positions = checked_points("start.positions", &positions, region, 0.0)?;
                if positions.is_empty() {
                    let expected = format!("1 to {MAX_POINTS} places are needed, one for each robot");
                    return Err(InputError::new("start.positions", "[]", expected));
                }
                let keys = positions.iter().enumerate().map(|(place, &at)| (format!("start.positions[{place}]"), at));
                (Start::At(positions.clone()), keys.collect())
            }
            _ => {
                let expected =
                    "give centre and radius, of the disc in which robots begin, or positions, one for each robot";
                return Err(InputError::new("start", "", expected));
            }
        };
        for (key, Point { x, y }) in places {
            if walls.containing(Point::new(x, y)).is_some() {
                let expected = "is inside a wall or disc; move the start or the wall";
                return Err(InputError::new(key, format!("[{x:?}, {y:?}]"), expected));
            }
        }
        Ok(start)
    }

    #[must_use]
    pub(super) fn scaled(&self, factor: f64) -> Start {
        match self {
            Start::Within(disc) => Start::Within(disc.scaled(factor)),
            Start::At(positions) => Start::At(positions.iter().map(|&position| position * factor).collect()),
        }
    }
}
