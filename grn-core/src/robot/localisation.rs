//! Where the robot is: predicted from its own wheels in every tick, and corrected by each fix of the localisation system.
//!
//! Fixes are rare, late and noisy: a camera on the ceiling gives some ten a second, each a quarter of a second old, and now
//! and then takes the robot for another. So:
//!
//! 1. In every tick the pose is moved by what the wheels were told in the tick before, along the arc.
//! 2. A fix that was measured a time ago is carried forward by what was driven since, and then corrects a part of the
//!    difference: noise is damped, and a wheel that is a few per cent too large leads nowhere.
//! 3. A fix far away from the prediction is ignored, unless such fixes go on for a third of a second: then the robot was
//!    carried away, and the fix is taken whole. So are the first one and one after a time without.
//! 4. Half a second without a fix that counts, and the robot does not know where it is.

use super::drive::heading;
use super::epuck2::{AXLE, METRES_PER_STEP, STEP_TIMER_HZ};
use super::percept::{Fix, NOMINAL_TICK_US, Percept};
use crate::geometry::{Point, Vector};
use crate::scalar::Scalar;

/// How much of the difference between fix and prediction is corrected: 2^-2.
const CORRECTION_EXPONENT: u8 = 2;
/// A fix this far from the prediction in x or y, 15 cm, is not believed at once.
const FAR_UM: i32 = 150_000;
/// For so long fixes far from the prediction are not believed.
const DOUBT_US: u32 = 333_000;
/// After this time without a fix that counts the pose is not known.
const STALE_US: u32 = 500_000;
/// A stretch of the way is at least this long: one and a half ticks of 1/32 s.
const LEG_US: u32 = NOMINAL_TICK_US * 3 / 2;
/// How many of them are kept, to carry fixes forward: 0.6 s at least.
const LEGS: usize = 13;

/// Where the robot is and where it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<S> {
    /// Metres.
    pub position: Point<S>,
    /// Of length 1.
    pub heading: Vector<S>,
}

/// A stretch of the way: what the wheels did in at least [`LEG_US`].
#[derive(Clone, Copy, Debug)]
struct Leg<S> {
    moved: Vector<S>,
    /// Radians, left positive.
    turned: S,
    elapsed_us: u32,
}

impl<S: Scalar> Leg<S> {
    const REST: Self = Leg { moved: Vector::ZERO, turned: S::ZERO, elapsed_us: LEG_US };
}

/// The state of localisation.
#[derive(Clone, Debug)]
pub struct Localisation<S> {
    pose: Option<Pose<S>>,
    /// What the wheels were told in the last tick, steps per second.
    wheels: [i16; 2],
    /// A ring of stretches; that at `newest` is the last one.
    legs: [Leg<S>; LEGS],
    newest: usize,
    /// Time since the last fix that counts.
    unfixed_us: u32,
    /// Time since fixes are far from the prediction; 0 if the last one was not.
    doubted_us: u32,
}

impl<S: Scalar> Default for Localisation<S> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: Scalar> Localisation<S> {
    /// Of a robot at rest somewhere.
    pub fn new() -> Self {
        Localisation { pose: None, wheels: [0; 2], legs: [Leg::REST; LEGS], newest: 0, unfixed_us: 0, doubted_us: 0 }
    }

    /// Remembers what the wheels are told until the next tick, steps per second.
    pub fn drive(&mut self, left: i16, right: i16) {
        self.wheels = [left, right];
    }

    /// The pose in this tick; `None` if it is not known.
    pub fn update(&mut self, percept: &Percept) -> Option<Pose<S>> {
        self.predict(percept.elapsed_us);
        if let Some(fix) = &percept.fix
            && let Some(measured) = self.carried_forward(fix)
        {
            self.correct(measured);
        } else if self.unfixed_us >= STALE_US {
            self.pose = None;
        }
        self.pose
    }

    /// Moves on along the arc that the wheels describe.
    fn predict(&mut self, elapsed_us: u32) {
        self.unfixed_us = self.unfixed_us.saturating_add(elapsed_us);
        if self.doubted_us > 0 {
            self.doubted_us = self.doubted_us.saturating_add(elapsed_us);
        }
        let [left, right] = self.wheels.map(|steps| speed(steps) * elapsed_us as i32);
        let path = scaled::<S>(left + right, METRES_PER_STEP / 2.0);
        let turned = scaled::<S>(right - left, METRES_PER_STEP / AXLE);
        let mut moved = Vector::ZERO;
        if let Some(pose) = &mut self.pose {
            let before = pose.heading;
            pose.heading = Rotation::by_less_than_a_radian(turned).of(before);
            // The chord leads halfway between both headings; it is up to 1 % longer than this, at 0.1 s.
            moved = (before + pose.heading) * path.over_power_of_two(1);
            pose.position = pose.position + moved;
        }
        self.remember(Leg { moved, turned, elapsed_us });
    }

    /// Short ticks share a stretch, so that few of them reach far back.
    fn remember(&mut self, leg: Leg<S>) {
        if let Some(newest) = self.legs.get_mut(self.newest)
            && newest.elapsed_us < LEG_US
        {
            newest.moved = newest.moved + leg.moved;
            newest.turned = newest.turned + leg.turned;
            newest.elapsed_us += leg.elapsed_us;
            return;
        }
        self.newest = if self.newest + 1 < LEGS { self.newest + 1 } else { 0 };
        if let Some(oldest) = self.legs.get_mut(self.newest) {
            *oldest = leg;
        }
    }

    /// Where the robot is now if the fix was right; `None` if it is older than the way that is remembered.
    fn carried_forward(&self, fix: &Fix) -> Option<Pose<S>> {
        let [east, north] = fix.position.map(S::from_millionths);
        let measured = Pose { position: Vector::new(east, north), heading: heading(fix.heading) };
        if fix.age_ms == 0 {
            return Some(measured);
        }
        let (mut moved, mut turned) = (Vector::ZERO, S::ZERO);
        let mut age_us = u32::from(fix.age_ms) * 1000;
        let (newer, older) = self.legs.split_at_checked(self.newest + 1)?;
        for leg in newer.iter().rev().chain(older.iter().rev()) {
            if leg.elapsed_us > age_us {
                let share = S::from_ratio(age_us as i32, leg.elapsed_us as i32);
                moved = moved + leg.moved * share;
                turned = turned + leg.turned * share;
                age_us = 0;
                break;
            }
            moved = moved + leg.moved;
            turned = turned + leg.turned;
            age_us -= leg.elapsed_us;
        }
        let carried =
            || Pose { position: measured.position + moved, heading: Rotation::by(turned).of(measured.heading) };
        (age_us == 0).then(carried)
    }

    fn correct(&mut self, measured: Pose<S>) {
        match &mut self.pose {
            Some(pose) if pose.is_near(&measured) => {
                pose.position = pose.position + part(measured.position - pose.position);
                pose.heading = unit(pose.heading + part(measured.heading - pose.heading));
            }
            Some(_) if self.doubted_us < DOUBT_US => {
                self.doubted_us = self.doubted_us.max(1);
                if self.unfixed_us >= STALE_US {
                    self.pose = None;
                }
                return;
            }
            _ => self.pose = Some(Pose { heading: unit(measured.heading), ..measured }),
        }
        (self.unfixed_us, self.doubted_us) = (0, 0);
    }
}

impl<S: Scalar> Pose<S> {
    /// Both coordinates within [`FAR_UM`], and both components of the heading within 3/4: at most 45° to 64°, as they lie.
    fn is_near(&self, other: &Self) -> bool {
        let within = |error: Vector<S>, limit: S| error.x.abs() < limit && error.y.abs() < limit;
        within(other.position - self.position, S::from_millionths(FAR_UM))
            && within(other.heading - self.heading, S::from_ratio(3, 4))
    }
}

/// What is corrected of a difference.
fn part<S: Scalar>(Vector { x, y }: Vector<S>) -> Vector<S> {
    Vector::new(x.over_power_of_two(CORRECTION_EXPONENT), y.over_power_of_two(CORRECTION_EXPONENT))
}

/// A vector of about length 1 made more so: a Newton step of 1 / √(x² + y²).
fn unit<S: Scalar>(vector: Vector<S>) -> Vector<S> {
    let three_halves = S::from_ratio(3, 2);
    vector * (three_halves - vector.dot(vector).over_power_of_two(1))
}

/// The speed a wheel really turns at, steps per second: its timer counts whole units.
fn speed(steps: i16) -> i32 {
    const TIMER: i32 = STEP_TIMER_HZ as i32;
    // Both divisions truncate, so that forward and backward are alike.
    TIMER.checked_div(i32::from(steps)).and_then(|units| TIMER.checked_div(units)).unwrap_or_default()
}

/// `number` millionths times `factor`, in two multiplications of integers.
fn scaled<S: Scalar>(number: i32, factor: f64) -> S {
    let factor = (factor * 4_294_967_296.0) as i64;
    S::from_millionths(((i64::from(number) * factor + (1 << 31)) >> 32) as i32)
}

/// A rotation as (cos, sin).
struct Rotation<S>(S, S);

impl<S: Scalar> Rotation<S> {
    /// By two terms of each series. The direction is off by 2e-3 at half a radian, the most that a tick of 0.1 s brings, and
    /// by 5e-6 at the most that 1/32 s brings.
    fn by_less_than_a_radian(angle: S) -> Self {
        let half = (angle * angle).over_power_of_two(1);
        Rotation(S::ONE - half, angle - angle * half * S::from_ratio(1, 3))
    }

    /// By any angle that a robot turns in a second: an eighth of it, doubled three times.
    fn by(angle: S) -> Self {
        Self::by_less_than_a_radian(angle.over_power_of_two(3)).doubled().doubled().doubled()
    }

    fn doubled(self) -> Self {
        let Rotation(cos, sin) = self;
        let product = cos * sin;
        Rotation(cos * cos - sin * sin, product + product)
    }

    fn of(self, vector: Vector<S>) -> Vector<S> {
        let Rotation(cos, sin) = self;
        vector * cos + vector.turned_left() * sin
    }
}

#[cfg(test)]
mod tests;
