//! Statistics for comparing stochastic optimisers over repeated runs.
//!
//! Nothing here assumes a distribution: runs are compared by ranks, rates by counting. All functions are
//! deterministic; the one that draws random numbers does so from a fixed seed. Smaller values are better
//! throughout, as in the search.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::cmp::Ordering;

/// The 97.5 % point of the standard normal distribution: 95 % lie within it on both sides.
const Z95: f64 = 1.959_963_984_540_054;
/// The largest product of sample sizes for which [`mann_whitney`] counts arrangements.
const EXACT_PAIRS: usize = 2500;
/// Resamples of [`bootstrap_rate`].
const RESAMPLES: usize = 2000;

/// The three points that cut sorted values into quarters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quartiles {
    /// A quarter of the values lies below.
    pub lower: f64,
    /// Half of the values lies below.
    pub median: f64,
    /// Three quarters of the values lie below.
    pub upper: f64,
}

/// The quartiles by linear interpolation between order statistics, type 7 of Hyndman and Fan (1996), which
/// is the default of R and of numpy. `None` if there are no values or one is not finite.
///
/// ```
/// use grn_optimisers::statistics::quartiles;
/// let q = quartiles(&[7.0, 1.0, 3.0, 10.0]).unwrap();
/// assert_eq!((q.lower, q.median, q.upper), (2.5, 5.0, 7.75));
/// ```
pub fn quartiles(values: &[f64]) -> Option<Quartiles> {
    if values.is_empty() || !values.iter().all(|v| v.is_finite()) {
        return None;
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let [lower, median, upper] = [0.25, 0.5, 0.75].map(|share| quantile(&sorted, share));
    Some(Quartiles { lower, median, upper })
}

/// The type 7 quantile of sorted finite values, at least one, at a share from 0 to 1.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share * (sorted.len() - 1) as f64;
    let below = place as usize;
    let above = (below + 1).min(sorted.len() - 1);
    let part = place - below as f64;
    sorted[below] + (sorted[above] - sorted[below]) * part
}

/// The two-sided p-value, from 0 to 1, of the rank-sum test of Mann and Whitney (1947): how probable it is
/// that two samples from one distribution differ in their ranks at least this much.
///
/// Exact, by the recurrence of that paper, if no two values are equal and there are at most 2500 pairs;
/// else by the normal approximation with corrections for ties and continuity. Infinite values have their
/// rank like any other, so a failed run may be given as infinity. `None` if a sample is empty or holds NaN.
///
/// ```
/// use grn_optimisers::statistics::mann_whitney;
/// assert_eq!(mann_whitney(&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0]), Some(0.1));
/// ```
pub fn mann_whitney(a: &[f64], b: &[f64]) -> Option<f64> {
    if a.is_empty() || b.is_empty() || a.iter().chain(b).any(|v| v.is_nan()) {
        return None;
    }
    let pairs = a.len() * b.len();
    let wins = wins(a, b);
    let least = wins.min(pairs as f64 - wins);
    let ties = ties(a, b);
    let p = match ties == 0.0 && pairs <= EXACT_PAIRS {
        true => 2.0 * exact_tail(a.len(), b.len(), least.round() as usize),
        false => normal_tails(a.len() as f64, b.len() as f64, least, ties),
    };
    Some(p.min(1.0))
}

/// The sum of t³ − t over groups of t equal values: 0 where no two are equal.
fn ties(a: &[f64], b: &[f64]) -> f64 {
    let mut all = [a, b].concat();
    all.sort_by(f64::total_cmp);
    all.chunk_by(|x, y| x == y).map(|equal| equal.len() as f64).map(|t| t * t * t - t).sum()
}

/// The probability that of `n` and `m` values in random order at most `u` pairs are in order. The last value
/// is one of the `n` with probability n / (n + m), and then in order with all `m`.
fn exact_tail(n: usize, m: usize, u: usize) -> f64 {
    // rows[j][k]: the probability of k ordered pairs among i and j values.
    let mut never = vec![0.0; u + 1];
    never[0] = 1.0;
    let mut rows = vec![never; m + 1];
    for i in 1..=n {
        for j in 1..=m {
            let share = i as f64 / (i + j) as f64;
            let (before, rest) = rows.split_at_mut(j);
            for k in (0..=u).rev() {
                let moved = if k >= j { rest[0][k - j] } else { 0.0 };
                rest[0][k] = share * moved + (1.0 - share) * before[j - 1][k];
            }
        }
    }
    rows[m].iter().sum()
}

/// Both tails of the normal approximation for `least` of `n · m` pairs.
fn normal_tails(n: f64, m: f64, least: f64, ties: f64) -> f64 {
    let all = n + m;
    let variance = n * m / 12.0 * (all + 1.0 - ties / (all * (all - 1.0)));
    let distance = n * m / 2.0 - least - 0.5;
    match variance > 0.0 && distance > 0.0 {
        true => libm::erfc(distance / libm::sqrt(2.0 * variance)),
        false => 1.0,
    }
}

/// The effect size A12 of Vargha and Delaney (2000), turned round for minimisation: the probability, from 0
/// to 1, that a value of `a` is *less*, thus better, than one of `b`, ties counted half. 0.5 is no
/// difference; 0.56, 0.64 and 0.71, or as far below, are called small, medium and large. NaN if a sample is
/// empty or holds NaN.
pub fn a12(a: &[f64], b: &[f64]) -> f64 {
    wins(a, b) / (a.len() * b.len()) as f64
}

/// In how many pairs the value of `a` is less, ties counted half: the statistic U. NaN if a value is.
fn wins(a: &[f64], b: &[f64]) -> f64 {
    let score = |(x, y): (&f64, &f64)| match x.partial_cmp(y) {
        Some(Ordering::Less) => 1.0,
        Some(Ordering::Equal) => 0.5,
        Some(Ordering::Greater) => 0.0,
        None => f64::NAN,
    };
    a.iter().flat_map(|x| b.iter().map(move |y| (x, y))).map(score).sum()
}

/// The p-values adjusted for being several by the step-down method of Holm (1979), in the given order: a
/// hypothesis with an adjusted value below α may be rejected with a family-wise error of at most α.
/// Takes and gives values from 0 to 1.
///
/// ```
/// use grn_optimisers::statistics::holm;
/// assert_eq!(holm(&[0.5, 0.01, 0.125]), [0.5, 0.03, 0.25]);
/// ```
pub fn holm(p_values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p_values.len()).collect();
    order.sort_by(|&i, &j| p_values[i].total_cmp(&p_values[j]));
    let mut adjusted = vec![0.0; p_values.len()];
    let mut largest = 0.0_f64;
    for (rank, i) in order.into_iter().enumerate() {
        largest = largest.max((p_values.len() - rank) as f64 * p_values[i]).min(1.0);
        adjusted[i] = largest;
    }
    adjusted
}

/// The 95 % score interval of Wilson (1927), without continuity correction, for the probability behind
/// `successes` of `trials` independent trials. All of 0 to 1 if there are none; more successes than trials
/// count as `trials`.
///
/// ```
/// use grn_optimisers::statistics::wilson;
/// let (low, high) = wilson(97, 100);
/// assert_eq!(format!("{:.1} to {:.1} %", 100.0 * low, 100.0 * high), "91.5 to 99.0 %");
/// ```
pub fn wilson(successes: usize, trials: usize) -> (f64, f64) {
    if trials == 0 {
        return (0.0, 1.0);
    }
    let (n, k) = (trials as f64, successes.min(trials) as f64);
    let (rate, z2) = (k / n, Z95 * Z95);
    let middle = (rate + z2 / (2.0 * n)) / (1.0 + z2 / n);
    let half = Z95 / (1.0 + z2 / n) * libm::sqrt(rate * (1.0 - rate) / n + z2 / (4.0 * n * n));
    let low = if successes == 0 { 0.0 } else { middle - half };
    let high = if successes >= trials { 1.0 } else { middle + half };
    (low, high)
}

/// A 95 % percentile interval of the success rate over a table `outcomes[run][world]`, for runs and worlds
/// that are both samples: the pigeonhole bootstrap (Owen 2007, "The pigeonhole bootstrap", Ann. Appl. Stat.
/// 1), which draws runs and worlds independently, each with replacement, 2000 times.
///
/// A single run is kept and only worlds are drawn. Rows may be short: what is missing is left out of the
/// rate. All of 0 to 1 if there is no outcome. The seed is fixed: equal tables give equal intervals.
pub fn bootstrap_rate(outcomes: &[Vec<bool>]) -> (f64, f64) {
    let (runs, worlds) = (outcomes.len(), outcomes.iter().map(Vec::len).max().unwrap_or(0));
    let mut rng = ChaCha8Rng::seed_from_u64(0);
    let mut rates = Vec::with_capacity(RESAMPLES);
    for _ in 0..RESAMPLES {
        let run_weights = if runs == 1 { vec![1] } else { draw(runs, &mut rng) };
        let world_weights = draw(worlds, &mut rng);
        let (mut good, mut all) = (0, 0);
        for (row, run) in outcomes.iter().zip(run_weights) {
            for (&success, world) in row.iter().zip(&world_weights) {
                all += run * world;
                good += if success { run * world } else { 0 };
            }
        }
        if all > 0 {
            rates.push(good as f64 / all as f64);
        }
    }
    rates.sort_by(f64::total_cmp);
    if rates.is_empty() { (0.0, 1.0) } else { (quantile(&rates, 0.025), quantile(&rates, 0.975)) }
}

/// How often each of `count` things is drawn in as many draws with replacement.
fn draw(count: usize, rng: &mut ChaCha8Rng) -> Vec<u64> {
    let mut times = vec![0; count];
    for _ in 0..count {
        times[rng.random_range(0..count)] += 1;
    }
    times
}

#[cfg(test)]
mod tests;
