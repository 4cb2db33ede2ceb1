//! Worlds whose obstacles and targets move, come and go: judged at each snapshot, and in closed loop.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use firmware_sim::config::SwarmConfig;
use firmware_sim::lab::Laboratory;
use firmware_sim::scenario::Scenario;
use grn_core::blob::Blob;
use grn_core::scalar::NumberType;
use host_evolver::evaluation::{Evaluator, Model, World};
use host_evolver::evolve::{Advance, Search, Settings, Task, deployed};
use host_evolver::model::deploy;
use host_evolver::model::published::PUBLISHED;
use host_evolver::simulation::{Simulation, simulate, usual_config};
use std::fmt::Write;
use std::ops::ControlFlow;
use std::sync::atomic::AtomicBool;

fn shipped(name: &str) -> Scenario {
    Scenario::load(format!("{}/../scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

/// The world as it stands at a time, for ever: one snapshot.
fn frozen(world: &Scenario, time: f64) -> Scenario {
    let mut text = world.to_toml();
    text.truncate(text.find("\n[[target]]").unwrap());
    text = text.replace(&format!("snapshots = {}", world.snapshots()), "snapshots = 1");
    for target in world.targets_at(time) {
        let _ = write!(text, "\n[[target]]\npath = [[{:?}, {:?}]]\n", target.x, target.y);
    }
    for wall in world.walls_at(time).polygons() {
        let corners: Vec<[f64; 2]> = wall.vertices().iter().map(|corner| [corner.x, corner.y]).collect();
        let _ = write!(text, "\n[[wall]]\npolygon = {corners:?}\n");
    }
    Scenario::parse(&text).unwrap()
}

#[test]
fn f2_is_the_mean_over_the_world_as_it_is_at_each_snapshot() {
    for name in ["crossing", "doors", "vanishing", "revolving"] {
        let scenario = shipped(&format!("moving/{name}"));
        let world = World::new(scenario.clone());
        let stills: Vec<World> = scenario.snapshot_times().map(|time| World::new(frozen(&scenario, time))).collect();
        let mut different = 0;
        for published in PUBLISHED {
            let model = Model::new(&published.network().unwrap(), 0.5).unwrap();
            let found = Evaluator::new(&world).evaluate(&model);
            let alone: Vec<_> = stills.iter().map(|still| Evaluator::new(still).evaluate(&model)).collect();
            let mean = |value: &dyn Fn(usize) -> f64| (0..alone.len()).map(value).sum::<f64>() / alone.len() as f64;
            assert!((found.f2 - mean(&|i| alone[i].f2)).abs() < 1e-9, "{name}, {}: {found:?}", published.name);
            assert!((found.violation - mean(&|i| alone[i].violation)).abs() < 1e-9, "{name}, {}", published.name);
            different += usize::from(alone.iter().any(|still| (still.f2 - alone[0].f2).abs() > 1e-6));
        }
        assert!(different > 0, "{name} is the same all the time for every model");
    }
}

/// With three messages in ten lost.
fn run(blob: &Blob, world: &Scenario, seed: u64, number: NumberType) -> Simulation {
    let mut config = usual_config(blob.scale, Laboratory::default());
    (config.seed, config.lab.radio.loss) = (seed, 0.3);
    simulate(blob, world, config, number, &mut (), |_| ControlFlow::Continue(())).unwrap().unwrap()
}

fn holds_again(simulation: &Simulation) {
    let (seed, recoveries) = (simulation.config.seed, &simulation.metrics.recoveries);
    assert!(!recoveries.is_empty());
    for recovery in recoveries {
        assert!(recovery.encircled_share.is_some_and(|share| share > 0.9), "seed {seed}: {recovery:?}");
    }
    // Twelve robots are too few to cage two targets that are apart, and it takes time to form again.
    let verdict = simulation.verdict();
    assert!(verdict.in_band && verdict.clear && verdict.together, "seed {seed}: {verdict:?}, {:?}", simulation.metrics);
}

#[test]
fn when_a_target_vanishes_its_robots_join_the_others() {
    let bytes = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../models/nand-xnor.grn")).unwrap();
    let blob = Blob::decode(&bytes).unwrap();
    let world = shipped("moving/vanishing");
    (1..=3).for_each(|seed| holds_again(&run(&blob, &world, seed, NumberType::F32)));
    holds_again(&run(&blob, &world, 4, NumberType::Q8_24));
}

#[test]
fn a_controller_that_evolved_among_doors_goes_through_them() {
    let scenario = shipped("moving/doors");
    let task = Task::in_one(scenario.clone(), SwarmConfig::default());
    let settings = Settings { evaluations: 2400, ..Settings::default() };
    let mut search = Search::new(&task, settings, None).unwrap();
    while search.advance(&AtomicBool::new(false), &|_| {}) == Advance::Generation {}
    let front = search.front();
    let member = &front[deployed(&front)];
    assert!(member.is_feasible());
    let blob = deploy::blob(member.network.clone(), &scenario.morphogen(), 0.25);
    (1..=3).for_each(|seed| holds_again(&run(&blob, &scenario, seed, NumberType::F32)));
}
