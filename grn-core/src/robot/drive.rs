//! From a velocity to wheel speeds.

use super::clock::Pace;
use super::epuck2::{AXLE, MAX_WHEEL_SPEED, METRES_PER_STEP};
use crate::geometry::Vector;
use crate::scalar::Scalar;

/// A unit vector's component from its units of 2^-14.
pub(super) fn unit<S: Scalar>(component: i16) -> S {
    S::from_ratio(i32::from(component), 1 << 14)
}

/// The heading of a percept as a vector of length 1.
pub fn heading<S: Scalar>([cos, sin]: [i16; 2]) -> Vector<S> {
    Vector::new(unit(cos), unit(sin))
}

/// Turns velocities into wheel speeds; drives backwards when that is the shorter turn.
#[derive(Clone, Debug)]
pub struct Drive<S> {
    /// Turning rate per unit of sideways error, 1/s.
    turn: S,
    backwards: bool,
}

/// Below this speed (metres per second) the body turns proportionally slower. The direction of a tiny
/// velocity is mostly noise, and a robot that follows it would turn to and fro on the spot.
const SLOW: (i32, i32) = (1, 100);

impl<S: Scalar> Drive<S> {
    /// `turn`: turning rate per unit of sideways error, 1/s.
    pub fn new(turn: S) -> Self {
        Drive { turn, backwards: false }
    }

    /// (left, right) wheel speeds in steps per second for a velocity in metres per second, turning no faster
    /// than the robot can stop at this `pace`.
    pub fn wheels(&mut self, velocity: Vector<S>, heading: Vector<S>, pace: &Pace<S>) -> (i16, i16) {
        let speed = velocity.length();
        let along = velocity.dot(heading);
        let aside = heading.cross(velocity);
        let reluctance = speed.over_power_of_two(2);
        if along > reluctance {
            self.backwards = false;
        } else if along < -reluctance {
            self.backwards = true;
        }
        let aside = if self.backwards { -aside } else { aside };
        let along = if self.backwards { along.min(S::ZERO) } else { along.max(S::ZERO) };
        let slow = S::from_ratio(SLOW.0, SLOW.1);
        let difference = pace.held(self.turn) * S::from_f64(AXLE / 2.0) * (aside / speed.max(slow));
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
    use super::super::clock::Clock;
    use super::super::percept::NOMINAL_TICK_US;
    use super::*;

    fn pace(elapsed_us: u32) -> Pace<f32> {
        Clock::default().advance(elapsed_us)
    }

    #[test]
    fn wheels_follow_the_velocity() {
        let pace = &pace(NOMINAL_TICK_US);
        let east = Vector::new(1.0_f32, 0.0);
        let mut drive = Drive::new(4.0);
        let (left, right) = drive.wheels(east * 0.1, east, pace);
        assert_eq!((left, right), (776, 776));
        let (left, right) = drive.wheels(east * -0.1, east, pace);
        assert_eq!((left, right), (-776, -776));
        let (left, right) = Drive::new(4.0).wheels(Vector::new(0.05, 0.05), east, pace);
        assert!(right > left && left + right > 0, "turns left while driving on: {left} {right}");
        let (left, right) = Drive::new(4.0).wheels(east * 9.0, east, pace);
        assert_eq!((left, right), (1100, 1100));
        assert_eq!(Drive::new(4.0_f32).wheels(Vector::ZERO, east, pace), (0, 0));
    }

    #[test]
    fn slow_control_turns_no_faster_than_it_can_stop() {
        let (east, north) = (Vector::new(1.0_f32, 0.0), Vector::new(0.0, 0.05));
        let turning = |elapsed_us: u32| {
            let (left, right) = Drive::new(5.0).wheels(north, east, &pace(elapsed_us));
            right - left
        };
        assert_eq!(turning(NOMINAL_TICK_US), turning(100_000));
        assert!((2 * turning(NOMINAL_TICK_US) - 5 * turning(250_000)).abs() <= 10);
    }
}
