//! What using robots has shown to go wrong, one test a fault, named after it.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use firmware_sim::body::Pose;
use firmware_sim::brain::{Brain, BrainError};
use firmware_sim::lab::{self, FaultKind, Faults, Laboratory, ScheduledFault};
use firmware_sim::trace::TraceHeader;
use firmware_sim::{Recorder, Scenario, Swarm, SwarmConfig, Trace};
use grn_core::blob::Blob;
use grn_core::network::DEFAULT_GENES;
use grn_core::robot::{Command, Controller, Heard, Message, Percept};
use grn_core::scalar::{NumberType, Q8_24, Scalar};
use grn_tests::golden::repository;
use grn_tests::robots::Shipped;
use host_evolver::model::deploy;
use host_evolver::model::tree::Tree;
use host_evolver::simulation::{PatternRuler, Simulation, simulate};
use std::ops::ControlFlow;

/// A controller on a radio that gives the robot its own broadcasts back, before what others say, if `loopback`.
struct OnRadio<S> {
    controller: Controller<S>,
    loopback: bool,
    sent: Option<Message>,
}

impl<S: Scalar> Brain for OnRadio<S> {
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
        let mut percept = percept.clone();
        if let Some(own) = self.sent.take().filter(|_| self.loopback) {
            percept.heard.insert(0, Heard { message: own, age_ms: 0 }).unwrap();
        }
        let command = self.controller.tick(&percept).map_err(|error| BrainError::new(error.to_string()))?;
        self.sent.clone_from(&command.broadcast);
        Ok(command)
    }
}

fn recorder(scenario: &Scenario, config: &SwarmConfig) -> Recorder {
    Recorder::new(TraceHeader::of(scenario, config), usize::MAX)
}

/// Twelve robots with a shipped model.
fn simulation(model: &str, world: &str, config: SwarmConfig) -> (Simulation, Trace) {
    let scenario = Scenario::load(repository(&format!("scenarios/{world}.toml"))).unwrap();
    let blob = Blob::<DEFAULT_GENES>::decode(&Shipped::named(model).bytes).unwrap();
    let config = SwarmConfig { target_speed_m_per_s: 0.03, ..config };
    let mut recorder = recorder(&scenario, &config);
    let run = simulate(&blob, &scenario, config, NumberType::F32, &mut recorder, |_| ControlFlow::Continue(()));
    (run.unwrap().unwrap(), recorder.into_trace())
}

/// The bytes of half a minute of twelve robots in the channel.
fn trace_bytes<S: Scalar>(loopback: bool) -> Vec<u8> {
    let scenario = Scenario::load(repository("scenarios/channel.toml")).unwrap();
    let blob = Blob::<DEFAULT_GENES>::decode(&Shipped::named("nand-xnor").bytes).unwrap();
    let config = SwarmConfig::default();
    let brain =
        |robot: usize| OnRadio { controller: Controller::<S>::new(&blob, robot as u16).unwrap(), loopback, sent: None };
    let mut recorder = recorder(&scenario, &config);
    let mut swarm = Swarm::new(&scenario, config, brain).unwrap();
    swarm.run(30 * 32, &mut recorder, |_| ControlFlow::Continue(())).unwrap();
    recorder.into_trace().encode()
}

#[test]
fn a_robot_that_hears_its_own_broadcast_drives_as_if_it_did_not() {
    assert!(trace_bytes::<f32>(true) == trace_bytes::<f32>(false));
    assert!(trace_bytes::<Q8_24>(true) == trace_bytes::<Q8_24>(false));
}

#[test]
fn robots_that_follow_a_broken_contour_along_walls_are_lost() {
    let (run, trace) = simulation("nand-xnor", "compound-channel", SwarmConfig { seed: 13, ..SwarmConfig::default() });
    let frame = trace.frames().last().unwrap();
    let away = frame.robots.iter().filter(|robot| {
        let offset = [0, 1].map(|axis| f64::from(robot.position_um[axis] - frame.targets_um[0].unwrap()[axis]) * 1e-6);
        offset.map(|metres| metres * metres).iter().sum::<f64>().sqrt() > 2.0 * run.ring_radius_m
    });
    assert_eq!((away.count(), run.metrics.lost_robots), (12, 12));
    let verdict = run.verdict();
    assert!(!verdict.caged && !verdict.together && !verdict.works(), "{verdict:?}, {:?}", run.metrics);
    assert_eq!(run.radial_error_share(), None, "most distances are unknown, so the median is");
}

#[test]
fn a_swarm_that_runs_into_itself_again_and_again_does_not_work() {
    let lab = lab::set(Laboratory::default(), "radio.loss=0.95").unwrap();
    let (deaf, _) = simulation("nand-xnor", "channel", SwarmConfig { lab, ..SwarmConfig::default() });
    let verdict = deaf.verdict();
    assert!(deaf.metrics.peer_contacts > 12 && !verdict.clear && !verdict.works(), "{:?}", deaf.caging);
    assert!(verdict.in_band && verdict.together, "nothing else is wrong: {:?}", deaf.caging);
}

/// A printed model and a typical evolved knee.
const MODELS: [&str; 2] = ["nand-xnor", "(NOR[1.9995] x1 x1)"];

/// A shipped blob by name, or a tree in prefix notation for the channel.
fn blob(model: &str) -> Blob {
    let tree = || model.parse::<Tree>().unwrap().network(1.0).unwrap();
    if model.starts_with('(') {
        deploy::blob(tree(), &channel().morphogen(), 0.25)
    } else {
        Blob::decode(&Shipped::named(model).bytes).unwrap()
    }
}

fn channel() -> Scenario {
    Scenario::load(repository("scenarios/channel.toml")).unwrap()
}

/// A robot that breaks down for good.
fn stop(robot: usize, second: usize) -> ScheduledFault {
    ScheduledFault { kind: FaultKind::Stop, robot: Some(robot), share: None, at_s: second as f64, lasts_s: None }
}

/// Nobody is lost or strays in the channel when these robots of twelve break down; in every seed, number type and model.
fn nobody_is_lost_when(stops: impl Fn(usize) -> Vec<ScheduledFault>) {
    for (model, number) in MODELS.iter().flat_map(|model| NumberType::ALL.map(|number| (model, number))) {
        for seed in 1..=8 {
            let faults = Faults { at: stops(seed as usize), ..Faults::default() };
            let lab = Laboratory { faults, ..Laboratory::default() };
            let config = SwarmConfig { seed, target_speed_m_per_s: 0.03, lab, ..SwarmConfig::default() };
            let run = simulate(&blob(model), &channel(), config, number, &mut (), |_| ControlFlow::Continue(()));
            let metrics = run.unwrap().unwrap().metrics;
            let away = (metrics.lost_robots, metrics.strayed_robots, metrics.wall_contacts);
            assert_eq!(away, (0, 0, 0), "{model}, {number}, seed {seed}: {metrics:?}");
        }
    }
}

#[test]
fn nobody_is_left_standing_behind_robots_that_broke_down() {
    let robot = |seed: usize, number: usize| 1 + (seed * 5 + number * 4) % 11;
    for second in [20, 40, 60] {
        nobody_is_lost_when(|seed| (0..3).map(|number| stop(robot(seed, number), second + 7 * number)).collect());
    }
}

#[test]
fn nobody_is_left_standing_behind_pairs_that_broke_down() {
    let robot = |seed: usize, number: usize| 2 + (seed * 5 + number / 2 * 3) % 9 + number % 2;
    for second in [40, 70] {
        nobody_is_lost_when(|seed| (0..4).map(|number| stop(robot(seed, number), second)).collect());
    }
}

/// A controller on a robot whose swarm sees no walls.
struct WallBlind<S>(Controller<S>);

impl<S: Scalar> Brain for WallBlind<S> {
    fn tick(&mut self, percept: &Percept) -> Result<Command, BrainError> {
        let percept = Percept { obstacles: Default::default(), ..percept.clone() };
        self.0.tick(&percept).map_err(|error| BrainError::new(error.to_string()))
    }
}

/// The robots that are more than two ring radii from the target in the end, with a box of 10 by 40 cm in the ring's way.
fn left_behind_a_box<S: Scalar>(model: &str, seed: u64) -> usize {
    const BOX: &str = "[[wall]]\npolygon = [[8.0, 10.6], [8.4, 10.6], [8.4, 12.2], [8.0, 12.2]]\n";
    let text = std::fs::read_to_string(repository("scenarios/channel.toml")).unwrap();
    let scenario = Scenario::parse(&(text.split("[[wall]]").next().unwrap().to_owned() + BOX)).unwrap();
    let blob = blob(model);
    let config = SwarmConfig { seed, target_speed_m_per_s: 0.03, ..SwarmConfig::default() };
    let brain = |robot: usize| WallBlind(Controller::<S>::new(&blob, robot as u16).unwrap());
    let mut swarm = Swarm::new(&scenario, config, brain).unwrap();
    swarm.run(swarm.arrival_tick(), &mut (), |_| ControlFlow::Continue(())).unwrap();
    let ring_radius = PatternRuler::new(&blob, &scenario).unwrap().ring_radius();
    let away = |pose: &&Pose| (pose.position - swarm.scene().targets()[0].unwrap()).length() > 2.0 * ring_radius;
    swarm.poses().iter().filter(away).count()
}

#[test]
fn nobody_is_left_standing_behind_a_box_that_no_map_knows() {
    for model in MODELS {
        for seed in 1..=6 {
            let left = (left_behind_a_box::<f32>(model, seed), left_behind_a_box::<Q8_24>(model, seed));
            assert_eq!(left, (0, 0), "{model}, seed {seed}");
        }
    }
}
