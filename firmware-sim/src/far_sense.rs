//! What mother robots see far away.

use crate::geometry::length_squared;
use crate::localisation::PoseError;
use crate::random::Stream;
use crate::units::millimetres;
use grn_core::geometry::{Point, Vector};
use grn_core::robot::percept::{MAX_SEEN_OBSTACLES, MAX_TARGETS};
use grn_core::robot::{Millimetres, Sighting};
use heapless::Vec;

/// What a robot sees with its own far sense in one tick.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Seen {
    /// Targets.
    pub targets: Vec<Sighting, MAX_TARGETS>,
    /// Points on walls.
    pub obstacles: Vec<Millimetres, MAX_SEEN_OBSTACLES>,
}

/// Where a mother looks from, and how well.
#[derive(Clone, Copy, Debug)]
pub struct Eye {
    /// Where she is.
    pub position: Point<f64>,
    /// How far she sees, metres.
    pub range: f64,
    /// By how much her own pose is off, if that is in what she tells.
    pub error: PoseError,
    /// Noise of each coordinate, metres.
    pub noise_m: f64,
}

impl Eye {
    fn seen(&self, thing: Point<f64>, stream: &mut Stream) -> Millimetres {
        let seen = self.error.seen(self.position, thing);
        let mut error = || if self.noise_m > 0.0 { self.noise_m * stream.normal() } else { 0.0 };
        millimetres(seen + Vector::new(error(), error()))
    }
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

    /// What the eye sees of these targets, those that are there, and wall samples.
    pub fn look(
        &mut self,
        eye: &Eye,
        targets: &[Option<Point<f64>>],
        samples: &[Point<f64>],
        stream: &mut Stream,
    ) -> Seen {
        let mut look = Seen::default();
        let (position, limit) = (eye.position, eye.range * eye.range);
        let there = (0u8..).zip(targets).filter_map(|(number, &target)| Some((number, target?)));
        let squared = |target: Point<f64>| length_squared(target - position);
        let limit_of_targets = nearest_targets(there.clone().map(|(_, target)| squared(target)), limit);
        for (number, target) in there.filter(|&(_, target)| squared(target) <= limit_of_targets) {
            let seen = Sighting { target: number, position: eye.seen(target, stream) };
            // Of two that are equally far the one with the lower number is seen.
            let _ = look.targets.push(seen);
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
            // Of walls that come and go there may be fewer samples than when she began this round.
            if let Some(&sample) = samples.get(index as usize) {
                let _ = look.obstacles.push(eye.seen(sample, stream));
            }
            self.next += 1;
        }
        look
    }
}

/// The squared distance up to which targets at these squared distances are told: `limit`, or less if more of them are within it than a
/// percept has room for; then the nearest ones.
fn nearest_targets(squared: impl Iterator<Item = f64>, limit: f64) -> f64 {
    let mut nearest: Vec<f64, { MAX_TARGETS + 1 }> = Vec::new();
    for squared in squared.filter(|&squared| squared <= limit) {
        let place = nearest.iter().position(|&other| squared < other).unwrap_or(nearest.len());
        if nearest.is_full() && place < nearest.len() {
            nearest.pop();
        }
        if !nearest.is_full() {
            let _ = nearest.insert(place, squared);
        }
    }
    if nearest.is_full() { nearest[MAX_TARGETS - 1] } else { limit }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Component;
    use std::vec::Vec;

    const EYE: Eye = Eye { position: Vector::new(1.0, 2.0), range: 5.0, error: PoseError::NONE, noise_m: 0.0 };

    fn stream() -> Stream {
        Stream::new(1, Component::Sensors, 0)
    }

    #[test]
    fn what_a_mother_sees_is_off_by_her_own_pose() {
        let error = PoseError { position: Vector::new(0.1, -0.2), heading: 0.05 };
        let look =
            FarSense::new(0).look(&Eye { error, ..EYE }, &[None, Some(Vector::new(3.0, 2.0))], &[], &mut stream());
        assert_eq!((look.targets.len(), look.targets[0].target), (1, 1));
        // Moved by the error, and turned about her by atan(0.05).
        let turned = 2.0 / (1.0f64 + 0.0025).sqrt();
        let expected = [1.1 + turned, 1.8 + turned * 0.05].map(|metres| (metres * 1e3).round() as i16);
        assert_eq!([look.targets[0].position.x, look.targets[0].position.y], expected);
    }

    #[test]
    fn of_many_targets_the_nearest_are_told() {
        let place = |x: f64| Some(Vector::new(x, 2.0));
        let targets = [3.5, 1.5, 9.0, 0.2, 2.0, 1.2, 5.9].map(place);
        let look = FarSense::new(0).look(&EYE, &targets, &[], &mut stream());
        assert_eq!(look.targets.iter().map(|seen| seen.target).collect::<Vec<_>>(), [1, 3, 4, 5]);
        let twins = [3.0, 2.0, 2.0, 2.0, 2.0, 2.0].map(place);
        let look = FarSense::new(0).look(&EYE, &twins, &[], &mut stream());
        assert_eq!(look.targets.iter().map(|seen| seen.target).collect::<Vec<_>>(), [1, 2, 3, 4]);
        let few = [3.0, 2.0, 4.0].map(place);
        assert_eq!(FarSense::new(0).look(&EYE, &few, &[], &mut stream()).targets.len(), 3);
    }

    #[test]
    fn mothers_see_targets_in_range_and_every_wall_point_in_turn() {
        let targets = [Some(Vector::new(3.0, 2.0)), Some(Vector::new(9.0, 2.0))];
        let samples: Vec<Point<f64>> = (0..40).map(|i| Vector::new(1.0 + f64::from(i) * 0.25, 3.0)).collect();
        let mut sense = FarSense::new(samples.len());
        let mut seen = Vec::new();
        for tick in 0..6 {
            let look = sense.look(&EYE, &targets, &samples, &mut stream());
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
