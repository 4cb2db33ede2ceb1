//! What using robots has shown to go wrong, one test a fault, named after it.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use firmware_sim::brain::{Brain, BrainError};
use firmware_sim::{Scenario, Swarm, SwarmConfig};
use grn_core::blob::Blob;
use grn_core::network::DEFAULT_GENES;
use grn_core::robot::{Command, Controller, Message, Percept};
use grn_core::scalar::{Q8_24, Scalar};
use grn_tests::golden::repository;
use grn_tests::robots::Shipped;

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
        let command = self.controller.tick(&percept);
        self.sent.clone_from(&command.broadcast);
        Ok(command)
    }
}

/// The bytes of half a minute of twelve robots in the channel.
fn trace_bytes<S: Scalar>(loopback: bool) -> Vec<u8> {
    let scenario = Scenario::load(repository("scenarios/channel.toml")).unwrap();
    let blob = Blob::<DEFAULT_GENES>::decode(&Shipped::named("nand-xnor").bytes).unwrap();
    let config = SwarmConfig { robots: 12, ..SwarmConfig::default() };
    let brain = |robot: usize| OnRadio {
        controller: Controller::<S>::new(&blob, robot as u8).unwrap(),
        loopback,
        sent: None,
    };
    let mut swarm = Swarm::new(&scenario, config, brain).unwrap();
    (0..30 * 32).for_each(|_| swarm.step().unwrap());
    swarm.trace().encode()
}

#[test]
fn a_robot_that_hears_its_own_broadcast_drives_as_if_it_did_not() {
    assert!(trace_bytes::<f32>(true) == trace_bytes::<f32>(false));
    assert!(trace_bytes::<Q8_24>(true) == trace_bytes::<Q8_24>(false));
}
