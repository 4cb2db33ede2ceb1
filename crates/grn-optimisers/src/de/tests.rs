//! Exact numbers of evaluations, rejected arguments, equal logs, and the sphere.

use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use super::*;
use crate::nsga2::Scores;

fn sphere(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum()
}

/// A run with the log of everything it evaluated.
fn logged(settings: &Settings, bounds: &Bounds, initial: &[Vec<f64>], seed: u64) -> (Outcome<f64>, Vec<Vec<f64>>) {
    let mut log = Vec::new();
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let outcome = minimise(
        settings,
        bounds,
        initial,
        &mut rng,
        |x, _| {
            log.push(x.to_vec());
            sphere(x)
        },
        at_most,
    );
    (outcome.unwrap(), log)
}

#[test]
fn ten_and_one_generation_is_twenty_evaluations() {
    let settings = Settings::new(10, 0.5, 0.9, 1).unwrap();
    let bounds = Bounds::cube(3, 0.0, 2.0).unwrap();
    let (outcome, log) = logged(&settings, &bounds, &[], 1);
    assert_eq!((outcome.evaluations, log.len(), settings.evaluations()), (20, 20, 20));
    assert!(log.iter().all(|x| bounds.contain(x)));
    let least = log.iter().map(|x| sphere(x)).fold(f64::INFINITY, f64::min);
    assert_eq!(outcome.fitness, least);
    assert_eq!(sphere(&outcome.best), least);
}

#[test]
fn a_budget_ends_a_run_anywhere_and_changes_nothing_before() {
    let settings = Settings::new(10, 0.5, 0.9, 3).unwrap();
    let bounds = Bounds::cube(2, -1.0, 1.0).unwrap();
    let (_, whole) = logged(&settings, &bounds, &[], 2);
    assert_eq!(whole.len(), 40);
    for budget in 1..=45 {
        let (outcome, log) = logged(&settings.within(budget).unwrap(), &bounds, &[], 2);
        assert_eq!(outcome.evaluations, budget.min(40));
        assert_eq!(log, whole[..budget.min(40)]);
        let least = log.iter().map(|x| sphere(x)).fold(f64::INFINITY, f64::min);
        assert_eq!(outcome.fitness, least, "the last evaluations count too");
    }
}

#[test]
fn no_generation_and_no_coordinate() {
    let bounds = Bounds::cube(2, -1.0, 1.0).unwrap();
    let (outcome, _) = logged(&Settings::new(4, 0.5, 0.9, 0).unwrap(), &bounds, &[], 3);
    assert_eq!(outcome.evaluations, 4);
    let settings = Settings::new(10, 0.5, 0.9, 5).unwrap();
    let (outcome, log) = logged(&settings, &Bounds::cube(0, 0.0, 1.0).unwrap(), &[vec![]], 3);
    assert_eq!((outcome.evaluations, log.len(), outcome.best.len()), (1, 1, 0));
}

#[test]
fn initial_vectors_come_first_and_the_rest_are_drawn() {
    let settings = Settings::new(6, 0.5, 0.9, 2).unwrap();
    let bounds = Bounds::cube(2, -1.0, 1.0).unwrap();
    let initial = [vec![1.0, -1.0], vec![0.0, 0.0]];
    let (outcome, log) = logged(&settings, &bounds, &initial, 4);
    assert_eq!(log[..2], initial);
    assert!(log[2..6].iter().all(|x| bounds.contain(x) && !initial.contains(x)));
    assert_eq!((outcome.best, outcome.fitness), (vec![0.0, 0.0], 0.0), "the optimum given is kept");
}

#[test]
fn bad_arguments_are_rejected_before_any_evaluation() {
    let new = Settings::new;
    assert_eq!(new(3, 0.5, 0.9, 1), Err(SettingsError::Population(3)));
    assert_eq!(new(4, 0.0, 0.9, 1), Err(SettingsError::Weight(0.0)));
    assert_eq!(new(4, 2.1, 0.9, 1), Err(SettingsError::Weight(2.1)));
    assert!(matches!(new(4, f64::NAN, 0.9, 1), Err(SettingsError::Weight(_))));
    assert_eq!(new(4, 0.5, -0.1, 1), Err(SettingsError::Crossover(-0.1)));
    assert_eq!(new(4, 0.5, 1.1, 1), Err(SettingsError::Crossover(1.1)));
    assert!(matches!(new(4, 0.5, f64::NAN, 1), Err(SettingsError::Crossover(_))));
    assert_eq!(new(4, 0.5, 0.9, usize::MAX), Err(SettingsError::Generations(usize::MAX)));
    let settings = new(4, 0.5, 0.9, 1).unwrap();
    assert_eq!(settings.within(0), Err(SettingsError::Budget));

    let bounds = Bounds::cube(2, 0.0, 1.0).unwrap();
    let run = |initial: &[Vec<f64>]| {
        let mut rng = Pcg64Mcg::seed_from_u64(1);
        minimise(&settings, &bounds, initial, &mut rng, |_, _| unreachable!(), at_most).unwrap_err()
    };
    let inside = vec![0.5, 0.5];
    assert_eq!(run(&vec![inside.clone(); 5]), InitialError::TooMany { given: 5, population: 4 });
    assert_eq!(run(&[inside.clone(), vec![0.5]]), InitialError::Length { vector: 1, length: 1, expected: 2 });
    let outside = InitialError::Outside { vector: 1, coordinate: 1, value: 1.5 };
    assert_eq!(run(&[inside.clone(), vec![0.5, 1.5]]), outside);
    assert_eq!(outside.to_string(), "initial vector 1: coordinate 1 is 1.5, out of bounds");
    assert!(matches!(run(&[vec![f64::NAN, 0.0]]), InitialError::Outside { .. }));
}

#[test]
fn equal_seed_equal_log() {
    let settings = Settings::new(10, 0.5, 0.9, 10).unwrap();
    let bounds = Bounds::cube(5, 0.0, 2.0).unwrap();
    assert_eq!(logged(&settings, &bounds, &[], 5), logged(&settings, &bounds, &[], 5));
    assert_ne!(logged(&settings, &bounds, &[], 5).1, logged(&settings, &bounds, &[], 6).1);
}

#[test]
fn trials_stay_in_the_box_and_off_its_walls() {
    // The optimum lies beyond a corner and the weight is large: most mutants leave the box.
    let settings = Settings::new(20, 1.5, 1.0, 50).unwrap();
    let bounds = Bounds::new(vec![(0.0, 1.0), (-3.0, -2.0), (7.0, 7.0)]).unwrap();
    let mut rng = Pcg64Mcg::seed_from_u64(7);
    let mut walls = 0;
    let evaluate = |x: &[f64], _: Option<&f64>| {
        assert!(bounds.contain(x), "{x:?}");
        walls += usize::from(x[0] == 0.0 || x[0] == 1.0);
        sphere(x)
    };
    let outcome = minimise(&settings, &bounds, &[], &mut rng, evaluate, at_most).unwrap();
    assert!(outcome.best[0] < 1e-3 && outcome.best[1] > -2.001 && outcome.best[2] == 7.0);
    assert!(walls < 20, "{walls} of 1020 trials on a wall");
}

#[test]
fn nan_is_worst_and_does_not_stick() {
    let settings = Settings::new(10, 0.5, 0.9, 30).unwrap();
    let bounds = Bounds::cube(2, -1.0, 1.0).unwrap();
    let half = |x: &[f64], _: Option<&f64>| if x[0] < 0.0 { f64::NAN } else { sphere(x) };
    for seed in 0..20 {
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let outcome = minimise(&settings, &bounds, &[], &mut rng, half, at_most).unwrap();
        assert!(outcome.fitness < 0.1, "{}", outcome.fitness);
    }
    assert!(at_most(&1.0, &f64::NAN) && !at_most(&f64::NAN, &1.0) && at_most(&f64::NAN, &f64::NAN));
}

/// Evaluations until the 10-D sphere in [-5.12, 5.12] is at most 1e-8, in pagmo's `de` (pygmo 2.20.0, variant 7, which
/// is rand/1/bin, F 0.5, CR 0.9, 50 vectors, seeds 1 to 51): quartiles. It counts whole generations.
const PAGMO: [usize; 3] = [10_650, 10_900, 11_150];

#[test]
fn the_sphere_takes_as_many_evaluations_as_in_pagmo() {
    let settings = Settings::new(50, 0.5, 0.9, 400).unwrap();
    let bounds = Bounds::cube(10, -5.12, 5.12).unwrap();
    let mut counts: Vec<usize> = (0..51)
        .map(|seed| {
            let (_, log) = logged(&settings, &bounds, &[], seed);
            (1 + log.iter().position(|x| sphere(x) <= 1e-8).unwrap()).next_multiple_of(50)
        })
        .collect();
    counts.sort_unstable();
    println!("evaluations to 1e-8: {:?}, pagmo's {PAGMO:?}", [counts[12], counts[25], counts[38]]);
    assert!((PAGMO[0]..=PAGMO[2]).contains(&counts[25]), "{counts:?}");
}

#[test]
fn debs_rule_finds_a_constrained_minimum() {
    // Least x² + y² with x + y >= 1; most of the box is infeasible.
    let settings = Settings::new(30, 0.5, 0.9, 150).unwrap();
    let bounds = Bounds::cube(2, -20.0, 5.0).unwrap();
    let mut rng = Pcg64Mcg::seed_from_u64(8);
    let evaluate =
        |x: &[f64], _: Option<&Scores<1>>| Scores { objectives: [sphere(x)], violation: (1.0 - x[0] - x[1]).max(0.0) };
    let outcome = minimise(&settings, &bounds, &[], &mut rng, evaluate, |a, b| !b.dominates(a)).unwrap();
    assert!(outcome.fitness.is_feasible());
    assert!((outcome.fitness.objectives[0] - 0.5).abs() < 1e-6, "{outcome:?}");
}

#[test]
fn an_evaluation_stopped_when_it_is_lost_changes_nothing() {
    let bounds = Bounds::cube(4, -1.0, 1.0).unwrap();
    for (generations, seed) in [(0, 1), (1, 2), (1, 3), (2, 4), (7, 5)] {
        let settings = Settings::new(8, 0.5, 0.9, generations).unwrap();
        let whole = logged(&settings, &bounds, &[], seed).0;
        let mut stopped = 0;
        let barely_worse = |x: &[f64], rival: Option<&f64>| match rival {
            Some(&rival) if sphere(x) > rival => {
                stopped += 1;
                rival.next_up()
            }
            _ => sphere(x),
        };
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let outcome = minimise(&settings, &bounds, &[], &mut rng, barely_worse, at_most).unwrap();
        assert_eq!(outcome, whole, "{generations} generations");
        assert!(stopped > 4 * generations.min(1), "only {stopped} evaluations could be stopped");
    }
}
