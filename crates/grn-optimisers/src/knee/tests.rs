//! Both measures by hand, the exact integral against sampling, odd fronts, and the knees of DO2DK.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::*;
use crate::problems::do2dk;

#[test]
fn angles_by_hand() {
    // A corner, seen from the ideal point: 3/4 of a turn.
    let a = angles(&[[0.0, 1.0], [1e-12, 1e-12], [1.0, 0.0]], Neighbours::Nearest);
    assert!((a[1] - 1.5 * PI).abs() < 1e-9, "{a:?}");
    // Straight, and the ends against the vertical and the horizontal.
    let a = angles(&[[0.0, 2.0], [1.0, 1.0], [2.0, 0.0]], Neighbours::Nearest);
    assert_eq!(a, [1.25 * PI, PI, 1.25 * PI]);
    // A notch.
    let a = angles(&[[0.0, 1.0], [1.0 - 1e-12, 1.0 - 1e-12], [1.0, 0.0]], Neighbours::Nearest);
    assert!((a[1] - 0.5 * PI).abs() < 1e-9, "{a:?}");
}

#[test]
fn two_neighbours_see_past_a_close_one() {
    // A point just before the knee takes most of the knee's angle away, and more from itself.
    let front = [[0.0, 10.0], [0.95, 3.0], [1.0, 2.9], [10.0, 0.0]];
    let (one, two) = (angles(&front, Neighbours::Nearest), angles(&front, Neighbours::Two));
    assert!(one.iter().zip(&two).all(|(one, two)| one <= two));
    assert!(two[2] > one[2] + 0.1, "{one:?} {two:?}");
}

#[test]
fn utilities_agree_with_sampled_weights() {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    for n in 2..40 {
        let points: Vec<[f64; 2]> = (0..n)
            .map(|_| {
                let t: f64 = rng.random();
                let bend = 1.0 - t.sqrt() + 0.05 * rng.random::<f64>();
                [3.0 * t, 7.0 * bend]
            })
            .collect();
        let front = Front::new(&points);
        let utility = |p: [f64; 2], w: f64| w * p[0] + (1.0 - w) * p[1];
        let steps = 20_000;
        let mut sampled = vec![0.0; front.points.len()];
        for step in 0..steps {
            let w = (f64::from(step) + 0.5) / f64::from(steps);
            let mut by_utility: Vec<(f64, usize)> = front.points.iter().map(|&p| utility(p, w)).zip(0..).collect();
            by_utility.sort_by(|a, b| a.0.total_cmp(&b.0));
            if let [best, second, ..] = by_utility[..] {
                sampled[best.1] += (second.0 - best.0) / f64::from(steps);
            }
        }
        if front.points.len() > 1 {
            for (exact, sampled) in front.losses().iter().zip(sampled) {
                assert!((exact - sampled).abs() < 1e-6, "{exact} {sampled}");
            }
        }
    }
}

type Pick = fn(&[[f64; 2]]) -> Option<usize>;
const PICKS: [Pick; 3] = [
    |points| knee_by_angle(points, Neighbours::Nearest),
    |points| knee_by_angle(points, Neighbours::Two),
    knee_by_utility,
];

#[test]
fn small_fronts_have_defined_knees() {
    for pick in PICKS {
        assert_eq!(pick(&[]), None);
        assert_eq!(pick(&[[f64::NAN, 1.0], [1.0, f64::INFINITY], [f64::MAX, 0.0]]), None);
        assert_eq!(pick(&[[5.0, 5.0]]), Some(0));
        assert_eq!(pick(&[[f64::NAN, 1.0], [5.0, 5.0], [5.0, 5.0]]), Some(1));
        assert_eq!(pick(&[[0.0, 1.0], [1.0, 0.0]]), Some(0));
        assert_eq!(pick(&[[1.0, 0.0], [0.0, 1.0], [0.0, 1.0]]), Some(0));
    }
    assert_eq!(marginal_utilities(&[[5.0, 5.0], [5.0, 5.0], [6.0, 6.0]]), [f64::INFINITY, f64::INFINITY, 0.0]);
    assert_eq!(marginal_utilities(&[[0.0, 9.0], [3.0, 2.0]]), [0.25, 0.25]);
    assert_eq!(angles(&[[2.0, 2.0]], Neighbours::Nearest), [1.5 * PI]);
}

#[test]
fn a_bulge_beats_the_ends_and_a_straight_or_concave_front_has_only_ends() {
    let curve = |bend: f64| -> Vec<[f64; 2]> {
        (0..=10).map(|i| f64::from(i) / 10.0).map(|t| [t, 1.0 - t + bend * t * (1.0 - t)]).collect()
    };
    for pick in PICKS {
        // The ends have larger values on this one, but one-sided ones.
        assert!((1..10).contains(&pick(&curve(-0.01)).unwrap()));
        assert!([0, 10].contains(&pick(&curve(0.0)).unwrap()));
        assert!([0, 10].contains(&pick(&curve(0.5)).unwrap()));
    }
}

#[test]
fn dominated_points_copies_order_and_units_do_not_matter() {
    let front = [[0.0, 10.0], [1.0, 4.0], [2.0, 2.0], [6.0, 1.0], [10.0, 0.0]];
    let more = [
        [10.0, 0.0],
        [2.0, 4.0],
        [2.0, 2.0],
        [f64::NAN, 0.0],
        [1.0, 4.0],
        [2.0, 2.0],
        [6.0, 1.0],
        [0.0, 11.0],
        [-0.0, 10.0],
        [7.0, 1.0],
    ];
    let matching = [Some(4), None, Some(2), None, Some(1), Some(2), Some(3), None, Some(0), None];
    for pick in PICKS {
        assert_eq!(pick(&front), Some(2));
        assert_eq!(pick(&more), Some(2));
        assert_eq!(pick(&front.map(|p| [p[0] * 1e-200, 5.0 - 1e200 * -p[1]])), Some(2));
    }
    for measure in [marginal_utilities as fn(&[[f64; 2]]) -> Vec<f64>, |p| angles(p, Neighbours::Two)] {
        let (plain, values) = (measure(&front), measure(&more));
        for (value, place) in values.into_iter().zip(matching) {
            assert_eq!(value, place.map_or(0.0, |i: usize| plain[i]));
        }
    }
}

#[test]
fn nothing_panics_on_anything() {
    let mut rng = Pcg64Mcg::seed_from_u64(2);
    let odd = [0.0, -0.0, 1.0, f64::NAN, f64::INFINITY, f64::MIN, f64::MAX / 2.0, 5e-324, 1e-308, -1e300];
    for _ in 0..5000 {
        let n = rng.random_range(0..12);
        let points: Vec<[f64; 2]> =
            (0..n).map(|_| [odd[rng.random_range(0..odd.len())], odd[rng.random_range(0..odd.len())]]).collect();
        for pick in PICKS {
            assert!(pick(&points).is_none_or(|i| i < n));
        }
        assert!(marginal_utilities(&points).iter().all(|v| *v >= 0.0));
    }
}

/// The DO2DK front scaled to [0, 1], at even arc length, as a NSGA-II population of `n` would have it.
fn do2dk_front(knees: u32, n: usize) -> Vec<[f64; 2]> {
    let dense: Vec<[f64; 2]> = (0..=200_000).map(|i| do2dk(&[f64::from(i) / 200_000.0], knees, 0.0)).collect();
    let front = Front::new(&dense).points;
    let length = |a: [f64; 2], b: [f64; 2]| libm::hypot(a[0] - b[0], a[1] - b[1]);
    let total: f64 = front.windows(2).map(|w| length(w[0], w[1])).sum();
    let mut picked = vec![front[0]];
    let mut walked = 0.0;
    for pair in front.windows(2) {
        walked += length(pair[0], pair[1]);
        if walked >= total * picked.len() as f64 / (n - 1) as f64 - 1e-12 {
            picked.push(pair[1]);
        }
    }
    picked
}

/// The knees by another definition: points whose distance below the chord that joins the points `reach` along
/// the front on either side is largest among those within `reach`, and at least a tenth of the largest of all.
fn knees_by_chord(front: &[[f64; 2]], reach: usize) -> Vec<[f64; 2]> {
    let depth_at = |i: usize| {
        if i < reach || i + reach >= front.len() {
            return 0.0;
        }
        let (a, b, p) = (front[i - reach], front[i + reach], front[i]);
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        (dy * (p[0] - a[0]) - dx * (p[1] - a[1])) / libm::hypot(dx, dy)
    };
    let depth: Vec<f64> = (0..front.len()).map(depth_at).collect();
    let deepest = depth.iter().copied().fold(0.0, f64::max);
    (reach..front.len() - reach)
        .filter(|&i| depth[i] > deepest / 10.0 && depth[i - reach..=i + reach].iter().all(|d| *d <= depth[i]))
        .map(|i| front[i])
        .collect()
}

#[test]
fn the_knee_of_do2dk_is_one_of_its_knees() {
    for k in 1..=4 {
        let dense = do2dk_front(k, 2001);
        let knees = knees_by_chord(&dense, 60);
        println!("K = {k}: {knees:?}");
        assert_eq!(knees.len(), k as usize, "{knees:?}");
        for n in [51, 101, 201] {
            let front = do2dk_front(k, n);
            for (pick, name) in PICKS.into_iter().zip(["nearest", "two", "utility"]) {
                let [x, y] = front[pick(&front).unwrap()];
                let distance = knees.iter().map(|p| libm::hypot(p[0] - x, p[1] - y)).fold(f64::INFINITY, f64::min);
                println!("K = {k}, n = {n}, {name}: ({x:.3}, {y:.3}), {distance:.4} away");
                assert!(distance < 0.04, "K = {k}, n = {n}, {name}: {distance}");
            }
        }
    }
}

/// Where the scaled DO2DK front bends most, from the curvature `(f1' f2'' - f2' f1'') / |f'|³` of the function itself;
/// the front is symmetric, so the mirrored point does too.
fn sharpest(knees: u32) -> [f64; 2] {
    let scale = do2dk(&[0.0], knees, 0.0)[0];
    let at = |x: f64| do2dk(&[x], knees, 0.0).map(|f| f / scale);
    let step = 1e-4;
    let bend = |x: f64| {
        let (a, b, c) = (at(x - step), at(x), at(x + step));
        let first = [0, 1].map(|m| (c[m] - a[m]) / (2.0 * step));
        let second = [0, 1].map(|m| (c[m] - 2.0 * b[m] + a[m]) / (step * step));
        // Turning right, as x1 walks the front from its lower end, is bulging towards the ideal point.
        (second[0] * first[1] - second[1] * first[0]) / libm::pow(libm::hypot(first[0], first[1]), 3.0)
    };
    let xs = (1..2000).map(|i| f64::from(i) / 2000.0);
    at(xs.max_by(|a, b| bend(*a).total_cmp(&bend(*b))).unwrap())
}

#[test]
fn the_knee_of_do2dk_is_where_it_bends_most() {
    for k in 1..=4 {
        let [x, y] = sharpest(k);
        for n in [51, 101, 201, 401] {
            let front = do2dk_front(k, n);
            for pick in PICKS {
                let p = front[pick(&front).unwrap()];
                let distance = libm::hypot(p[0] - x, p[1] - y).min(libm::hypot(p[0] - y, p[1] - x));
                println!("K = {k}, n = {n}: {p:?}, {distance:.4} from ({x:.4}, {y:.4})");
                assert!(distance < 0.01, "K = {k}, n = {n}: {p:?}, {distance} from ({x}, {y})");
            }
        }
    }
}
