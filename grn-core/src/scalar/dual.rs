//! Forward-mode differentiation with respect to the two inputs.

use super::{Arithmetic, Scalar};
use core::ops::{Add, Mul, Sub};

/// A value with its derivatives with respect to x1 and x2.
///
/// ```
/// use grn_core::scalar::{Arithmetic, Dual};
/// let x1 = Dual::input(3.0_f64, 0);
/// let x2 = Dual::input(2.0_f64, 1);
/// let product = x1 * x2;
/// assert_eq!((product.value, product.gradient), (6.0, [2.0, 3.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<S> {
    /// The value.
    pub value: S,
    /// (∂/∂x1, ∂/∂x2).
    pub gradient: [S; 2],
}

impl<S: Scalar> Dual<S> {
    /// Input number `axis` (0 for x1, 1 for x2) at `value`.
    pub fn input(value: S, axis: usize) -> Self {
        let unit = |i| if i == axis { S::ONE } else { S::ZERO };
        Dual { value, gradient: [unit(0), unit(1)] }
    }

    fn with(value: S, left: Self, right: Self, derivative: impl Fn(S, S) -> S) -> Self {
        let [l1, l2] = left.gradient;
        let [r1, r2] = right.gradient;
        Dual { value, gradient: [derivative(l1, r1), derivative(l2, r2)] }
    }
}

impl<S: Scalar> Add for Dual<S> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Dual::with(self.value + other.value, self, other, |a, b| a + b)
    }
}

impl<S: Scalar> Sub for Dual<S> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Dual::with(self.value - other.value, self, other, |a, b| a - b)
    }
}

impl<S: Scalar> Mul for Dual<S> {
    type Output = Self;
    #[expect(clippy::suspicious_arithmetic_impl, reason = "the product rule has a sum")]
    fn mul(self, other: Self) -> Self {
        Dual::with(self.value * other.value, self, other, |a, b| a * other.value + self.value * b)
    }
}

impl<S: Scalar> Arithmetic for Dual<S> {
    type Real = S;
    const ZERO: Self = Dual { value: S::ZERO, gradient: [S::ZERO, S::ZERO] };
    const ONE: Self = Dual { value: S::ONE, gradient: [S::ZERO, S::ZERO] };
    fn constant(value: S) -> Self {
        Dual { value, gradient: [S::ZERO, S::ZERO] }
    }
    /// σ' = σ (1 - σ).
    fn logistic(self) -> Self {
        let s = self.value.logistic();
        let slope = s * (S::ONE - s);
        let [d1, d2] = self.gradient;
        Dual { value: s, gradient: [slope * d1, slope * d2] }
    }
    fn sigmoid(self, theta: S, k: S) -> Self {
        let from_threshold = Dual { value: self.value - theta, gradient: self.gradient };
        // k is mostly 1, and products take a fifth of the time.
        if k == S::ONE {
            return from_threshold.logistic();
        }
        let [d1, d2] = from_threshold.gradient;
        Dual { value: from_threshold.value * k, gradient: [d1 * k, d2 * k] }.logistic()
    }
}
