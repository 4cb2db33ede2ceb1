//! The e-puck2's body: stepper wheels on a timer, and differential drive along exact arcs.

use crate::lab;
use crate::random::{Component, Stream};
use crate::timing::FRAME_S;
use grn_core::geometry::{Point, Vector};
use grn_core::robot::epuck2::{AXLE, MAX_WHEEL_SPEED, STEP_TIMER_HZ, STEPS_PER_TURN, WHEEL_DIAMETER};

/// Where a robot is and where it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Centre of the body, metres.
    pub position: Point<f64>,
    /// Heading as a unit vector (cos, sin).
    pub heading: Vector<f64>,
}

/// One robot's own measures, which differ a little between robots of a kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyParameters {
    /// Diameter of the left and of the right wheel, metres.
    pub wheel_diameters: [f64; 2],
    /// Distance between the wheels, metres.
    pub axle: f64,
    /// What each wheel turns faster than it should while it is driven, steps per second.
    pub bias: [f64; 2],
    /// Commands slower than this do not turn a wheel, steps per second.
    pub dead_zone: f64,
}

impl Default for BodyParameters {
    /// The data sheet's robot.
    fn default() -> Self {
        BodyParameters { wheel_diameters: [WHEEL_DIAMETER; 2], axle: AXLE, bias: [0.0; 2], dead_zone: 0.0 }
    }
}

impl BodyParameters {
    /// Robot number `robot` of those whose wheels are like this.
    pub fn drawn(wheels: &lab::Wheels, seed: u64, robot: usize) -> Self {
        let mut stream = Stream::new(seed, Component::Variation, robot);
        let mut factor = || 1.0 + wheels.gain * stream.symmetric();
        let (wheel_diameters, axle) = ([factor(), factor()].map(|factor| WHEEL_DIAMETER * factor), AXLE * factor());
        let bias = [(); 2].map(|()| wheels.bias * stream.symmetric());
        BodyParameters { wheel_diameters, axle, bias, dead_zone: wheels.dead_zone }
    }
}

/// The speed, steps per second, at which a wheel turns when commanded to `speed` steps per second: limited to ±1100,
/// then 50000 / ⌊50000 / |speed|⌋, because the motor timer counts whole ticks. 0 stands still.
pub fn actual_speed(speed: i16) -> f64 {
    let magnitude = u32::from(speed.unsigned_abs()).min(u32::from(MAX_WHEEL_SPEED.unsigned_abs()));
    let Some(period) = STEP_TIMER_HZ.checked_div(magnitude) else { return 0.0 };
    let actual = f64::from(STEP_TIMER_HZ) / f64::from(period);
    if speed < 0 { -actual } else { actual }
}

/// sin(h)/h and cos(h) by their Taylor polynomials, for |h| ≤ 0.2: the next terms are below 2^-53. A robot with the largest
/// wheels, the smallest axle and the most slip turns by twice 0.16 in a frame.
fn sinc_cos(h: f64) -> (f64, f64) {
    let s = h * h;
    let sinc = 1.0
        - s * (1.0 / 6.0)
            * (1.0
                - s * (1.0 / 20.0) * (1.0 - s * (1.0 / 42.0) * (1.0 - s * (1.0 / 72.0) * (1.0 - s * (1.0 / 110.0)))));
    let cos = 1.0
        - s * 0.5
            * (1.0 - s * (1.0 / 12.0) * (1.0 - s * (1.0 / 30.0) * (1.0 - s * (1.0 / 56.0) * (1.0 - s * (1.0 / 90.0)))));
    (sinc, cos)
}

/// Turns wheel commands into motion.
#[derive(Clone, Copy, Debug)]
pub struct Drive {
    /// Metres per frame at one step per second, left and right.
    roll: [f64; 2],
    per_axle: f64,
    bias: [f64; 2],
    dead_zone: f64,
}

impl Drive {
    /// The drive of a body with these measures.
    pub fn new(parameters: &BodyParameters) -> Self {
        let per_step = core::f64::consts::PI / f64::from(STEPS_PER_TURN) * FRAME_S;
        let &BodyParameters { wheel_diameters, axle, bias, dead_zone } = parameters;
        Drive { roll: wheel_diameters.map(|diameter| diameter * per_step), per_axle: 1.0 / axle, bias, dead_zone }
    }

    /// How far the wheels, commanded to these speeds in steps per second, roll in a frame (1/32 s), metres.
    pub fn rolled(&self, wheels: [i16; 2]) -> [f64; 2] {
        let [left, right] = wheels.map(|speed| (speed, f64::from(speed.unsigned_abs()) < self.dead_zone));
        let rolled = |(speed, too_slow): (i16, bool), bias: f64, roll: f64| match speed {
            0 => 0.0,
            _ if too_slow => 0.0,
            _ => (actual_speed(speed) + bias) * roll,
        };
        [rolled(left, self.bias[0], self.roll[0]), rolled(right, self.bias[1], self.roll[1])]
    }

    /// The pose after the wheels have rolled so far (metres, in at most one frame): the exact arc.
    #[must_use]
    pub fn advanced(&self, pose: Pose, [rolled_left, rolled_right]: [f64; 2]) -> Pose {
        if rolled_left == 0.0 && rolled_right == 0.0 {
            return pose;
        }
        let half_turn = (rolled_right - rolled_left) * self.per_axle / 2.0;
        // The chord of an arc of angle 2h is its length times sin(h)/h, and points along the middle heading.
        let (shortening, cos) = sinc_cos(half_turn);
        let sin = shortening * half_turn;
        let turned = |v: Vector<f64>| Vector::new(v.x * cos - v.y * sin, v.x * sin + v.y * cos);
        let middle = turned(pose.heading);
        let heading = turned(middle);
        // One Newton step keeps the heading's length at 1 against rounding.
        let correction = 1.5 - 0.5 * (heading.x * heading.x + heading.y * heading.y);
        Pose {
            position: pose.position + middle * ((rolled_left + rolled_right) / 2.0 * shortening),
            heading: heading * correction,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use grn_core::robot::epuck2::METRES_PER_STEP;

    const START: Pose = Pose { position: Vector::new(0.3, -0.2), heading: Vector::new(0.6, 0.8) };

    fn drive() -> Drive {
        varied([1.0; 3])
    }

    /// A drive whose left wheel, right wheel and axle are larger by these factors.
    fn varied([left, right, axle]: [f64; 3]) -> Drive {
        let wheel_diameters = [WHEEL_DIAMETER * left, WHEEL_DIAMETER * right];
        Drive::new(&BodyParameters { wheel_diameters, axle: AXLE * axle, ..BodyParameters::default() })
    }

    fn moved(drive: &Drive, pose: Pose, wheels: [i16; 2]) -> Pose {
        drive.advanced(pose, drive.rolled(wheels))
    }

    #[test]
    fn parts_of_a_frame_add_up() {
        let [left, right] = drive().rolled([700, -400]);
        let whole = drive().advanced(START, [left, right]);
        let half = drive().advanced(START, [left * 0.25, right * 0.25]);
        let parts = drive().advanced(half, [left * 0.75, right * 0.75]);
        assert!((whole.position - parts.position).length() < 1e-15 && (whole.heading - parts.heading).length() < 1e-14);
    }

    #[test]
    fn a_wheel_may_have_a_dead_zone_and_a_bias() {
        let odd = BodyParameters { bias: [10.0, -10.0], dead_zone: 20.0, ..BodyParameters::default() };
        let drive = Drive::new(&odd);
        assert_eq!(drive.rolled([19, -19]), [0.0, 0.0]);
        assert_eq!(drive.rolled([0, 0]), [0.0, 0.0]);
        let per_frame = METRES_PER_STEP / 32.0;
        let [left, right] = drive.rolled([1000, 1000]);
        assert!((left - 1010.0 * per_frame).abs() < 1e-15 && (right - 990.0 * per_frame).abs() < 1e-15);
    }

    #[test]
    fn robots_differ_by_their_gain() {
        let wheels = lab::Wheels { gain: 0.1, bias: 5.0, ..lab::Wheels::default() };
        let drawn = |robot| BodyParameters::drawn(&wheels, 1, robot);
        assert_eq!(drawn(1), drawn(1));
        assert_ne!(drawn(1), drawn(2));
        for body in (0..200).map(drawn) {
            assert!(body.wheel_diameters.iter().all(|d| (d / WHEEL_DIAMETER - 1.0).abs() <= 0.1));
            assert!((body.axle / AXLE - 1.0).abs() <= 0.1 && body.bias.iter().all(|b| b.abs() <= 5.0));
        }
        assert_eq!(BodyParameters::drawn(&lab::Wheels::default(), 1, 0), BodyParameters::default());
    }

    #[test]
    fn the_timer_makes_speeds_discrete() {
        for (commanded, actual) in [(0, 0.0), (1, 1.0), (3, 50_000.0 / 16_666.0), (1000, 1000.0), (999, 1000.0)] {
            assert_eq!((actual_speed(commanded), actual_speed(-commanded)), (actual, -actual), "{commanded}");
        }
        assert_eq!(actual_speed(1100), 50_000.0 / 45.0);
        assert_eq!((actual_speed(i16::MAX), actual_speed(i16::MIN)), (50_000.0 / 45.0, -50_000.0 / 45.0));
    }

    #[test]
    fn small_angles_are_exact() {
        for step in -200..=200 {
            let h = f64::from(step) * 1e-3;
            let (sinc, cos) = sinc_cos(h);
            assert!((sinc * h - libm::sin(h)).abs() < 1e-16 && (cos - libm::cos(h)).abs() < 3e-16, "{h}");
        }
        assert_eq!(sinc_cos(0.0), (1.0, 1.0));
    }

    #[test]
    fn straight_ahead_is_straight() {
        let mut pose = START;
        for _ in 0..32 {
            pose = moved(&drive(), pose, [1000, 1000]);
        }
        let expected = START.position + START.heading * (1000.0 * METRES_PER_STEP);
        assert!((pose.position - expected).length() < 1e-12);
        assert_eq!(pose.heading, START.heading);
    }

    #[test]
    fn opposite_wheels_turn_on_the_spot() {
        let pose = moved(&drive(), START, [-500, 500]);
        let angle = 2.0 * 500.0 * METRES_PER_STEP / AXLE / 32.0;
        assert!((pose.position - START.position).length() < 1e-15);
        assert!((START.heading.cross(pose.heading) - libm::sin(angle)).abs() < 1e-14);
        assert!((START.heading.dot(pose.heading) - libm::cos(angle)).abs() < 1e-14);
    }

    #[test]
    fn many_ticks_follow_the_closed_form_circle() {
        let mut pose = START;
        let ticks = 10_000;
        for _ in 0..ticks {
            pose = moved(&drive(), pose, [500, 1000]);
            assert!((pose.heading.length() - 1.0).abs() < 1e-15);
        }
        let (left, right) = (500.0 * METRES_PER_STEP, 1000.0 * METRES_PER_STEP);
        let radius = AXLE / 2.0 * (right + left) / (right - left);
        let angle = (right - left) / AXLE * f64::from(ticks) / 32.0;
        let centre = START.position + START.heading.turned_left() * radius;
        let (sin, cos) = libm::sincos(angle);
        let arm = START.position - centre;
        let expected = centre + Vector::new(arm.x * cos - arm.y * sin, arm.x * sin + arm.y * cos);
        assert!((pose.position - expected).length() < 1e-9, "{:?} {expected:?}", pose.position);
    }

    #[test]
    fn a_larger_wheel_pulls_to_the_other_side() {
        let odd = moved(&varied([1.0, 1.02, 1.0]), START, [800, 800]);
        let angle = libm::asin(START.heading.cross(odd.heading));
        assert!((angle - 0.02 * 50_000.0 / 62.0 * METRES_PER_STEP / AXLE / 32.0).abs() < 1e-12);
        let wide = moved(&varied([1.0, 1.0, 2.0]), START, [-500, 500]);
        let normal = moved(&drive(), START, [-500, 500]);
        assert!(START.heading.cross(wide.heading) < 0.6 * START.heading.cross(normal.heading));
    }
}
