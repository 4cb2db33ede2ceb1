//! The closed loop: simulated swarms that run the flashed controller encircle a moving target on the model's pattern.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use firmware_sim::{Scenario, SwarmConfig};
use grn_core::network::Network;
use grn_core::scalar::NumberType;
use host_evolver::model::deploy;
use host_evolver::model::published::PUBLISHED;
use host_evolver::model::tree::Tree;
use host_evolver::simulation::{Simulation, simulate};
use std::ops::ControlFlow;
use std::thread;

/// Two printed models and a typical evolved knee.
const MODELS: [&str; 3] = ["nand-xnor", "andn-nand-xnor", "(NOR[1.9995] x1 x1)"];
const NUMBERS: [NumberType; 2] = [NumberType::F32, NumberType::Q8_24];

fn scenario(name: &str) -> Scenario {
    Scenario::load(grn_tests::golden::repository(&format!("scenarios/{name}.toml"))).unwrap()
}

/// A printed model by name, or a tree in prefix notation.
fn network(model: &str) -> Network<f32> {
    let printed = PUBLISHED.iter().find(|published| published.name == model);
    printed.map_or_else(|| model.parse::<Tree>().unwrap().network(1.0).unwrap(), |printed| printed.network().unwrap())
}

/// The world of the bar: a quarter of the scenario's scale, 12 robots, targets at 30 mm/s.
fn bar(seed: u64) -> SwarmConfig {
    SwarmConfig { seed, target_speed_m_per_s: 0.03, ..SwarmConfig::default() }
}

/// One run for each configuration, two at a time.
fn runs(model: &str, number: NumberType, scenario: &Scenario, configs: &[SwarmConfig]) -> Vec<Simulation> {
    let run = |config: &SwarmConfig| {
        let blob = deploy::blob(network(model), &scenario.morphogen(), config.scale as f32);
        simulate(&blob, scenario, config.clone(), number, &mut (), |_| ControlFlow::Continue(())).unwrap().unwrap()
    };
    let half = configs.len().div_ceil(2);
    thread::scope(|scope| {
        let workers: Vec<_> =
            configs.chunks(half).map(|part| scope.spawn(move || part.iter().map(run).collect::<Vec<_>>())).collect();
        workers.into_iter().flat_map(|worker| worker.join().unwrap()).collect()
    })
}

fn assert_bar(name: &str, runs: &[Simulation]) {
    for run in runs {
        let seed = run.config.seed;
        assert!(run.verdict().works(), "{name}, seed {seed}: {:?}, {:?}", run.verdict(), run.metrics);
    }
}

#[test]
fn a_moving_target_is_encircled() {
    let channel = scenario("channel");
    for model in MODELS {
        for (number, seeds) in NUMBERS.into_iter().zip([[1, 2], [3, 4]]) {
            assert_bar(&format!("{model}, {number:?}"), &runs(model, number, &channel, &seeds.map(bar)));
        }
    }
}

#[test]
fn a_crowd_stands_in_one_row() {
    let crowd = |seed| bar(seed).with_robots(20);
    for run in runs("nand-xnor", NumberType::F32, &scenario("channel"), &[1, 2].map(crowd)) {
        let p95 = run.metrics.radial_error_p95_m.unwrap() / run.ring_radius_m;
        assert!(p95 < 0.1, "20 robots are off the pattern by {p95:.3} of its radius");
    }
}

#[test]
fn targets_that_part_are_both_kept() {
    for run in runs("andn-xnor", NumberType::Q8_24, &scenario("channel-two-targets"), &[3, 11].map(bar)) {
        assert!(run.metrics.encircled_share.unwrap() > 0.95, "a target got away: {:?}", run.metrics);
        assert_eq!(run.metrics.wall_contacts, 0);
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

fn table_row(world: &str, model: &str, number: NumberType, runs: &[Simulation]) {
    let all = |value: fn(&Simulation) -> f64| runs.iter().map(value).collect::<Vec<f64>>();
    let lowest = |values: Vec<f64>| values.into_iter().fold(f64::INFINITY, f64::min);
    let formed = || all(|run| run.metrics.formed_at_s.unwrap_or(f64::INFINITY));
    let encircled = || all(|run| run.metrics.encircled_share.unwrap_or(0.0));
    println!(
        "| {world} | {model} | {number:?} | {:.1} / {:.1} | {:.3} / {:.3} | {:.2} / {:.2} | {:.3} | {} | {} |",
        median(formed()),
        formed().into_iter().fold(0.0, f64::max),
        lowest(encircled()),
        median(encircled()),
        100.0 * median(all(|run| run.radial_error_share().unwrap_or(f64::INFINITY))),
        100.0 * all(|run| run.radial_error_share().unwrap_or(f64::INFINITY)).into_iter().fold(0.0, f64::max),
        median(all(|run| run.metrics.spacing_evenness.unwrap_or(0.0))),
        all(|run| run.metrics.wall_contacts as f64).into_iter().sum::<f64>(),
        all(|run| run.metrics.peer_contacts as f64).into_iter().sum::<f64>(),
    );
}

/// The whole bar, and how the controller does beyond it: run with `--release -- --ignored --nocapture`.
#[test]
#[ignore = "some minutes; prints a table"]
fn twenty_seeds_of_every_model() {
    println!(
        "| world | model | number | formed s, median / max | encircled, min / median | median radial error, % of ring, \
         median / max | evenness | wall contacts | peer contacts |\n|---|---|---|---|---|---|---|---|---|"
    );
    let both = |world: &str, scenario: &Scenario, model: &str, config: &dyn Fn(u64) -> SwarmConfig| {
        let configs: Vec<SwarmConfig> = (1..=20).map(config).collect();
        NUMBERS.map(|number| {
            let found = runs(model, number, scenario, &configs);
            table_row(world, model, number, &found);
            found
        })
    };
    let [channel, two_targets, compound] = ["channel", "channel-two-targets", "compound-channel"].map(scenario);
    let bars: Vec<_> = MODELS.into_iter().map(|model| (model, both("channel", &channel, model, &bar))).collect();
    for model in ["andn-xnor", "eh-grn-1", "eh-grn-2"] {
        both("channel", &channel, model, &bar);
    }
    for model in ["nand-xnor", "andn-nand-xnor"] {
        both("channel, 8 robots", &channel, model, &|seed| bar(seed).with_robots(8));
        both("channel, 20 robots", &channel, model, &|seed| bar(seed).with_robots(20));
        both("channel, 50 mm/s", &channel, model, &|seed| SwarmConfig { target_speed_m_per_s: 0.05, ..bar(seed) });
        let small = |seed| SwarmConfig { scale: 0.1, ..bar(seed) }.with_robots(8);
        both("channel, scale 0.1, 8 robots", &channel, model, &small);
    }
    for model in ["nand-xnor", "andn-xnor", "andn-nand-xnor", "eh-grn-2"] {
        both("two targets", &two_targets, model, &bar);
    }
    for model in ["andn-xnor", "andn-nand-xnor", "eh-grn-2"] {
        both("compound channel", &compound, model, &bar);
    }
    for (model, runs) in &bars {
        runs.iter().for_each(|runs| assert_bar(model, runs));
    }
}
