//! Q8.24: 8 integer bits (signed), 24 fractional bits, saturating.

use super::division::quotient;
use super::isqrt::isqrt;
use super::{Arithmetic, Scalar};
use core::ops::{Add, Div, Mul, Neg, Sub};
use fixed::types::I8F24;

/// A saturating fixed-point number in [-128, 128 - 2^-24], resolution 2^-24 ≈ 6e-8.
///
/// Products, quotients and halvings are rounded to nearest (halves up), so that a cascade of operations does not drift.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Q8_24(I8F24);

const FRACTION_BITS: u32 = 24;
const ONE_BITS: i32 = 1 << FRACTION_BITS;
const HALF_ULP: i64 = 1 << (FRACTION_BITS - 1);

impl Q8_24 {
    /// The number with the given two's-complement bits: `bits` · 2^-24.
    pub const fn from_bits(bits: i32) -> Self {
        Q8_24(I8F24::from_bits(bits))
    }

    /// The two's-complement bits: value · 2^24.
    pub const fn to_bits(self) -> i32 {
        self.0.to_bits()
    }

    const fn saturating_from_wide(bits: i64) -> Self {
        let low = bits as i32;
        if low as i64 == bits {
            Self::from_bits(low)
        } else {
            Self::from_bits(if bits < 0 { i32::MIN } else { i32::MAX })
        }
    }
}

impl Add for Q8_24 {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Q8_24(self.0.saturating_add(other.0))
    }
}

impl Sub for Q8_24 {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Q8_24(self.0.saturating_sub(other.0))
    }
}

impl Neg for Q8_24 {
    type Output = Self;
    fn neg(self) -> Self {
        Q8_24(self.0.saturating_neg())
    }
}

impl Mul for Q8_24 {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let product = i64::from(self.to_bits()) * i64::from(other.to_bits());
        Self::saturating_from_wide((product + HALF_ULP) >> FRACTION_BITS)
    }
}

impl Div for Q8_24 {
    type Output = Self;
    /// Rounded towards zero; division by zero saturates with the dividend's sign (0 / 0 is 0).
    fn div(self, other: Self) -> Self {
        let [dividend, divisor] = [self, other].map(|number| number.to_bits().unsigned_abs());
        let magnitude = i64::from(quotient(dividend, divisor));
        Self::saturating_from_wide(if (self.to_bits() < 0) == (other.to_bits() < 0) { magnitude } else { -magnitude })
    }
}

/// 1/n! for n = 0 ..= 7, in units of 2^-30.
const EXP_SERIES_Q30: [i32; 8] = {
    const fn rounded(factorial: i32) -> i32 {
        ((1 << 30) + factorial / 2) / factorial
    }
    [1 << 30, 1 << 30, 1 << 29, rounded(6), rounded(24), rounded(120), rounded(720), rounded(5040)]
};

/// Samples of the logistic function per unit of z.
const KNOTS_PER_UNIT_LOG2: u32 = 5;
/// Beyond this z the logistic function rounds to 1 in 24 bits (it does from 17.33 on).
const SATURATED_FROM: usize = 18;
const KNOTS: usize = (SATURATED_FROM << KNOTS_PER_UNIT_LOG2) + 3;
/// `LOGISTIC_KNOTS[i + 1]` = round(2^24 / (1 + e^(-i/32))), i = -1 ..= 577.
static LOGISTIC_KNOTS: [i32; KNOTS] = logistic_knots();

#[expect(clippy::indexing_slicing, reason = "evaluated by the compiler")]
const fn logistic_knots() -> [i32; KNOTS] {
    let step = 1.0 / (1 << KNOTS_PER_UNIT_LOG2) as f64;
    let ratio = 1.0 / exp_series(step);
    let mut decay = exp_series(step);
    let mut knots = [0; KNOTS];
    let mut i = 0;
    while i < KNOTS {
        knots[i] = (ONE_BITS as f64 / (1.0 + decay) + 0.5) as i32;
        decay *= ratio;
        i += 1;
    }
    knots
}

/// e^x for |x| ≤ 1, evaluated by the compiler.
const fn exp_series(x: f64) -> f64 {
    let mut term = 1.0;
    let mut sum = 1.0;
    let mut n = 1;
    while n < 24 {
        term *= x / n as f64;
        sum += term;
        n += 1;
    }
    sum
}

/// σ(z) for z ≥ 0 in units of 2^-24.
///
/// Between two knots: the chord plus the parabola t(1-t)c, with c half the mean second difference at both ends. The
/// polynomial is exact in 64 bits and rounded once, hence monotone; the remainder, below 0.001 h³ at knot spacing
/// h = 1/32, is a fraction of one unit.
fn logistic_of_positive(z: u32) -> i32 {
    const SHIFT: u32 = FRACTION_BITS - KNOTS_PER_UNIT_LOG2;
    let knot = (z >> SHIFT) as usize;
    let Some(&[before, left, right, after]) = LOGISTIC_KNOTS.get(knot..).and_then(|knots| knots.first_chunk::<4>())
    else {
        return ONE_BITS;
    };
    let t = i64::from(z & ((1 << SHIFT) - 1));
    let complement = (1 << SHIFT) - t;
    // Four times c: the mean of two second differences, halved.
    let bulge = i64::from(right + left - before - after);
    let slope = (i64::from(right - left) << (SHIFT + 2)) + complement * bulge;
    let rise = (t * slope + (1 << (2 * SHIFT + 1))) >> (2 * SHIFT + 2);
    left + rise as i32
}

impl Arithmetic for Q8_24 {
    type Real = Self;
    const ZERO: Self = Self::from_bits(0);
    const ONE: Self = Self::from_bits(ONE_BITS);
    fn constant(value: Self) -> Self {
        value
    }
    /// Maximum error 1.5 · 2^-24 over the whole range (tested on every input), monotone, σ(-z) = 1 - σ(z) exactly.
    fn logistic(self) -> Self {
        let positive = logistic_of_positive(self.to_bits().unsigned_abs());
        Self::from_bits(if self.to_bits() < 0 { ONE_BITS - positive } else { positive })
    }
    /// k is mostly 1, and a product takes a third of a logistic function's time.
    #[inline]
    fn sigmoid(self, theta: Self, k: Self) -> Self {
        let z = self - theta;
        if k == Self::ONE { z.logistic() } else { (z * k).logistic() }
    }
}

impl Scalar for Q8_24 {
    const NAME: &'static str = "q8.24";
    type Square = u64;
    fn from_f32(value: f32) -> Self {
        // As below; a product with a power of two is exact.
        let scaled = value * ONE_BITS as f32;
        let whole = scaled as i64;
        let rest = scaled - whole as f32;
        Self::saturating_from_wide(whole.saturating_add(i64::from(rest >= 0.5) - i64::from(rest <= -0.5)))
    }
    fn from_f64(value: f64) -> Self {
        // Halves away from zero, in steps that a compiler evaluates when the value is a constant.
        let scaled = value * f64::from(ONE_BITS);
        let whole = scaled as i64;
        let rest = scaled - whole as f64;
        Self::saturating_from_wide(whole.saturating_add(i64::from(rest >= 0.5) - i64::from(rest <= -0.5)))
    }
    fn from_ratio(numerator: i32, denominator: i32) -> Self {
        let wide = i64::from(numerator) << FRACTION_BITS;
        wide.checked_div(i64::from(denominator)).map_or(Self::ZERO, Self::saturating_from_wide)
    }
    fn from_millionths(millionths: i32) -> Self {
        const PER_MILLION_Q48: i64 = ((1 << 48) + 500_000) / 1_000_000;
        Self::saturating_from_wide((i64::from(millionths) * PER_MILLION_Q48 + HALF_ULP) >> FRACTION_BITS)
    }
    fn to_f32(self) -> f32 {
        self.to_bits() as f32 / ONE_BITS as f32
    }
    fn to_f64(self) -> f64 {
        f64::from(self.to_bits()) / f64::from(ONE_BITS)
    }
    fn times_to_i32(self, factor: i32) -> i32 {
        let product = i64::from(self.to_bits()) * i64::from(factor);
        let magnitude = (product.unsigned_abs() + HALF_ULP.unsigned_abs()) >> FRACTION_BITS;
        let magnitude = i32::try_from(magnitude).unwrap_or(i32::MAX);
        if product < 0 { -magnitude } else { magnitude }
    }
    /// Maximum error 2^-23 (tested).
    ///
    /// e^-u = 2^-n · 2^-f with u·log2(e) = n + f; 2^-f by its Taylor polynomial in f·ln 2 around f = 1/2, in Q2.30.
    fn exp_neg(self) -> Self {
        const LOG2_E_Q30: i64 = 1_549_082_005;
        const LN_2_Q30: i32 = 744_261_118;
        const INV_SQRT_2_Q30: i32 = 759_250_125;
        const HALF_Q30: i32 = 1 << 29;
        let product = |a: i32, b: i32| ((i64::from(a) * i64::from(b)) >> 30) as i32;
        let binary_exponent = i64::from(self.to_bits().max(0)) * LOG2_E_Q30;
        let whole = binary_exponent >> 54;
        if whole > 25 {
            return Self::ZERO;
        }
        let fraction = (binary_exponent >> 24) as i32 & ((1 << 30) - 1);
        let x = product(HALF_Q30 - fraction, LN_2_Q30);
        let [c0, c1, c2, c3, c4, c5, c6, c7] = EXP_SERIES_Q30;
        let sum = |term: i32, tail: i32| term + product(x, tail);
        let series = sum(c0, sum(c1, sum(c2, sum(c3, sum(c4, sum(c5, sum(c6, c7)))))));
        let mantissa = product(series, INV_SQRT_2_Q30);
        let shift = 6 + whole;
        Self::from_bits(((mantissa >> (shift - 1)) + 1) >> 1)
    }
    fn sqrt(self) -> Self {
        let wide = (self.to_bits().max(0) as u64) << FRACTION_BITS;
        Self::from_bits(isqrt(wide) as i32)
    }
    fn hypot(self, other: Self) -> Self {
        Self::saturating_from_wide(i64::from(isqrt(self.square_sum(other))))
    }
    fn square_sum(self, other: Self) -> u64 {
        let square = |v: Self| (i64::from(v.to_bits()) * i64::from(v.to_bits())) as u64;
        square(self) + square(other)
    }
    fn over_power_of_two(self, exponent: u8) -> Self {
        match u32::from(exponent.min(30)).checked_sub(1) {
            None => self,
            Some(all_but_one) => {
                let twice = self.to_bits() >> all_but_one;
                Self::from_bits((twice >> 1) + (twice & 1))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every input: error, monotonicity and symmetry of the sigmoid.
    #[test]
    fn logistic_is_accurate_and_monotone_on_every_input() {
        let mut previous = 0;
        let mut worst = 0.0_f64;
        // The exact value by recurrence between anchors keeps 2^28 inputs affordable; anchors come from libm.
        const BLOCK: i32 = 1 << 12;
        let ratio = libm::exp(-1.0 / f64::from(ONE_BITS));
        for anchor in (0..19 << 24).step_by(BLOCK as usize) {
            let mut decay = libm::exp(-f64::from(anchor) / f64::from(ONE_BITS));
            for z in anchor..anchor + BLOCK {
                let s = Q8_24::from_bits(z).logistic().to_bits();
                assert!(s >= previous, "σ falls from {previous} to {s} at z = {z}");
                previous = s;
                let error = f64::from(s) - f64::from(ONE_BITS) / (1.0 + decay);
                worst = worst.max(error.abs());
                decay *= ratio;
            }
        }
        assert!(worst <= 1.5, "largest error {worst} units of 2^-24");
        for z in [1, 77, 1 << 20, (5 << 24) + 3, i32::MAX] {
            let mirrored = Q8_24::from_bits(-z).logistic().to_bits();
            assert_eq!(mirrored, ONE_BITS - Q8_24::from_bits(z).logistic().to_bits());
        }
        assert_eq!(Q8_24::from_bits(i32::MAX).logistic(), Q8_24::ONE);
        assert_eq!(Q8_24::from_bits(i32::MIN).logistic(), Q8_24::ZERO);
    }

    #[test]
    fn exp_neg_is_within_two_units() {
        for bits in (0..20 << 24).step_by(577) {
            let u = f64::from(bits) / f64::from(ONE_BITS);
            let exact = libm::exp(-u) * f64::from(ONE_BITS);
            let got = f64::from(Q8_24::from_bits(bits).exp_neg().to_bits());
            assert!((got - exact).abs() < 2.0, "e^-{u}: {got} against {exact}");
        }
        assert_eq!(Q8_24::from_bits(-5).exp_neg(), Q8_24::ONE);
        assert_eq!(Q8_24::from_bits(i32::MAX).exp_neg(), Q8_24::ZERO);
    }

    #[test]
    fn operations_saturate_and_round_to_nearest() {
        let big = Q8_24::from_f32(100.0);
        assert_eq!((big * big).to_bits(), i32::MAX);
        assert_eq!((big + big).to_bits(), i32::MAX);
        assert_eq!((-big - big).to_bits(), i32::MIN);
        assert_eq!((big / Q8_24::ZERO).to_bits(), i32::MAX);
        assert_eq!((-big / Q8_24::ZERO).to_bits(), i32::MIN);
        assert_eq!(Q8_24::ZERO / Q8_24::ZERO, Q8_24::ZERO);
        assert_eq!(Q8_24::from_bits(i32::MIN) / -Q8_24::ONE, Q8_24::from_bits(i32::MAX));
        assert_eq!(Q8_24::from_bits(3).over_power_of_two(1).to_bits(), 2);
        assert_eq!(Q8_24::from_bits(-3).over_power_of_two(1).to_bits(), -1);
        assert_eq!(Q8_24::from_f32(f32::NAN), Q8_24::ZERO);
        assert_eq!(Q8_24::from_f32(-2.5).times_to_i32(1), -3);
        assert_eq!(Q8_24::from_f32(1.1).times_to_i32(1000), 1100);
        assert_eq!(big.times_to_i32(i32::MIN), -i32::MAX);
        assert_eq!(Q8_24::from_f32(3.0).hypot(Q8_24::from_f32(-4.0)), Q8_24::from_f32(5.0));
        assert_eq!(Q8_24::from_bits(i32::MIN).hypot(Q8_24::from_bits(i32::MIN)).to_bits(), i32::MAX);
        assert_eq!(Q8_24::from_f32(2.25).sqrt(), Q8_24::from_f32(1.5));
    }
}
