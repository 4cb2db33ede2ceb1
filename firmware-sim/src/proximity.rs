//! The ring of eight proximity sensors: what is in front of each, and what the sensor makes of it.
//!
//! A sensor looks radially outwards, along its bearing, from the body's edge. An infrared sensor returns a signal that falls with the
//! distance; the robot turns it back into a distance by the sensor's nominal curve. So an error of the signal, or a gain that is not
//! nominal, becomes an error of the distance that is larger where the curve is flat, far away.

use crate::body::Pose;
use crate::geometry::Edge;
use crate::lab::{self, Response};
use crate::random::{Component, Stream};
use grn_core::geometry::{Point, Vector};
use grn_core::robot::epuck2::{BODY_RADIUS, PROXIMITY_RANGE, PROXIMITY_SENSORS};

/// Free distances in front of the eight sensors, from the body's edge, metres; infinite when nothing is met.
pub type FreeDistances = [f64; PROXIMITY_SENSORS];

/// Nothing is met.
pub const ALL_FREE: FreeDistances = [f64::INFINITY; PROXIMITY_SENSORS];

/// From farther than this between centre and wall no sensor can reach the wall, metres.
pub const WALL_REACH: f64 = BODY_RADIUS + PROXIMITY_RANGE;
/// From farther than this between centres no sensor can reach the other robot, metres.
pub const ROBOT_REACH: f64 = 2.0 * BODY_RADIUS + PROXIMITY_RANGE;

/// Distance in metres, signal, and noise as a share of the signal: the lookup table of Webots' e-puck.
const WEBOTS: [(f64, f64, f64); 10] = [
    (0.0, 4095.0, 0.002),
    (0.005, 2133.33, 0.003),
    (0.01, 1465.73, 0.007),
    (0.015, 601.46, 0.0406),
    (0.02, 383.84, 0.01472),
    (0.03, 234.93, 0.0241),
    (0.04, 158.03, 0.0287),
    (0.05, 120.0, 0.04225),
    (0.06, 104.09, 0.03065),
    (0.07, 67.19, 0.04897),
];
/// a, b and c of a d² + b d + c in ARGoS.
const ARGOS: [f64; 3] = [197.9, -30.5, 1.01];
/// Largest signal, x₀ and c in Enki; distances in centimetres.
const ENKI: [f64; 3] = [3731.0, 0.3, 0.7];
/// Standard deviation of Enki's signal.
const ENKI_NOISE: f64 = 10.0;

/// How a response is computed.
trait Curve {
    /// Signal and its standard deviation for a distance in metres, at most 7 cm.
    fn signal(self, distance: f64) -> (f64, f64);
    /// The distance in metres that nominally gives this signal, 0 or more.
    fn distance(self, signal: f64) -> f64;
}

impl Curve for Response {
    fn signal(self, distance: f64) -> (f64, f64) {
        match self {
            Response::Distance => (distance, 0.0),
            Response::Webots => {
                let upper = WEBOTS.partition_point(|row| row.0 <= distance).clamp(1, WEBOTS.len() - 1);
                let ((near, high, quiet), (far, low, loud)) = (WEBOTS[upper - 1], WEBOTS[upper]);
                let share = (distance - near) / (far - near);
                let signal = high + share * (low - high);
                (signal, signal * (quiet + share * (loud - quiet)))
            }
            Response::Argos => (ARGOS[0] * distance * distance + ARGOS[1] * distance + ARGOS[2], 0.0),
            Response::Enki => {
                let [most, x0, c] = ENKI;
                let x = (distance * 100.0).max(x0);
                (most * (c - x0 * x0) / (x * x - 2.0 * x0 * x + c), ENKI_NOISE)
            }
        }
    }

    fn distance(self, signal: f64) -> f64 {
        match self {
            Response::Distance => signal.max(0.0),
            Response::Webots => {
                let lower = WEBOTS.partition_point(|row| row.1 > signal).clamp(1, WEBOTS.len() - 1);
                let ((near, high, _), (far, low, _)) = (WEBOTS[lower - 1], WEBOTS[lower]);
                (near + (far - near) * (high - signal) / (high - low)).max(0.0)
            }
            Response::Argos => {
                let [a, b, c] = ARGOS;
                let root = (b * b - 4.0 * a * (c - signal)).max(0.0).sqrt();
                ((-b - root) / (2.0 * a)).max(0.0)
            }
            Response::Enki => {
                let [most, x0, c] = ENKI;
                let beyond = ((c - x0 * x0) * (most / signal.max(1.0) - 1.0)).max(0.0).sqrt();
                if signal >= most { 0.0 } else { (x0 + beyond) / 100.0 }
            }
        }
    }
}

/// The ring as it is built: where sensors look, and how they respond.
#[derive(Clone, Debug)]
pub struct ProximityRing {
    cos: [f64; PROXIMITY_SENSORS],
    sin: [f64; PROXIMITY_SENSORS],
    response: Response,
    noise_m: f64,
    noise_growth: f64,
}

/// What is particular about one robot's ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains([f64; PROXIMITY_SENSORS]);

impl Gains {
    /// Robot number `robot`'s, for sensors whose factors differ by up to `gain` from 1.
    pub fn drawn(gain: f64, seed: u64, robot: usize) -> Self {
        let mut stream = Stream::new(seed, Component::ProximityGain, robot);
        Gains([(); PROXIMITY_SENSORS].map(|()| 1.0 + gain * stream.symmetric()))
    }
}

/// `point` as seen from the pose: x ahead, y to the left.
fn in_body_frame(pose: &Pose, point: Point<f64>) -> Vector<f64> {
    let offset = point - pose.position;
    Vector::new(pose.heading.dot(offset), pose.heading.cross(offset))
}

impl ProximityRing {
    /// The ring of a laboratory's robots.
    pub fn new(proximity: &lab::Proximity) -> Self {
        let bearings = proximity.bearings_deg.map(|bearing| libm::sincos(bearing.to_radians()));
        ProximityRing {
            cos: bearings.map(|(_, cos)| cos),
            sin: bearings.map(|(sin, _)| sin),
            response: proximity.response,
            noise_m: proximity.noise_m,
            noise_growth: proximity.noise_growth,
        }
    }

    /// Shortens free distances by a round body with this radius (metres) whose centre is at `other`.
    #[inline]
    pub fn sense_body(&self, pose: &Pose, other: Point<f64>, radius: f64, free: &mut FreeDistances) {
        let offset = in_body_frame(pose, other);
        for ((free, &cos), &sin) in free.iter_mut().zip(&self.cos).zip(&self.sin) {
            let along = offset.x * cos + offset.y * sin;
            let aside = offset.x * sin - offset.y * cos;
            let room = radius * radius - aside * aside;
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

    /// Free distances as the percept has them, in 0.1 mm.
    pub fn readings(&self, free: &FreeDistances, gains: &Gains, noise: &mut Stream) -> [u16; PROXIMITY_SENSORS] {
        let mut readings = [u16::MAX; PROXIMITY_SENSORS];
        for ((reading, &distance), &gain) in readings.iter_mut().zip(free).zip(&gains.0) {
            if distance <= PROXIMITY_RANGE {
                let sensed = self.sensed(distance.max(0.0), gain, noise);
                *reading = if sensed > PROXIMITY_RANGE { u16::MAX } else { (sensed * 1e4 + 0.5) as u16 };
            }
        }
        readings
    }

    /// The distance that the robot makes of a true one, metres.
    fn sensed(&self, distance: f64, gain: f64, noise: &mut Stream) -> f64 {
        let (signal, deviation) = self.response.signal(distance);
        let signal = signal * gain + error(deviation, noise);
        let inverted = match self.response {
            Response::Distance | Response::Argos => self.response.distance(signal),
            Response::Webots | Response::Enki => self.response.distance(signal.max(0.0).round_ties_even()),
        };
        (inverted + error(self.noise_m + self.noise_growth * distance, noise)).max(0.0)
    }
}

/// A random error with this standard deviation.
fn error(deviation: f64, noise: &mut Stream) -> f64 {
    if deviation > 0.0 { deviation * noise.normal() } else { 0.0 }
}

#[cfg(test)]
mod tests;
