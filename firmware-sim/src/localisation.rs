//! How robots learn where they are: a tracking system with a rate, a delay, gaps, noise and drift.
//!
//! How a pose comes to a robot:
//!
//! 1. At its own moments, `rate_hz` times a second, the system measures the robot's pose, unless it loses sight of it.
//! 2. The measured pose is off by the drift of that moment and by noise.
//! 3. `latency_s` later it is there. A robot that thinks gets the newest that has come since it thought last, with its age.
//!
//! The drift of each coordinate is an Ornstein-Uhlenbeck process, which has one value a second and runs straight from one to the next.

use crate::body::Pose;
use crate::bursts::Bursts;
use crate::lab;
use crate::random::{Component, Stream};
use crate::units::{micrometres, unit_q14};
use grn_core::geometry::{Point, Vector};
use grn_core::robot::Fix;
use std::collections::VecDeque;

/// Microseconds between two values of the drift.
const DRIFT_STEP_US: u64 = 1_000_000;

/// By how much a pose is off: metres and radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseError {
    /// East and north.
    pub position: Vector<f64>,
    /// Anticlockwise.
    pub heading: f64,
}

impl PoseError {
    /// None.
    pub const NONE: PoseError = PoseError { position: Vector::ZERO, heading: 0.0 };

    /// The pose with this error.
    fn applied(&self, pose: &Pose) -> Pose {
        Pose { position: pose.position + self.position, heading: turned(pose.heading, self.heading) }
    }

    /// Where somebody with this error of its pose believes a thing to be that it sees from `here`.
    pub fn seen(&self, here: Point<f64>, thing: Point<f64>) -> Point<f64> {
        here + self.position + turned(thing - here, self.heading)
    }
}

/// A vector turned by a small angle e: (1, e) made a unit vector turns by atan(e), near enough to e for an error.
fn turned(v: Vector<f64>, e: f64) -> Vector<f64> {
    if e == 0.0 { v } else { (v + v.turned_left() * e) * (1.0 / (1.0 + e * e).sqrt()) }
}

/// The tracking system.
#[derive(Clone, Debug)]
pub struct Tracker {
    period_us: u64,
    latency_us: u64,
    noise: [f64; 2],
    drift: [f64; 2],
    /// By what a drift is multiplied in a second.
    kept: f64,
    gaps: Bursts,
}

/// What the tracking system has of one robot.
#[derive(Clone, Debug)]
pub struct Track {
    stream: Stream,
    next_us: u64,
    in_gap: bool,
    on_its_way: VecDeque<(u64, Pose)>,
    /// Standard normal values of x, y and heading, of this second's beginning and end.
    drift: [[f64; 3]; 2],
    drift_from_us: u64,
    /// By how much it jumps at present, metres.
    jump: Vector<f64>,
    error: PoseError,
}

impl Tracker {
    /// The system of a laboratory.
    pub fn new(localisation: &lab::Localisation) -> Self {
        let lab::Localisation {
            rate_hz,
            latency_s,
            noise_m,
            noise_deg,
            drift_m,
            drift_deg,
            drift_s,
            dropout,
            dropout_s,
        } = *localisation;
        Tracker {
            period_us: (1e6 / rate_hz) as u64,
            latency_us: (latency_s * 1e6) as u64,
            noise: [noise_m, noise_deg.to_radians()],
            drift: [drift_m, drift_deg.to_radians()],
            kept: libm::exp(-1.0 / drift_s),
            gaps: Bursts::new(dropout, dropout_s, 1.0 / rate_hz),
        }
    }

    /// The track of robot number `robot`. All robots are measured in the same images, or each at moments of its own.
    pub fn track(&self, seed: u64, robot: usize) -> Track {
        let mut stream = Stream::new(seed, Component::Localisation, robot);
        let drifts = self.drift != [0.0; 2];
        let begin = if drifts { [(); 3].map(|()| stream.normal()) } else { [0.0; 3] };
        let in_gap = self.gaps.first(&mut stream);
        let mut track = Track {
            stream,
            next_us: 0,
            in_gap,
            on_its_way: VecDeque::new(),
            drift: [begin; 2],
            drift_from_us: 0,
            jump: Vector::ZERO,
            error: PoseError::NONE,
        };
        track.drift[1] = self.next_drift(begin, &mut track.stream);
        track
    }

    fn next_drift(&self, drift: [f64; 3], stream: &mut Stream) -> [f64; 3] {
        if self.drift == [0.0; 2] {
            return [0.0; 3];
        }
        let fresh = (1.0 - self.kept * self.kept).sqrt();
        drift.map(|value| self.kept * value + fresh * stream.normal())
    }

    /// Measures a robot that is at `pose` at the time `now_us`, if that is due.
    pub fn measure(&self, track: &mut Track, now_us: u64, pose: &Pose) {
        if now_us < track.next_us {
            return;
        }
        // After a gap in time measuring goes on in the old rhythm.
        track.next_us += self.period_us;
        if now_us >= track.next_us {
            track.next_us += self.period_us * (1 + (now_us - track.next_us) / self.period_us);
        }
        track.in_gap = self.gaps.next(track.in_gap, &mut track.stream);
        if track.in_gap {
            return;
        }
        track.error = self.error(track, now_us);
        track.error.position = track.error.position + track.jump;
        track.on_its_way.push_back((now_us, track.error.applied(pose)));
    }

    fn error(&self, track: &mut Track, now_us: u64) -> PoseError {
        let [noise_m, noise_rad] = self.noise;
        let stream = &mut track.stream;
        let position =
            if noise_m > 0.0 { Vector::new(stream.normal(), stream.normal()) * noise_m } else { Vector::ZERO };
        let heading = if noise_rad > 0.0 { stream.normal() * noise_rad } else { 0.0 };
        let noise = PoseError { position, heading };
        if self.drift == [0.0; 2] {
            return noise;
        }
        while now_us >= track.drift_from_us + DRIFT_STEP_US {
            track.drift_from_us += DRIFT_STEP_US;
            let [_, last] = track.drift;
            track.drift = [last, self.next_drift(last, &mut track.stream)];
        }
        let share = (now_us - track.drift_from_us) as f64 / DRIFT_STEP_US as f64;
        let [from, to] = track.drift;
        let [x, y, turn] = [0, 1, 2].map(|i| from[i] + share * (to[i] - from[i]));
        let [drift_m, drift_rad] = self.drift;
        PoseError { position: noise.position + Vector::new(x, y) * drift_m, heading: noise.heading + turn * drift_rad }
    }

    /// The newest pose that has come to the robot by now and since it was asked last.
    pub fn newest(&self, track: &mut Track, now_us: u64) -> Option<Fix> {
        let mut newest = None;
        while let Some(&(measured_us, pose)) = track.on_its_way.front()
            && measured_us + self.latency_us <= now_us
        {
            track.on_its_way.pop_front();
            newest = Some((measured_us, pose));
        }
        newest.map(|(measured_us, Pose { position, heading })| Fix {
            position: [micrometres(position.x), micrometres(position.y)],
            heading: [unit_q14(heading.x), unit_q14(heading.y)],
            age_ms: ((now_us - measured_us + 500) / 1000).min(u64::from(u16::MAX)) as u16,
        })
    }
}

impl Track {
    /// From now on poses are off by this much more than usual, metres.
    pub fn jump(&mut self, offset: Vector<f64>) {
        self.jump = offset;
    }

    /// The error of the pose that was measured last.
    pub fn error(&self) -> PoseError {
        self.error
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POSE: Pose = Pose { position: Vector::new(1.0, 2.0), heading: Vector::new(0.0, 1.0) };
    const FRAME_US: u64 = 31_250;

    /// (time, fix) of this many frames, with a robot that thinks in each.
    fn fixes(localisation: lab::Localisation, frames: u64) -> Vec<(u64, Fix)> {
        let tracker = Tracker::new(&localisation);
        let mut track = tracker.track(1, 0);
        let one = |frame: u64| {
            let now = frame * FRAME_US;
            tracker.measure(&mut track, now, &POSE);
            tracker.newest(&mut track, now).map(|fix| (now, fix))
        };
        (0..frames).filter_map(one).collect()
    }

    fn perfect() -> lab::Localisation {
        lab::Laboratory::perfect().localisation
    }

    #[test]
    fn a_perfect_tracker_tells_the_pose_of_now() {
        let exact = Fix { position: [1_000_000, 2_000_000], heading: [0, 16_384], age_ms: 0 };
        let found = fixes(perfect(), 32);
        assert_eq!(found.len(), 32);
        assert!(found.iter().all(|(_, fix)| *fix == exact));
    }

    #[test]
    fn rate_and_latency_are_as_asked() {
        let slow = fixes(lab::Localisation { rate_hz: 5.0, latency_s: 0.1, ..perfect() }, 321);
        assert_eq!(slow.len(), 50);
        // Each is at least as old as the latency, and at most one frame older.
        assert!(slow.iter().all(|(_, fix)| (100..=132).contains(&fix.age_ms)), "{slow:?}");
        assert_eq!(fixes(lab::Localisation { latency_s: 2.0, ..perfect() }, 64).len(), 0);
        assert_eq!(fixes(lab::Localisation { rate_hz: 1000.0, ..perfect() }, 64).len(), 64, "one a frame at most");
    }

    #[test]
    fn noise_and_drift_have_the_deviations_asked_for() {
        let deviation = |localisation: lab::Localisation, frames: u64, every: usize| {
            let errors: Vec<[f64; 2]> = fixes(localisation, frames)
                .iter()
                .step_by(every)
                .map(|(_, fix)| [f64::from(fix.position[0] - 1_000_000) * 1e-6, f64::from(-fix.heading[0]) / 16_384.0])
                .collect();
            [0, 1].map(|i| (errors.iter().map(|e| e[i] * e[i]).sum::<f64>() / errors.len() as f64).sqrt())
        };
        let [position, heading] =
            deviation(lab::Localisation { noise_m: 0.02, noise_deg: 5.0, ..perfect() }, 20_000, 1);
        assert!(
            (position / 0.02 - 1.0).abs() < 0.02 && (heading / 5f64.to_radians() - 1.0).abs() < 0.03,
            "{position} {heading}"
        );
        let drifting = lab::Localisation { drift_m: 0.05, drift_deg: 5.0, drift_s: 2.0, ..perfect() };
        let [position, heading] = deviation(drifting, 640_000, 320);
        assert!(
            (position / 0.05 - 1.0).abs() < 0.1 && (heading / 5f64.to_radians() - 1.0).abs() < 0.1,
            "{position} {heading}"
        );
        // From one moment to the next it hardly moves.
        let found = fixes(lab::Localisation { drift_s: 30.0, ..drifting }, 3200);
        let step = |pair: &[(u64, Fix)]| (pair[1].1.position[0] - pair[0].1.position[0]).abs();
        assert!(found.windows(2).map(step).max().unwrap() < 3000);
    }

    #[test]
    fn gaps_come_in_rows() {
        let found = fixes(lab::Localisation { dropout: 0.2, dropout_s: 0.5, ..perfect() }, 32_000);
        assert!((found.len() as f64 / 32_000.0 - 0.8).abs() < 0.03, "{}", found.len());
        let longest = found.windows(2).map(|pair| pair[1].0 - pair[0].0).max().unwrap();
        assert!(longest > 1_000_000, "{longest}");
    }
}
