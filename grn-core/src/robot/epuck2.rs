//! The e-puck2's body, as far as its controller must know it.

use core::f64::consts::PI;

/// Control ticks per second.
pub const TICKS_PER_SECOND: u16 = 32;
/// Radius of the body, metres.
pub const BODY_RADIUS: f64 = 0.035;
/// Distance between the wheels, metres.
pub const AXLE: f64 = 0.053;
/// Diameter of a wheel, metres.
pub const WHEEL_DIAMETER: f64 = 0.041;
/// Motor steps per turn of a wheel.
pub const STEPS_PER_TURN: u16 = 1000;
/// Metres a wheel rolls in one step: 0.1288 mm.
pub const METRES_PER_STEP: f64 = WHEEL_DIAMETER * PI / STEPS_PER_TURN as f64;
/// The fastest a wheel turns, steps per second (0.142 m/s).
pub const MAX_WHEEL_SPEED: i16 = 1100;
/// The motor timer counts at 50 kHz: a wheel commanded to s steps/s turns at 50000 / ⌊50000 / s⌋.
pub const STEP_TIMER_HZ: u32 = 50_000;
/// How many proximity sensors the ring has.
pub const PROXIMITY_SENSORS: usize = 8;
/// How far a proximity sensor reaches from the body's edge, metres.
pub const PROXIMITY_RANGE: f64 = 0.05;
/// Bearings of the proximity sensors from the heading, degrees, left positive, in the order of the percept.
pub const PROXIMITY_BEARINGS_DEG: [i16; PROXIMITY_SENSORS] = [-17, -50, -90, -150, 150, 90, 50, 17];
