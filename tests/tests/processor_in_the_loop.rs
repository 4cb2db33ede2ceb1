//! The image that is flashed, in QEMU, against the same controller in this process. `cargo xtask target` builds the images
//! and runs these tests.
#![allow(clippy::unwrap_used, reason = "what only tests call")]

use firmware_sim::link::RemoteBrain;
use firmware_sim::link::qemu::Emulator;
use firmware_sim::{Brain, Scenario, Swarm, SwarmConfig};
use grn_core::blob::Blob;
use grn_core::network::DEFAULT_GENES;
use grn_core::robot::Controller;
use grn_core::robot::link::message::{RollBack, Status};
use grn_core::robot::slots::Stage;
use grn_core::scalar::{Q8_24, Scalar};
use grn_link::flashing::flash;
use grn_link::{Client, Patience};
use grn_tests::robots::Shipped;
use std::path::{Path, PathBuf};

type Outcome = Result<(), Box<dyn std::error::Error>>;

const TICKS_PER_SECOND: u64 = 32;
const EMULATED: usize = 4;

fn image(name: &str) -> PathBuf {
    let images = "../firmware/target/thumbv7em-none-eabihf/release";
    Path::new(env!("CARGO_MANIFEST_DIR")).join(images).join(name)
}

/// Twelve robots in the channel, four of them emulated, and the same twelve all in this process: one trace.
fn emulated_robots_leave_the_same_trace<S: Scalar>(name: &str, seconds: u64) -> Outcome {
    let scenario = Scenario::load(format!("{}/../scenarios/channel.toml", env!("CARGO_MANIFEST_DIR")))?;
    let model = Shipped::named("andn-nand-xnor");
    let blob = Blob::<DEFAULT_GENES>::decode(&model.bytes)?;
    let config = || SwarmConfig { scale: 0.25, ..SwarmConfig::default() };
    let controller = |robot: usize| Controller::<S>::new(&blob, robot as u16).unwrap();
    let mut native = Swarm::new(&scenario, config(), controller)?;
    let sockets = tempfile::tempdir()?;
    let mut emulated = Swarm::new(&scenario, config(), |robot| -> Box<dyn Brain> {
        if robot >= EMULATED {
            return Box::new(controller(robot));
        }
        let emulator = Emulator::start(&image(name), sockets.path().join(robot.to_string())).unwrap();
        let (client, _) = Client::connect(emulator, Patience::default()).unwrap();
        Box::new(RemoteBrain::start(client, &model.bytes, model.identity, robot as u16).unwrap())
    })?;
    for _ in 0..seconds * TICKS_PER_SECOND {
        native.step()?;
        emulated.step()?;
        assert_eq!(native.poses(), emulated.poses(), "tick {}", native.tick());
        assert_eq!(native.frame().robots, emulated.frame().robots, "tick {}", native.tick());
    }
    Ok(())
}

#[test]
fn emulated_robots_leave_the_same_trace_in_f32() -> Outcome {
    emulated_robots_leave_the_same_trace::<f32>("robot-f32", 60)
}

#[test]
fn emulated_robots_leave_the_same_trace_in_q8_24() -> Outcome {
    emulated_robots_leave_the_same_trace::<Q8_24>("robot-q8_24", 10)
}

#[test]
fn an_emulated_robot_is_flashed_confirmed_and_rolled_back() -> Outcome {
    let (old, new) = (Shipped::named("nand-xnor"), Shipped::named("eh-grn-1"));
    let sockets = tempfile::tempdir()?;
    let emulator = Emulator::start(&image("robot-f32"), sockets.path().join("robot"))?;
    let (mut client, about) = Client::connect(emulator, Patience::default())?;
    assert_eq!(about.name, "netduinoplus2");
    flash(&mut client, &old.bytes, old.identity, true, |_| {})?;
    flash(&mut client, &new.bytes, new.identity, true, |_| {})?;
    assert_eq!(client.ask(&Status)?.slots.map(|slot| slot.stage), [Stage::Confirmed; 2]);
    client.ask(&RollBack { identity: new.identity })?;
    let status = client.ask(&Status)?;
    assert_eq!((status.active, status.slots[1].stage), (Some(0), Stage::Rejected));
    Ok(())
}
