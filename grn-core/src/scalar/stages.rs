//! Four numbers computed with side by side.

use super::{Arithmetic, Scalar};
use core::ops::{Add, Mul, Sub};

/// A quantity's values in the four stages of a Runge-Kutta step; operations go stage by stage.
///
/// ```
/// use grn_core::scalar::{Arithmetic, Stages};
/// let product = Stages([1.0_f32, 2.0, 3.0, 4.0]) * Stages::constant(0.5);
/// assert_eq!(product, Stages([0.5, 1.0, 1.5, 2.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stages<S>(pub [S; 4]);

impl<S: Scalar> Stages<S> {
    #[inline]
    fn zipped(self, other: Self, operation: impl Fn(S, S) -> S) -> Self {
        let ([a1, a2, a3, a4], [b1, b2, b3, b4]) = (self.0, other.0);
        Stages([operation(a1, b1), operation(a2, b2), operation(a3, b3), operation(a4, b4)])
    }
}

impl<S: Scalar> Add for Stages<S> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        self.zipped(other, |a, b| a + b)
    }
}

impl<S: Scalar> Sub for Stages<S> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self.zipped(other, |a, b| a - b)
    }
}

impl<S: Scalar> Mul for Stages<S> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        self.zipped(other, |a, b| a * b)
    }
}

impl<S: Scalar> Arithmetic for Stages<S> {
    type Real = S;
    const ZERO: Self = Stages([S::ZERO; 4]);
    const ONE: Self = Stages([S::ONE; 4]);
    #[inline]
    fn constant(value: S) -> Self {
        // Written out: compilers for size make a loop of the short form.
        Stages([value, value, value, value])
    }
    #[inline]
    fn logistic(self) -> Self {
        let [a1, a2, a3, a4] = self.0;
        Stages([a1.logistic(), a2.logistic(), a3.logistic(), a4.logistic()])
    }
    #[inline]
    fn sigmoid(self, theta: S, k: S) -> Self {
        let [a1, a2, a3, a4] = self.0;
        Stages([a1.sigmoid(theta, k), a2.sigmoid(theta, k), a3.sigmoid(theta, k), a4.sigmoid(theta, k)])
    }
}
