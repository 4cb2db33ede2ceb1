//! Two-objective problems whose best fronts are known, to hold the optimisers to. Vectors have coordinates in
//! [0, 1] (see [`unit_box`]); both objectives are minimised and have no unit.

use core::f64::consts::PI;

use super::bounds::Bounds;

/// `dimension` coordinates in [0, 1]: the box of every problem here.
#[must_use]
pub fn unit_box(dimension: usize) -> Bounds {
    // Zero to one is an interval.
    Bounds::cube(dimension, 0.0, 1.0).unwrap_or_else(|_| unreachable!())
}

/// `1 + 9 mean(x2..xn)`, the distance term of ZDT1-3: 1 on the front.
fn zdt_distance(x: &[f64]) -> f64 {
    let rest = x.get(1..).unwrap_or_default();
    if rest.is_empty() { 1.0 } else { 1.0 + 9.0 * rest.iter().sum::<f64>() / rest.len() as f64 }
}

fn first(x: &[f64]) -> f64 {
    x.first().copied().unwrap_or(0.0)
}

/// ZDT1 (Zitzler, Deb, Thiele 2000): a convex front, `f2 = 1 - sqrt(f1)`. Usually 30 coordinates.
#[must_use]
pub fn zdt1(x: &[f64]) -> [f64; 2] {
    let (f1, g) = (first(x), zdt_distance(x));
    [f1, g * (1.0 - (f1 / g).sqrt())]
}

/// ZDT2: a concave front, `f2 = 1 - f1²`. Usually 30 coordinates.
#[must_use]
pub fn zdt2(x: &[f64]) -> [f64; 2] {
    let (f1, g) = (first(x), zdt_distance(x));
    [f1, g * (1.0 - (f1 / g) * (f1 / g))]
}

/// ZDT3: a front in five pieces, on `f2 = 1 - sqrt(f1) - f1 sin(10 pi f1)`. Usually 30 coordinates.
#[must_use]
pub fn zdt3(x: &[f64]) -> [f64; 2] {
    let (f1, g) = (first(x), zdt_distance(x));
    let h = f1 / g;
    [f1, g * (1.0 - h.sqrt() - h * libm::sin(10.0 * PI * f1))]
}

/// DO2DK (Branke, Deb, Dierolf, Osswald 2004): a front with `knees` bulges. `skew` is the paper's `s`, at least
/// 0, which tilts the front. On the front every coordinate but the first is 0, so `x` of length 1 walks it.
///
/// `g = 1 + 9 mean(x2..xn)`, `r = 5 + 10 (x1 - 0.5)² + cos(2 K pi x1) 2^(s/2) / K`,
/// `f1 = g r (sin(pi x1 / 2^(s+1) + (1 + (2^s - 1) / 2^(s+2)) pi) + 1)`, `f2 = g r (cos(pi x1 / 2 + pi) + 1)`.
#[must_use]
pub fn do2dk(x: &[f64], knees: u32, skew: f64) -> [f64; 2] {
    let (x1, k, g) = (first(x), f64::from(knees), zdt_distance(x));
    let tilt = libm::exp2(skew);
    let d = x1 - 0.5;
    let r = 5.0 + 10.0 * d * d + libm::cos(2.0 * k * PI * x1) * tilt.sqrt() / k;
    let turn = PI * x1 / (2.0 * tilt) + (1.0 + (tilt - 1.0) / (4.0 * tilt)) * PI;
    [g * r * (libm::sin(turn) + 1.0), g * r * (libm::cos(PI * x1 / 2.0 + PI) + 1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fronts_are_where_the_papers_put_them() {
        for i in 0..=20 {
            let f1 = f64::from(i) / 20.0;
            let mut x = vec![0.0; 30];
            x[0] = f1;
            assert!((zdt1(&x)[1] - (1.0 - f1.sqrt())).abs() < 1e-15);
            assert!((zdt2(&x)[1] - (1.0 - f1 * f1)).abs() < 1e-15);
            assert!((zdt3(&x)[1] - (1.0 - f1.sqrt() - f1 * libm::sin(10.0 * PI * f1))).abs() < 1e-15);
            // Away from the front the second objective is worse.
            x[7] = 0.5;
            assert!(zdt1(&x)[1] > 1.0 - f1.sqrt() && zdt2(&x)[1] > 1.0 - f1 * f1);
        }
    }

    #[test]
    fn do2dk_ends_and_middle() {
        // K = 1, s = 0: r is 8.5 at the ends and 4 in the middle.
        let [f1, f2] = do2dk(&[0.0], 1, 0.0);
        assert!((f1 - 8.5).abs() < 1e-12 && f2.abs() < 1e-12);
        let [f1, f2] = do2dk(&[1.0], 1, 0.0);
        assert!(f1.abs() < 1e-12 && (f2 - 8.5).abs() < 1e-12);
        let [f1, f2] = do2dk(&[0.5], 1, 0.0);
        let middle = 4.0 * (1.0 - core::f64::consts::FRAC_1_SQRT_2);
        assert!((f1 - middle).abs() < 1e-12 && (f2 - middle).abs() < 1e-12);
    }

    #[test]
    fn short_vectors_do_not_panic() {
        for x in [&[][..], &[0.5][..]] {
            assert!(zdt1(x).iter().chain(&do2dk(x, 1, 0.0)).all(|f| f.is_finite()));
        }
        assert_eq!(unit_box(3).dimension(), 3);
    }
}
