//! The link between host and robot: what is said, what is refused, and what bad wires do to it.
#![allow(clippy::unwrap_used, reason = "what only tests call")]

use firmware_sim::link::RemoteBrain;
use firmware_sim::link::faults::{Faults, FaultyWire};
use firmware_sim::{Brain, Scenario, Swarm, SwarmConfig};
use grn_core::blob::{Blob, BlobError, FORMAT_VERSION};
use grn_core::motif::Motif;
use grn_core::robot::link::Refusal;
use grn_core::robot::link::frame::{self};
use grn_core::robot::link::message::{
    About, Activate, Begin, Chunk, Commit, Confirm, REFUSED, RESPONSE, Request, Reset, RollBack, Status, VERSION,
    decode_message, encode_request,
};
use grn_core::robot::link::refusal::{BlobFault, PerceptFault};
use grn_core::robot::link::server::TRIAL_TICKS;
use grn_core::robot::percept::{HEADING_UNIT, MAX_POSITION};
use grn_core::robot::slots::{MAX_BLOB, Stage};
use grn_core::robot::{Controller, Fix, Percept};
use grn_core::scalar::NumberType;
use grn_link::flashing::{Flashed, flash};
use grn_link::wire::LocalRobot;
use grn_link::{Client, LinkError, Patience, Wire};
use grn_tests::decoder::sealed;
use grn_tests::robots::{PATIENCE, Shipped, blob_of_genes, client, empty_flash, say, server};
use std::io::ErrorKind;
use std::time::Duration;

type Outcome = Result<(), Box<dyn std::error::Error>>;

fn upload_raw(client: &mut Client<impl Wire>, bytes: &[u8]) -> Result<(), LinkError> {
    client.ask(&Begin { length: bytes.len() as u32, identity: *bytes[7..].first_chunk().unwrap() })?;
    for (place, bytes) in bytes.chunks(64).enumerate() {
        client.ask(&Chunk { offset: place as u32 * 64, bytes: bytes.iter().copied().collect() })?;
    }
    client.ask(&Commit)
}

fn refusal<T>(result: Result<T, LinkError>) -> Refusal {
    match result {
        Err(LinkError::Refused(refusal)) => refusal,
        Err(error) => panic!("{error}"),
        Ok(_) => panic!("not refused"),
    }
}

#[test]
fn a_blob_is_flashed_proves_itself_and_is_rolled_back() -> Outcome {
    let model = Shipped::named("nand-xnor");
    let other = model.cruising_at(0.1);
    let (mut client, about) = Client::connect(LocalRobot::new(server(empty_flash(0))), PATIENCE)?;
    let expected = About {
        protocol: VERSION,
        blob_format: FORMAT_VERSION,
        genes: 32,
        blob_bytes: MAX_BLOB as u16,
        number_type: NumberType::F32,
        name: "test robot".try_into().map_err(|_| "too long")?,
    };
    assert_eq!(about, expected);
    assert_eq!(refusal(client.ask(&Percept::nothing())), Refusal::NoController);
    assert_eq!(refusal(client.ask(&Reset { robot: 1 })), Refusal::NoController);
    assert_eq!(flash(&mut client, &model.bytes, model.identity, true, |_| {})?, Flashed::InCharge);
    assert_eq!(flash(&mut client, &model.bytes, model.identity, true, |_| {})?, Flashed::WasInCharge);
    assert_eq!(flash(&mut client, &other.bytes, other.identity, false, |_| {})?, Flashed::InCharge);
    for _ in 1..TRIAL_TICKS {
        client.ask(&Percept::nothing())?;
    }
    assert_eq!(client.ask(&Status)?.slots[1].stage, Stage::Trial);
    client.ask(&Percept::nothing())?;
    let status = client.ask(&Status)?;
    assert_eq!((status.active, status.ticks, status.slots[1].stage), (Some(1), TRIAL_TICKS, Stage::Confirmed));
    assert_eq!(refusal(client.ask(&Confirm { identity: model.identity })), Refusal::NotThere);
    client.ask(&RollBack { identity: other.identity })?;
    assert_eq!(client.ask(&Status)?.active, Some(0));
    assert_eq!(refusal(client.ask(&RollBack { identity: model.identity })), Refusal::NoFallback);
    Ok(())
}

#[test]
fn a_robot_behind_the_link_does_what_a_robot_in_the_process_does() -> Outcome {
    let scenario = Scenario::load(format!("{}/../scenarios/channel.toml", env!("CARGO_MANIFEST_DIR")))?;
    let model = Shipped::named("andn-nand-xnor");
    let blob = Blob::<32>::decode(&model.bytes)?;
    let config = || SwarmConfig { scale: 0.25, ..SwarmConfig::default() }.with_robots(6);
    let mut native = Swarm::new(&scenario, config(), |robot| Controller::<f32>::new(&blob, robot as u16).unwrap())?;
    let mut remote = Swarm::new(&scenario, config(), |robot| -> Box<dyn Brain> {
        let client = client(server(empty_flash(robot as u64)));
        Box::new(RemoteBrain::start(client, &model.bytes, model.identity, robot as u16).unwrap())
    })?;
    for _ in 0..300 {
        native.step()?;
        remote.step()?;
        assert_eq!(native.frame().robots, remote.frame().robots, "the link changes something");
    }
    assert_eq!(native.poses(), remote.poses(), "the link changes something");
    Ok(())
}

#[test]
fn each_request_is_done_once_however_often_it_arrives() -> Outcome {
    let model = Shipped::named("nand-xnor");
    let mut client = client(server(empty_flash(0)));
    flash(&mut client, &model.bytes, model.identity, true, |_| {})?;
    let mut server = client.into_wire().into_server();
    let request = encode_request(77, &Percept::nothing()).map_err(|_| "too long")?;
    let first = say(&mut server, &request);
    for _ in 0..3 {
        assert_eq!(say(&mut server, &request), first);
    }
    let status = say(&mut server, &encode_request(78, &Status).map_err(|_| "too long")?).ok_or("no answer")?;
    let status: <Status as Request>::Response = decode_message(&status.1).ok_or("no status")?;
    assert_eq!(status.ticks, 1);
    Ok(())
}

#[test]
fn percepts_that_no_robot_can_have_are_refused_and_are_no_tick() -> Outcome {
    let model = Shipped::named("nand-xnor");
    let mut client = client(server(empty_flash(0)));
    flash(&mut client, &model.bytes, model.identity, true, |_| {})?;
    client.ask(&Percept::nothing())?;
    let fixed = |position, heading| {
        let fix = Some(Fix { position, heading, age_ms: 0 });
        Percept { fix, ..Percept::nothing() }
    };
    let hasty = Percept { elapsed_us: 31, ..Percept::nothing() };
    for (percept, fault, words) in [
        (fixed([0; 2], [0, 0]), PerceptFault::Heading, "unit vector"),
        (fixed([MAX_POSITION + 1, 0], [HEADING_UNIT, 0]), PerceptFault::Position, "range"),
        (hasty, PerceptFault::Elapsed, "microseconds"),
    ] {
        let refusal = refusal(client.ask(&percept));
        assert_eq!(refusal, Refusal::Percept(fault));
        assert!(refusal.to_string().contains(words), "{refusal}");
    }
    assert_eq!(client.ask(&Status)?.ticks, 1);
    Ok(())
}

#[test]
fn requests_and_codes_that_a_robot_does_not_know_ask_for_newer_firmware() -> Outcome {
    let mut server = server(empty_flash(0));
    let unknown = frame::encode([VERSION, 1, 77], |_| Some(0)).map_err(|_| "too long")?;
    let (operation, payload) = say(&mut server, &unknown).ok_or("no answer")?;
    assert_eq!(operation, REFUSED);
    let refusal: Refusal = decode_message(&payload).ok_or("no refusal")?;
    assert!(refusal.to_string().contains("update the robot's firmware"), "{refusal}");
    // A motif of a later release: the blob is sound, so writing it again would change nothing.
    let model = Shipped::named("nand-xnor");
    let payload = &model.bytes[15..model.bytes.len() - 4];
    let motif = payload.iter().position(|&byte| byte == Motif::Nand.code()).ok_or("no NAND")?;
    let mut newer = payload.to_vec();
    newer[motif] = 99;
    let newer = sealed(&newer);
    assert!(matches!(Blob::<32>::decode(&newer), Err(BlobError::Opcode { opcode: 99, .. })), "the case is none");
    let refusal = self::refusal(upload_raw(&mut client(self::server(empty_flash(0))), &newer));
    assert_eq!(refusal, Refusal::Blob(BlobFault::UnknownCode));
    assert!(refusal.to_string().contains("update the robot's firmware"), "{refusal}");
    Ok(())
}

#[test]
fn other_versions_are_refused_but_can_still_upload() -> Outcome {
    let model = Shipped::named("nand-xnor");
    let mut server = server(empty_flash(0));
    let mut sequence = 0;
    let mut ask = |operation: u8, payload: &[u8]| {
        sequence += 1;
        let write = |room: &mut [u8]| {
            room[..payload.len()].copy_from_slice(payload);
            Some(payload.len())
        };
        let bytes = frame::encode([VERSION + 1, sequence, operation], write).unwrap();
        say(&mut server, &bytes).unwrap()
    };
    let payload = |message: &dyn Fn(&mut [u8]) -> usize| {
        let mut buffer = vec![0; 600];
        let length = message(&mut buffer);
        buffer.truncate(length);
        buffer
    };
    let begin = payload(&|room| {
        let begin = Begin { length: model.bytes.len() as u32, identity: model.identity };
        postcard::to_slice(&begin, room).unwrap().len()
    });
    assert_eq!(ask(Begin::OPERATION, &begin), (Begin::OPERATION | RESPONSE, vec![]));
    for (place, bytes) in model.bytes.chunks(64).enumerate() {
        let chunk = payload(&|room| {
            let chunk = Chunk { offset: place as u32 * 64, bytes: bytes.iter().copied().collect() };
            postcard::to_slice(&chunk, room).unwrap().len()
        });
        assert_eq!(ask(Chunk::OPERATION, &chunk).0, Chunk::OPERATION | RESPONSE);
    }
    assert_eq!(ask(Commit::OPERATION, &[]).0, Commit::OPERATION | RESPONSE);
    assert_eq!(ask(Activate::OPERATION, &model.identity).0, Activate::OPERATION | RESPONSE);
    let percept = payload(&|room| postcard::to_slice(&Percept::nothing(), room).unwrap().len());
    let (operation, refused) = ask(Percept::OPERATION, &percept);
    assert_eq!(operation, REFUSED);
    let refusal: Refusal = decode_message(&refused).ok_or("no refusal")?;
    assert_eq!(refusal, Refusal::Version { spoken: VERSION });
    assert!(refusal.to_string().contains("update"));
    assert_eq!(ask(99, &[]).0, REFUSED);
    assert_eq!(ask(Begin::OPERATION, &begin[1..]), (REFUSED, vec![2]), "malformed");
    Ok(())
}

#[test]
fn unsound_blobs_are_refused_with_a_way_out() -> Outcome {
    let model = Shipped::named("nand-xnor");
    let payload = &model.bytes[15..model.bytes.len() - 4];
    let with = |at: usize, byte: u8| {
        let mut bytes = model.bytes.clone();
        bytes[at] = byte;
        bytes
    };
    let mut unfit = payload.to_vec();
    let time_scale = unfit.len() - 9 * 4;
    unfit[time_scale..time_scale + 4].copy_from_slice(&0.3_f32.to_le_bytes());
    let cases = [
        (with(4, FORMAT_VERSION - 1), "write the blob again"),
        (with(4, FORMAT_VERSION + 1), "update the robot's firmware"),
        (model.bytes[..model.bytes.len() - 9].to_vec(), "cut short"),
        (with(30, model.bytes[30] ^ 1), "upload it again"),
        (with(0, b'X'), "choose a .grn file"),
        (blob_of_genes(40), "40 genes, the robot holds at most 32"),
        (sealed(&unfit), "whole RK4 steps"),
    ];
    for (bytes, words) in cases {
        let mut client = client(server(empty_flash(0)));
        let refusal = refusal(upload_raw(&mut client, &bytes)).to_string();
        assert!(refusal.contains(words), "{words:?} is not in {refusal:?}");
        assert_eq!(client.ask(&Status)?.slots[0].stage, Stage::Partial);
        flash(&mut client, &model.bytes, model.identity, true, |_| {})?;
    }
    Ok(())
}

/// Whether flashing succeeded; if not, it must have ended with a word that a person can act on.
fn ended_cleanly<T>(result: Result<T, LinkError>) -> Option<T> {
    match result {
        Ok(done) => Some(done),
        Err(LinkError::Silent { .. } | LinkError::Refused(_)) => None,
        Err(LinkError::Wire(error)) if error.kind() == ErrorKind::ConnectionReset => None,
        Err(error) => panic!("{error}"),
    }
}

/// A wire that counts what is sent.
struct Counted<'a, W> {
    wire: W,
    frames: &'a mut u32,
}

impl<W: Wire> Wire for Counted<'_, W> {
    fn send(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        *self.frames += 1;
        self.wire.send(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], patience: Duration) -> std::io::Result<usize> {
        self.wire.receive(buffer, patience)
    }
}

/// As bad wires as below, and no more patience than `grn flash` has.
#[test]
fn every_upload_ends_after_a_bounded_number_of_frames() {
    let model = Shipped::named("nand-xnor");
    let patience = Patience { tries: Patience::default().tries, ..PATIENCE };
    // Identify, status, begin, commit, activate, confirm; chunks of 8 bytes; and from 64 bytes down to these 6 tries each.
    let most = patience.tries * (6 + model.bytes.len().div_ceil(8) as u32) + 3 * 6;
    let (mut uploads, mut longest) = (0, 0);
    for seed in 0..300 {
        // From hardly any fault to 10 % of all bytes.
        let share = 0.1 / 3.0 * (seed % 10 + 1) as f64 / 10.0;
        let faults = Faults { flipped: share, dropped: share, doubled: share, broken: 1e-4 };
        let mut robot = LocalRobot::new(server(empty_flash(seed)));
        let mut frames = 0;
        let wire = Counted { wire: FaultyWire::new(&mut robot, faults, seed), frames: &mut frames };
        let connected = ended_cleanly(Client::connect(wire, patience));
        let flashed = connected
            .and_then(|(mut client, _)| ended_cleanly(flash(&mut client, &model.bytes, model.identity, true, |_| {})));
        assert!(frames <= most, "{frames} frames");
        longest = longest.max(frames);
        let status = client(robot.into_server()).ask(&Status).unwrap();
        let identity = status.active.map(|slot| status.slots[usize::from(slot)].identity);
        assert!(identity.is_none_or(|identity| identity == model.identity), "a wrong blob is in charge");
        assert!(flashed.is_none() || identity.is_some());
        uploads += usize::from(flashed.is_some());
    }
    println!("{uploads} of 300 uploads; the longest took {longest} of {most} frames");
    assert!((30..270).contains(&uploads), "{uploads} uploads: the exercise has no edge");
}

/// 10 % of all bytes are flipped, lost or doubled, and the connection breaks at random, again and again.
#[test]
fn bad_wires_delay_an_upload_but_never_spoil_it() {
    let (old, new) = (Shipped::named("nand-xnor").cruising_at(0.1), Shipped::named("andn-nand-xnor"));
    let (mut uploads, mut connections) = (0, 0);
    for seed in 0..300 {
        let mut calm = client(server(empty_flash(seed)));
        flash(&mut calm, &old.bytes, old.identity, true, |_| {}).unwrap();
        let mut robot = calm.into_wire();
        let share = 0.1 / 3.0;
        let broken = if seed % 2 == 0 { 1e-4 } else { 0.0 };
        let faults = Faults { flipped: share, dropped: share, doubled: share, broken };
        let flashed = (0..40).any(|connection| {
            connections += 1;
            let faulty = FaultyWire::new(&mut robot, faults, seed << 8 | connection);
            let Some((mut client, _)) = ended_cleanly(Client::connect(faulty, PATIENCE)) else { return false };
            ended_cleanly(flash(&mut client, &new.bytes, new.identity, true, |_| {})).is_some()
        });
        let status = client(robot.into_server()).ask(&Status).unwrap();
        let identity = status.slots[usize::from(status.active.unwrap())].identity;
        assert!([old.identity, new.identity].contains(&identity), "a wrong blob is in charge");
        assert!(!flashed || identity == new.identity);
        uploads += usize::from(flashed);
    }
    println!("{uploads} of 300 uploads in {connections} connections");
    assert_eq!(uploads, 300);
}
