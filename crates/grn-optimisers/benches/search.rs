//! How long the optimisers themselves take, on problems that cost nothing.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use grn_optimisers::nsga2::{Scores, sort, standings};
use grn_optimisers::problems::{unit_box, zdt1};
use grn_optimisers::{bounds::Bounds, cmaes, de, real};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// 4,000 scores, a third of them infeasible and a quarter of them copies.
fn scores() -> Vec<Scores<2>> {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let mut scores: Vec<Scores<2>> = (0..3000)
        .map(|_| Scores {
            objectives: [rng.random(), rng.random()],
            violation: if rng.random_ratio(1, 3) { rng.random() } else { 0.0 },
        })
        .collect();
    scores.extend_from_within(1000..2000);
    scores
}

fn nsga2(c: &mut Criterion) {
    let scores = scores();
    let feasible: Vec<_> = scores.iter().map(|s| Scores::feasible(s.objectives)).collect();
    c.bench_function("sort 4000 points, a third infeasible", |b| b.iter(|| sort(black_box(&scores))));
    c.bench_function("sort 4000 points, all feasible", |b| b.iter(|| sort(black_box(&feasible))));
    c.bench_function("standings of 4000 points", |b| b.iter(|| standings(black_box(&feasible))));
}

fn runs(c: &mut Criterion) {
    let mut group = c.benchmark_group("runs");
    group.sample_size(10);
    group.bench_function("NSGA-II, ZDT1, 25000 evaluations", |b| {
        let usual = "usual settings are accepted";
        let crossover = real::Sbx::new(0.9, 15.0).expect(usual);
        let mutation = real::PolynomialMutation::new(1.0 / 30.0, 20.0).expect(usual);
        let settings = real::Settings::new(100, 25_000, crossover, mutation).expect(usual);
        let bounds = unit_box(30);
        b.iter(|| {
            let mut rng = Pcg64Mcg::seed_from_u64(1);
            real::minimise(&settings, &bounds, &mut rng, |x| Scores::feasible(zdt1(x)))
        });
    });
    group.bench_function("DE, 10-D sphere, 11000 evaluations", |b| {
        let settings = de::Settings::new(50, 0.5, 0.9, 219).expect("usual settings are accepted");
        let bounds = Bounds::cube(10, -5.12, 5.12).expect("an interval");
        b.iter(|| {
            let mut rng = Pcg64Mcg::seed_from_u64(1);
            let sphere = |x: &[f64], _: Option<&f64>| x.iter().map(|x| x * x).sum::<f64>();
            de::minimise(&settings, &bounds, &[], &mut rng, sphere, de::at_most)
        });
    });
    group.bench_function("CMA-ES, 10-D Rosenbrock, 5000 evaluations", |b| {
        let settings = cmaes::Settings::new(10, 0.5, 5000).expect("usual settings are accepted");
        let bounds = Bounds::cube(10, -1e3, 1e3).expect("an interval");
        let rosenbrock =
            |x: &[f64]| x.windows(2).map(|w| 100.0 * (w[1] - w[0] * w[0]).powi(2) + (1.0 - w[0]).powi(2)).sum::<f64>();
        b.iter(|| {
            let mut rng = Pcg64Mcg::seed_from_u64(1);
            cmaes::minimise(&settings, &bounds, &[0.0; 10], None, &mut rng, rosenbrock, de::at_most)
        });
    });
    group.finish();
}

criterion_group!(benches, nsga2, runs);
criterion_main!(benches);
