//! The exact area dominated by a two-objective front.

/// The area of the region that some point dominates and that lies below `reference` in both objectives
/// (Zitzler and Thiele 1998, the hypervolume, both objectives minimised), in the product of the objectives'
/// units; by one sweep over the points sorted by the first objective.
///
/// Points may come in any order, may be dominated or repeated. Those not below `reference` in both objectives
/// add nothing; those with a coordinate that is not finite are ignored.
///
/// ```
/// use grn_optimisers::hypervolume::hypervolume;
/// // Three unit squares of the four below (2, 2).
/// assert_eq!(hypervolume(&[[0.0, 1.0], [1.0, 0.0]], [2.0, 2.0]), 3.0);
/// ```
#[must_use]
pub fn hypervolume(points: &[[f64; 2]], reference: [f64; 2]) -> f64 {
    let mut below: Vec<[f64; 2]> = points
        .iter()
        .copied()
        .filter(|p| p.iter().zip(&reference).all(|(x, limit)| x.is_finite() && x < limit))
        .collect();
    below.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut ceiling = reference[1];
    let mut area = 0.0;
    for [x, y] in below {
        if y < ceiling {
            area += (reference[0] - x) * (ceiling - y);
            ceiling = y;
        }
    }
    area
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::*;

    #[test]
    fn empty_and_outside_points_dominate_nothing() {
        assert_eq!(hypervolume(&[], [1.0, 1.0]), 0.0);
        assert_eq!(hypervolume(&[[1.0, 0.0], [0.0, 1.0], [2.0, -3.0]], [1.0, 1.0]), 0.0);
        assert_eq!(hypervolume(&[[f64::NAN, 0.0], [f64::NEG_INFINITY, 0.0]], [1.0, 1.0]), 0.0);
        assert_eq!(hypervolume(&[[0.0, 0.0]], [f64::NAN, 1.0]), 0.0);
    }

    #[test]
    fn dominated_and_repeated_points_add_nothing() {
        let front = [[0.0, 2.0], [1.0, 1.0], [2.0, 0.0]];
        assert_eq!(hypervolume(&front, [3.0, 3.0]), 6.0);
        let more = [[2.0, 0.0], [1.0, 1.0], [1.0, 1.0], [0.0, 2.0], [2.5, 0.5], [1.0, 2.0]];
        assert_eq!(hypervolume(&more, [3.0, 3.0]), 6.0);
    }

    #[test]
    fn agrees_with_counting_cells() {
        let mut rng = Pcg64Mcg::seed_from_u64(7);
        for _ in 0..200 {
            let n = rng.random_range(0..12);
            let points: Vec<[f64; 2]> = (0..n).map(|_| [0, 1].map(|_| f64::from(rng.random_range(0..10u32)))).collect();
            let cells = (0..8)
                .flat_map(|x| (0..8).map(move |y| [f64::from(x), f64::from(y)]))
                .filter(|c| points.iter().any(|p| p[0] <= c[0] && p[1] <= c[1]))
                .count();
            assert_eq!(hypervolume(&points, [8.0, 8.0]), cells as f64);
        }
    }
}
