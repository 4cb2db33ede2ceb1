//! Sigmoids of a distance, tabulated over the squared distance: no square root, no exponential in the inner loop.

/// Largest product of table spacing and steepness; keeps the interpolation error below 1e-7.
const SPACING_TIMES_STEEPNESS: f64 = 0.1;
/// Nearer than this (metres) the function is evaluated exactly: there the square root bends it.
const NEAR: f64 = 0.5;
/// Beyond this many steepness lengths from the last threshold the function has reached its limit.
const REACH: f64 = 20.0;

/// A smooth function of a distance, which tends to a limit.
#[derive(Clone, Debug)]
pub(super) struct Profile<F> {
    exact: F,
    limit: f64,
    per_spacing: f64,
    /// Values at squared distances `i` · spacing.
    table: Vec<f64>,
}

impl<F: Fn(f64) -> f64> Profile<F> {
    /// Tabulates `exact`, made of sigmoids of the given steepness (1/m) with thresholds up to `threshold` metres.
    pub(super) fn new(exact: F, steepness: f64, threshold: f64) -> Self {
        let spacing = SPACING_TIMES_STEEPNESS / steepness;
        let reach = threshold + REACH / steepness;
        let entries = (reach * reach / spacing).ceil() as usize + 4;
        let table = (0..entries).map(|i| exact(libm::sqrt(i as f64 * spacing))).collect();
        Profile { limit: exact(1e9), exact, per_spacing: 1.0 / spacing, table }
    }

    /// The function at the root of `squared_distance`, by cubic interpolation.
    pub(super) fn at(&self, squared_distance: f64) -> f64 {
        if squared_distance < NEAR * NEAR {
            return (self.exact)(libm::sqrt(squared_distance));
        }
        let place = squared_distance * self.per_spacing;
        let index = place as usize;
        let Some(&[a, b, c, d]) = self.table.get(index.wrapping_sub(1)..).and_then(|rest| rest.first_chunk()) else {
            return self.limit;
        };
        let t = place - index as f64;
        let (s, u) = (t - 1.0, t + 1.0);
        let v = t - 2.0;
        u * v * (b * s - c * t) * 0.5 + t * s * (d * u - a * v) * (1.0 / 6.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_equals_the_function() {
        for steepness in [2.0, 10.0, 40.0] {
            let exact = |d: f64| {
                let sig = |x: f64| 1.0 / (1.0 + libm::exp(-steepness * x));
                sig(d - 2.0) + sig(1.0 - d)
            };
            let profile = Profile::new(exact, steepness, 2.0);
            for i in 0..40_000 {
                let d = f64::from(i) * 0.0005;
                let error = (profile.at(d * d) - exact(d)).abs();
                assert!(error < 1e-7, "steepness {steepness}, d = {d}: off by {error}");
            }
        }
    }
}
