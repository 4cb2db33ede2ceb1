//! The quotient of two numbers in Q8.24: by two short divisions, which chips have, instead of a long one, which they call
//! a library for.

const FRACTION_BITS: u32 = 24;

/// ⌊`dividend` · 2^24 / `divisor`⌋, or the largest number where that does not fit or the divisor is 0; 0 / 0 is 0.
///
/// Schoolbook division in base 2^16 (Knuth, The Art of Computer Programming, volume 2, algorithm 4.3.1 D): with the divisor
/// normalised, a digit guessed from its upper half is at most 2 too large.
pub(super) fn quotient(dividend: u32, divisor: u32) -> u32 {
    let upper = dividend >> (u32::BITS - FRACTION_BITS);
    if upper >= divisor {
        return if dividend == 0 { 0 } else { u32::MAX };
    }
    // The divisor is not 0 and the quotient fits.
    let shift = divisor.leading_zeros();
    let divisor = divisor << shift;
    let dividend = (u64::from(dividend) << FRACTION_BITS) << shift;
    let (rest, low) = ((dividend >> 32) as u32, dividend as u32);
    let (first, rest) = digit(rest, low >> 16, divisor);
    let (second, _) = digit(rest, low & 0xffff, divisor);
    (first << 16) | second
}

/// One digit of the quotient, and the remainder: (`rest` · 2^16 + `next`) / `divisor`, with `rest` below `divisor`, which
/// is at least 2^31.
fn digit(rest: u32, next: u32, divisor: u32) -> (u32, u32) {
    // Normalised, it has this bit already; a compiler then sees that it is not 0.
    let upper = (divisor >> 16) | 0x8000;
    let mut digit = (rest / upper).min(0xffff);
    let mut left = (i64::from(rest) << 16 | i64::from(next)) - i64::from(digit) * i64::from(divisor);
    while left < 0 {
        digit -= 1;
        left += i64::from(divisor);
    }
    (digit, left as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotients_are_exact() {
        let exact = |dividend: u32, divisor: u32| {
            let wide = (u64::from(dividend) << FRACTION_BITS).checked_div(u64::from(divisor));
            wide.map_or(if dividend == 0 { 0 } else { u32::MAX }, |wide| u32::try_from(wide).unwrap_or(u32::MAX))
        };
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 32) as u32
        };
        for i in 0..4_000_000 {
            let (dividend, divisor) = (random() >> (i % 32), random() >> (i / 32 % 32));
            assert_eq!(quotient(dividend, divisor), exact(dividend, divisor), "{dividend} / {divisor}");
        }
        let edges =
            [0, 1, 2, 3, 0xff, 0x100, 0x7fff, 0x8000, 0xffff, 0x1_0000, 0x1_0001, 1 << 24, 0x7fff_ffff, 1 << 31];
        let edges = edges.into_iter().chain([u32::MAX, u32::MAX - 1, 0xffff_0000, 0x8000_ffff, 0xfffe_ffff]);
        for dividend in edges.clone() {
            for divisor in edges.clone() {
                assert_eq!(quotient(dividend, divisor), exact(dividend, divisor), "{dividend} / {divisor}");
            }
        }
    }
}
