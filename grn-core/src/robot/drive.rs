//! From a wanted velocity to wheel speeds, and the reflex away from what is close.

use super::epuck2::{AXLE, MAX_WHEEL_SPEED, METRES_PER_STEP, PROXIMITY_SENSORS};
use crate::geometry::Vector;
use crate::scalar::Scalar;

/// (cos, sin) of the proximity sensors' bearings in units of 2^-14, in the percept's order.
const SENSOR_DIRECTIONS: [(i16, i16); PROXIMITY_SENSORS] = [
    (15_668, -4_790),
    (10_531, -12_551),
    (0, -16_384),
    (-14_189, -8_192),
    (-14_189, 8_192),
    (0, 16_384),
    (10_531, 12_551),
    (15_668, 4_790),
];
/// A unit vector's component from its units of 2^-14.
fn unit<S: Scalar>(component: i16) -> S {
    S::from_ratio(i32::from(component), 1 << 14)
}

/// The heading of a percept as a vector of length 1.
pub fn heading<S: Scalar>([cos, sin]: [i16; 2]) -> Vector<S> {
    Vector::new(unit(cos), unit(sin))
}

/// Free distance, in 0.1 mm, below which the reflex acts. Less than the 5 cm that sensors reach: robots side by side on a
/// crowded ring would push each other off it, because eight rays do not feel the same on both sides.
const REFLEX_RANGE: i32 = 300;

/// The reflex: a velocity away from what the proximity sensors feel, at most about `strength` per sensor.
///
/// A sensor with free distance r in front of it, r below R = [`REFLEX_RANGE`], pushes with (1 - r/R)².
pub fn reflex<S: Scalar>(proximity: &[u16; PROXIMITY_SENSORS], heading: Vector<S>, strength: S) -> Vector<S> {
    let felt = proximity.iter().zip(SENSOR_DIRECTIONS).filter(|(distance, _)| i32::from(**distance) < REFLEX_RANGE);
    felt.fold(Vector::ZERO, |sum, (&distance, (cos, sin))| {
        let closeness = S::from_ratio(REFLEX_RANGE - i32::from(distance), REFLEX_RANGE);
        let direction = heading * unit::<S>(cos) + heading.turned_left() * unit::<S>(sin);
        sum - direction * (strength * closeness * closeness)
    })
}

/// Turns velocities into wheel speeds; drives backwards when that is the shorter turn.
#[derive(Clone, Debug)]
pub struct Drive<S> {
    /// How much faster than the middle a wheel rolls per unit of sideways error, m/s.
    turn: S,
    backwards: bool,
}

/// Below this speed (metres per second) the body turns proportionally slower: a robot at rest need not look anywhere.
const SLOW: (i32, i32) = (1, 100);

impl<S: Scalar> Drive<S> {
    /// `turn`: turning rate per unit of sideways error, 1/s.
    pub fn new(turn: S) -> Self {
        Drive { turn: turn * S::from_f64(AXLE / 2.0), backwards: false }
    }

    /// (left, right) wheel speeds in steps per second for a velocity in metres per second.
    pub fn wheels(&mut self, velocity: Vector<S>, heading: Vector<S>) -> (i16, i16) {
        let speed = velocity.length();
        let along = velocity.dot(heading);
        let aside = heading.cross(velocity);
        let reluctance = speed.halved(2);
        if along > reluctance {
            self.backwards = false;
        } else if along < -reluctance {
            self.backwards = true;
        }
        let aside = if self.backwards { -aside } else { aside };
        let along = if self.backwards { along.min(S::ZERO) } else { along.max(S::ZERO) };
        let slow = S::from_ratio(SLOW.0, SLOW.1);
        let difference = self.turn * (aside / speed.max(slow));
        wheel_steps(along - difference, along + difference)
    }
}

/// Wheel speeds in steps per second, both slowed in proportion if one is beyond the motors.
fn wheel_steps<S: Scalar>(left: S, right: S) -> (i16, i16) {
    let steps = |speed: S| (speed * S::from_f64(0.001 / METRES_PER_STEP)).times_to_i32(1000);
    let (left, right) = (steps(left), steps(right));
    let fastest = left.abs().max(right.abs());
    let limit = i32::from(MAX_WHEEL_SPEED);
    let fitted = |wheel: i32| match wheel.saturating_mul(limit).checked_div(fastest) {
        Some(slowed) if fastest > limit => slowed as i16,
        _ => wheel as i16,
    };
    (fitted(left), fitted(right))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::epuck2::PROXIMITY_BEARINGS_DEG;

    #[test]
    fn sensor_directions_are_those_of_the_bearings() {
        for (bearing, (cos, sin)) in PROXIMITY_BEARINGS_DEG.into_iter().zip(SENSOR_DIRECTIONS) {
            let (s, c) = libm::sincos(f64::from(bearing).to_radians());
            assert_eq!((libm::round(c * 16384.0) as i16, libm::round(s * 16384.0) as i16), (cos, sin));
        }
    }

    #[test]
    fn wheels_follow_the_velocity() {
        let east = Vector::new(1.0_f32, 0.0);
        let mut drive = Drive::new(4.0);
        let (left, right) = drive.wheels(east * 0.1, east);
        assert_eq!((left, right), (776, 776));
        let (left, right) = drive.wheels(east * -0.1, east);
        assert_eq!((left, right), (-776, -776));
        let (left, right) = Drive::new(4.0).wheels(Vector::new(0.05, 0.05), east);
        assert!(right > left && left + right > 0, "turns left while driving on: {left} {right}");
        let (left, right) = Drive::new(4.0).wheels(east * 9.0, east);
        assert_eq!((left, right), (1100, 1100));
        assert_eq!(Drive::new(4.0_f32).wheels(Vector::ZERO, east), (0, 0));
    }

    #[test]
    fn the_reflex_points_away() {
        let north = Vector::new(0.0_f32, 1.0);
        let mut proximity = [u16::MAX; 8];
        assert_eq!(reflex(&proximity, north, 0.1), Vector::ZERO);
        proximity[2] = 0;
        let push = reflex(&proximity, north, 0.1);
        assert!((push.x + 0.1).abs() < 1e-4 && push.y.abs() < 1e-6, "right sensor of a northbound robot: {push:?}");
    }
}
