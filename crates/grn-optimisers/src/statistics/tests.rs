//! Reference values are from scipy 1.17.1, statsmodels 0.15.0 and numpy 2.4.6, but where a test says so.

use super::*;

const A: [f64; 12] = [0.0, 1.0, 4.0, 9.0, 16.0, 25.0, 5.0, 18.0, 2.0, 19.0, 7.0, 28.0];
const B: [f64; 15] = [8.0, 9.0, 16.0, 35.0, 14.0, 17.0, 21.0, 32.0, 27.0, 12.0, 22.0, 34.0, 25.0, 30.0, 26.0];

/// `count` values in steps of `step`, from `start`.
fn ramp(count: u32, start: f64, step: f64) -> Vec<f64> {
    (0..count).map(|i| start + step * f64::from(i)).collect()
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1e-9), "{found} is not {expected}");
}

/// Samples of 1 to 12 values, many of them equal.
fn samples(count: usize) -> Vec<Vec<f64>> {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut sample = |_| {
        let size = rng.random_range(1..=12);
        (0..size).map(|_| f64::from(rng.random_range(0..20_u8))).collect()
    };
    (0..count).map(&mut sample).collect()
}

#[test]
fn quartiles_are_those_of_numpy() {
    let of = |values: &[f64]| quartiles(values).map(|q| [q.lower, q.median, q.upper]);
    assert_eq!(of(&[7.0, 1.0, 3.0, 10.0]), Some([2.5, 5.0, 7.75]));
    assert_eq!(of(&[4.0]), Some([4.0; 3]));
    let [lower, median, upper] = of(&[2.5, 0.1, 9.0, -4.0, 3.3, 3.4, 8.0]).unwrap();
    near(lower, 1.3);
    near(median, 3.3);
    near(upper, 5.7);
    assert_eq!(of(&[]), None);
    assert_eq!(of(&[1.0, f64::NAN]), None);
    assert_eq!(of(&[1.0, f64::INFINITY]), None);
}

#[test]
fn quartiles_are_in_order_and_within_the_values() {
    for values in samples(200) {
        let q = quartiles(&values).unwrap();
        let (least, most) = values.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
        assert!(least <= q.lower && q.lower <= q.median && q.median <= q.upper && q.upper <= most);
    }
}

#[test]
fn exact_p_values_are_those_of_scipy() {
    let p = |a: &[f64], b: &[f64]| mann_whitney(a, b).unwrap();
    near(p(&[19.0, 22.0, 16.0, 29.0, 24.0], &[20.0, 11.0, 17.0, 12.0]), 0.1111111111111111);
    near(p(&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0, 7.0]), 2.0 / 35.0);
    near(p(&[1.0, 4.0, 5.0], &[2.0, 3.0, 6.0, 7.0, 8.0]), 0.39285714285714285);
    near(p(&ramp(12, 0.0, 1.0), &ramp(15, 3.25, 1.5)), 0.001421318395339125);
    near(p(&ramp(50, 0.0, 1.0), &ramp(50, 9.5, 1.0)), 0.0028083166387707576);
}

#[test]
fn approximate_p_values_are_those_of_scipy() {
    let p = |a: &[f64], b: &[f64]| mann_whitney(a, b).unwrap();
    let (a, b) = ([1.0, 2.0, 2.0, 3.0, 3.0, 3.0, 4.0], [2.0, 3.0, 4.0, 4.0, 5.0, 5.0, 6.0, 6.0]);
    near(p(&a, &b), 0.025144761173357368);
    near(p(&A, &B), 0.011132792031618615);
    near(p(&ramp(60, 0.0, 1.0), &ramp(60, 20.5, 1.0)), 8.747567722893498e-8);
    near(p(&ramp(60, 0.0, 1.0), &ramp(60, 100.0, 1.0)), 3.5565709749847226e-21);
    assert_eq!(p(&[2.0; 4], &[2.0; 5]), 1.0);
}

#[test]
fn p_values_are_bounded_and_symmetric_and_depend_on_ranks_only() {
    let samples = samples(200);
    for (a, b) in samples.iter().zip(&samples[1..]) {
        let p = mann_whitney(a, b).unwrap();
        assert!(p > 0.0 && p <= 1.0, "{p}");
        assert!((p - mann_whitney(b, a).unwrap()).abs() < 1e-12);
        let stretch = |values: &[f64]| values.iter().map(|v| v * v * v - 5.0).collect::<Vec<_>>();
        assert_eq!(mann_whitney(&stretch(a), &stretch(b)), Some(p));
    }
    let apart = |gap: f64| mann_whitney(&ramp(10, 0.0, 1.0), &ramp(10, gap + 0.5, 1.0)).unwrap();
    assert!((0..9).all(|gap| apart(f64::from(gap)) > apart(f64::from(gap) + 1.0)));
}

#[test]
fn a_failed_run_ranks_last_and_nan_or_nothing_has_no_p_value() {
    let (a, b) = (ramp(8, 0.0, 1.0), ramp(8, 0.5, 1.0));
    let failed = |worst: f64| [&b[..7], &[worst]].concat();
    assert_eq!(mann_whitney(&a, &failed(f64::INFINITY)), mann_whitney(&a, &failed(1e9)));
    assert_eq!(mann_whitney(&a, &failed(f64::NAN)), None);
    assert_eq!(mann_whitney(&a, &[]), None);
    assert_eq!(mann_whitney(&[], &b), None);
}

#[test]
fn a12_is_the_share_of_pairs_in_order() {
    near(a12(&A, &B), 0.7916666666666666);
    assert_eq!(a12(&[1.0, 2.0], &[3.0]), 1.0);
    assert_eq!(a12(&[1.0, 3.0], &[3.0]), 0.75);
    assert!(a12(&[], &B).is_nan() && a12(&A, &[f64::NAN]).is_nan());
    for pair in samples(200).windows(2) {
        near(a12(&pair[0], &pair[1]) + a12(&pair[1], &pair[0]), 1.0);
        assert_eq!(a12(&pair[0], &pair[0]), 0.5);
    }
}

#[test]
fn holm_values_are_those_of_statsmodels() {
    let adjusted = holm(&[0.01, 0.04, 0.03, 0.005, 0.03, 0.9]);
    for (found, expected) in adjusted.into_iter().zip([0.05, 0.12, 0.12, 0.03, 0.12, 0.9]) {
        near(found, expected);
    }
    assert!(holm(&[]).is_empty());
    assert_eq!(holm(&[0.2]), [0.2]);
}

#[test]
fn holm_keeps_the_order_and_never_lowers_a_value() {
    for values in samples(200) {
        let p: Vec<f64> = values.iter().map(|v| v / 20.0).collect();
        let adjusted = holm(&p);
        for (i, found) in adjusted.iter().enumerate() {
            assert!(*found >= p[i] && *found <= (p.len() as f64 * p[i]).min(1.0));
            assert!((0..p.len()).all(|j| p[i] > p[j] || *found <= adjusted[j]));
        }
    }
}

#[test]
fn wilson_intervals_are_those_of_scipy() {
    let expected = [
        ((0, 30), (0.0, 0.11351339317396875)),
        ((27, 30), (0.7437891742081592, 0.9654001112526657)),
        ((30, 30), (0.8864866068260312, 1.0)),
        ((5, 9), (0.2666512934954931, 0.8112214789023354)),
        ((500, 1000), (0.4690696003681042, 0.5309303996318958)),
    ];
    for ((successes, trials), (low, high)) in expected {
        let found = wilson(successes, trials);
        near(found.0, low);
        near(found.1, high);
    }
    assert_eq!(wilson(0, 0), (0.0, 1.0));
    assert_eq!(wilson(4, 3), wilson(3, 3));
}

/// Newcombe (1998), "Two-sided confidence intervals for the single proportion", Stat. Med. 17, table I, method 3.
#[test]
fn wilson_intervals_are_those_published() {
    let published = [
        ((81, 263), (0.2553, 0.3662)),
        ((15, 148), (0.0624, 0.1605)),
        ((0, 20), (0.0000, 0.1611)),
        ((1, 29), (0.0061, 0.1718)),
    ];
    for ((successes, trials), (low, high)) in published {
        let found = wilson(successes, trials);
        assert!((found.0 - low).abs() <= 5e-5 && (found.1 - high).abs() <= 5e-5, "{successes} of {trials}: {found:?}");
    }
}

#[test]
fn wilson_intervals_hold_the_rate_rise_with_it_and_mirror() {
    let mut last = (-1.0, 0.0);
    for k in 0..=40 {
        let (low, high) = wilson(k, 40);
        let rate = k as f64 / 40.0;
        assert!(0.0 <= low && low <= rate && rate <= high && high <= 1.0);
        assert!(low > last.0 && high > last.1);
        near(wilson(40 - k, 40).0, 1.0 - high);
        last = (low, high);
    }
}

#[test]
fn bootstrap_of_one_run_or_of_equal_worlds_is_binomial() {
    // The 2.5 % and 97.5 % points of a binomial distribution of 10 trials at 1/2 are 2 and 8 of 10.
    let halves: Vec<bool> = (0..10).map(|i| i % 2 == 0).collect();
    let one_run = bootstrap_rate(std::slice::from_ref(&halves));
    let equal_worlds: Vec<Vec<bool>> = halves.iter().map(|success| vec![*success; 40]).collect();
    for (low, high) in [one_run, bootstrap_rate(&equal_worlds)] {
        near(low, 0.2);
        near(high, 0.8);
    }
}

#[test]
fn bootstrap_is_that_of_a_long_run_in_numpy() {
    // 200,000 resamples there; 2000 here have a standard error of some 0.005.
    let close = |(low, high): (f64, f64), expected: (f64, f64)| {
        assert!((low - expected.0).abs() < 0.02 && (high - expected.1).abs() < 0.02, "{low} {high}");
    };
    let success = |i: usize, j: usize| (7 * i * i + 3 * i * j + 5 * j * j + i) % 11 < 4 + i % 4;
    let table: Vec<Vec<bool>> = (0..10).map(|i| (0..20).map(|j| success(i, j)).collect()).collect();
    close(bootstrap_rate(&table), (0.355, 0.625));
    let row = |i: usize| {
        let worlds = if i.is_multiple_of(3) { 7 } else { 12 };
        (0..worlds).map(|j| (i * j + j * j + i) % 5 < 3).collect()
    };
    let short_rows: Vec<Vec<bool>> = (0..12).map(row).collect();
    close(bootstrap_rate(&short_rows), (0.5096, 0.8211));
}

#[test]
fn bootstrap_has_bounds_and_repeats() {
    assert_eq!(bootstrap_rate(&vec![vec![true; 5]; 4]), (1.0, 1.0));
    assert_eq!(bootstrap_rate(&vec![vec![false; 5]; 4]), (0.0, 0.0));
    assert_eq!(bootstrap_rate(&[]), (0.0, 1.0));
    assert_eq!(bootstrap_rate(&[vec![], vec![]]), (0.0, 1.0));
    let table: Vec<Vec<bool>> = (0..6).map(|i| (0..9).map(|j| (i * j) % 4 == 1).collect()).collect();
    let (low, high) = bootstrap_rate(&table);
    assert!(0.0 <= low && low < high && high <= 1.0);
    assert_eq!(bootstrap_rate(&table), (low, high));
}
