//! Powers and roots for one distribution index, without the general power function where there is a shorter way.

/// The exponent `η + 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Exponent(f64);

impl Exponent {
    /// For a distribution index of at least 0.
    pub fn new(eta: f64) -> Self {
        Self(eta + 1.0)
    }

    /// The exponent if it is a small whole number, as it usually is.
    fn whole(self) -> Option<u32> {
        let whole = self.0 as u32;
        (f64::from(whole) == self.0 && whole <= 64).then_some(whole)
    }

    /// `x` to the power of `η + 1`, for `x` at least 0.
    pub fn raise(self, x: f64) -> f64 {
        let Some(mut whole) = self.whole() else {
            return libm::pow(x, self.0);
        };
        let (mut square, mut product) = (x, 1.0);
        while whole > 0 {
            if whole % 2 == 1 {
                product *= square;
            }
            square *= square;
            whole /= 2;
        }
        product
    }

    /// The root of every `x`, `x` to the power of `1 / (η + 1)`, for `x` at least 0. Several at once, because each
    /// step waits long for the one before.
    pub fn roots<const N: usize>(self, x: [f64; N]) -> [f64; N] {
        match self.whole() {
            Some(whole) if whole.is_power_of_two() => (0..whole.trailing_zeros()).fold(x, |x, _| x.map(f64::sqrt)),
            _ => x.map(|x| libm::pow(x, 1.0 / self.0)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_and_roots_agree_with_the_general_function() {
        for eta in [0.0, 1.0, 2.0, 3.0, 15.0, 20.0, 30.0, 63.0, 64.0, 100.0, 0.5, 15.5] {
            let exponent = Exponent::new(eta);
            for i in 0..=1000 {
                let x = f64::from(i) / 700.0;
                let (power, root) = (libm::pow(x, eta + 1.0), libm::pow(x, 1.0 / (eta + 1.0)));
                assert!((exponent.raise(x) - power).abs() <= 1e-13 * power, "{x} to the power of {eta} + 1");
                assert!((exponent.roots([x])[0] - root).abs() <= 1e-15 * root, "root of {x} for {eta}");
            }
        }
    }
}
