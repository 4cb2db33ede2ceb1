//! Keeping away from what the proximity sensors feel, and going around it where no map knows it.
//!
//! The motion law keeps away from live neighbours and from walls, because robots tell each other where these are. It knows
//! nothing of a robot that broke down or of a box that somebody left there. How a velocity is made safe:
//!
//! 1. Each proximity sensor that feels something near pushes the robot away from it; the pushes are added up.
//! 2. If the wanted velocity does not lead against the push, or a neighbour or wall that the robot knows can be what pushes,
//!    the push is added to the wanted velocity, and that is all.
//! 3. Otherwise push and wanted velocity could cancel out, and the robot would stand there for good. So it picks a side, drops
//!    the part of the wanted velocity that leads to the other side, and adds the push turned a quarter turn to its side, too.
//!    The robot slides past the obstacle.
//! 4. Whatever came of this, the robot approaches the nearest thing that pushes no faster than twice the free distance a second,
//!    less a margin, and backs away from what is within the margin. Pushes alone do not stop a robot that believes its place
//!    on the pattern to be where another one is, as happens when positions are off.

use super::drive::unit;
use super::epuck2::{PROXIMITY_SENSORS, TICKS_PER_SECOND};
use super::knowledge::Knowledge;
use crate::geometry::{Point, Vector};
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

/// Free distance, in 0.1 mm, below which something pushes. Less than the 5 cm that sensors reach: robots side by side on a
/// crowded ring would push each other off it, because eight rays do not feel the same on both sides.
const PUSH_RANGE: i32 = 300;
/// The same for a robot that hears nobody: all that sensors reach. Then nothing else spreads robots along the pattern.
const LONELY_PUSH_RANGE: i32 = 500;

/// Free distance, in 0.1 mm, that the robot keeps from what is nearest.
const MARGIN: i32 = 100;

/// A robot keeps to one side of an obstacle until nothing has been in its way for this many ticks, 1 s. If it chose anew in
/// every tick, it would go to and fro between two obstacles that stand side by side. It changes sides before that only if
/// the wanted velocity leads past the obstacle on the other side, more than 63° (tan⁻¹ 2) from straight at it.
const KEEP_SIDE_TICKS: u8 = TICKS_PER_SECOND as u8;

/// On which side the robot goes around something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Left,
    Right,
}

impl Side {
    fn other(self) -> Side {
        match self {
            Side::Left => Side::Right,
            Side::Right => Side::Left,
        }
    }
}

/// The state of avoidance.
#[derive(Clone, Debug)]
pub struct Avoidance<S> {
    /// The push of one sensor that touches something, m/s.
    strength: S,
    side: Side,
    /// Ticks until the side may be chosen anew.
    kept: u8,
}

impl<S: Scalar> Avoidance<S> {
    /// Pushes up to `cruise`, metres per second, for each sensor: as fast as the robot may want to drive.
    pub fn new(cruise: S) -> Self {
        Avoidance { strength: cruise, side: Side::Left, kept: 0 }
    }

    /// The velocity to drive at, metres per second, for one that is `wanted`, `ticks` of 1/32 s after the last time. On the `map`,
    /// where the robot is and what it knows, things that it knows of are not gone around: the pattern keeps it away from them. The
    /// way home, which leads straight on, has none.
    pub fn velocity(
        &mut self,
        wanted: Vector<S>,
        proximity: &[u16; PROXIMITY_SENSORS],
        heading: Vector<S>,
        map: Option<(Point<S>, &Knowledge<S>)>,
        ticks: u32,
    ) -> Vector<S> {
        let lonely = map.is_none_or(|(_, knowledge)| knowledge.neighbours().known().is_empty());
        let range = if lonely { LONELY_PUSH_RANGE } else { PUSH_RANGE };
        let Some((push, nearest)) = self.push(proximity, heading, range) else {
            self.kept = u32::from(self.kept).saturating_sub(ticks) as u8;
            return wanted;
        };
        let against = push.dot(wanted);
        let is_known = || map.is_some_and(|(here, knowledge)| knowledge.knows_what_pushes(here, push));
        let velocity = if against >= S::ZERO || is_known() {
            self.kept = u32::from(self.kept).saturating_sub(ticks) as u8;
            wanted + push
        } else {
            self.around(wanted, push, against)
        };
        nearest.held_off(velocity)
    }

    /// The velocity around what pushes; `against` = push · wanted, negative.
    fn around(&mut self, wanted: Vector<S>, push: Vector<S>, against: S) -> Vector<S> {
        // How much of the wanted velocity leads to the left: the robot looks against the push.
        let to_left = wanted.cross(push);
        let opposed = match self.side {
            Side::Left => -to_left,
            Side::Right => to_left,
        };
        if opposed > -against - against || (self.kept == 0 && opposed > S::ZERO) {
            self.side = self.side.other();
        }
        self.kept = KEEP_SIDE_TICKS;
        let aside = match self.side {
            Side::Left => -push.turned_left(),
            Side::Right => push.turned_left(),
        };
        // What leads to the other side is left out: it would hold the robot back.
        let along = wanted.dot(aside);
        let held_back = if along < S::ZERO { aside * (along / aside.dot(aside)) } else { Vector::ZERO };
        wanted - held_back + push + aside
    }

    /// A velocity away from what the proximity sensors feel, and what of it is the nearest; `None` if nothing is within `range`.
    ///
    /// A sensor with free distance r in front of it, r below R = `range`, 0.1 mm, pushes with (1 - r/R)².
    fn push(
        &self,
        proximity: &[u16; PROXIMITY_SENSORS],
        heading: Vector<S>,
        range: i32,
    ) -> Option<(Vector<S>, Felt<S>)> {
        let felt = proximity.iter().zip(SENSOR_DIRECTIONS).filter(|(distance, _)| i32::from(**distance) < range);
        // Not divided by the range in a variable: integers of 64 bits would be divided.
        let per_range = if range == PUSH_RANGE {
            S::from_ratio(10_000, PUSH_RANGE)
        } else {
            S::from_ratio(10_000, LONELY_PUSH_RANGE)
        };
        let (mut push, mut nearest) = (Vector::ZERO, None);
        for (&distance, (cos, sin)) in felt {
            let distance = i32::from(distance);
            let closeness = tenth_millimetres::<S>(range - distance) * per_range;
            let direction = heading * unit::<S>(cos) + heading.turned_left() * unit::<S>(sin);
            push = push - direction * (self.strength * closeness * closeness);
            nearest = match nearest {
                Some(Felt { distance: nearer, .. }) if nearer <= distance => nearest,
                _ => Some(Felt { direction, distance }),
            };
        }
        nearest.map(|nearest| (push, nearest))
    }
}

/// What a proximity sensor feels.
struct Felt<S> {
    /// Where, of length 1.
    direction: Vector<S>,
    /// Free distance, 0.1 mm.
    distance: i32,
}

impl<S: Scalar> Felt<S> {
    /// The velocity without what of it approaches this too fast: 2/s · (r - margin) at the free distance r.
    fn held_off(&self, velocity: Vector<S>) -> Vector<S> {
        let approach = velocity.dot(self.direction);
        let most = tenth_millimetres(2 * (self.distance - MARGIN));
        if approach > most { velocity - self.direction * (approach - most) } else { velocity }
    }
}

/// A length in 0.1 mm, or a speed in 0.1 mm/s, in metres.
fn tenth_millimetres<S: Scalar>(number: i32) -> S {
    S::from_millionths(number * 100)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::epuck2::PROXIMITY_BEARINGS_DEG;

    const FREE: [u16; 8] = [u16::MAX; 8];
    const NORTH: Vector<f32> = Vector::new(0.0, 1.0);

    #[test]
    fn sensor_directions_are_those_of_the_bearings() {
        for (bearing, (cos, sin)) in PROXIMITY_BEARINGS_DEG.into_iter().zip(SENSOR_DIRECTIONS) {
            let (s, c) = libm::sincos(f64::from(bearing).to_radians());
            assert_eq!((libm::round(c * 16384.0) as i16, libm::round(s * 16384.0) as i16), (cos, sin));
        }
    }

    #[test]
    fn the_push_points_away() {
        let avoidance = Avoidance::new(0.1);
        assert!(avoidance.push(&FREE, NORTH, PUSH_RANGE).is_none());
        let right = [u16::MAX, u16::MAX, 0, u16::MAX, u16::MAX, u16::MAX, u16::MAX, u16::MAX];
        let (push, nearest) = avoidance.push(&right, NORTH, PUSH_RANGE).unwrap();
        assert!(nearest.distance == 0 && (nearest.direction.x - 1.0).abs() < 1e-4, "{:?}", nearest.direction);
        assert!((push.x + 0.1).abs() < 1e-4 && push.y.abs() < 1e-6, "right sensor of a northbound robot: {push:?}");
    }

    /// The velocity of a northbound robot that wants this velocity and feels this in front, left and right.
    fn velocity(avoidance: &mut Avoidance<f32>, wanted: Vector<f32>, [left, right]: [u16; 2]) -> Vector<f32> {
        let mut proximity = FREE;
        (proximity[7], proximity[0]) = (left, right);
        avoidance.velocity(wanted, &proximity, NORTH, Some((Vector::ZERO, &Knowledge::new())), 1)
    }

    #[test]
    fn one_side_is_kept_around_what_no_map_knows() {
        let mut avoidance = Avoidance::new(0.1);
        let east = velocity(&mut avoidance, Vector::new(0.01, 0.1), [100, 100]);
        assert!(east.x > 0.05, "{east:?}");
        // A little to the other side now, but it stays on its way.
        for _ in 0..100 {
            let east = velocity(&mut avoidance, Vector::new(-0.01, 0.1), [100, 100]);
            assert!(east.x > 0.05, "{east:?}");
        }
        // After a second with nothing in the way it may choose anew.
        for _ in 0..31 {
            velocity(&mut avoidance, NORTH * 0.1, [u16::MAX; 2]);
        }
        assert!(velocity(&mut avoidance.clone(), Vector::new(-0.01, 0.1), [100, 100]).x > 0.05);
        velocity(&mut avoidance, NORTH * 0.1, [u16::MAX; 2]);
        assert!(velocity(&mut avoidance, Vector::new(-0.01, 0.1), [100, 100]).x < -0.05);
    }

    #[test]
    fn what_is_felt_is_approached_slowly_and_not_touched() {
        for (distance, approach) in [(299, 0.0398), (200, 0.02), (100, 0.0), (0, -0.02)] {
            let thing = Felt { direction: NORTH, distance };
            let held = thing.held_off(Vector::new(0.03, 0.12));
            assert!((held.y - approach).abs() < 1e-6 && held.x == 0.03, "{distance}: {held:?}");
            // Who drives away faster than that already may do so.
            let away = Vector::new(0.01, -0.05);
            assert_eq!(thing.held_off(away), away);
        }
    }

    #[test]
    fn what_is_behind_only_pushes() {
        let south = velocity(&mut Avoidance::new(0.1), NORTH * -0.1, [100, 100]);
        assert!(south.x.abs() < 1e-4 && south.y < -0.15, "{south:?}");
    }
}
