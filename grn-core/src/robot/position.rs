//! Places in the world, as messages and percepts tell them and as the controller computes with them.

use crate::geometry::{Point, Vector};
use crate::scalar::Scalar;
use serde::{Deserialize, Serialize};

/// A position in the world, millimetres, within ±32.7 m.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Millimetres {
    /// East.
    pub x: i16,
    /// North.
    pub y: i16,
}

/// The squared distance between two places, mm², at most what a `u32` holds (65 m).
pub(super) fn squared_distance(a: Millimetres, b: Millimetres) -> u32 {
    // The square of 16 bits' difference fits 32 bits without a sign.
    let square = |a: i16, b: i16| {
        let difference = i32::from(a) - i32::from(b);
        difference.wrapping_mul(difference) as u32
    };
    square(a.x, b.x).saturating_add(square(a.y, b.y))
}

/// Where that is, metres.
pub fn metres<S: Scalar>(position: Millimetres) -> Point<S> {
    let metre = |mm: i16| S::from_millionths(i32::from(mm) * 1000);
    Vector::new(metre(position.x), metre(position.y))
}

pub(super) fn millimetres<S: Scalar>(position: Point<S>) -> Millimetres {
    let mm = |metres: S| metres.times_to_i32(1000).clamp(-32_767, 32_767) as i16;
    Millimetres { x: mm(position.x), y: mm(position.y) }
}
