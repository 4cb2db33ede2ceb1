//! Sums of sigmoids of a distance, tabulated over the squared distance: no square root, no exponential in the inner loop.

use super::lanes::Lanes;

/// Largest product of table spacing (m²) and steepness (1/m); keeps the interpolation error below 1e-7.
const SPACING_TIMES_STEEPNESS: f64 = 0.1;
/// Largest table spacing, m²: gentle sigmoids too are bent by the square root.
const LARGEST_SPACING: f64 = 0.01;
/// Nearer than this (metres) the sum is evaluated exactly: there the square root bends it most.
const NEAR: f64 = 0.5;
/// This many steepness lengths beyond the last threshold the sum has reached its limit.
const REACH: f64 = 20.0;

/// The paper's sig(x, θ, k) as a function of a distance x = d, or with negative k of θ.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sigmoid {
    /// θ, metres.
    pub(super) threshold: f64,
    /// k, 1/m; negative if it falls with the distance.
    pub(super) slope: f64,
}

impl Sigmoid {
    /// Its value at a distance, metres.
    pub(super) fn at(self, distance: f64) -> f64 {
        1.0 / (1.0 + libm::exp(-self.slope * (distance - self.threshold)))
    }
}

/// A sum of sigmoids of a distance.
#[derive(Clone, Debug)]
pub(crate) struct DistanceTable {
    sigmoids: Vec<Sigmoid>,
    per_spacing: f64,
    /// At each knot of squared distance the value and a sixth of the second difference.
    knots: Vec<[f64; 2]>,
}

impl DistanceTable {
    /// Tabulates a sum of sigmoids.
    pub(super) fn new(sigmoids: Vec<Sigmoid>) -> Self {
        let steepest = sigmoids.iter().fold(1e-3, |most, sigmoid| sigmoid.slope.abs().max(most));
        let spacing = (SPACING_TIMES_STEEPNESS / steepest).min(LARGEST_SPACING);
        let reach = reach(&sigmoids);
        let count = (reach * reach / spacing).ceil() as usize + 2;
        let mut profile = DistanceTable { sigmoids, per_spacing: 1.0 / spacing, knots: Vec::new() };
        let value = |place: usize| profile.exact(place as f64 * spacing);
        // The first knot is never asked for, being near: its neighbour below does not matter.
        let sixth = |place: usize| (value(place.max(1) - 1) + value(place + 1) - 2.0 * value(place)) / 6.0;
        profile.knots = (0..count).map(|place| [value(place), sixth(place)]).collect();
        profile
    }

    /// From this distance on it has reached its limit, metres.
    pub(crate) fn reach(&self) -> f64 {
        reach(&self.sigmoids)
    }

    /// The sum at the root of `squared_distance`, by cubic interpolation.
    #[inline]
    pub(crate) fn at(&self, squared_distance: f64) -> f64 {
        if squared_distance < NEAR * NEAR {
            return self.exact(squared_distance);
        }
        let place = (squared_distance * self.per_spacing).min((self.knots.len() - 2) as f64);
        let index = place as u32;
        let t = place - f64::from(index);
        let Some(&knots) = self.knots.get(index as usize..).and_then(|rest| rest.first_chunk()) else {
            return self.exact(squared_distance);
        };
        everett(t, knots)
    }

    /// The same at eight squared distances.
    #[inline]
    pub(super) fn at_all(&self, squared_distances: Lanes) -> Lanes {
        if squared_distances.0.iter().any(|&squared| squared < NEAR * NEAR) {
            return Lanes(squared_distances.0.map(|squared| self.at(squared)));
        }
        let last = (self.knots.len() - 2) as f64;
        if squared_distances.0.iter().all(|&squared| squared * self.per_spacing >= last) {
            return Lanes::splat(self.knots[self.knots.len() - 2][0]);
        }
        let places = squared_distances.0.map(|squared| (squared * self.per_spacing).min(last));
        let indices = places.map(|place| place as u32);
        let knots = indices.map(|index| [self.knots[index as usize], self.knots[index as usize + 1]]);
        Lanes(std::array::from_fn(|lane| {
            let t = places[lane] - f64::from(indices[lane]);
            everett(t, knots[lane])
        }))
    }

    #[cold]
    fn exact(&self, squared_distance: f64) -> f64 {
        let distance = libm::sqrt(squared_distance);
        self.sigmoids.iter().map(|sigmoid| sigmoid.at(distance)).sum()
    }
}

fn reach(sigmoids: &[Sigmoid]) -> f64 {
    sigmoids.iter().map(|sigmoid| sigmoid.threshold + REACH / sigmoid.slope.abs()).fold(0.0, f64::max)
}

/// The cubic through four knots, at the share `t` of the way from the second to the third.
#[inline]
fn everett(t: f64, [below, above]: [[f64; 2]; 2]) -> f64 {
    let u = 1.0 - t;
    u * (below[0] + (u * u - 1.0) * below[1]) + t * (above[0] + (t * t - 1.0) * above[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluation::lanes::WIDTH;

    #[test]
    fn the_table_equals_the_function() {
        for steepness in [0.5, 2.0, 10.0, 40.0] {
            let sig = |x: f64| 1.0 / (1.0 + libm::exp(-steepness * x));
            let exact = |d: f64| sig(d - 2.0) + sig(1.0 - d);
            let falling = Sigmoid { threshold: 1.0, slope: -steepness };
            let profile = DistanceTable::new(vec![Sigmoid { threshold: 2.0, slope: steepness }, falling]);
            for i in 0..60_000 {
                let d = f64::from(i) * 0.0005;
                assert_eq!(profile.at_all(Lanes::splat(d * d)).0, [profile.at(d * d); WIDTH]);
                let error = (profile.at(d * d) - exact(d)).abs();
                assert!(error < 1e-7, "steepness {steepness}, d = {d}: off by {error}");
            }
        }
    }
}
