//! What a robot perceives: localisation, the proximity ring, and the mother robots' far sense.

use crate::body::Pose;
use crate::geometry::{Edge, length_squared};
use crate::random::Stream;
use grn_core::geometry::{Point, Vector};
use grn_core::robot::epuck2::{BODY_RADIUS, PROXIMITY_BEARINGS_DEG, PROXIMITY_RANGE, PROXIMITY_SENSORS};
use grn_core::robot::percept::{MAX_SEEN_OBSTACLES, MAX_TARGETS};
use grn_core::robot::{Fix, Millimetres, Sighting};
use heapless::Vec;
use serde::{Deserialize, Serialize};

/// Sensor noise: the half-widths of triangular distributions around the truth (the standard deviation is 1/√6 of the
/// half-width); 0 switches a noise off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Noise {
    /// Own position, each coordinate, metres.
    pub position_m: f64,
    /// Own heading, degrees, below 45.
    pub heading_deg: f64,
    /// Each proximity sensor that senses something, metres.
    pub proximity_m: f64,
    /// Targets and wall points seen by mother robots, each coordinate, metres.
    pub sighting_m: f64,
}

impl Default for Noise {
    /// A good tracking system and calibrated sensors: 2 mm, 1°, 2 mm, 5 mm.
    fn default() -> Self {
        Noise { position_m: 0.002, heading_deg: 1.0, proximity_m: 0.002, sighting_m: 0.005 }
    }
}

impl Noise {
    /// Perfect sensors.
    pub const NONE: Noise = Noise { position_m: 0.0, heading_deg: 0.0, proximity_m: 0.0, sighting_m: 0.0 };
}

/// Free distances in front of the eight sensors, from the body's edge, metres; infinite when nothing is met.
pub type FreeDistances = [f64; PROXIMITY_SENSORS];

/// Nothing is met.
pub const ALL_FREE: FreeDistances = [f64::INFINITY; PROXIMITY_SENSORS];

/// From farther than this between centre and wall no sensor can reach the wall, metres.
pub const WALL_REACH: f64 = BODY_RADIUS + PROXIMITY_RANGE;
/// From farther than this between centres no sensor can reach the other robot, metres.
pub const ROBOT_REACH: f64 = 2.0 * BODY_RADIUS + PROXIMITY_RANGE;

/// The ring of eight proximity sensors: each looks radially outwards, along its bearing, from the body's edge.
#[derive(Debug)]
pub struct ProximityRing {
    cos: [f64; PROXIMITY_SENSORS],
    sin: [f64; PROXIMITY_SENSORS],
}

impl Default for ProximityRing {
    fn default() -> Self {
        let bearings = PROXIMITY_BEARINGS_DEG.map(|bearing| libm::sincos(f64::from(bearing).to_radians()));
        ProximityRing { cos: bearings.map(|(_, cos)| cos), sin: bearings.map(|(sin, _)| sin) }
    }
}

/// `point` as seen from the pose: x ahead, y to the left.
fn in_body_frame(pose: &Pose, point: Point<f64>) -> Vector<f64> {
    let offset = point - pose.position;
    Vector::new(pose.heading.dot(offset), pose.heading.cross(offset))
}

impl ProximityRing {
    /// Shortens free distances by another robot whose centre is at `other`.
    #[inline]
    pub fn sense_robot(&self, pose: &Pose, other: Point<f64>, free: &mut FreeDistances) {
        let offset = in_body_frame(pose, other);
        for ((free, &cos), &sin) in free.iter_mut().zip(&self.cos).zip(&self.sin) {
            let along = offset.x * cos + offset.y * sin;
            let aside = offset.x * sin - offset.y * cos;
            let room = BODY_RADIUS * BODY_RADIUS - aside * aside;
            let distance = along - (if room > 0.0 { room } else { 0.0 }).sqrt() - BODY_RADIUS;
            // Without short circuits the eight sensors are computed side by side.
            let met = (along > 0.0) & (room >= 0.0) & (distance < *free);
            *free = if met { distance } else { *free };
        }
    }

    /// Shortens free distances by a wall's edge.
    #[inline]
    pub fn sense_edge(&self, pose: &Pose, edge: &Edge, free: &mut FreeDistances) {
        let start = in_body_frame(pose, edge.start());
        let along = in_body_frame(pose, edge.end()) - start;
        let crossed = start.cross(along);
        for ((free, &cos), &sin) in free.iter_mut().zip(&self.cos).zip(&self.sin) {
            // A ray parallel to the edge divides by 0 and meets nothing, because no comparison with NaN holds and an
            // infinite distance is not shorter.
            let per_denominator = 1.0 / (cos * along.y - sin * along.x);
            let distance = crossed * per_denominator - BODY_RADIUS;
            let share = (start.x * sin - start.y * cos) * per_denominator;
            let met = (distance >= -BODY_RADIUS) & (share * (1.0 - share) >= 0.0) & (distance < *free);
            *free = if met { distance } else { *free };
        }
    }

    /// Free distances as the percept has them, in 0.1 mm, with noise of this half-width (metres).
    pub fn quantised(free: &FreeDistances, half_width: f64, noise: &mut Stream) -> [u16; PROXIMITY_SENSORS] {
        free.map(|distance| {
            if distance > PROXIMITY_RANGE {
                return u16::MAX;
            }
            let sensed = if half_width > 0.0 { distance + half_width * noise.triangular() } else { distance };
            if sensed > PROXIMITY_RANGE { u16::MAX } else { (sensed.max(0.0) * 1e4 + 0.5) as u16 }
        })
    }
}

/// The nearest whole number, halves up, for values that fit; ⌊value + 1/2⌋ without a call to `floor`.
fn rounded(value: f64) -> i32 {
    let above = value + 0.5;
    let whole = above as i32;
    whole - i32::from(f64::from(whole) > above)
}

/// A coordinate in metres as the nearest micrometre.
pub(crate) fn micrometres(metres: f64) -> i32 {
    rounded(metres * 1e6)
}

/// A component of a unit vector in units of 2^-14, as the nearest whole number.
pub(crate) fn unit_q14(component: f64) -> i16 {
    rounded(component * 16384.0) as i16
}

fn millimetres(point: Point<f64>, half_width: f64, noise: &mut Stream) -> Millimetres {
    let mut perceived = |metres: f64| {
        let error = if half_width > 0.0 { half_width * noise.triangular() } else { 0.0 };
        rounded((metres + error) * 1e3) as i16
    };
    Millimetres { x: perceived(point.x), y: perceived(point.y) }
}

/// Own position and heading as localisation gives them, in the percept's units.
pub fn localise(pose: &Pose, noise: &Noise, stream: &mut Stream) -> Fix {
    let Pose { mut position, mut heading } = *pose;
    if noise.position_m > 0.0 {
        position = position + Vector::new(stream.triangular(), stream.triangular()) * noise.position_m;
    }
    if noise.heading_deg > 0.0 {
        // Turn by a small angle e: (1, e) made a unit vector turns by atan(e), near enough to e for a noise.
        let e = noise.heading_deg.to_radians() * stream.triangular();
        let shrink = 1.0 / (1.0 + e * e).sqrt();
        heading = (heading + heading.turned_left() * e) * shrink;
    }
    let position = [micrometres(position.x), micrometres(position.y)];
    Fix { position, heading: [unit_q14(heading.x), unit_q14(heading.y)], age_ms: 0 }
}

/// What a robot sees with its own far sense in one tick.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Seen {
    /// Targets.
    pub targets: Vec<Sighting, MAX_TARGETS>,
    /// Points on walls.
    pub obstacles: Vec<Millimetres, MAX_SEEN_OBSTACLES>,
}

/// A mother robot's far sense: targets and samples of the walls' outlines within range, through walls. Wall points come
/// a few per tick: all those in range, nearest first, and then again from the nearest.
#[derive(Debug, Default)]
pub struct FarSense {
    queue: std::vec::Vec<(f64, u32)>,
    next: usize,
}

impl FarSense {
    /// A far sense with room for this many wall samples.
    pub fn new(samples: usize) -> Self {
        FarSense { queue: std::vec::Vec::with_capacity(samples), next: 0 }
    }

    /// What is seen from `position` within `range` metres.
    pub fn look(
        &mut self,
        position: Point<f64>,
        range: f64,
        targets: &[Point<f64>],
        samples: &[Point<f64>],
        noise: &Noise,
        stream: &mut Stream,
    ) -> Seen {
        let mut look = Seen::default();
        let limit = range * range;
        for (number, &target) in (0u8..).zip(targets) {
            if length_squared(target - position) <= limit {
                let seen = Sighting { target: number, position: millimetres(target, noise.sighting_m, stream) };
                // A scenario has no more targets than a percept has room for.
                let _ = look.targets.push(seen);
            }
        }
        if self.next >= self.queue.len() {
            self.next = 0;
            self.queue.clear();
            let near = (0u32..).zip(samples).map(|(index, &sample)| (length_squared(sample - position), index));
            self.queue.extend(near.filter(|&(squared, _)| squared <= limit));
            self.queue.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        }
        while let Some(&(_, index)) = self.queue.get(self.next)
            && !look.obstacles.is_full()
        {
            let _ = look.obstacles.push(millimetres(samples[index as usize], noise.sighting_m, stream));
            self.next += 1;
        }
        look
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Component;
    use std::vec::Vec;

    const POSE: Pose = Pose { position: Vector::new(1.0, 2.0), heading: Vector::new(0.0, 1.0) };

    fn stream() -> Stream {
        Stream::new(1, Component::Sensors, 0)
    }

    /// A point at `distance` from the pose, `bearing` degrees left of its heading.
    fn at(bearing: f64, distance: f64) -> Point<f64> {
        let (sin, cos) = libm::sincos(bearing.to_radians());
        POSE.position + (POSE.heading * cos + POSE.heading.turned_left() * sin) * distance
    }

    #[test]
    fn a_robot_straight_before_a_sensor_is_met_at_its_edge() {
        let ring = ProximityRing::default();
        for (sensor, bearing) in PROXIMITY_BEARINGS_DEG.into_iter().enumerate() {
            let mut free = ALL_FREE;
            ring.sense_robot(&POSE, at(f64::from(bearing), 0.1), &mut free);
            assert!((free[sensor] - 0.03).abs() < 1e-12, "{bearing}: {free:?}");
            assert!(free.iter().enumerate().all(|(other, &f)| other == sensor || f > 0.03), "{bearing}: {free:?}");
        }
    }

    #[test]
    fn a_robot_off_the_axis_is_met_on_its_flank_or_missed() {
        let ring = ProximityRing::default();
        // Straight ahead at 90 mm: both front sensors, 17° off the centre line.
        let mut free = ALL_FREE;
        ring.sense_robot(&POSE, at(0.0, 0.09), &mut free);
        let (sin, cos) = libm::sincos(17f64.to_radians());
        let expected = 0.09 * cos - (0.035f64 * 0.035 - 0.09 * 0.09 * sin * sin).sqrt() - 0.035;
        assert!((free[0] - expected).abs() < 1e-12 && (free[7] - expected).abs() < 1e-12);
        assert!(free[1..7].iter().all(|f| f.is_infinite()));
        // Overlapping robots give no negative reading.
        let mut free = ALL_FREE;
        ring.sense_robot(&POSE, at(90.0, 0.06), &mut free);
        assert_eq!(ProximityRing::quantised(&free, 0.0, &mut stream())[5], 0);
    }

    #[test]
    fn walls_are_met_at_the_ray_s_distance() {
        let ring = ProximityRing::default();
        // A wall across the heading, its line 60 mm ahead.
        let edge = Edge::new(at(0.0, 0.06) + Vector::new(-1.0, 0.0), at(0.0, 0.06) + Vector::new(1.0, 0.0));
        let mut free = ALL_FREE;
        ring.sense_edge(&POSE, &edge, &mut free);
        let expected = |bearing: f64| 0.06 / libm::cos(bearing.to_radians()) - 0.035;
        assert!((free[0] - expected(17.0)).abs() < 1e-12 && (free[1] - expected(50.0)).abs() < 1e-12);
        // The sensors at 90° look along the wall, those at 150° away from it.
        assert!(free[2] > 1.0 && free[3].is_infinite() && free[4].is_infinite() && free[5] > 1.0);
        // The same from the edge's other direction, and a short edge beside the rays is missed.
        let mut reversed = ALL_FREE;
        ring.sense_edge(&POSE, &Edge::new(edge.end(), edge.start()), &mut reversed);
        assert!((reversed[0] - free[0]).abs() < 1e-15 && (reversed[6] - free[6]).abs() < 1e-15);
        let mut missed = ALL_FREE;
        ring.sense_edge(&POSE, &Edge::new(at(-10.0, 0.06), at(10.0, 0.06)), &mut missed);
        assert_eq!(missed, ALL_FREE);
    }

    #[test]
    fn readings_are_tenths_of_millimetres_up_to_five_centimetres() {
        let mut free = ALL_FREE;
        (free[0], free[1], free[2]) = (0.0123, 0.05, 0.0501);
        let read = ProximityRing::quantised(&free, 0.0, &mut stream());
        assert_eq!(read, [123, 500, u16::MAX, u16::MAX, u16::MAX, u16::MAX, u16::MAX, u16::MAX]);
        free[0] = 0.02;
        let mut noise = stream();
        let noisy: Vec<u16> = (0..1000).map(|_| ProximityRing::quantised(&free, 0.002, &mut noise)[0]).collect();
        assert!(noisy.iter().all(|r| (180..=220).contains(r)));
        assert!(noisy.iter().any(|&r| r < 190) && noisy.iter().any(|&r| r > 210));
    }

    #[test]
    fn localisation_is_exact_without_noise_and_near_with_it() {
        let exact = Fix { position: [1_000_000, 2_000_000], heading: [0, 16384], age_ms: 0 };
        assert_eq!(localise(&POSE, &Noise::NONE, &mut stream()), exact);
        let mut noise = stream();
        for _ in 0..1000 {
            let Fix { position, heading, age_ms } = localise(&POSE, &Noise::default(), &mut noise);
            assert_eq!(age_ms, 0);
            assert!((position[0] - 1_000_000).abs() <= 2000 && heading[0].abs() <= 286);
            let [x, y] = heading.map(f64::from);
            assert!((libm::hypot(x, y) - 16384.0).abs() < 1.5);
        }
    }

    #[test]
    fn mothers_see_targets_in_range_and_every_wall_point_in_turn() {
        let targets = [Vector::new(3.0, 2.0), Vector::new(9.0, 2.0)];
        let samples: Vec<Point<f64>> = (0..40).map(|i| Vector::new(1.0 + f64::from(i) * 0.25, 3.0)).collect();
        let mut sense = FarSense::new(samples.len());
        let mut seen = Vec::new();
        for tick in 0..6 {
            let look = sense.look(POSE.position, 5.0, &targets, &samples, &Noise::NONE, &mut stream());
            assert_eq!(look.targets.as_slice(), [Sighting { target: 0, position: Millimetres { x: 3000, y: 2000 } }]);
            assert_eq!(look.obstacles.len(), if tick % 3 == 2 { 4 } else { MAX_SEEN_OBSTACLES });
            assert!(look.obstacles.iter().all(|point| point.y == 3000));
            seen.extend(look.obstacles.iter().map(|point| point.x));
        }
        // √24 m to the side: 20 of the samples are in range, each seen once a round.
        let round: Vec<i16> = (0..20).map(|i| 1000 + i * 250).collect();
        assert_eq!((&seen[..20], &seen[20..]), (&round[..], &round[..]));
    }
}
