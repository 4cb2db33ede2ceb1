//! A robot and random frames: whatever comes over the link, it answers or drops it, and never panics.
#![allow(clippy::unwrap_used, reason = "what only tests call")]

use grn_core::robot::link::frame;
use grn_core::robot::link::message::{Activate, Begin, Chunk, Confirm, REFUSED, Request, Reset, RollBack, VERSION};
use grn_core::robot::percept::MAX_POSITION;
use grn_core::robot::{Fix, Heard, Message, Millimetres, ObstacleReport, Percept, Sighting, TargetReport};
use grn_link::flashing::flash;
use grn_tests::robots::{Shipped, client, empty_flash, say, server};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// An operation and its payload as a host might mean it.
fn sensible(rng: &mut Pcg64, model: &Shipped) -> (u8, Vec<u8>) {
    let identity = if rng.random_bool(0.5) { model.identity } else { rng.random() };
    let mut buffer = [0; 600];
    let operation = rng.random_range(1..11);
    let written = match operation {
        Begin::OPERATION => postcard::to_slice(&Begin { length: rng.random_range(0..500), identity }, &mut buffer),
        Chunk::OPERATION => {
            let bytes = (0..8 * rng.random_range(0..9)).map(|_| rng.random()).collect();
            postcard::to_slice(&Chunk { offset: 8 * rng.random_range(0..3), bytes }, &mut buffer)
        }
        Activate::OPERATION | Confirm::OPERATION | RollBack::OPERATION => {
            postcard::to_slice(&Activate { identity }, &mut buffer)
        }
        Reset::OPERATION => postcard::to_slice(&Reset { robot: rng.random() }, &mut buffer),
        Percept::OPERATION => postcard::to_slice(&percept(rng), &mut buffer),
        _ => postcard::to_slice(&(), &mut buffer),
    };
    (operation, written.unwrap().to_vec())
}

fn senseless(rng: &mut Pcg64) -> (u8, Vec<u8>) {
    let longest = if rng.random_bool(0.1) { 400 } else { 30 };
    let length = rng.random_range(0..longest);
    let operation = if rng.random_bool(0.9) { rng.random_range(0..12) } else { rng.random() };
    (operation, (0..length).map(|_| rng.random()).collect())
}

/// Anything, near and far; a few that no robot can have.
fn percept(rng: &mut Pcg64) -> Percept {
    let spread = if rng.random_bool(0.5) { 2000 } else { i16::MAX };
    let mut millimetres = {
        let mut rng = Pcg64::seed_from_u64(rng.random());
        move || Millimetres { x: rng.random_range(-spread..=spread), y: rng.random_range(-spread..=spread) }
    };
    let message = |_| Message {
        sender: rng.random(),
        position: millimetres(),
        target: Some(TargetReport {
            target: rng.random_range(0..6),
            position: millimetres(),
            velocity: rng.random(),
            age: rng.random(),
        }),
        obstacles: (0..4).map(|_| ObstacleReport { position: millimetres(), age: rng.random() }).collect(),
    };
    let messages: Vec<Message> = (0..3).map(message).collect();
    let heard = messages.into_iter().map(|message| Heard { message, age_ms: rng.random() }).collect();
    let possible = rng.random_bool(0.9);
    let far = if possible { MAX_POSITION } else { i32::MAX };
    let headings = [[16_384, 0], [0, -16_384], [11_585, 11_585], [-14_189, 8_192]];
    Percept {
        fix: rng.random_bool(0.7).then(|| Fix {
            position: [(); 2].map(|()| rng.random_range(-far..=far)),
            heading: if possible { headings[rng.random_range(0..headings.len())] } else { rng.random() },
            age_ms: if rng.random_bool(0.5) { rng.random_range(0..700) } else { rng.random() },
        }),
        elapsed_us: if possible { rng.random_range(1_000..=250_000) } else { rng.random() },
        proximity: rng.random(),
        targets: (0..2).map(|target| Sighting { target, position: millimetres() }).collect(),
        obstacles: (0..4).map(|_| millimetres()).collect(),
        heard,
    }
}

/// Random frames, sound and unsound, with and without sense; `GRN_FUZZ_INPUTS` asks for more.
#[test]
fn no_frame_makes_a_robot_panic() -> Outcome {
    let inputs = match std::env::var("GRN_FUZZ_INPUTS") {
        Ok(asked) => asked.parse()?,
        Err(_) => 200_000,
    };
    let model = Shipped::named("nand-xnor");
    let mut client = client(server(empty_flash(0)));
    flash(&mut client, &model.bytes, model.identity, true, |_| {})?;
    let mut server = client.into_wire().into_server();
    let mut rng = Pcg64::seed_from_u64(11);
    let (mut answered, mut done) = (0_u64, 0_u64);
    for input in 0..inputs {
        if input > 0 && input % 1_000_000 == 0 {
            println!("{input} frames");
        }
        let (operation, mut payload) =
            if rng.random_bool(0.5) { sensible(&mut rng, &model) } else { senseless(&mut rng) };
        if !payload.is_empty() && rng.random_bool(0.2) {
            let at = rng.random_range(0..payload.len());
            payload[at] = rng.random();
        }
        let version = if rng.random_bool(0.9) { VERSION } else { rng.random() };
        let write = |room: &mut [u8]| {
            room.get_mut(..payload.len())?.copy_from_slice(&payload);
            Some(payload.len())
        };
        let mut bytes = frame::encode([version, input as u8, operation], write).map_err(|_| "too long")?;
        if rng.random_bool(0.2) {
            let at = rng.random_range(0..bytes.len());
            bytes[at] = rng.random();
        }
        if let Some((operation, _)) = say(&mut server, &bytes) {
            answered += 1;
            done += u64::from(operation != REFUSED);
        }
    }
    println!("{inputs} frames, {answered} answered, {done} requests done");
    assert!(answered > inputs / 2 && done > inputs / 5, "{answered} answered, {done} done: the exercise has no edge");
    Ok(())
}
