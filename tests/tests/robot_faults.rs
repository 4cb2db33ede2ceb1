//! What using robots has shown to go wrong, one test a fault, named after it.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use firmware_sim::brain::{Brain, BrainError};
use firmware_sim::radio::RadioConfig;
use firmware_sim::{Scenario, Swarm, SwarmConfig};
use grn_core::blob::Blob;
use grn_core::network::DEFAULT_GENES;
use grn_core::robot::{Command, Controller, Message, Percept};
use grn_core::scalar::{NumberType, Q8_24, Scalar};
use grn_tests::golden::repository;
use grn_tests::robots::Shipped;
use host_evolver::simulation::{Simulation, simulate};
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
            percept.heard.insert(0, own).unwrap();
        }
        let command = self.controller.tick(&percept).map_err(|error| BrainError::new(error.to_string()))?;
        self.sent.clone_from(&command.broadcast);
        Ok(command)
    }
}

/// Twelve robots with a shipped model.
fn simulation(model: &str, world: &str, config: SwarmConfig) -> Simulation {
    let scenario = Scenario::load(repository(&format!("scenarios/{world}.toml"))).unwrap();
    let blob = Blob::<DEFAULT_GENES>::decode(&Shipped::named(model).bytes).unwrap();
    let config = SwarmConfig { robots: 12, target_speed_m_per_s: 0.03, ..config };
    simulate(&blob, &scenario, config, NumberType::F32, |_| ControlFlow::Continue(())).unwrap().unwrap()
}

/// The bytes of half a minute of twelve robots in the channel.
fn trace_bytes<S: Scalar>(loopback: bool) -> Vec<u8> {
    let scenario = Scenario::load(repository("scenarios/channel.toml")).unwrap();
    let blob = Blob::<DEFAULT_GENES>::decode(&Shipped::named("nand-xnor").bytes).unwrap();
    let config = SwarmConfig { robots: 12, ..SwarmConfig::default() };
    let brain =
        |robot: usize| OnRadio { controller: Controller::<S>::new(&blob, robot as u8).unwrap(), loopback, sent: None };
    let mut swarm = Swarm::new(&scenario, config, brain).unwrap();
    (0..30 * 32).for_each(|_| swarm.step().unwrap());
    swarm.trace().encode()
}

#[test]
fn a_robot_that_hears_its_own_broadcast_drives_as_if_it_did_not() {
    assert!(trace_bytes::<f32>(true) == trace_bytes::<f32>(false));
    assert!(trace_bytes::<Q8_24>(true) == trace_bytes::<Q8_24>(false));
}

#[test]
fn robots_that_follow_a_broken_contour_along_walls_are_not_accurate() {
    let run = simulation("nand-xnor", "compound-channel", SwarmConfig { seed: 4, ..SwarmConfig::default() });
    let frame = run.trace.frames().last().unwrap();
    let away = frame.robots.iter().filter(|robot| {
        let offset = [0, 1].map(|axis| f64::from(robot.position_um[axis] - frame.targets_um[0][axis]) * 1e-6);
        offset.map(|metres| metres * metres).iter().sum::<f64>().sqrt() > 2.0 * run.ring_radius_m
    });
    assert_eq!((away.count(), run.metrics.lost_robots), (12, 12));
    let verdict = run.verdict();
    assert!(!verdict.accurate && !verdict.known && !verdict.none_lost && !verdict.works(), "{:?}", run.metrics);
    assert_eq!(run.radial_error_share(), None, "most distances are unknown, so the median is");
}

#[test]
fn a_swarm_that_runs_into_itself_again_and_again_does_not_work() {
    let radio = RadioConfig { loss: 0.95, ..RadioConfig::default() };
    let deaf = simulation("nand-xnor", "channel", SwarmConfig { radio, ..SwarmConfig::default() });
    let verdict = deaf.verdict();
    assert!(deaf.metrics.peer_contacts > 12 && !verdict.clear_of_peers && !verdict.works(), "{:?}", deaf.metrics);
    assert!(verdict.encircled && verdict.accurate, "nothing else is wrong: {:?}", deaf.metrics);
}
