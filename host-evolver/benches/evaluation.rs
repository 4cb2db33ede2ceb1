//! f2 the fast and the plain way on the channel, and a whole run of the search.
#![allow(clippy::expect_used, reason = "a benchmark that cannot go on ends")]

use criterion::{Criterion, criterion_group, criterion_main};
use firmware_sim::config::SwarmConfig;
use firmware_sim::scenario::Scenario;
use grn_core::geometry::Vector;
use host_evolver::evaluation::{Evaluator, Model, World};
use host_evolver::evolve::{Advance, Search, Settings, Task};
use host_evolver::model::published::PUBLISHED;
use std::hint::black_box;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

mod plain;

/// Spacing of the plain grid, metres.
const PLAIN_STEP: f64 = 0.05;

fn channel() -> World {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/channel.toml");
    World::new(Scenario::load(path).expect("the scenario is valid"))
}

fn model(index: usize) -> Model {
    let network = PUBLISHED[index].network().expect("printed models are valid");
    Model::new(&network, 0.5).expect("printed models have patterns")
}

fn f2_plain(world: &World, model: &Model) -> f64 {
    let [width, height] = world.scenario().region();
    let area = [Vector::new(0.0, 0.0), Vector::new(width, height)];
    let moments = world.snapshots().iter().map(|snapshot| {
        let pattern = plain::trace(world, model, snapshot, area, PLAIN_STEP);
        plain::evaluate(world, snapshot, &pattern)[0]
    });
    moments.sum::<f64>() / world.snapshots().len() as f64
}

fn evolve(task: &Task) -> f64 {
    let mut search = Search::new(task, Settings::default(), None).expect("usual settings are accepted");
    while search.advance(&AtomicBool::new(false), &|_| {}) == Advance::Generation {}
    search.state().history.last().and_then(|milestone| milestone.best_f2).unwrap_or(f64::NAN)
}

/// The shortest of several times: what else runs on the machine only makes them longer.
fn time_of(times: u32, mut work: impl FnMut()) -> Duration {
    let once = |_| {
        let begin = Instant::now();
        work();
        begin.elapsed()
    };
    (0..times).map(once).min().unwrap_or_default()
}

/// One run that measures both ways in turn and prints their ratio.
fn ratio(world: &World) {
    let mut evaluator = Evaluator::new(world);
    for (index, published) in PUBLISHED.iter().enumerate() {
        let model = model(index);
        let fast_f2 = evaluator.evaluate(&model).f2;
        let mut plain_f2 = 0.0;
        let plain = time_of(2, || plain_f2 = f2_plain(world, &model));
        let fast = time_of(400, || {
            black_box(evaluator.evaluate(black_box(&model)));
        });
        let ratio = plain.as_secs_f64() / fast.as_secs_f64();
        println!(
            "{}: f2 fast {fast_f2:.6} in {fast:.1?}, plain {plain_f2:.6} in {plain:.1?}: {ratio:.0} x",
            published.name
        );
    }
    let task = Task::in_one(world.scenario().clone(), SwarmConfig::default());
    let run = time_of(3, || {
        black_box(evolve(&task));
    })
    .as_secs_f64();
    println!("evolve: 4000 evaluations in {run:.3} s, {:.0} a second", 4000.0 / run);
}

fn objective(c: &mut Criterion) {
    let world = channel();
    ratio(&world);
    let model = model(1);
    let mut evaluator = Evaluator::new(&world);
    c.bench_function("f2 fast", |b| b.iter(|| evaluator.evaluate(black_box(&model))));
    let mut group = c.benchmark_group("slow");
    group.sample_size(10);
    group.bench_function("f2 plain", |b| b.iter(|| f2_plain(&world, black_box(&model))));
    let task = Task::in_one(world.scenario().clone(), SwarmConfig::default());
    group.bench_function("evolve 4000 evaluations", |b| b.iter(|| evolve(&task)));
    group.finish();
}

criterion_group!(benches, objective);
criterion_main!(benches);
