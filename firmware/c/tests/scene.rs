//! The C functions give what the controller gives, bit for bit: in the examples' scene, and for percepts at random.
#![allow(clippy::unwrap_used)]

use grn_c::*;
use grn_core::blob::Blob;
use grn_core::robot::{
    Command, Controller, Fix, Heard, Message, Millimetres, ObstacleReport, Percept, Sighting, TargetReport,
};
use grn_core::scalar::{Q8_24, Scalar};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn firmware() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn model(name: &str) -> Vec<u8> {
    fs::read(firmware().join("../models").join(name)).unwrap()
}

const MODELS: [&str; 5] = ["nand-xnor.grn", "andn-nand-xnor.grn", "andn-xnor.grn", "eh-grn-1.grn", "eh-grn-2.grn"];

fn at(x: i16, y: i16) -> Millimetres {
    Millimetres { x, y }
}

/// What `perceive` in examples/c/scene.c gives.
fn perceive(tick: i16) -> Percept {
    let (mut cos, mut sin) = (1 << 14, 0);
    for _ in 0..tick {
        cos -= sin / 16;
        sin += cos / 16;
    }
    let mut percept = Percept::nothing();
    percept.fix = Some(Fix { position: [-400_000 + 3125 * i32::from(tick), -300_000], heading: [cos, sin], age_ms: 0 });
    if tick >= 48 {
        percept.proximity[5] = (400 - 10 * (tick - 48)) as u16;
    }
    if tick % 8 == 0 {
        percept.targets.push(Sighting { target: 1, position: at(100, 2 * tick) }).unwrap();
    }
    if tick % 4 == 1 {
        let target = TargetReport { target: 2, position: at(-600, 500), velocity: [0, -40], age: 12 };
        let obstacles = [
            ObstacleReport { position: at(150, -350), age: 1 },
            ObstacleReport { position: at(200, -350 - tick), age: 0 },
        ];
        let message = Message {
            sender: 7,
            position: at(3 * tick, -250),
            target: (tick > 16).then_some(target),
            obstacles: obstacles.into_iter().collect(),
        };
        percept.heard.push(Heard { message, age_ms: 0 }).unwrap();
    }
    percept
}

/// What `play` in examples/c/scene.c prints.
fn play<S: Scalar>(blob: &Blob) -> String {
    let mut controller = Controller::<S>::new(blob, 3).unwrap();
    let mut text = format!("{} {:016x}\n", S::NAME, u64::from_be_bytes(controller.identity()));
    for tick in 0..64 {
        let Command { left, right, broadcast } = controller.tick(&perceive(tick)).unwrap();
        let bits = controller.morphogen().to_f32().to_bits();
        write!(text, "{tick} {bits:08x} {left} {right}").unwrap();
        if let Some(message) = broadcast {
            write!(text, " says {} {} {}", message.sender, message.position.x, message.position.y).unwrap();
            if let Some(TargetReport { target, position: Millimetres { x, y }, velocity, age }) = message.target {
                write!(text, " target {target} {x} {y} {} {} {age}", velocity[0], velocity[1]).unwrap();
            }
            for ObstacleReport { position: Millimetres { x, y }, age } in &message.obstacles {
                write!(text, " obstacle {x} {y} {age}").unwrap();
            }
        }
        text.push('\n');
    }
    text
}

#[test]
fn what_the_examples_print_is_what_the_controller_does() {
    let blob = Blob::decode(&model("nand-xnor.grn")).unwrap();
    let made = play::<f32>(&blob) + &play::<Q8_24>(&blob);
    let path = firmware().join("examples/c/expected.txt");
    if env::var_os("GRN_BLESS").is_some() {
        fs::write(&path, &made).unwrap();
    }
    let golden = fs::read_to_string(&path).unwrap_or_default();
    assert!(made == golden, "examples/c/expected.txt is stale: if it may change, `cargo xtask c --bless`");
}

fn point(Millimetres { x, y }: Millimetres) -> GrnMillimetres {
    GrnMillimetres { x, y }
}

fn message(message: &Message) -> GrnMessage {
    let target = message.target.map(|TargetReport { target, position, velocity, age }| GrnTargetReport {
        target,
        position: point(position),
        velocity,
        age,
        ..GrnTargetReport::default()
    });
    let mut told = GrnMessage {
        sender: message.sender,
        position: point(message.position),
        has_target: target.is_some().into(),
        target: target.unwrap_or_default(),
        obstacle_count: message.obstacles.len() as u8,
        ..GrnMessage::default()
    };
    for (slot, report) in told.obstacles.iter_mut().zip(&message.obstacles) {
        *slot = GrnObstacleReport { position: point(report.position), age: report.age, reserved: 0 };
    }
    told
}

fn percept(percept: &Percept) -> GrnPercept {
    // By name, so that a field that a percept gets is missed here.
    let Percept { fix, elapsed_us, proximity, targets, obstacles, heard } = percept;
    let mut told = GrnPercept::nothing();
    (told.elapsed_us, told.proximity) = (*elapsed_us, *proximity);
    if let Some(Fix { position, heading, age_ms }) = *fix {
        (told.has_fix, told.fix) = (1, GrnFix { position, heading, age_ms, reserved: [0; 2] });
    }
    told.target_count = targets.len() as u8;
    told.obstacle_count = obstacles.len() as u8;
    told.heard_count = heard.len() as u8;
    for (slot, sighting) in told.targets.iter_mut().zip(targets) {
        *slot = GrnSighting { target: sighting.target, reserved: 0, position: point(sighting.position) };
    }
    for (slot, &position) in told.obstacles.iter_mut().zip(obstacles) {
        *slot = point(position);
    }
    for (slot, heard) in told.heard.iter_mut().zip(heard) {
        *slot = GrnHeard { message: message(&heard.message), age_ms: heard.age_ms };
    }
    told
}

/// A percept in which everything is random; the generator is Knuth's, of which the upper bits are taken.
fn random(state: &mut u64) -> Percept {
    let mut next = move || {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 40) as u32
    };
    let mut number = |low: i32, high: i32| low + (next() % (high - low + 1) as u32) as i32;
    let place = |number: &mut dyn FnMut(i32, i32) -> i32| at(number(-900, 900) as i16, number(-900, 900) as i16);
    let angle = f64::from(number(0, 359)).to_radians();
    let (sin, cos) = libm::sincos(angle);
    let length = f64::from(number(15_880, 16_880));
    let fix = Fix {
        position: [number(-800_000, 800_000), number(-800_000, 800_000)],
        heading: [(cos * length) as i16, (sin * length) as i16],
        age_ms: number(0, 400) as u16,
    };
    let mut percept = Percept {
        fix: (number(0, 3) > 0).then_some(fix),
        elapsed_us: number(1_000, 250_000) as u32,
        proximity: [(); 8].map(|()| number(0, 500) as u16),
        targets: heapless::Vec::new(),
        obstacles: heapless::Vec::new(),
        heard: heapless::Vec::new(),
    };
    for _ in 0..number(0, 4) {
        let target = number(0, 5) as u8;
        percept.targets.push(Sighting { target, position: place(&mut number) }).unwrap();
    }
    for _ in 0..number(0, 8) {
        percept.obstacles.push(place(&mut number)).unwrap();
    }
    for _ in 0..number(0, 8) {
        let report = TargetReport {
            target: number(0, 5) as u8,
            position: place(&mut number),
            velocity: [number(-128, 127) as i8, number(-128, 127) as i8],
            age: number(0, 255) as u8,
        };
        let mut message = Message {
            sender: number(0, 65_535) as u16,
            position: place(&mut number),
            target: (number(0, 1) == 1).then_some(report),
            obstacles: heapless::Vec::new(),
        };
        for _ in 0..number(0, 4) {
            let age = number(0, 255) as u8;
            message.obstacles.push(ObstacleReport { position: place(&mut number), age }).unwrap();
        }
        percept.heard.push(Heard { message, age_ms: number(0, 3000) as u16 }).unwrap();
    }
    percept
}

fn compare<S: Scalar>(bytes: &[u8], number: GrnNumber) {
    let mut controller = Controller::<S>::new(&Blob::decode(bytes).unwrap(), 9).unwrap();
    let mut storage = GrnController::default();
    let size = size_of::<GrnController>();
    let status = unsafe { grn_load(&mut storage, size, bytes.as_ptr(), bytes.len(), number as i32, 9) };
    assert_eq!(status, GrnStatus::Ok);
    let mut identity = [0; GRN_IDENTITY_BYTES];
    assert_eq!(unsafe { grn_identity(&storage, identity.as_mut_ptr()) }, GrnStatus::Ok);
    assert_eq!(identity, controller.identity());
    let mut state = 1;
    for tick in 0..300 {
        let perceived = random(&mut state);
        let Command { left, right, broadcast } = controller.tick(&perceived).unwrap();
        let mut command = GrnCommand::default();
        assert_eq!(unsafe { grn_tick(&mut storage, &percept(&perceived), &mut command) }, GrnStatus::Ok);
        let expected = GrnCommand {
            left,
            right,
            has_broadcast: broadcast.is_some().into(),
            reserved: 0,
            broadcast: broadcast.as_ref().map(message).unwrap_or_default(),
        };
        assert_eq!(command, expected, "tick {tick}");
        let mut morphogen = f32::NAN;
        assert_eq!(unsafe { grn_morphogen(&storage, &mut morphogen) }, GrnStatus::Ok);
        assert_eq!(f64::from(morphogen), controller.morphogen().to_f64(), "without loss");
    }
}

#[test]
fn random_percepts_give_equal_commands() {
    for name in MODELS {
        let blob = model(name);
        compare::<f32>(&blob, GrnNumber::F32);
        compare::<Q8_24>(&blob, GrnNumber::Q8_24);
    }
}

/// The header said that M is a number from 0 to 1.
#[test]
fn the_morphogen_of_a_last_gene_xnor_may_be_below_zero() {
    let bytes = model("andn-nand-xnor.grn");
    let mut storage = GrnController::default();
    let (size, number) = (size_of::<GrnController>(), GrnNumber::F32 as i32);
    assert_eq!(unsafe { grn_load(&mut storage, size, bytes.as_ptr(), bytes.len(), number, 1) }, GrnStatus::Ok);
    // Nothing but a target far away.
    let mut told = GrnPercept::nothing();
    (told.has_fix, told.fix.heading) = (1, [16_384, 0]);
    told.target_count = 1;
    told.targets[0].position = GrnMillimetres { x: 20_000, y: 0 };
    let (mut command, mut morphogen) = (GrnCommand::default(), 0.0);
    for _ in 0..320 {
        assert_eq!(unsafe { grn_tick(&mut storage, &told, &mut command) }, GrnStatus::Ok);
        assert_eq!(unsafe { grn_morphogen(&storage, &mut morphogen) }, GrnStatus::Ok);
    }
    assert!((-0.01..0.0).contains(&morphogen), "{morphogen}");
    let header = fs::read_to_string(firmware().join("c/include/grn.h")).unwrap();
    assert!(header.contains("XNOR may take it a little below 0") && !header.contains("number from 0 to 1"));
}
