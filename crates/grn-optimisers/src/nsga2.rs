//! The pieces of NSGA-II (Deb, Pratap, Agarwal, Meyarivan 2002) that do not depend on what an individual is:
//! constrained dominance, non-dominated sorting, crowding, survival, the binary tournament.
//!
//! Everything works on a slice of [`Scores`] and answers with indices into it. One generation is: score parents
//! and offspring together, keep [`survivors`], draw the next parents with [`tournament`] or [`tournaments`].
//!
//! [`real::minimise`](super::real::minimise) puts them together for real vectors.

use core::cmp::Ordering;

use rand::seq::SliceRandom;
use rand::{Rng, RngExt};

/// What an evaluation gives: `M` objectives to be minimised, and by how much the constraints are violated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scores<const M: usize> {
    /// Smaller is better; NaN counts as positive infinity.
    pub objectives: [f64; M],
    /// 0 for a feasible solution; larger is worse. Below 0 counts as 0, NaN as positive infinity.
    pub violation: f64,
}

/// A number as it is compared: NaN is positive infinity, and there is one zero. Equal keys have equal bits.
fn key(x: f64) -> f64 {
    if x.is_nan() { f64::INFINITY } else { x + 0.0 }
}

impl<const M: usize> Scores<M> {
    /// The scores of a feasible solution.
    #[must_use]
    pub fn feasible(objectives: [f64; M]) -> Self {
        Self { objectives, violation: 0.0 }
    }

    /// Whether no constraint is violated.
    #[must_use]
    pub fn is_feasible(&self) -> bool {
        self.violation <= 0.0
    }

    /// The scores as they are compared, every field a [`key`].
    fn keys(&self) -> Self {
        // Not `max`, which would turn NaN into 0.
        let violation = if self.violation < 0.0 { 0.0 } else { self.violation };
        Self { objectives: self.objectives.map(key), violation: key(violation) }
    }

    /// Deb's rule: the lesser violation wins, so feasible beats infeasible; at equal violation, Pareto
    /// dominance (nowhere worse, somewhere better). Nothing dominates itself or its copy.
    ///
    /// With one objective this is a total order: `!b.dominates(a)` says that `a` is at least as good as `b`.
    ///
    /// ```
    /// use grn_optimisers::nsga2::Scores;
    /// let good = Scores::feasible([1.0, 2.0]);
    /// assert!(good.dominates(&Scores::feasible([1.0, 3.0])));
    /// assert!(good.dominates(&Scores { objectives: [0.0, 0.0], violation: 0.1 }));
    /// assert!(!good.dominates(&Scores::feasible([2.0, 1.0])));
    /// ```
    #[must_use]
    pub fn dominates(&self, other: &Self) -> bool {
        let (a, b) = (self.keys(), other.keys());
        a.violation < b.violation || (a.violation == b.violation && pareto(&a.objectives, &b.objectives))
    }

    /// Lexicographic by violation and then objectives, on keys. A dominator always comes before what it dominates.
    fn cmp_keys(&self, other: &Self) -> Ordering {
        let start = self.violation.total_cmp(&other.violation);
        self.objectives.iter().zip(&other.objectives).fold(start, |order, (a, b)| order.then_with(|| a.total_cmp(b)))
    }
}

/// Whether `a` is nowhere worse than `b` and somewhere better. Of keys.
fn pareto<const M: usize>(a: &[f64; M], b: &[f64; M]) -> bool {
    let pairs = || a.iter().zip(b);
    pairs().all(|(a, b)| a <= b) && pairs().any(|(a, b)| a < b)
}

/// Where an individual stands among the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// The front it is in: 0 for the non-dominated, then those that only front 0 dominates, and so on.
    pub rank: u32,
    /// How much room it has in its front, from 0; infinite at the ends. More is better.
    pub crowding: f64,
}

impl Standing {
    /// Better first: lower rank, then more room.
    #[must_use]
    pub fn cmp_best_first(&self, other: &Self) -> Ordering {
        self.rank.cmp(&other.rank).then_with(|| other.crowding.total_cmp(&self.crowding))
    }
}

/// The rank of every entry by non-dominated sorting under [`Scores::dominates`]: 0 if nothing dominates it,
/// else one more than the highest rank among its dominators.
///
/// Entries are sorted once; then each finds its front by binary search, because a front that holds a dominator
/// comes after fronts that hold one too. For two objectives one comparison settles a front, so the whole is
/// O(n log n) (Jensen 2003); otherwise it may have to look at the whole front (ENS-BS, Zhang et al. 2015),
/// O(M n²) at worst.
#[must_use]
pub fn sort<const M: usize>(scores: &[Scores<M>]) -> Vec<u32> {
    ranks(&in_order(scores))
}

/// Keys and indices, by violation, then objectives, then index.
fn in_order<const M: usize>(scores: &[Scores<M>]) -> Vec<(Scores<M>, usize)> {
    let mut sorted: Vec<(Scores<M>, usize)> = scores.iter().map(Scores::keys).zip(0..).collect();
    sorted.sort_unstable_by(|(a, i), (b, j)| a.cmp_keys(b).then(i.cmp(j)));
    sorted
}

/// The rank of every entry, by index.
fn ranks<const M: usize>(sorted: &[(Scores<M>, usize)]) -> Vec<u32> {
    let mut ranks = vec![0; sorted.len()];
    // Each distinct violation is a world of its own, whose first front follows the last front of the one before.
    let mut first_rank = 0;
    for group in sorted.chunk_by(|(a, _), (b, _)| a.violation == b.violation) {
        first_rank += if M == 2 { sweep(group, first_rank, &mut ranks) } else { peel(group, first_rank, &mut ranks) };
    }
    ranks
}

/// Ranks a sorted group of equal violation in two objectives, and says how many fronts it has.
fn sweep<const M: usize>(group: &[(Scores<M>, usize)], first_rank: u32, ranks: &mut [u32]) -> u32 {
    // The least second objective in each front so far; it never decreases from one front to the next. Whoever is
    // already in a front has a first objective no larger, so the front dominates exactly from its least upwards.
    let mut least: Vec<f64> = Vec::new();
    for copies in group.chunk_by(|(a, _), (b, _)| a.objectives == b.objectives) {
        let second = copies[0].0.objectives.get(1).copied().unwrap_or(0.0);
        let front = least.partition_point(|&least| least <= second);
        match least.get_mut(front) {
            Some(least) => *least = second,
            None => least.push(second),
        }
        copies.iter().for_each(|(_, index)| ranks[*index] = first_rank + front as u32);
    }
    least.len() as u32
}

/// Ranks a sorted group of equal violation in any number of objectives, and says how many fronts it has.
fn peel<const M: usize>(group: &[(Scores<M>, usize)], first_rank: u32, ranks: &mut [u32]) -> u32 {
    let mut fronts: Vec<Vec<&[f64; M]>> = Vec::new();
    for copies in group.chunk_by(|(a, _), (b, _)| a.objectives == b.objectives) {
        let objectives = &copies[0].0.objectives;
        // The most recent members are the closest, so the likeliest dominators.
        let front = fronts.partition_point(|front| front.iter().rev().any(|other| pareto(other, objectives)));
        match fronts.get_mut(front) {
            Some(front) => front.push(objectives),
            None => fronts.push(vec![objectives]),
        }
        copies.iter().for_each(|(_, index)| ranks[*index] = first_rank + front as u32);
    }
    fronts.len() as u32
}

/// The crowding distance of every entry within its front, given the entries' `ranks` (as [`sort`] gives them).
///
/// In each objective the two ends of a front get infinity, and one in between gets the gap between its two
/// neighbours divided by the front's range; the sum over objectives is the distance. Two cases the paper leaves
/// open: copies (equal objectives) count as one point, whose distance the first copy by index gets while the
/// others get 0 (Fortin and Parizeau 2013), so a front of one or two distinct points has infinity at each;
/// and an objective whose range is not finite adds nothing but its two ends. Equal values stay in index order.
///
/// # Panics
/// If `ranks` is shorter than `scores`.
#[must_use]
pub fn crowding<const M: usize>(scores: &[Scores<M>], ranks: &[u32]) -> Vec<f64> {
    crowding_in_order(&in_order(scores), ranks)
}

/// [`crowding`] of sorted entries.
fn crowding_in_order<const M: usize>(sorted: &[(Scores<M>, usize)], ranks: &[u32]) -> Vec<f64> {
    let mut keys = vec![[0.0; M]; sorted.len()];
    sorted.iter().for_each(|(scores, index)| keys[*index] = scores.objectives);
    let mut distances = vec![0.0; sorted.len()];
    let mut order: Vec<usize> = sorted.iter().map(|(_, index)| *index).collect();
    // Fronts one after the other, each by objectives and then index: entries of one rank have one violation.
    order.sort_by_key(|&i| ranks[i]);
    order.dedup_by(|later, first| ranks[*later] == ranks[*first] && keys[*later] == keys[*first]);
    for front in order.chunk_by_mut(|&a, &b| ranks[a] == ranks[b]) {
        if M == 0 {
            front.iter().for_each(|&i| distances[i] = f64::INFINITY);
        }
        for m in 0..M {
            add_gaps(&keys, front, m, &mut distances);
        }
    }
    distances
}

/// Adds to the distances of the entries in `front` their gaps in objective `m`, and infinity to its two ends.
fn add_gaps<const M: usize>(keys: &[[f64; M]], front: &mut [usize], m: usize, distances: &mut [f64]) {
    // Fronts come in order of the first objective.
    if m > 0 {
        front.sort_unstable_by(|&a, &b| keys[a][m].total_cmp(&keys[b][m]).then(a.cmp(&b)));
    }
    let (Some(&first), Some(&last)) = (front.first(), front.last()) else {
        return;
    };
    let range = keys[last][m] - keys[first][m];
    if range > 0.0 && range.is_finite() {
        for three in front.windows(3) {
            distances[three[1]] += (keys[three[2]][m] - keys[three[0]][m]) / range;
        }
    }
    distances[first] = f64::INFINITY;
    distances[last] = f64::INFINITY;
}

/// [`sort`] and [`crowding`] of every entry.
#[must_use]
pub fn standings<const M: usize>(scores: &[Scores<M>]) -> Vec<Standing> {
    let sorted = in_order(scores);
    let ranks = ranks(&sorted);
    let distances = crowding_in_order(&sorted, &ranks);
    ranks.into_iter().zip(distances).map(|(rank, crowding)| Standing { rank, crowding }).collect()
}

/// The indices of the `n` best, or of all if there are fewer: best first, equals in index order.
#[must_use]
pub fn best(standings: &[Standing], n: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..standings.len()).collect();
    order.sort_unstable_by(|&a, &b| standings[a].cmp_best_first(&standings[b]).then(a.cmp(&b)));
    order.truncate(n);
    order
}

/// NSGA-II survival: the indices of the `n` best by rank and then crowding (computed before anything is
/// removed), or of all if there are fewer; best first, equals in index order.
#[must_use]
pub fn survivors<const M: usize>(scores: &[Scores<M>], n: usize) -> Vec<usize> {
    best(&standings(scores), n)
}

/// The binary tournament: two different entries are drawn, the one of lower rank wins, then the one with more
/// room, and a coin settles the rest. With a single entry, that one, and nothing is drawn.
///
/// # Panics
/// If `standings` is empty.
pub fn tournament<R: Rng + ?Sized>(rng: &mut R, standings: &[Standing]) -> usize {
    let n = standings.len();
    assert!(n > 0, "a tournament needs an entrant");
    if n == 1 {
        return 0;
    }
    let a = rng.random_range(0..n);
    let other = rng.random_range(0..n - 1);
    duel(rng, standings, a, if other >= a { other + 1 } else { other })
}

/// The winners of `n` binary tournaments in which everyone enters equally often, as in Deb's own code: the
/// entries are shuffled and meet in pairs, and again when all have met (of an odd number one sits out each
/// round). The best cannot be missed by bad luck, which steadies a small population. With a single entry, `n`
/// times that one, and nothing is drawn.
///
/// # Panics
/// If `standings` is empty and `n` is not 0.
pub fn tournaments<R: Rng + ?Sized>(rng: &mut R, standings: &[Standing], n: usize) -> Vec<usize> {
    assert!(n == 0 || !standings.is_empty(), "a tournament needs an entrant");
    if standings.len() == 1 {
        return vec![0; n];
    }
    let mut order: Vec<usize> = (0..standings.len()).collect();
    let mut winners = Vec::with_capacity(n);
    while winners.len() < n {
        order.shuffle(rng);
        for pair in order.chunks_exact(2).take(n - winners.len()) {
            winners.push(duel(rng, standings, pair[0], pair[1]));
        }
    }
    winners
}

/// The better of two entries, or either by a coin.
fn duel<R: Rng + ?Sized>(rng: &mut R, standings: &[Standing], a: usize, b: usize) -> usize {
    match standings[a].cmp_best_first(&standings[b]) {
        Ordering::Less => a,
        Ordering::Greater => b,
        Ordering::Equal if rng.random::<bool>() => a,
        Ordering::Equal => b,
    }
}

/// The indices, ascending, of the entries that no other dominates under [`Scores::dominates`]. Copies are all
/// kept. If nothing is feasible these are among the least violated: look at [`Scores::is_feasible`].
#[must_use]
pub fn non_dominated<const M: usize>(scores: &[Scores<M>]) -> Vec<usize> {
    sort(scores).into_iter().zip(0..).filter(|&(rank, _)| rank == 0).map(|(_, index)| index).collect()
}

#[cfg(test)]
mod tests;
