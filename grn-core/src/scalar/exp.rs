//! e^x in single precision, alike on every machine: only sums, products and integer operations, and no branches, so that
//! a compiler may compute the stages of an integration step side by side.

/// Adding this to a number below 2^22 rounds it to a whole one, which then stands in the sum's last bits.
const TO_WHOLE: f32 = 12_582_912.0;
const EXPONENT_ONE: u32 = 127 << 23;
/// ln 2 in two parts; whole numbers up to 2^7 times the first are exact.
const LN_2_HIGH: f32 = 355.0 / 512.0;
const LN_2_LOW: f32 = -2.121_944_4e-4;
/// (e^r - 1 - r) / r² for |r| ≤ ln 2 / 2, from Cephes' `expf`.
const SERIES: [f32; 6] = [0.5, 1.666_666_5e-1, 4.166_579_6e-2, 8.333_452e-3, 1.398_2e-3, 1.987_569_1e-4];
/// Arguments are limited to these bounds.
pub(super) const LOWEST: f32 = -87.0;
const HIGHEST: f32 = 88.0;

/// e^x for x limited to [-87, 88], off by at most 1.1 units in the last place (tested).
///
/// e^x = 2^n · e^r with n the whole number nearest to x / ln 2.
#[inline]
#[cfg_attr(feature = "micromath", allow(dead_code, reason = "micromath has its own"))]
pub(super) fn exp(x: f32) -> f32 {
    // Written so that NaN passes.
    let limited = if x > HIGHEST { HIGHEST } else { x };
    let limited = if limited < LOWEST { LOWEST } else { limited };
    let shifted = limited * core::f32::consts::LOG2_E + TO_WHOLE;
    let whole = shifted - TO_WHOLE;
    let rest = limited - whole * LN_2_HIGH - whole * LN_2_LOW;
    let [c0, c1, c2, c3, c4, c5] = SERIES;
    let square = rest * rest;
    let series = (c0 + rest * c1) + square * ((c2 + rest * c3) + square * (c4 + rest * c5));
    let mantissa = 1.0 + (rest + square * series);
    let power = f32::from_bits((shifted.to_bits() << 23).wrapping_add(EXPONENT_ONE));
    mantissa * power
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every 17th number of either sign, from the smallest that matter on.
    #[test]
    fn accurate_to_a_unit_and_monotone() {
        let magnitudes = |bound: f32| (0x3200_0000..=bound.to_bits()).step_by(17).map(f32::from_bits);
        let mut previous = 0.0;
        let mut worst = 0.0_f64;
        for x in
            magnitudes(-LOWEST).map(|x| -x).collect::<std::vec::Vec<_>>().into_iter().rev().chain(magnitudes(HIGHEST))
        {
            let (got, exact) = (exp(x), libm::exp(f64::from(x)));
            assert!(got >= previous, "e^{x} = {got} after {previous}");
            previous = got;
            let nearest = exact as f32;
            let unit = f64::from(f32::from_bits(nearest.to_bits() + 1)) - f64::from(nearest);
            worst = worst.max((f64::from(got) - exact).abs() / unit);
        }
        assert!(worst <= 1.1, "largest error {worst} units in the last place");
    }

    #[test]
    fn ends_of_the_range() {
        assert_eq!([0.0, -0.0, -1e-30].map(exp), [1.0; 3]);
        assert_eq!([-87.1, f32::NEG_INFINITY].map(exp), [exp(LOWEST); 2]);
        assert_eq!(exp(f32::INFINITY), exp(HIGHEST));
        assert!(exp(f32::INFINITY).is_finite() && exp(f32::NAN).is_nan());
    }
}
