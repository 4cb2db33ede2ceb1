//! A base station with the flashed controller: it sends robots as the pattern grows, calls spare ones home, replaces those that break down.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use firmware_sim::base_station::{BaseRecord, Dispatch};
use firmware_sim::lab::{BaseStation, FaultKind, Faults, Laboratory, ScheduledFault};
use firmware_sim::{Scenario, SwarmConfig};
use grn_core::blob::Blob;
use grn_core::scalar::NumberType;
use grn_tests::robots::Shipped;
use host_evolver::simulation::{Simulation, simulate};
use std::ops::ControlFlow;

const OPEN: &str = "name = \"open\"\nregion = [24.0, 20.0]\nsnapshots = 5\n\
    [morphogen]\nkernel = \"gaussian\"\ntarget_width = 1.5\nobstacle_width = 0.9\nlevel = 0.5\n\
    [ring]\nd_min = 1.0\nd_max = 2.0\nd_obstacle = 2.0\nsteepness = 10.0\n";

fn world(paths: &[&str]) -> Scenario {
    let targets: String = paths.iter().map(|path| format!("[[target]]\npath = {path}\n")).collect();
    Scenario::parse(&format!("{OPEN}{targets}")).unwrap()
}

fn run(scenario: &Scenario, fleet: usize, faults: Faults, seed: u64, number: NumberType) -> Simulation {
    let blob = Blob::decode(&Shipped::named("nand-xnor").bytes).unwrap();
    let base_station = BaseStation { sends: true, spacing_m: 0.2, reserve: 0.1 };
    let lab = Laboratory { base_station, faults, ..Laboratory::default() };
    let config = SwarmConfig { seed, target_speed_m_per_s: 0.03, lab, ..SwarmConfig::default() }.with_robots(fleet);
    simulate(&blob, scenario, config, number, &mut (), |_| ControlFlow::Continue(())).unwrap().unwrap()
}

fn base(run: &Simulation) -> &BaseRecord {
    run.base.as_ref().unwrap()
}

fn times(run: &Simulation, what: Dispatch) -> Vec<f64> {
    base(run).dispatched.iter().filter(|deed| deed.what == what).map(|deed| deed.at_s).collect()
}

fn nobody_is_away(run: &Simulation) {
    let metrics = &run.metrics;
    assert_eq!(
        (metrics.lost_robots, metrics.strayed_robots),
        (0, 0),
        "seed {}: {metrics:?} {:?}",
        run.config.seed,
        run.base
    );
}

#[test]
fn targets_that_part_get_more_robots() {
    let scenario = world(&["[[6.0, 10.0], [18.0, 15.0]]", "[[6.0, 10.0], [18.0, 5.0]]"]);
    for (seed, number) in [(1, NumberType::F32), (2, NumberType::Q8_24)] {
        let run = run(&scenario, 24, Faults::default(), seed, number);
        let sent = times(&run, Dispatch::Sent);
        let at_first = sent.iter().filter(|&&at| at == 0.0).count();
        // Two targets at one place have one ring of 3.4 m.
        assert!((16..=18).contains(&at_first) && sent.len() == base(&run).most_needed, "{sent:?}");
        // Two rings of 1.92 m need 10 robots each; just before they part, the outline of both is longer.
        assert!((20..=24).contains(&base(&run).most_needed), "{:?}", base(&run));
        assert_eq!(base(&run).short_s, 0.0);
        assert!(run.metrics.encircled_share.unwrap() > 0.9, "{:?}", run.metrics);
        nobody_is_away(&run);
    }
}

#[test]
fn targets_that_meet_send_robots_home() {
    let scenario = world(&["[[6.0, 15.0], [12.0, 10.0]]", "[[6.0, 5.0], [12.0, 10.0]]"]);
    let run = run(&scenario, 24, Faults::default(), 1, NumberType::F32);
    let (called, back) = (times(&run, Dispatch::CalledHome), times(&run, Dispatch::Back));
    // Of 20 to 22 the ring of both needs 17, and two stay in reserve.
    assert!((2..=4).contains(&called.len()) && called[0] > 40.0, "{:?}", base(&run));
    // Those that were called 15 s before the end are back.
    let early = called.iter().filter(|&&at| at < run.metrics.duration_s - 15.0).count();
    assert!(back.len() >= early && early > 0, "{called:?} {back:?}");
    nobody_is_away(&run);
}

#[test]
fn robots_that_break_down_are_replaced() {
    let scenario = world(&["[[6.0, 10.0], [18.0, 10.0]]"]);
    let stop = ScheduledFault { kind: FaultKind::Stop, robot: None, share: Some(0.25), at_s: 40.0, lasts_s: None };
    for seed in 1..=3 {
        let run = run(&scenario, 14, Faults { at: vec![stop], ..Faults::default() }, seed, NumberType::F32);
        let broken: Vec<usize> = run.faults.faults().iter().map(|fault| fault.robot).collect();
        let replaced = times(&run, Dispatch::Sent).into_iter().filter(|&at| at >= 40.0).count();
        let out_then = broken.iter().filter(|&&robot| robot < base(&run).most_needed).count();
        let spare = (base(&run).most_needed..14).filter(|robot| !broken.contains(robot)).count();
        assert_eq!(replaced, out_then.min(spare), "{broken:?} {:?}", base(&run));
        assert_eq!(base(&run).short_s > 0.0, out_then > spare);
        nobody_is_away(&run);
        assert!(run.metrics.recoveries[0].encircled_share.unwrap() > 0.9, "seed {seed}: {:?}", run.metrics);
    }
}
