//! Metres and unit vectors in the units of percepts, messages and traces.

use grn_core::geometry::Point;
use grn_core::robot::Millimetres;

/// The nearest whole number, halves up, for values that fit; ⌊value + 1/2⌋ without a call to `floor`.
pub(crate) fn rounded(value: f64) -> i32 {
    let above = value + 0.5;
    let whole = above as i32;
    whole - i32::from(f64::from(whole) > above)
}

/// A coordinate in metres as the nearest micrometre.
pub(crate) fn micrometres(metres: f64) -> i32 {
    rounded(metres * 1e6)
}

/// A place in metres as messages hold it; one farther than ±32.767 m off is moved to there.
pub(crate) fn millimetres(place: Point<f64>) -> Millimetres {
    let coordinate = |metres: f64| rounded(metres.clamp(-32.767, 32.767) * 1e3) as i16;
    Millimetres { x: coordinate(place.x), y: coordinate(place.y) }
}

/// A component of a unit vector in units of 2^-14, as the nearest whole number.
pub(crate) fn unit_q14(component: f64) -> i16 {
    rounded(component * 16384.0) as i16
}
