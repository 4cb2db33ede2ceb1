//! The integer square root, without division: a robot's motion law takes a dozen a tick.

/// Leading bits of a normalised number that the first guess looks at: 7, of which the upper two are not both 0.
const GUESS_SHIFT: u32 = 57;
const FIRST: usize = 32;
const GUESSES: usize = 96;
/// `GUESSES_Q16[i]` ≈ 2^47 / √m for m around (i + 32) · 2^57, within 1 %.
static GUESSES_Q16: [u16; GUESSES] = guesses();

#[expect(clippy::indexing_slicing, reason = "evaluated by the compiler")]
const fn guesses() -> [u16; GUESSES] {
    let mut guesses = [0; GUESSES];
    let mut i = 0;
    while i < GUESSES {
        let middle = (2 * (i + FIRST) as u64 + 1) << (GUESS_SHIFT - 1);
        guesses[i] = ((1 << 47) / middle.isqrt()) as u16;
        i += 1;
    }
    guesses
}

/// ⌊√n⌋.
///
/// √m = m · (1/√m) for the normalised m in [2^62, 2^64): a guess at 2^63/√m from a table, good to 7 bits, two Newton steps
/// y ← y (3 - m y²) / 2, one correction of the product by its own error, and one unit up or down.
pub(super) fn isqrt(n: u64) -> u32 {
    let shift = n.leading_zeros() & !1;
    if shift >= 64 {
        return 0;
    }
    let m = n << shift;
    let index = ((m >> GUESS_SHIFT) as usize).saturating_sub(FIRST);
    let guess = GUESSES_Q16.get(index).copied().unwrap_or(u16::MAX);
    // Factors of 32 bits: a chip multiplies these in one instruction.
    let upper = (m >> 32) as u32;
    let newton = |y: u32| {
        let square = (product(y, y) >> 32) as u32;
        let one_q30 = (product(upper, square) >> 32) as u32;
        narrowed(product(y, (3_u32 << 30).wrapping_sub(one_q30)) >> 31)
    };
    let inverse = newton(newton(u32::from(guess) << 16));
    let estimate = narrowed(product(upper, inverse) >> 31);
    // The estimate is within 100 of the root, so its square's error fits 40 bits.
    let error = m.wrapping_sub(product(estimate, estimate)) as i64;
    let correction = (i64::from((error >> 10) as i32) * i64::from(inverse)) >> 54;
    let mut root = (i64::from(estimate) + correction).clamp(0, i64::from(u32::MAX)) as u32;
    if product(root, root) > m {
        root -= 1;
    }
    if m - product(root, root) > 2 * u64::from(root) {
        root += 1;
    }
    root >> (shift / 2)
}

fn product(a: u32, b: u32) -> u64 {
    u64::from(a) * u64::from(b)
}

fn narrowed(wide: u64) -> u32 {
    u32::try_from(wide).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_exact() {
        let mut state = 1_u64;
        for i in 0..4_000_000_u64 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let number = state >> (i % 64);
            assert_eq!(u64::from(isqrt(number)), number.isqrt(), "{number}");
            // Beside squares, where one unit counts.
            let root = u64::from((state >> 32) as u32 >> (i % 32));
            let square = root * root;
            assert_eq!(u64::from(isqrt(square)), root);
            assert_eq!(u64::from(isqrt(square + 2 * root)), root, "{root}");
            assert_eq!(u64::from(isqrt(square.saturating_sub(1))), root.saturating_sub(1));
        }
        for number in (0..100_000).chain(u64::MAX - 100_000..=u64::MAX) {
            assert_eq!(u64::from(isqrt(number)), number.isqrt(), "{number}");
        }
        // Both ends of every interval of the table.
        for step in 32..128_u64 {
            for number in [step << 57, (step << 57) + ((1 << 57) - 1)] {
                assert_eq!(u64::from(isqrt(number)), number.isqrt(), "{number}");
            }
        }
    }
}
