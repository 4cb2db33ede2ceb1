//! The operators' distributions, rejected arguments, equal logs, and NSGA-II on ZDT1, ZDT2 and ZDT3.

use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use super::*;
use crate::hypervolume::hypervolume;
use crate::problems::{unit_box, zdt1, zdt2, zdt3};

fn zdt_settings(evaluations: usize) -> Settings {
    let crossover = Sbx::new(0.9, 15.0).unwrap();
    let mutation = PolynomialMutation::new(1.0 / 30.0, 20.0).unwrap();
    Settings::new(100, evaluations, crossover, mutation).unwrap()
}

/// The median over 15 seeds of the hypervolume below (1.1, 1.1).
fn median_hypervolume(problem: fn(&[f64]) -> [f64; 2]) -> f64 {
    let (settings, bounds) = (zdt_settings(25_000), unit_box(30));
    let mut volumes: Vec<f64> = (1..=15)
        .map(|seed| {
            let mut evaluations = 0;
            let mut rng = Pcg64Mcg::seed_from_u64(seed);
            let population = minimise(&settings, &bounds, &mut rng, |x| {
                evaluations += 1;
                Scores::feasible(problem(x))
            });
            assert_eq!((evaluations, population.len()), (25_000, 100));
            let front: Vec<[f64; 2]> = population.iter().map(|i| i.scores.objectives).collect();
            hypervolume(&front, [1.1, 1.1])
        })
        .collect();
    volumes.sort_by(f64::total_cmp);
    println!("median {:.5}, {:.5} to {:.5}", volumes[7], volumes[0], volumes[14]);
    volumes[7]
}

#[test]
fn zdt1_front_is_found() {
    assert!(median_hypervolume(zdt1) >= 0.8690);
}

#[test]
fn zdt2_front_is_found() {
    assert!(median_hypervolume(zdt2) >= 0.5360);
}

#[test]
fn zdt3_front_is_found() {
    assert!(median_hypervolume(zdt3) >= 1.3270);
}

#[test]
fn equal_seed_equal_log_and_exact_budgets() {
    let bounds = unit_box(30);
    let run = |evaluations, seed| {
        let mut log = Vec::new();
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let population = minimise(&zdt_settings(evaluations), &bounds, &mut rng, |x| {
            log.push(x.to_vec());
            Scores::feasible(zdt3(x))
        });
        (log, population)
    };
    let (log, population) = run(1000, 1);
    assert!(run(1000, 1) == (log.clone(), population));
    assert!(run(1000, 2).0 != log);
    assert!(log.iter().all(|x| bounds.contain(x)));
    for budget in [1, 99, 100, 101, 257] {
        let (part, population) = run(budget, 1);
        assert!(part == log[..budget], "a smaller budget only cuts the run short: {budget}");
        assert_eq!(population.len(), budget.min(100));
    }
}

#[test]
fn infeasible_and_nan_regions_are_left() {
    let crossover = Sbx::new(0.9, 15.0).unwrap();
    let mutation = PolynomialMutation::new(0.5, 20.0).unwrap();
    let settings = Settings::new(20, 2000, crossover, mutation).unwrap();
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    let population = minimise(&settings, &unit_box(2), &mut rng, |x| Scores {
        objectives: [x[0], if x[1] > 0.9 { f64::NAN } else { 1.0 - x[0] + x[1] }],
        violation: (0.3 - x[0]).max(0.0),
    });
    for individual in population {
        assert!(individual.scores.is_feasible() && individual.x[1] < 0.2, "{individual:?}");
    }
}

#[test]
fn bad_arguments_are_rejected() {
    for p in [-0.1, 1.1, f64::NAN] {
        assert!(matches!(Sbx::new(p, 15.0), Err(SettingsError::Probability(_))));
        assert!(matches!(PolynomialMutation::new(p, 15.0), Err(SettingsError::Probability(_))));
    }
    for eta in [-1.0, f64::INFINITY, f64::NAN] {
        assert!(matches!(Sbx::new(0.9, eta), Err(SettingsError::Index(_))));
        assert!(matches!(PolynomialMutation::new(0.9, eta), Err(SettingsError::Index(_))));
    }
    let (sbx, pm) = (Sbx::new(0.9, 15.0).unwrap(), PolynomialMutation::new(0.1, 20.0).unwrap());
    assert_eq!(Settings::new(1, 10, sbx, pm), Err(SettingsError::Population(1)));
    assert_eq!(Settings::new(2, 0, sbx, pm), Err(SettingsError::Budget));
}

#[test]
fn crossover_keeps_the_mean_and_the_box() {
    let bounds = Bounds::cube(1, -1e6, 1e6).unwrap();
    let sbx = Sbx::new(1.0, 15.0).unwrap();
    let mut rng = Pcg64Mcg::seed_from_u64(4);
    let (mut unchanged, mut inside) = (0, 0);
    for _ in 0..10_000 {
        let (mut a, mut b) = ([1.0], [3.0]);
        sbx.cross(&mut rng, &bounds, &mut a, &mut b);
        assert!((a[0] + b[0] - 4.0).abs() < 1e-9);
        unchanged += usize::from(a == [1.0] && b == [3.0]);
        inside += usize::from(a[0].min(b[0]) > 1.0);
    }
    assert!((4800..5200).contains(&unchanged), "half of the coordinates: {unchanged}");
    assert!((2350..2650).contains(&inside), "contracting as often as expanding: {inside}");

    // In a tight box no child leaves, and fixed coordinates stay.
    let bounds = Bounds::new(vec![(0.0, 1.0), (0.0, 1.0), (2.0, 2.0)]).unwrap();
    let (sbx, pm) = (Sbx::new(1.0, 0.0).unwrap(), PolynomialMutation::new(1.0, 0.0).unwrap());
    for _ in 0..10_000 {
        let (mut a, mut b) = ([0.0, 0.4, 2.0], [1.0, 0.6, 2.0]);
        sbx.cross(&mut rng, &bounds, &mut a, &mut b);
        pm.mutate(&mut rng, &bounds, &mut a);
        assert!(bounds.contain(&a) && bounds.contain(&b), "{a:?} {b:?}");
    }
}

#[test]
fn mutation_is_centred_and_as_frequent_as_asked() {
    let bounds = unit_box(10);
    let pm = PolynomialMutation::new(0.1, 20.0).unwrap();
    let mut rng = Pcg64Mcg::seed_from_u64(5);
    let (mut changed, mut sum, mut size) = (0, 0.0, 0.0);
    for _ in 0..10_000 {
        let mut x = [0.5; 10];
        pm.mutate(&mut rng, &bounds, &mut x);
        changed += x.iter().filter(|x| **x != 0.5).count();
        sum += x.iter().map(|x| x - 0.5).sum::<f64>();
        size += x.iter().map(|x| (x - 0.5).abs()).sum::<f64>();
    }
    assert!((9_600..10_400).contains(&changed), "{changed}");
    // The mean of |δ| is 1 / (η + 2).
    let mean = size / changed as f64;
    assert!((mean - 1.0 / 22.0).abs() < 0.002 && (sum / changed as f64).abs() < 0.002, "{mean} {sum}");
}
