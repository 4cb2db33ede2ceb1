//! The bytes that host and robot exchange. Both may be of different releases, so no byte may change unnoticed.
#![allow(clippy::unwrap_used, reason = "what only tests call")]

use grn_core::robot::link::Refusal;
use grn_core::robot::link::message::{
    Activate, Begin, Chunk, Commit, Confirm, Identify, Request, Reset, RollBack, Status, VERSION, decode_message,
};
use grn_core::robot::link::refusal::{BlobFault, LoadFault, PerceptFault};
use grn_core::robot::{Command, Fix, Heard, Message, Millimetres, ObstacleReport, Percept, Sighting, TargetReport};

fn bytes(message: &impl serde::Serialize) -> Vec<u8> {
    postcard::to_slice(message, &mut [0; 600]).unwrap().to_vec()
}

/// The bytes on the wire, which every later version must keep.
#[test]
fn frozen_messages_have_exactly_these_bytes() {
    let identity = [1, 2, 3, 4, 5, 6, 7, 8];
    assert!(bytes(&Identify).is_empty());
    assert!(bytes(&Status).is_empty());
    assert_eq!(bytes(&Begin { length: 300, identity }), [0xac, 2, 1, 2, 3, 4, 5, 6, 7, 8]);
    assert_eq!(bytes(&Chunk { offset: 8, bytes: [9, 9].into_iter().collect() }), [8, 2, 9, 9]);
    assert!(bytes(&Commit).is_empty());
    assert_eq!(bytes(&Activate { identity }), identity);
    assert_eq!(bytes(&Confirm { identity }), identity);
    assert_eq!(bytes(&RollBack { identity }), identity);
    assert_eq!(bytes(&Reset { robot: 519 }), [135, 4]);
    let operations = [
        Identify::OPERATION,
        Status::OPERATION,
        Begin::OPERATION,
        Chunk::OPERATION,
        Commit::OPERATION,
        Activate::OPERATION,
        Confirm::OPERATION,
        RollBack::OPERATION,
        Reset::OPERATION,
        Percept::OPERATION,
    ];
    assert_eq!(operations, [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]);
    let refusals = [
        (Refusal::Version { spoken: 7 }, vec![0, 7]),
        (Refusal::Unknown, vec![1]),
        (Refusal::Malformed, vec![2]),
        (Refusal::Layout, vec![3]),
        (Refusal::Flash, vec![4]),
        (Refusal::TooLong, vec![5]),
        (Refusal::OnTrial, vec![6]),
        (Refusal::NoUpload, vec![7]),
        (Refusal::Chunk { expected: 8 }, vec![8, 8]),
        (Refusal::Blob(BlobFault::Length), vec![9, 0]),
        (Refusal::Blob(BlobFault::NotABlob), vec![9, 1]),
        (Refusal::Blob(BlobFault::Version { found: 2, read: 1 }), vec![9, 2, 2, 1]),
        (Refusal::Blob(BlobFault::Damaged), vec![9, 3]),
        (Refusal::Blob(BlobFault::Convention(4)), vec![9, 4, 4]),
        (Refusal::Blob(BlobFault::TooManyGenes { genes: 40, capacity: 32 }), vec![9, 5, 40, 32]),
        (Refusal::Blob(BlobFault::Content), vec![9, 6]),
        (Refusal::Blob(BlobFault::UnknownCode), vec![9, 7]),
        (Refusal::OtherBlob, vec![10]),
        (Refusal::NotThere, vec![11]),
        (Refusal::NoFallback, vec![12]),
        (Refusal::MarksUsedUp, vec![13]),
        (Refusal::Load(LoadFault::NoPattern), vec![14, 0]),
        (Refusal::Load(LoadFault::NoRing), vec![14, 1]),
        (Refusal::Load(LoadFault::StepsPerTick), vec![14, 2]),
        (Refusal::NoController, vec![15]),
        (Refusal::Percept(PerceptFault::Position), vec![16, 0]),
        (Refusal::Percept(PerceptFault::Heading), vec![16, 1]),
        (Refusal::Percept(PerceptFault::Elapsed), vec![16, 2]),
        (Refusal::SequenceUsedUp, vec![17]),
    ];
    for (refusal, expected) in refusals {
        assert_eq!(bytes(&refusal), expected, "{refusal:?}");
        assert!(refusal.to_string().len() > 20, "{refusal:?} says too little");
    }
}

fn message() -> Message {
    Message {
        sender: 519,
        position: Millimetres { x: 258, y: -259 },
        target: Some(TargetReport { target: 1, position: Millimetres { x: -2, y: 300 }, velocity: [-5, 6], age: 200 }),
        obstacles: [ObstacleReport { position: Millimetres { x: 1000, y: -1000 }, age: 3 }].into_iter().collect(),
    }
}

/// Every field by name and with a value of its own, so that a new field is missed here.
fn percept() -> Percept {
    Percept {
        fix: Some(Fix { position: [-1_000_000, 70_000], heading: [11_585, -11_585], age_ms: 130 }),
        elapsed_us: 31_250,
        proximity: [0, 1, 127, 128, 500, 16_383, 16_384, u16::MAX],
        targets: [Sighting { target: 2, position: Millimetres { x: 10, y: -11 } }].into_iter().collect(),
        obstacles: [Millimetres { x: 63, y: -64 }, Millimetres { x: 64, y: -65 }].into_iter().collect(),
        heard: [Heard { message: message(), age_ms: 300 }].into_iter().collect(),
    }
}

fn command() -> Command {
    Command { left: -1100, right: 63, broadcast: Some(message()) }
}

/// Percept and command of operation 10 in each version of the protocol.
#[rustfmt::skip]
const TICK: [(u8, &[u8], &[u8]); 2] = [(
    1,
    &[
        255, 136, 122, 224, 197, 8, // position
        130, 181, 1, 129, 181, 1, // heading
        0, 1, 127, 128, 1, 244, 3, 255, 127, 128, 128, 1, 255, 255, 3, // proximity
        1, 2, 20, 21, // targets
        2, 126, 127, 128, 1, 129, 1, // obstacles
        1, 7, 132, 4, 133, 4, 1, 1, 3, 216, 4, 251, 6, 200, 1, 208, 15, 207, 15, 3, // heard
    ],
    &[
        151, 17, 126, // wheels
        1, 7, 132, 4, 133, 4, 1, 1, 3, 216, 4, 251, 6, 200, 1, 208, 15, 207, 15, 3, // broadcast
    ],
), (
    2,
    &[
        1, 255, 136, 122, 224, 197, 8, 130, 181, 1, 129, 181, 1, 130, 1, // fix: position, heading, age
        146, 244, 1, // elapsed
        0, 1, 127, 128, 1, 244, 3, 255, 127, 128, 128, 1, 255, 255, 3, // proximity
        1, 2, 20, 21, // targets
        2, 126, 127, 128, 1, 129, 1, // obstacles
        1, 135, 4, 132, 4, 133, 4, 1, 1, 3, 216, 4, 251, 6, 200, 1, 208, 15, 207, 15, 3, 172, 2, // heard, each with its age
    ],
    &[
        151, 17, 126, // wheels
        1, 135, 4, 132, 4, 133, 4, 1, 1, 3, 216, 4, 251, 6, 200, 1, 208, 15, 207, 15, 3, // broadcast
    ],
)];

const WAY_OUT: &str = "\
    The bytes of operation 10 are not those of this version of the link, so hosts and robots of other releases would read \
    nonsense. If they are meant to change: raise VERSION in grn-core/src/robot/link/message.rs, add a line with the new \
    bytes to TICK in tests/tests/link_bytes.rs (leave the old lines), and describe the new version in docs/link.md.";

#[test]
fn a_tick_has_exactly_the_bytes_of_its_protocol_version() {
    let (_, percept_bytes, command_bytes) =
        TICK.into_iter().find(|&(version, ..)| version == VERSION).unwrap_or_else(|| {
            panic!("no bytes are kept for version {VERSION} of the link. {WAY_OUT}");
        });
    assert_eq!(bytes(&percept()), percept_bytes, "the percept. {WAY_OUT}");
    assert_eq!(bytes(&command()), command_bytes, "the command. {WAY_OUT}");
    assert_eq!(decode_message(percept_bytes), Some(percept()), "the percept is read otherwise. {WAY_OUT}");
    assert_eq!(decode_message(command_bytes), Some(command()), "the command is read otherwise. {WAY_OUT}");
}

#[test]
fn a_tick_without_anything_has_exactly_these_bytes() {
    let nothing = [0, 146, 244, 1];
    let far = [0xff, 0xff, 3].repeat(8);
    assert_eq!(bytes(&Percept::nothing()), [&nothing[..], &far, &[0, 0, 0]].concat(), "{WAY_OUT}");
    assert_eq!(bytes(&Command::default()), [0, 0, 0], "{WAY_OUT}");
}
