//! What the controller is told each tick and what it answers.

use super::epuck2::{PROXIMITY_SENSORS, TICKS_PER_SECOND};
use super::message::Message;
use super::position::Millimetres;
use core::fmt;
use heapless::Vec;
use serde::{Deserialize, Serialize};

/// The most targets a robot sees or keeps in mind; of more targets it keeps the nearest.
pub const MAX_TARGETS: usize = 4;
/// The most obstacle points a robot's own sensors report in one tick.
pub const MAX_SEEN_OBSTACLES: usize = 8;
/// The most messages delivered to a robot in one tick; a radio keeps the strongest.
pub const MAX_HEARD: usize = 8;
/// The farthest a robot may be from the origin in x and in y, micrometres: what a [`Message`] can say, in millimetres.
pub const MAX_POSITION: i32 = 32_767_000;
/// The length of a heading in its own unit.
pub const HEADING_UNIT: i16 = 1 << 14;
/// How far the length of a heading may be from [`HEADING_UNIT`]: a 32nd of it.
///
/// The controller makes the length 1, so a little does no harm: that of a table of sines, or of a heading that is turned by
/// small angles again and again. A wrong unit (degrees, 2^-15,
/// thousandths) or a heading that was never set is much farther off.
pub const HEADING_TOLERANCE: i16 = HEADING_UNIT / 32;
/// The time from one tick to the next that gains and blobs are made for, microseconds: 1/32 s.
pub const NOMINAL_TICK_US: u32 = 1_000_000 / TICKS_PER_SECOND as u32;
/// The shortest time from one tick to the next, microseconds.
pub const SHORTEST_TICK_US: u32 = 1_000;
/// The longest time from one tick to the next, microseconds.
pub const LONGEST_TICK_US: u32 = 250_000;

/// What a localisation system says of the robot: where it was and how it looked when that was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fix {
    /// Own position in the world, micrometres, within ±[`MAX_POSITION`].
    pub position: [i32; 2],
    /// Own heading as (cos, sin), in units of 2^-14: a vector of length [`HEADING_UNIT`], give or take
    /// [`HEADING_TOLERANCE`].
    pub heading: [i16; 2],
    /// How long ago it was measured, milliseconds; 0 if that is not known.
    pub age_ms: u16,
}

/// A message received by radio.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Heard {
    /// What was said.
    pub message: Message,
    /// How long it was on its way as far as the radio knows, milliseconds; 0 if that is not known.
    pub age_ms: u16,
}

/// A target seen with the robot's own sensors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sighting {
    /// Which target: targets can be told apart.
    pub target: u8,
    /// Where it is.
    pub position: Millimetres,
}

/// Everything a robot perceives in one tick.
///
/// It has no `Default`, because zeros mean something else than nothing: obstacles that touch the robot on all sides. Begin
/// with [`Percept::nothing`], or name every field, so that the compiler finds the places that a new field concerns.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Percept {
    /// Where the robot is, if the localisation system has said so since the last tick.
    pub fix: Option<Fix>,
    /// Time since the last tick, microseconds, from [`SHORTEST_TICK_US`] to [`LONGEST_TICK_US`]; [`NOMINAL_TICK_US`] if
    /// ticks come on time.
    pub elapsed_us: u32,
    /// Free distance in front of each proximity sensor, from the body's edge, in units of 0.1 mm; `u16::MAX` when
    /// nothing is in range. Bearings as in [`PROXIMITY_BEARINGS_DEG`](super::epuck2::PROXIMITY_BEARINGS_DEG).
    pub proximity: [u16; PROXIMITY_SENSORS],
    /// Targets seen with own sensors (mother robots).
    pub targets: Vec<Sighting, MAX_TARGETS>,
    /// Points on obstacles seen with own sensors (mother robots).
    pub obstacles: Vec<Millimetres, MAX_SEEN_OBSTACLES>,
    /// Messages received since the last tick. The robot's own, which some radios give back, are ignored.
    pub heard: Vec<Heard, MAX_HEARD>,
}

/// What a robot does until the next tick.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Command {
    /// Left wheel, steps per second, forward positive, within ±1100.
    pub left: i16,
    /// Right wheel, steps per second, forward positive, within ±1100.
    pub right: i16,
    /// What to broadcast in this tick, if anything.
    pub broadcast: Option<Message>,
}

/// Why a percept is not one that a robot can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PerceptError {
    /// The position is farther from the origin than [`MAX_POSITION`].
    Position {
        /// The position, micrometres.
        position: [i32; 2],
    },
    /// The heading is not a unit vector.
    Heading {
        /// The heading, units of 2^-14.
        heading: [i16; 2],
    },
    /// The time since the last tick is out of range.
    Elapsed {
        /// The time, microseconds.
        elapsed_us: u32,
    },
}

impl Percept {
    /// The percept of a robot that perceives nothing, not even where it is, in a tick that came on time.
    pub const fn nothing() -> Self {
        Percept {
            fix: None,
            elapsed_us: NOMINAL_TICK_US,
            proximity: [u16::MAX; PROXIMITY_SENSORS],
            targets: Vec::new(),
            obstacles: Vec::new(),
            heard: Vec::new(),
        }
    }

    /// Whether a robot can perceive this.
    ///
    /// # Errors
    /// [`PerceptError`].
    pub fn check(&self) -> Result<(), PerceptError> {
        let elapsed_us = self.elapsed_us;
        if !(SHORTEST_TICK_US..=LONGEST_TICK_US).contains(&elapsed_us) {
            return Err(PerceptError::Elapsed { elapsed_us });
        }
        self.fix.as_ref().map_or(Ok(()), Fix::check)
    }
}

impl Fix {
    fn check(&self) -> Result<(), PerceptError> {
        let Fix { position, heading, age_ms: _ } = *self;
        let far = |coordinate: i32| coordinate.unsigned_abs() > MAX_POSITION as u32;
        let [east, north] = position;
        if far(east) || far(north) {
            return Err(PerceptError::Position { position });
        }
        const SHORTEST: u32 = (HEADING_UNIT - HEADING_TOLERANCE) as u32;
        const LONGEST: u32 = (HEADING_UNIT + HEADING_TOLERANCE) as u32;
        let square = |component: i16| (i32::from(component) * i32::from(component)) as u32;
        let [x, y] = heading;
        if !(SHORTEST * SHORTEST..=LONGEST * LONGEST).contains(&(square(x) + square(y))) {
            return Err(PerceptError::Heading { heading });
        }
        Ok(())
    }
}

impl fmt::Display for PerceptError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PerceptError::Position { position: [x, y] } => write!(
                f,
                "the robot's position ({x}, {y}) is out of range: give micrometres, within {MAX_POSITION} of the origin in \
                 both directions"
            ),
            PerceptError::Heading { heading: [x, y] } => write!(
                f,
                "the robot's heading ({x}, {y}) is not a unit vector: give its cosine and sine times {HEADING_UNIT}; the \
                 length may be {HEADING_TOLERANCE} off"
            ),
            PerceptError::Elapsed { elapsed_us } => write!(
                f,
                "{elapsed_us} µs since the last tick are out of range: give {SHORTEST_TICK_US} to {LONGEST_TICK_US}, \
                 {NOMINAL_TICK_US} if ticks come on time"
            ),
        }
    }
}

impl core::error::Error for PerceptError {}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::ToString;

    fn fixed(position: [i32; 2], heading: [i16; 2]) -> Result<(), PerceptError> {
        Percept { fix: Some(Fix { position, heading, age_ms: 0 }), ..Percept::nothing() }.check()
    }

    fn looking(heading: [i16; 2]) -> Result<(), PerceptError> {
        fixed([0; 2], heading)
    }

    fn at(position: [i32; 2]) -> Result<(), PerceptError> {
        fixed(position, [HEADING_UNIT, 0])
    }

    #[test]
    fn nothing_is_a_percept_in_which_nothing_is_near() {
        let nothing = Percept::nothing();
        assert_eq!(nothing.check(), Ok(()));
        assert_eq!((nothing.fix, nothing.elapsed_us, nothing.proximity), (None, 31_250, [u16::MAX; 8]));
        assert!(nothing.targets.is_empty() && nothing.obstacles.is_empty() && nothing.heard.is_empty());
    }

    #[test]
    fn headings_of_another_length_than_one_are_refused() {
        for angle in 0..360 {
            let (sin, cos) = libm::sincos(f64::from(angle).to_radians());
            let of_length = |length: f64| looking([libm::round(cos * length) as i16, libm::round(sin * length) as i16]);
            for length in [15_874.0, 16_384.0, 16_894.0] {
                assert_eq!(of_length(length), Ok(()), "{angle} degrees, length {length}");
            }
            for length in [0.0, 1.0, 100.0, 1000.0, 10_000.0, 15_870.0, 16_898.0, 20_000.0, 32_767.0] {
                assert!(of_length(length).is_err(), "{angle} degrees, length {length}");
            }
        }
        for heading in [[15_872, 0], [0, -16_896]] {
            assert_eq!(looking(heading), Ok(()));
        }
        for heading in [[15_871, 0], [0, -16_897], [16_384, 16_384], [i16::MIN, i16::MIN], [i16::MIN, 0], [0, i16::MAX]]
        {
            assert_eq!(looking(heading), Err(PerceptError::Heading { heading }));
        }
        let text = PerceptError::Heading { heading: [90, 0] }.to_string();
        assert!(text.contains("(90, 0)") && text.contains("16384"), "{text}");
    }

    #[test]
    fn positions_that_no_message_can_say_are_refused() {
        for position in [[32_767_000, -32_767_000], [0, 32_767_000]] {
            assert_eq!(at(position), Ok(()));
        }
        for position in [[32_767_001, 0], [0, -32_767_001], [i32::MIN, 0], [i32::MAX, i32::MIN]] {
            assert_eq!(at(position), Err(PerceptError::Position { position }));
        }
        let text = PerceptError::Position { position: [i32::MAX, 5] }.to_string();
        assert!(text.contains("(2147483647, 5)") && text.contains("micrometres"), "{text}");
    }

    #[test]
    fn times_between_ticks_that_no_control_loop_has_are_refused() {
        let after = |elapsed_us: u32| Percept { elapsed_us, ..Percept::nothing() }.check();
        for elapsed_us in [1_000, 31_250, 100_000, 250_000] {
            assert_eq!(after(elapsed_us), Ok(()));
        }
        for elapsed_us in [0, 31, 999, 250_001, u32::MAX] {
            assert_eq!(after(elapsed_us), Err(PerceptError::Elapsed { elapsed_us }));
        }
        let text = after(31).unwrap_err().to_string();
        assert!(text.contains("31 µs") && text.contains("31250"), "{text}");
    }
}
