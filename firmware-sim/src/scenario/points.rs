//! The points of a file, checked.

use super::limits::MAX_POINTS;
use grn_core::geometry::{Point, Vector};
use grn_input::{InputError, Pair, Range};

/// A point that must lie in the region, or at most `overhang` metres beside it.
pub(super) fn checked_point(
    key: &str,
    Pair([x, y]): Pair,
    region: [f64; 2],
    overhang: f64,
) -> Result<Point<f64>, InputError> {
    let holds = |value: f64, side: f64| Range::new(-overhang, side + overhang, "").holds(value);
    if holds(x, region[0]) && holds(y, region[1]) {
        return Ok(Vector::new(x, y));
    }
    let [east, north] = region;
    let expected = if overhang > 0.0 {
        format!(
            "must be finite and at most {overhang} metres outside the region, {east:?} x {north:?} metres from [0, 0]"
        )
    } else {
        format!("must lie in the region, {east:?} x {north:?} metres from [0, 0]; move it, or make the region larger")
    };
    Err(InputError::new(key, format!("[{x:?}, {y:?}]"), expected))
}

fn too_many(key: &str, count: usize) -> InputError {
    InputError::new(key, format!("{count} points"), format!("at most {MAX_POINTS} points are allowed; simplify it"))
}

pub(super) fn checked_points(
    key: &str,
    raw: &[Pair],
    region: [f64; 2],
    overhang: f64,
) -> Result<Vec<Point<f64>>, InputError> {
    if raw.len() > MAX_POINTS {
        return Err(too_many(key, raw.len()));
    }
    let point = |(index, &raw)| checked_point(&format!("{key}[{index}]"), raw, region, overhang);
    raw.iter().enumerate().map(point).collect()
}
