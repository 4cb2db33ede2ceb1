//! More targets than a robot can keep in mind, in closed loop.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use firmware_sim::lab::Laboratory;
use firmware_sim::scenario::Scenario;
use firmware_sim::trace::{Frame, Observer, metres};
use grn_core::blob::Blob;
use grn_core::geometry::Vector;
use grn_core::scalar::NumberType;
use host_evolver::simulation::{simulate, usual_config};
use std::fmt::Write;
use std::ops::ControlFlow;

const TARGETS: usize = 10;
/// Robots that begin behind each target.
const EACH: usize = 3;
/// From one target to the next, metres of the scenario: a mother sees five of them.
const SPACING: f64 = 2.5;

/// Ten targets abreast that go east; the first robots are mothers, one behind each.
fn world() -> Scenario {
    let height = SPACING * (TARGETS as f64 + 1.0);
    let mut text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/open.toml")).unwrap();
    text.truncate(text.find("\n[[target]]").unwrap());
    let region = text.lines().find(|line| line.starts_with("region")).unwrap().to_owned();
    let mut text = text.replace(&region, &format!("region = [18.0, {height:?}]"));
    let north = |target: usize| SPACING * (target as f64 + 1.0);
    for target in 0..TARGETS {
        let _ = write!(text, "\n[[target]]\npath = [[4.0, {0:?}], [14.0, {0:?}]]\n", north(target));
    }
    let places: Vec<[f64; 2]> = (0..EACH * TARGETS)
        .map(|robot| [2.9, north(robot % TARGETS) + 0.5 * ((robot / TARGETS) as f64 - 1.0)])
        .collect();
    let swarm = format!("robots = {}\nmothers = {TARGETS}", places.len());
    Scenario::parse(&format!("{text}\n[swarm]\n{swarm}\n\n[start]\npositions = {places:?}\n")).unwrap()
}

/// Which target is nearest to each robot, and how far, metres, in the last frame.
#[derive(Default)]
struct Last(Vec<(usize, f64)>);

impl Observer for Last {
    fn observe(&mut self, frame: &Frame<'_>) {
        let targets: Vec<_> = frame.targets_um.iter().map(|target| metres(target.unwrap())).collect();
        let nearest = |place: Vector<f64>| {
            let distances = targets.iter().map(|&target| (target - place).length()).enumerate();
            distances.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
        };
        self.0 = frame.robots.iter().map(|robot| nearest(metres(robot.position_um))).collect();
    }
}

#[test]
fn every_robot_accompanies_the_nearest_of_ten_targets() {
    let bytes = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../models/nand-xnor.grn")).unwrap();
    let blob = Blob::decode(&bytes).unwrap();
    let world = world();
    for number in [NumberType::F32, NumberType::Q8_24] {
        let config = world.configured(usual_config(blob.scale, Laboratory::default()));
        let scale = config.scale;
        let mut last = Last::default();
        simulate(&blob, &world, config, number, &mut last, |_| ControlFlow::Continue(())).unwrap().unwrap();
        assert_eq!(last.0.len(), EACH * TARGETS);
        // All came along, 10 m, and every target kept robots of its own. One at the edge of two rings may belong to either.
        let d_max = world.ring().d_max * scale;
        let far: Vec<_> = last.0.iter().filter(|(_, distance)| *distance > 1.25 * d_max).collect();
        assert!(far.is_empty(), "{number:?}: {far:?}");
        for target in 0..TARGETS {
            let own = last.0.iter().filter(|(nearest, _)| *nearest == target).count();
            assert!(own >= 1, "{number:?}: target {target} has none: {:?}", last.0);
        }
    }
}
