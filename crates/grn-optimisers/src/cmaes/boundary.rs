//! How a search without bounds is folded into a box: coordinate by coordinate, as pycma's `BoundTransform` does.
//!
//! A free coordinate is taken as it is unless it is near a wall or beyond. Within a margin on either side of the wall
//! a parabola with its vertex one margin beyond it leads smoothly to the wall and back; further out everything
//! repeats, mirrored. So the distribution is untouched where the optimum is inside; and an optimum on a wall, where a
//! fitness has a slope, is an ordinary smooth optimum of the free coordinate.

/// The margin as a share of the interval's width.
const MARGIN: f64 = 0.05;

/// The coordinate in `[lo, hi]` for a free one, any finite number.
pub(super) fn fold(free: f64, (lo, hi): (f64, f64)) -> f64 {
    let margin = MARGIN * (hi - lo);
    let (first, last) = (lo - margin, hi + margin);
    let span = last - first;
    if span <= 0.0 {
        return lo;
    }
    // Mirrored at the vertices, which has a period of two spans.
    let beyond = (free - first).rem_euclid(2.0 * span);
    let from_first = beyond.min(2.0 * span - beyond);
    let from_last = span - from_first;
    let x = if from_first < 2.0 * margin {
        lo + from_first * from_first / (4.0 * margin)
    } else if from_last < 2.0 * margin {
        hi - from_last * from_last / (4.0 * margin)
    } else if (lo..=hi).contains(&free) {
        free
    } else {
        first + from_first
    };
    x.max(lo).min(hi)
}

/// A free coordinate that [`fold`]s to `x` in `[lo, hi]`, up to rounding: the nearest.
pub(super) fn unfold(x: f64, (lo, hi): (f64, f64)) -> f64 {
    let margin = MARGIN * (hi - lo);
    if x - lo < margin {
        lo - margin + 2.0 * (margin * (x - lo)).sqrt()
    } else if hi - x < margin {
        hi + margin - 2.0 * (margin * (hi - x)).sqrt()
    } else {
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folding_undoes_unfolding() {
        for ends @ (lo, hi) in [(0.0, 2.0), (-5.0, 5.0), (1e6, 1e6 + 1.0)] {
            for i in 0..=1000 {
                let x = lo + (hi - lo) * f64::from(i) / 1000.0;
                assert!((fold(unfold(x, ends), ends) - x).abs() < 1e-9 * (1.0 + (hi - lo)), "{x}");
            }
            let middle = lo + 0.3 * (hi - lo);
            assert_eq!((fold(middle, ends), unfold(middle, ends)), (middle, middle));
        }
        assert_eq!((fold(7.0, (3.0, 3.0)), unfold(3.0, (3.0, 3.0))), (3.0, 3.0));
    }

    #[test]
    fn folds_are_smooth_mirrors_and_never_leave() {
        let ends = (0.0, 2.0);
        let step = 1e-4;
        let mut last_slope = f64::NAN;
        for i in -100_000..100_000 {
            let free = f64::from(i) * step;
            let x = fold(free, ends);
            assert!((0.0..=2.0).contains(&x), "{free} gives {x}");
            let slope = (fold(free + step, ends) - x) / step;
            // The parabola bends by one over two margins of 0.1.
            assert!(i == -100_000 || (slope - last_slope).abs() < 6.0 * step, "at {free}: {last_slope}, {slope}");
            last_slope = slope;
            assert!((fold(-0.2 - free, ends) - x).abs() < 1e-9, "mirrored at the vertex: {free}");
        }
        for free in [1e300, -1e300, f64::MAX, 1e17] {
            assert!((0.0..=2.0).contains(&fold(free, ends)));
        }
    }
}
