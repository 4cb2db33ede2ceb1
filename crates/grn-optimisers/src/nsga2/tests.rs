//! The fast sort and the crowding are held to their definitions; survival and tournaments to what they promise.

use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use super::*;

const INF: f64 = f64::INFINITY;

/// Ranks by the definition: peel off whoever nothing left dominates.
fn naive<const M: usize>(scores: &[Scores<M>]) -> Vec<u32> {
    let mut ranks = vec![u32::MAX; scores.len()];
    let mut rank = 0;
    while ranks.contains(&u32::MAX) {
        let left: Vec<usize> = (0..scores.len()).filter(|&i| ranks[i] == u32::MAX).collect();
        for &i in &left {
            if !left.iter().any(|&j| scores[j].dominates(&scores[i])) {
                ranks[i] = rank;
            }
        }
        rank += 1;
    }
    ranks
}

/// Scores with many copies, ties, infeasible entries, zeros of both signs, infinities and NaN.
fn nasty<const M: usize>(rng: &mut Pcg64Mcg, n: usize) -> Vec<Scores<M>> {
    let grid = rng.random_range(1..20u32);
    let number = |rng: &mut Pcg64Mcg| match rng.random_range(0..40) {
        0 => f64::NAN,
        1 => -f64::NAN,
        2 => INF,
        3 => -INF,
        4 => -0.0,
        5 => 0.0,
        6..20 => rng.random(),
        _ => f64::from(rng.random_range(0..grid)) - 2.0,
    };
    (0..n)
        .map(|_| Scores {
            objectives: [(); M].map(|()| number(rng)),
            violation: if rng.random_bool(0.6) { 0.0 } else { number(rng) },
        })
        .collect()
}

fn agrees<const M: usize>(rounds: usize) {
    let mut rng = Pcg64Mcg::seed_from_u64(M as u64);
    for round in 0..rounds {
        let scores = nasty::<M>(&mut rng, round % 60);
        let ranks = naive(&scores);
        assert_eq!(sort(&scores), ranks, "{scores:?}");
        let front: Vec<usize> = (0..scores.len()).filter(|&i| ranks[i] == 0).collect();
        assert_eq!(non_dominated(&scores), front);
    }
}

#[test]
fn sorting_agrees_with_the_definition() {
    agrees::<0>(50);
    agrees::<1>(400);
    agrees::<2>(2000);
    agrees::<3>(600);
    agrees::<5>(300);
}

#[test]
fn dominance_is_a_strict_partial_order() {
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    for _ in 0..200 {
        let s = nasty::<2>(&mut rng, 12);
        for a in &s {
            assert!(!a.dominates(a));
            for b in &s {
                assert!(!(a.dominates(b) && b.dominates(a)));
                for c in &s {
                    assert!(!(a.dominates(b) && b.dominates(c)) || a.dominates(c));
                }
            }
        }
    }
}

#[test]
fn debs_rule() {
    let s = |objectives, violation| Scores { objectives, violation };
    assert!(s([9.0], 0.0).dominates(&s([1.0], 0.1)));
    assert!(s([9.0], 0.1).dominates(&s([1.0], 0.2)));
    assert!(s([1.0], 0.2).dominates(&s([9.0], 0.2)));
    assert!(s([9.0], INF).dominates(&s([INF], f64::NAN)));
    assert!(s([9.0], 0.2).dominates(&s([1.0], f64::NAN)));
    assert!(!s([9.0], -1.0).dominates(&s([1.0], 0.0)), "all feasible ones are equally feasible");
    assert!(s([1e300], 0.0).dominates(&s([f64::NAN], 0.0)));
    assert!(!s([0.0], -0.0).dominates(&s([-0.0], 0.0)) && !s([-0.0], 0.0).dominates(&s([0.0], 0.0)));
    assert!(s([0.0], -1.0).is_feasible() && !s([0.0], f64::NAN).is_feasible());
}

fn feasible<const M: usize>(points: &[[f64; M]]) -> Vec<Scores<M>> {
    points.iter().map(|&p| Scores::feasible(p)).collect()
}

#[test]
fn crowding_by_hand() {
    // Ranges 4 and 8. The point in the middle: (4 - 0) / 4 + (8 - 0) / 8.
    let scores = feasible(&[[4.0, 0.0], [1.0, 4.0], [0.0, 8.0]]);
    assert_eq!(crowding(&scores, &sort(&scores)), [INF, 2.0, INF]);
    let scores = feasible(&[[0.0, 8.0], [1.0, 6.0], [2.0, 2.0], [4.0, 0.0], [5.0, 9.0]]);
    let ranks = sort(&scores);
    assert_eq!(ranks, [0, 0, 0, 0, 1]);
    assert_eq!(crowding(&scores, &ranks), [INF, 2.0 / 4.0 + 6.0 / 8.0, 3.0 / 4.0 + 6.0 / 8.0, INF, INF]);
}

#[test]
fn copies_share_one_place() {
    let scores = feasible(&[[4.0, 0.0], [1.0, 4.0], [0.0, 8.0], [1.0, 4.0], [0.0, 8.0], [4.0, 0.0]]);
    assert_eq!(crowding(&scores, &sort(&scores)), [INF, 2.0, INF, 0.0, 0.0, 0.0]);
    assert_eq!(survivors(&scores, 3), [0, 2, 1]);
}

#[test]
fn crowding_is_never_nan_and_ends_are_infinite() {
    let mut rng = Pcg64Mcg::seed_from_u64(9);
    for _ in 0..500 {
        let scores = nasty::<2>(&mut rng, 30);
        let standings = standings(&scores);
        assert!(standings.iter().all(|s| s.crowding >= 0.0));
        for rank in 0..=standings.iter().map(|s| s.rank).max().unwrap_or(0) {
            let infinite = standings.iter().filter(|s| s.rank == rank && s.crowding == INF).count();
            assert!((1..=2).contains(&infinite), "{infinite}");
        }
    }
}

#[test]
fn crowding_does_not_depend_on_units() {
    let mut rng = Pcg64Mcg::seed_from_u64(4);
    let points: Vec<[f64; 2]> = (0..50).map(|_| [rng.random(), rng.random()]).collect();
    let scaled: Vec<[f64; 2]> = points.iter().map(|p| [p[0] * 1024.0, p[1] / 64.0]).collect();
    assert_eq!(standings(&feasible(&points)), standings(&feasible(&scaled)));
}

#[test]
fn survivors_are_best_first_and_never_more_than_there_are() {
    let mut rng = Pcg64Mcg::seed_from_u64(5);
    for n in [0, 1, 7, 40, 100] {
        let scores = nasty::<2>(&mut rng, 40);
        let standings = standings(&scores);
        let kept = survivors(&scores, n);
        assert_eq!(kept.len(), n.min(40));
        for pair in kept.windows(2) {
            let order = standings[pair[0]].cmp_best_first(&standings[pair[1]]);
            assert!(order.then(pair[0].cmp(&pair[1])).is_lt());
        }
        let worst = kept.last().map(|&i| standings[i]);
        let dropped = (0..40).filter(|i| !kept.contains(i));
        assert!(dropped.into_iter().all(|i| worst.is_none_or(|w| w.cmp_best_first(&standings[i]).is_le())));
    }
    assert!(survivors::<2>(&[], 3).is_empty());
}

#[test]
fn tournaments_prefer_the_better_and_toss_for_the_rest() {
    let place = |rank, crowding| Standing { rank, crowding };
    let mut rng = Pcg64Mcg::seed_from_u64(6);
    let mut wins = [0; 5];
    let standings = [place(1, INF), place(0, 1.0), place(0, 2.0), place(0, 1.0), place(2, INF)];
    for _ in 0..10_000 {
        wins[tournament(&mut rng, &standings)] += 1;
    }
    // Of the 20 ordered pairs: 2 beats all; 1 and 3 beat 0 and 4 and share the pair between them; 0 beats 4.
    for (wins, expected) in wins.into_iter().zip([1000, 2500, 4000, 2500, 0]) {
        assert!((i32::abs(wins - expected)) < 150, "{wins} {expected}");
    }
    assert_eq!(tournament(&mut rng, &standings[..1]), 0);
}

#[test]
fn in_a_round_of_tournaments_everyone_enters_once() {
    let place = |rank| Standing { rank, crowding: 1.0 };
    let mut rng = Pcg64Mcg::seed_from_u64(7);
    let standings: Vec<Standing> = (0..10).map(place).collect();
    for _ in 0..100 {
        let winners = tournaments(&mut rng, &standings, 10);
        // Two rounds of five: the best wins twice, the worst never, nobody more than twice.
        let wins = |i| winners.iter().filter(|w| **w == i).count();
        assert_eq!((winners.len(), wins(0), wins(9)), (10, 2, 0));
        assert!((0..10).all(|i| wins(i) <= 2));
        assert_eq!(tournaments(&mut rng, &standings[..3], 7).len(), 7);
    }
    assert_eq!(tournaments(&mut rng, &standings[..1], 3), [0, 0, 0]);
    assert!(tournaments(&mut rng, &[], 0).is_empty());
}

#[test]
fn equal_seed_equal_winners() {
    let scores = nasty::<2>(&mut Pcg64Mcg::seed_from_u64(8), 40);
    let run = || {
        let mut rng = Pcg64Mcg::seed_from_u64(1);
        (0..1000).map(|_| tournament(&mut rng, &standings(&scores))).collect::<Vec<_>>()
    };
    assert_eq!(run(), run());
}
