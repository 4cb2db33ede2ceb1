//! The box a real vector lives in.

use core::fmt;

use rand::{Rng, RngExt};

/// A closed interval for each coordinate of a vector. Both ends are finite and the lower is at most the upper;
/// equal ends fix the coordinate. There may be no coordinate at all: then the box holds one vector, the empty one.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds(Vec<(f64, f64)>);

/// Why an interval was rejected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundsError {
    /// Which coordinate, from 0.
    pub coordinate: usize,
    /// The interval as given: an end is not finite, or the lower end is above the upper.
    pub interval: (f64, f64),
}

impl fmt::Display for BoundsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (lo, hi) = self.interval;
        write!(f, "coordinate {}: [{lo}, {hi}] is not an interval with finite ends in order", self.coordinate)
    }
}

impl core::error::Error for BoundsError {}

impl Bounds {
    /// One `(lowest, highest)` for each coordinate.
    ///
    /// # Errors
    /// The first interval with an end that is not finite, with its ends reversed, or too wide for the
    /// difference of its ends to be finite.
    pub fn new(intervals: Vec<(f64, f64)>) -> Result<Self, BoundsError> {
        let bad = |&(lo, hi): &(f64, f64)| !(lo <= hi && (hi - lo).is_finite());
        match intervals.iter().position(bad) {
            Some(coordinate) => Err(BoundsError { coordinate, interval: intervals[coordinate] }),
            None => Ok(Self(intervals)),
        }
    }

    /// The same `[lo, hi]` for every one of `dimension` coordinates.
    ///
    /// # Errors
    /// As [`Bounds::new`], naming coordinate 0.
    pub fn cube(dimension: usize, lo: f64, hi: f64) -> Result<Self, BoundsError> {
        Self::new(vec![(lo, hi); dimension])
    }

    /// How many coordinates a vector has.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.0.len()
    }

    /// The intervals, one a coordinate.
    #[must_use]
    pub fn intervals(&self) -> &[(f64, f64)] {
        &self.0
    }

    /// Whether `x` has the right length and every coordinate is within its interval, ends included.
    #[must_use]
    pub fn contain(&self, x: &[f64]) -> bool {
        x.len() == self.dimension() && self.outside(x).is_none()
    }

    /// The first coordinate of `x` that is not within its interval (NaN never is). Lengths are not compared.
    #[must_use]
    pub fn outside(&self, x: &[f64]) -> Option<usize> {
        x.iter().zip(&self.0).position(|(x, (lo, hi))| !(lo <= x && x <= hi))
    }

    /// A vector drawn uniformly from the box, one number from `rng` a coordinate.
    pub fn sample<R: Rng + ?Sized>(&self, rng: &mut R) -> Vec<f64> {
        self.0.iter().map(|&(lo, hi)| (lo + rng.random::<f64>() * (hi - lo)).min(hi)).collect()
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_pcg::Pcg64Mcg;

    use super::*;

    #[test]
    fn bad_intervals_are_rejected_and_named() {
        for interval in [(1.0, 0.0), (f64::NAN, 1.0), (0.0, f64::NAN), (0.0, f64::INFINITY), (f64::MIN, f64::MAX)] {
            let error = Bounds::new(vec![(0.0, 1.0), interval]).unwrap_err();
            assert_eq!(error.coordinate, 1);
            assert!(error.to_string().starts_with("coordinate 1: ["), "{error}");
        }
        assert!(Bounds::cube(3, 2.0, 1.0).is_err());
    }

    #[test]
    fn ends_are_inside_and_a_wrong_length_is_not() {
        let bounds = Bounds::new(vec![(0.0, 1.0), (2.0, 2.0)]).unwrap();
        assert!(bounds.contain(&[0.0, 2.0]) && bounds.contain(&[1.0, 2.0]));
        assert!(!bounds.contain(&[0.5]) && !bounds.contain(&[0.5, 2.0, 0.0]));
        assert_eq!(bounds.outside(&[0.5, 2.1]), Some(1));
        assert_eq!(bounds.outside(&[f64::NAN, 2.0]), Some(0));
    }

    #[test]
    fn samples_lie_inside_and_fill_the_box() {
        let bounds = Bounds::new(vec![(-1.0, 3.0), (5.0, 5.0), (0.0, 1e-3)]).unwrap();
        let mut rng = Pcg64Mcg::seed_from_u64(1);
        let samples: Vec<_> = (0..1000).map(|_| bounds.sample(&mut rng)).collect();
        assert!(samples.iter().all(|x| bounds.contain(x)));
        let mean = samples.iter().map(|x| x[0]).sum::<f64>() / 1000.0;
        assert!((mean - 1.0).abs() < 0.15, "{mean}");
    }
}
