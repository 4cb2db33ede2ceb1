//! From Python's SI units to the integers of percepts and back.

use crate::errors::refused;
use grn_core::robot::Millimetres;
use grn_core::robot::epuck2::PROXIMITY_RANGE;
use grn_core::robot::percept::HEADING_UNIT;
use pyo3::prelude::*;
use pyo3::types::PyAny;

/// Ticks that are 1/32 s: the unit of the ages in messages, seconds.
pub const TICK: f64 = 1.0 / grn_core::robot::epuck2::TICKS_PER_SECOND as f64;

/// Two numbers, from a tuple, a list, an array.
pub fn pair(what: &str, value: &Bound<'_, PyAny>) -> PyResult<[f64; 2]> {
    let wrong = || refused(format_args!("{what} = {value}: must be two numbers, (east, north) in metres"));
    let mut numbers = value.try_iter().map_err(|_| wrong())?;
    let mut next = || numbers.next().and_then(|number| number.ok()?.extract::<f64>().ok());
    match (next(), next(), next()) {
        (Some(x), Some(y), None) if x.is_finite() && y.is_finite() => Ok([x, y]),
        _ => Err(wrong()),
    }
}

/// The integer nearest to a number, which must be within `most` of 0.
fn whole(what: &str, given: f64, units: f64, most: i32) -> PyResult<i32> {
    let number = (given * units).round();
    if number.abs() <= f64::from(most) {
        return Ok(number as i32);
    }
    Err(refused(format_args!("{what} = {given}: must be within {} of 0, in metres", f64::from(most) / units)))
}

/// Metres as micrometres.
pub fn micrometres(what: &str, [x, y]: [f64; 2]) -> PyResult<[i32; 2]> {
    let most = grn_core::robot::percept::MAX_POSITION;
    Ok([whole(what, x, 1e6, most)?, whole(what, y, 1e6, most)?])
}

/// A place in metres as millimetres.
pub fn millimetres(what: &str, value: &Bound<'_, PyAny>) -> PyResult<Millimetres> {
    let [x, y] = pair(what, value)?;
    let coordinate = |metres| whole(what, metres, 1e3, i32::from(i16::MAX)).map(|mm| mm as i16);
    Ok(Millimetres { x: coordinate(x)?, y: coordinate(y)? })
}

fn since(what: &str, seconds: f64, units: f64, most: f64) -> PyResult<f64> {
    let number = (seconds * units).round();
    if (0.0..=most).contains(&number) {
        return Ok(number);
    }
    Err(refused(format_args!("{what} = {seconds}: must be 0 to {} seconds", most / units)))
}

/// An age in seconds as milliseconds.
pub fn milliseconds(what: &str, seconds: f64) -> PyResult<u16> {
    since(what, seconds, 1e3, f64::from(u16::MAX)).map(|ms| ms as u16)
}

/// A time in seconds as microseconds.
pub fn microseconds(what: &str, seconds: f64) -> PyResult<u32> {
    since(what, seconds, 1e6, f64::from(u32::MAX)).map(|us| us as u32)
}

/// A place in millimetres as metres.
pub fn metres(Millimetres { x, y }: Millimetres) -> (f64, f64) {
    (f64::from(x) * 1e-3, f64::from(y) * 1e-3)
}

/// An angle in radians, anticlockwise from east, as a vector in units of 2^-14.
pub fn direction(angle: f64) -> PyResult<[i16; 2]> {
    if !angle.is_finite() {
        return Err(refused(format_args!("heading = {angle}: must be an angle in radians")));
    }
    let (sin, cos) = libm::sincos(angle);
    Ok([cos, sin].map(|component| (component * f64::from(HEADING_UNIT)).round() as i16))
}

/// A free distance in metres as a percept has it; `None` and what is beyond reach are nothing.
pub fn free_distance(distance: Option<f64>) -> PyResult<u16> {
    match distance {
        None => Ok(u16::MAX),
        Some(distance) if distance >= 0.0 => {
            Ok(if distance > PROXIMITY_RANGE { u16::MAX } else { (distance * 1e4).round() as u16 })
        }
        Some(distance) => Err(refused(format_args!(
            "proximity: {distance} is no free distance from the body's edge: give metres from 0 on, or None for nothing in reach"
        ))),
    }
}
