//! The number types a controller computes with.
//!
//! [`Arithmetic`] is what a regulation function needs: ring operations and the sigmoid. [`Scalar`] adds what fields,
//! patterns and the robot need. `f32` and [`Q8_24`] run on robots; `f64` is the host's reference; [`Dual`] carries a
//! gradient with respect to the two inputs through the same generic code, and [`Stages`] the stages of an integration step.

mod division;
mod dual;
mod exp;
mod isqrt;
mod number_type;
mod q8_24;
mod stages;

pub use dual::Dual;
pub use number_type::{NumberType, UnknownNumberType};
pub use q8_24::Q8_24;
pub use stages::Stages;

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// What a motif's regulation function needs of a number.
pub trait Arithmetic: Copy + Debug + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// The plain number that parameters (θ, k) are given in.
    type Real: Scalar;
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// A parameter as this type; its gradient is zero.
    fn constant(value: Self::Real) -> Self;
    /// The logistic function 1 / (1 + e^-z) of `self` = z, in [0, 1], monotone.
    #[must_use]
    fn logistic(self) -> Self;
    /// 1 / (1 + e^(-k (x - θ))) of `self` = x.
    #[must_use]
    #[inline]
    fn sigmoid(self, theta: Self::Real, k: Self::Real) -> Self {
        ((self - Self::constant(theta)) * Self::constant(k)).logistic()
    }
}

/// A real number on the robot or the host: `f32`, [`Q8_24`] or `f64`.
///
/// Every operation is total: overflow saturates in Q8.24 and follows IEEE-754 in floating point.
pub trait Scalar:
    Arithmetic<Real = Self> + PartialOrd + Div<Output = Self> + Neg<Output = Self> + Send + Sync + 'static
{
    /// The name users type: `f32`, `q8.24`, `f64`.
    const NAME: &'static str;
    /// Squares to compare lengths by, without the range and the rounding of a number.
    type Square: Copy + PartialOrd;
    /// Nearest representable value; Q8.24 saturates at ±128 and takes NaN as 0.
    fn from_f32(value: f32) -> Self;
    /// Nearest representable value; Q8.24 saturates at ±128 and takes NaN as 0.
    fn from_f64(value: f64) -> Self;
    /// `numerator / denominator`, rounded once per operation; the denominator must not be 0.
    fn from_ratio(numerator: i32, denominator: i32) -> Self;
    /// `millionths` · 10^-6, off by at most two units in the last place: micrometres as metres.
    fn from_millionths(millionths: i32) -> Self;
    /// Nearest `f32`.
    fn to_f32(self) -> f32;
    /// Exact for every implementation.
    fn to_f64(self) -> f64;
    /// The integer nearest to `self` · `factor`, halves away from zero, saturating; NaN gives 0.
    ///
    /// The product may exceed the type's own range: `metres.times_to_i32(1000)` is a length in millimetres.
    fn times_to_i32(self, factor: i32) -> i32;
    /// e^-u of `self` = u ≥ 0, in [0, 1]; a negative u is taken as 0.
    #[must_use]
    fn exp_neg(self) -> Self;
    /// Square root; a negative number gives 0.
    #[must_use]
    fn sqrt(self) -> Self;
    /// √(self² + other²) without intermediate overflow in Q8.24.
    #[must_use]
    fn hypot(self, other: Self) -> Self;
    /// self² + other².
    fn square_sum(self, other: Self) -> Self::Square;
    /// `self` · 2^-`exponent`, exponent in 0..=30; exact in floating point, rounded to nearest in Q8.24.
    #[must_use]
    fn over_power_of_two(self, exponent: u8) -> Self;
    /// |self|.
    #[must_use]
    fn abs(self) -> Self {
        if self < Self::ZERO { -self } else { self }
    }
    /// The smaller of two numbers; `other` if `self` is NaN.
    #[must_use]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    /// The larger of two numbers; `other` if `self` is NaN.
    #[must_use]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    /// `self` limited to [`low`, `high`].
    #[must_use]
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }
}

impl Arithmetic for f32 {
    type Real = f32;
    const ZERO: f32 = 0.0;
    const ONE: f32 = 1.0;
    fn constant(value: f32) -> f32 {
        value
    }
    #[inline]
    fn logistic(self) -> f32 {
        1.0 / (1.0 + exp_f32(-self))
    }
}

#[cfg(not(feature = "micromath"))]
#[inline]
fn exp_f32(x: f32) -> f32 {
    exp::exp(x)
}

/// micromath's approximation of e^x, held to the range where its exponent arithmetic is sound.
#[cfg(feature = "micromath")]
fn exp_f32(x: f32) -> f32 {
    micromath::F32(x.clamp(-80.0, 80.0)).exp().0
}

impl Scalar for f32 {
    const NAME: &'static str = "f32";
    type Square = f32;
    fn from_f32(value: f32) -> f32 {
        value
    }
    fn from_f64(value: f64) -> f32 {
        value as f32
    }
    fn from_millionths(millionths: i32) -> f32 {
        millionths as f32 * 1e-6
    }
    fn from_ratio(numerator: i32, denominator: i32) -> f32 {
        numerator as f32 / denominator as f32
    }
    fn to_f32(self) -> f32 {
        self
    }
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    fn times_to_i32(self, factor: i32) -> i32 {
        // The largest number below 1/2: with 1/2 itself, what is just below it would round up.
        let product = self * factor as f32;
        (product + 0.499_999_97_f32.copysign(product)) as i32
    }
    fn exp_neg(self) -> f32 {
        // Beyond, the result is below the smallest normal number.
        if self > -exp::LOWEST { 0.0 } else { exp_f32(-self.max(0.0)) }
    }
    fn sqrt(self) -> f32 {
        libm::sqrtf(Scalar::max(self, 0.0))
    }
    fn hypot(self, other: f32) -> f32 {
        libm::sqrtf(self.square_sum(other))
    }
    fn square_sum(self, other: f32) -> f32 {
        self * self + other * other
    }
    fn over_power_of_two(self, exponent: u8) -> f32 {
        self * f32::from_bits((127 - u32::from(exponent.min(30))) << 23)
    }
}

impl Arithmetic for f64 {
    type Real = f64;
    const ZERO: f64 = 0.0;
    const ONE: f64 = 1.0;
    fn constant(value: f64) -> f64 {
        value
    }
    fn logistic(self) -> f64 {
        1.0 / (1.0 + libm::exp(-self))
    }
}

impl Scalar for f64 {
    const NAME: &'static str = "f64";
    type Square = f64;
    fn from_f32(value: f32) -> f64 {
        f64::from(value)
    }
    fn from_f64(value: f64) -> f64 {
        value
    }
    fn from_millionths(millionths: i32) -> f64 {
        f64::from(millionths) * 1e-6
    }
    fn from_ratio(numerator: i32, denominator: i32) -> f64 {
        f64::from(numerator) / f64::from(denominator)
    }
    fn to_f32(self) -> f32 {
        self as f32
    }
    fn to_f64(self) -> f64 {
        self
    }
    fn times_to_i32(self, factor: i32) -> i32 {
        libm::round(self * f64::from(factor)) as i32
    }
    fn exp_neg(self) -> f64 {
        libm::exp(-self.max(0.0))
    }
    fn sqrt(self) -> f64 {
        libm::sqrt(Scalar::max(self, 0.0))
    }
    fn hypot(self, other: f64) -> f64 {
        libm::sqrt(self.square_sum(other))
    }
    fn square_sum(self, other: f64) -> f64 {
        self * self + other * other
    }
    fn over_power_of_two(self, exponent: u8) -> f64 {
        self * f64::from_bits((1023 - u64::from(exponent.min(30))) << 52)
    }
}
