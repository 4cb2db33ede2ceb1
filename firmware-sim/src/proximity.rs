//! The ring of eight proximity sensors: what is in front of each, and what the sensor makes of it.
//!
//! A sensor looks radially outwards, along its bearing, from the body's edge. An infrared sensor returns a signal that falls with the
//! distance; the robot turns it back into a distance by the sensor's nominal curve. So an error of the signal, or a gain that is not
//! nominal, becomes an error of the distance that is larger where the curve is flat, far away.
//!
//! A sensor with an aperture a has two more rays, a to the right and to the left of its bearing. Enki (`IRSensor.h`, 2016) adds up
//! the signals F of the three: F(middle) + F(right) + F(left) - 2 F(middle / cos a), so that a wall straight ahead gives F(middle).
//! A ray that meets nothing within reach has no signal. What only the middle ray meets, a post, weakens the sum to nothing.

use crate::body::Pose;
use crate::geometry::Edge;
use crate::lab::{self, Response};
use crate::random::{Component, Stream};
use grn_core::geometry::{Point, Vector};
use grn_core::robot::epuck2::{BODY_RADIUS, PROXIMITY_RANGE, PROXIMITY_SENSORS};

/// The most rays of a sensor: the middle one, then those to its right and left.
const RAYS: usize = 3;

/// Free distances in front of the eight sensors, from the body's edge, metres, for each ray; infinite when nothing is met.
pub type FreeDistances = [[f64; PROXIMITY_SENSORS]; RAYS];

/// Nothing is met.
pub const ALL_FREE: FreeDistances = [[f64::INFINITY; PROXIMITY_SENSORS]; RAYS];

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

/// One ray of every sensor.
#[derive(Clone, Debug)]
struct Fan {
    cos: [f64; PROXIMITY_SENSORS],
    sin: [f64; PROXIMITY_SENSORS],
    /// Where the rays begin, seen from the body's centre: how far along them, and how far to their right, metres.
    ahead: f64,
    aside: f64,
}

impl Fan {
    /// Rays `turn` radians to the left of these bearings.
    fn new(bearings_deg: &[f64; PROXIMITY_SENSORS], turn: f64) -> Self {
        let directions = bearings_deg.map(|bearing| libm::sincos(bearing.to_radians() + turn));
        let (sin, cos) = libm::sincos(turn);
        Fan {
            cos: directions.map(|(_, cos)| cos),
            sin: directions.map(|(sin, _)| sin),
            ahead: BODY_RADIUS * cos,
            aside: BODY_RADIUS * sin,
        }
    }

    #[inline]
    fn sense_body(&self, offset: Vector<f64>, radius: f64, free: &mut [f64; PROXIMITY_SENSORS]) {
        for ((free, &cos), &sin) in free.iter_mut().zip(&self.cos).zip(&self.sin) {
            let along = offset.x * cos + offset.y * sin;
            let aside = offset.x * sin - offset.y * cos - self.aside;
            let room = radius * radius - aside * aside;
            // A ray that passes by has the root of a negative number, NaN, with which no comparison holds.
            let distance = along - room.sqrt() - self.ahead;
            // Without short circuits the eight sensors are computed side by side.
            let met = (along > 0.0) & (distance < *free);
            *free = if met { distance } else { *free };
        }
    }

    #[inline]
    fn sense_edge(&self, start: Vector<f64>, along: Vector<f64>, free: &mut [f64; PROXIMITY_SENSORS]) {
        let crossed = start.cross(along);
        for ((free, &cos), &sin) in free.iter_mut().zip(&self.cos).zip(&self.sin) {
            // A ray parallel to the edge divides by 0 and meets nothing, because no comparison with NaN holds and an
            // infinite distance is not shorter.
            let sideways = self.aside * (cos * along.x + sin * along.y);
            let per_denominator = 1.0 / (cos * along.y - sin * along.x);
            let distance = (crossed - sideways) * per_denominator - self.ahead;
            let share = (start.x * sin - start.y * cos - self.aside) * per_denominator;
            let met = (distance >= -BODY_RADIUS) & (share * (1.0 - share) >= 0.0) & (distance < *free);
            *free = if met { distance } else { *free };
        }
    }
}

/// The ring as it is built: where sensors look, and how they respond.
#[derive(Clone, Debug)]
pub struct ProximityRing {
    /// The middle rays; with an aperture those to their right and left, too.
    fans: Vec<Fan>,
    /// How much farther a side ray meets a wall straight ahead than the middle one: 1 / cos a.
    longer: f64,
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
        let aperture = proximity.aperture_deg.to_radians();
        let turns: &[f64] = if aperture > 0.0 { &[0.0, -aperture, aperture] } else { &[0.0] };
        ProximityRing {
            fans: turns.iter().map(|&turn| Fan::new(&proximity.bearings_deg, turn)).collect(),
            longer: 1.0 / libm::cos(aperture),
            response: proximity.response,
            noise_m: proximity.noise_m,
            noise_growth: proximity.noise_growth,
        }
    }

    /// Shortens free distances by a round body with this radius (metres) whose centre is at `other`.
    #[inline]
    pub fn sense_body(&self, pose: &Pose, other: Point<f64>, radius: f64, free: &mut FreeDistances) {
        let offset = in_body_frame(pose, other);
        self.fans.iter().zip(free).for_each(|(fan, free)| fan.sense_body(offset, radius, free));
    }

    /// Shortens free distances by a wall's edge.
    #[inline]
    pub fn sense_edge(&self, pose: &Pose, edge: &Edge, free: &mut FreeDistances) {
        let start = in_body_frame(pose, edge.start());
        let along = in_body_frame(pose, edge.end()) - start;
        self.fans.iter().zip(free).for_each(|(fan, free)| fan.sense_edge(start, along, free));
    }

    /// Free distances as the percept has them, in 0.1 mm.
    pub fn readings(&self, free: &FreeDistances, gains: &Gains, noise: &mut Stream) -> [u16; PROXIMITY_SENSORS] {
        let mut readings = [u16::MAX; PROXIMITY_SENSORS];
        let [mut nearest, side_rays @ ..] = *free;
        for fan in side_rays.iter().take(self.fans.len() - 1) {
            nearest.iter_mut().zip(fan).for_each(|(nearest, ray)| *nearest = nearest.min(*ray));
        }
        for (sensor, (reading, &gain)) in readings.iter_mut().zip(&gains.0).enumerate() {
            let nearest = nearest[sensor];
            if nearest > PROXIMITY_RANGE {
                continue;
            }
            let nearest = nearest.max(0.0);
            let felt = if self.fans.len() == 1 {
                Some(self.response.signal(nearest))
            } else {
                self.felt(free.map(|fan| fan[sensor].max(0.0)))
            };
            if let Some(felt) = felt {
                let sensed = self.sensed(felt, nearest, gain, noise);
                *reading = if sensed > PROXIMITY_RANGE { u16::MAX } else { (sensed * 1e4 + 0.5) as u16 };
            }
        }
        readings
    }

    /// Signal and its standard deviation for what a sensor's three rays meet; `None` if it is too weak to be one.
    fn felt(&self, rays: [f64; RAYS]) -> Option<(f64, f64)> {
        let [middle, right, left] = rays;
        if self.response == Response::Distance {
            return Some(self.response.signal(middle.min(right).min(left)));
        }
        let within_reach = |ray: f64| if ray <= PROXIMITY_RANGE { self.response.signal(ray) } else { (0.0, 0.0) };
        let [(middle, loud), (beyond, _), (right, _), (left, _)] =
            [middle, middle * self.longer, right, left].map(within_reach);
        let sum = middle + right + left - 2.0 * beyond;
        // One sensor has one noise, as loud as where the middle ray meets something or, if it does not, as for this sum.
        let deviation = if loud > 0.0 { loud } else { self.response.signal(self.response.distance(sum)).1 };
        (sum > 0.0).then_some((sum, deviation))
    }

    /// The distance that the robot makes of a signal from something that is so many metres away.
    fn sensed(&self, (signal, deviation): (f64, f64), distance: f64, gain: f64, noise: &mut Stream) -> f64 {
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
