//! Eight numbers at a time: the same model code as on the robot, for as many lattice nodes as the compiler's vector
//! instructions and the processor's pipeline can take.

use grn_core::field::Kernel;
use grn_core::scalar::Arithmetic;
use std::ops::{Add, Mul, Sub};

/// How many numbers one [`Lanes`] holds.
pub(super) const WIDTH: usize = 8;

/// Eight `f64`, each on its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lanes(pub [f64; WIDTH]);

impl Lanes {
    pub(super) fn splat(value: f64) -> Self {
        Lanes([value; WIDTH])
    }

    /// e^z of each lane, z limited to ±700; within 2 units in the last place of `libm::exp`.
    ///
    /// z = n ln 2 + r with |r| ≤ (ln 2)/2; e^r by its Taylor polynomial; 2^n by the exponent's bits.
    pub(super) fn exp(self) -> Self {
        const LN_2_HIGH: f64 = 6.931_471_803_691_238e-1;
        const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;
        /// Adding it rounds to an integer, which then stands in the lowest bits.
        const ROUNDER: f64 = 6_755_399_441_055_744.0;
        self.map(|z| {
            let z = z.clamp(-700.0, 700.0);
            let rounded = z * std::f64::consts::LOG2_E + ROUNDER;
            let n = rounded - ROUNDER;
            let r = (z - n * LN_2_HIGH) - n * LN_2_LOW;
            let power = f64::from_bits((rounded.to_bits() << 52).wrapping_add(1.0_f64.to_bits()));
            taylor_exp(r) * power
        })
    }

    /// Square root of each lane.
    pub(super) fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }

    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Lanes(self.0.map(f))
    }

    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Lanes(std::array::from_fn(|lane| f(self.0[lane], other.0[lane])))
    }
}

/// 1/n! from n = 0 on.
const INVERSE_FACTORIALS: [f64; 13] = {
    let mut table = [1.0; 13];
    let mut n = 1;
    while n < 13 {
        table[n] = table[n - 1] / n as f64;
        n += 1;
    }
    table
};

/// Twelfth-degree Taylor polynomial, in pairs and pairs of pairs: a shorter chain of operations than Horner's.
fn taylor_exp(r: f64) -> f64 {
    let c = &INVERSE_FACTORIALS;
    let (r2, r4) = (r * r, (r * r) * (r * r));
    let four = |n: usize| (c[n] + c[n + 1] * r) + (c[n + 2] + c[n + 3] * r) * r2;
    four(0) + (four(4) + (four(8) + c[12] * r4) * r4) * r4
}

/// κ at the given squared distances in metres², for a width in metres.
pub(super) fn concentration(kernel: Kernel, width: f64, squared_distance: Lanes) -> Lanes {
    match kernel {
        Kernel::Gaussian => (squared_distance * Lanes::splat(-0.5 / (width * width))).exp(),
        Kernel::Exponential => (squared_distance.sqrt() * Lanes::splat(-1.0 / width)).exp(),
    }
}

impl Add for Lanes {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl Sub for Lanes {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl Mul for Lanes {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl Arithmetic for Lanes {
    type Real = f64;
    const ZERO: Self = Lanes([0.0; WIDTH]);
    const ONE: Self = Lanes([1.0; WIDTH]);
    fn constant(value: f64) -> Self {
        Lanes::splat(value)
    }
    fn logistic(self) -> Self {
        self.map(|z| -z).exp().map(|decay| 1.0 / (1.0 + decay))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluation::Model;
    use crate::model::published::PUBLISHED;
    use grn_core::scalar::Scalar;

    #[test]
    fn exponentials_equal_those_of_the_library() {
        for i in -70_000..70_000 {
            let z = f64::from(i) * 0.01;
            let (got, exact) = (Lanes::splat(z).exp().0[3], libm::exp(z));
            assert!((got / exact - 1.0).abs() < 5e-16, "e^{z}: {got} against {exact}");
        }
        assert_eq!(Lanes::splat(-1e9).logistic().0[0], 1.0 / (1.0 + Lanes::splat(700.0).exp().0[0]));
    }

    #[test]
    fn models_and_kernels_equal_the_robots_code() {
        for published in &PUBLISHED {
            let model = Model::new(&published.network().unwrap(), 0.5).unwrap();
            for i in 0..500 {
                let (x1, x2) = (f64::from(i % 50) * 0.05, f64::from(i / 50) * 0.1);
                let lanes = model.errors(Lanes::splat(x1), Lanes::splat(x2));
                assert!((lanes.0[5] - model.error(x1, x2)).abs() < 1e-11, "{} at {x1}, {x2}", published.name);
            }
        }
        for kernel in [Kernel::Gaussian, Kernel::Exponential] {
            for i in 0..100 {
                let d = f64::from(i) * 0.1;
                let exact = kernel.concentration(d / 1.5);
                assert!((concentration(kernel, 1.5, Lanes::splat(d * d)).0[7] - exact).abs() < 1e-15);
            }
        }
        assert_eq!(Lanes::splat(2.0).sqrt().0[1], Scalar::sqrt(2.0_f64));
    }
}
