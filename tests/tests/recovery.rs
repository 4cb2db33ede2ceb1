//! A swarm recovers: three messages in ten are lost, and a quarter of the robots break down while the target moves.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use firmware_sim::lab::{FaultKind, Faults, Laboratory, ScheduledFault};
use firmware_sim::metrics::Metrics;
use firmware_sim::{Scenario, SwarmConfig};
use grn_core::blob::Blob;
use grn_core::scalar::NumberType;
use grn_tests::golden::repository;
use grn_tests::robots::Shipped;
use host_evolver::model::deploy;
use host_evolver::model::tree::Tree;
use host_evolver::simulation::simulate;
use std::ops::ControlFlow;

/// A printed model and a typical evolved knee.
const MODELS: [&str; 2] = ["nand-xnor", "(NOR[1.9995] x1 x1)"];
/// Every target is encircled for more than this share of the time once the swarm has formed again.
const ENOUGH: f64 = 0.9;

/// Robots that broke down for good a minute into the run, and what the run was worth.
fn run(model: &str, number: NumberType, seed: u64) -> (Vec<usize>, Metrics) {
    let channel = Scenario::load(repository("scenarios/channel.toml")).unwrap();
    let blob = if model.starts_with('(') {
        deploy::blob(model.parse::<Tree>().unwrap().network(1.0).unwrap(), &channel.morphogen(), 0.25)
    } else {
        Blob::decode(&Shipped::named(model).bytes).unwrap()
    };
    let stop = ScheduledFault { kind: FaultKind::Stop, robot: None, share: Some(0.25), at_s: 60.0, lasts_s: None };
    let mut lab = Laboratory { faults: Faults { at: vec![stop], ..Faults::default() }, ..Laboratory::default() };
    lab.radio.loss = 0.3;
    let config = SwarmConfig { seed, target_speed_m_per_s: 0.03, lab, ..SwarmConfig::default() };
    let run = simulate(&blob, &channel, config, number, &mut (), |_| ControlFlow::Continue(())).unwrap().unwrap();
    (run.faults.faults().iter().map(|fault| fault.robot).collect(), run.metrics)
}

/// Whether a mother is left, who sees the target.
fn is_seen(broken: &[usize]) -> bool {
    [0, 1].iter().any(|mother| !broken.contains(mother))
}

fn recovers(metrics: &Metrics) -> bool {
    let share = metrics.recoveries.last().and_then(|last| last.encircled_share);
    share.is_some_and(|share| share > ENOUGH) && metrics.lost_robots == 0
}

#[test]
fn a_quarter_of_the_robots_break_down_and_the_others_go_on() {
    for model in MODELS {
        for (number, seed) in [(NumberType::F32, 1), (NumberType::Q8_24, 2), (NumberType::F32, 3)] {
            let (broken, metrics) = run(model, number, seed);
            assert!(broken.len() == 3 && is_seen(&broken), "{broken:?}: choose another seed");
            assert!(recovers(&metrics), "{model}, {number}, seed {seed}, without {broken:?}: {metrics:?}");
        }
    }
}

#[test]
fn a_swarm_whose_mothers_all_broke_down_loses_its_target_and_the_metrics_say_so() {
    let broken_mothers = |seed| Some(run(MODELS[0], NumberType::F32, seed)).filter(|(broken, _)| !is_seen(broken));
    let (broken, metrics) = (20..60).find_map(broken_mothers).unwrap();
    assert!(!recovers(&metrics) && metrics.lost_robots == 9, "without {broken:?}: {metrics:?}");
}

/// The whole bar: run with `--release -- --ignored --nocapture`.
#[test]
#[ignore = "some minutes; prints a table"]
fn fifty_seeds_of_each_model() {
    println!(
        "| model | number | runs with a mother left | recover | re-formed after s, max | encircled, min | lost, max |"
    );
    println!("|---|---|---|---|---|---|---|");
    for (model, number) in MODELS.iter().flat_map(|model| NumberType::ALL.map(|number| (model, number))) {
        let runs: Vec<Metrics> = (1..=50)
            .map(|seed| run(model, number, seed))
            .filter(|(broken, _)| is_seen(broken))
            .map(|run| run.1)
            .collect();
        let last = |metrics: &Metrics| metrics.recoveries.last().cloned().unwrap();
        let after = |metrics: &Metrics| last(metrics).reformed_at_s.map_or(f64::INFINITY, |at| at - 60.0);
        let most = runs.iter().map(after).fold(0.0, f64::max);
        let least = runs.iter().map(|metrics| last(metrics).encircled_share.unwrap_or(0.0)).fold(1.0, f64::min);
        let (recover, lost) =
            (runs.iter().filter(|run| recovers(run)).count(), runs.iter().map(|run| run.lost_robots).max());
        println!(
            "| {model} | {number} | {} | {recover} | {most:.1} | {least:.3} | {} |",
            runs.len(),
            lost.unwrap_or(0)
        );
        assert_eq!(recover, runs.len());
    }
}
