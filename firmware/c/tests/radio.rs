//! Messages over the radio, as C code sends and hears them.
#![allow(clippy::unwrap_used)]

use grn_c::*;
use std::ptr::{null, null_mut};

fn message(sender: u16) -> GrnMessage {
    let position = GrnMillimetres { x: 12_345, y: -23_456 };
    let target = GrnTargetReport { target: 3, position, velocity: [-100, 100], age: 7, ..GrnTargetReport::default() };
    let point = GrnObstacleReport { position: GrnMillimetres { x: -1, y: 900 }, age: 9, reserved: 0 };
    GrnMessage {
        sender,
        position,
        has_target: 1,
        target,
        obstacle_count: 4,
        obstacles: [point; GRN_MAX_REPORTED_OBSTACLES],
        ..GrnMessage::default()
    }
}

fn packed(message: &GrnMessage) -> Vec<u8> {
    let (mut bytes, mut length) = ([0; GRN_PACKED_MESSAGE_BYTES], 99);
    let status = unsafe { grn_message_write(message, bytes.as_mut_ptr(), bytes.len(), &mut length) };
    assert_eq!(status, GrnStatus::Ok);
    bytes[..length].to_vec()
}

fn read(bytes: &[u8]) -> (GrnStatus, GrnMessage) {
    let mut got = message(9);
    let status = unsafe { grn_message_read(bytes.as_ptr(), bytes.len(), &mut got) };
    (status, got)
}

fn fragments(message: &GrnMessage, payload: usize, number: u8) -> Vec<Vec<u8>> {
    let fragment = |index| {
        let (mut bytes, mut length) = (vec![0; payload], 99);
        let status = unsafe { grn_message_fragment(message, number, payload, index, bytes.as_mut_ptr(), &mut length) };
        assert_eq!(status, GrnStatus::Ok);
        bytes.truncate(length);
        (length > 0).then_some(bytes)
    };
    (0..).map_while(fragment).collect()
}

fn hear(assembler: &mut GrnAssembler, tick: u32, fragment: &[u8]) -> (GrnStatus, GrnMessage) {
    let mut got = message(9);
    let size = size_of::<GrnAssembler>();
    let status = unsafe { grn_assembler_receive(assembler, size, tick, fragment.as_ptr(), fragment.len(), &mut got) };
    (status, got)
}

#[test]
fn messages_come_back_and_every_flipped_bit_is_refused() {
    let bytes = packed(&message(7));
    assert_eq!(bytes.len(), GRN_PACKED_MESSAGE_BYTES);
    assert_eq!(read(&bytes), (GrnStatus::Ok, message(7)));
    for bit in 0..bytes.len() * 8 {
        let mut flipped = bytes.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(read(&flipped), (GrnStatus::MessageDamaged, GrnMessage::default()), "bit {bit}");
    }
    assert_eq!(read(&bytes[..7]).0, GrnStatus::MessageLength);
    assert_eq!(packed(&GrnMessage::default()), [0x20, 0, 0, 0, 0, 0, 0, 0x38, 0x9f]);
}

#[test]
fn reserved_bytes_are_not_sent() {
    let dirty = GrnMessage { reserved0: 1, reserved1: 2, ..message(7) };
    assert_eq!(packed(&dirty), packed(&message(7)));
}

#[test]
fn fragments_become_messages_in_any_order() {
    let mut assembler = GrnAssembler::default();
    for (tick, payload) in (0..).map(|tick| 100 * tick).zip([2, 3, 8, 20, 30, 39, 200]) {
        let mut pieces = fragments(&message(7), payload, 1);
        pieces.reverse();
        let (last, others) = pieces.split_last().unwrap();
        for piece in others.iter().chain(others) {
            assert_eq!(hear(&mut assembler, tick, piece), (GrnStatus::MessageIncomplete, GrnMessage::default()));
        }
        assert_eq!(hear(&mut assembler, tick, last), (GrnStatus::Ok, message(7)), "payload {payload}");
        assert_eq!(hear(&mut assembler, tick, last).0, GrnStatus::MessageIncomplete, "a duplicate");
    }
}

#[test]
fn whatever_is_in_an_assembler_is_one() {
    for filling in [0xff, 0x55, 0x01] {
        let mut assembler = GrnAssembler::default();
        unsafe { (&raw mut assembler).write_bytes(filling, 1) };
        for tick in 0..1000 {
            let piece = [tick as u8, (tick >> 3) as u8, 7];
            assert_eq!(hear(&mut assembler, tick, &piece).0, GrnStatus::MessageIncomplete);
        }
    }
}

#[test]
fn what_cannot_be_sent_or_heard_is_refused() {
    let (good, mut bytes, mut length, mut assembler) = (message(1), [0; 64], 99, GrnAssembler::default());
    let size = size_of::<GrnAssembler>();
    let damaged = GrnMessage { obstacle_count: 5, ..good };
    let room = bytes.as_mut_ptr();
    let mut got = message(9);
    let refused = unsafe {
        [
            grn_message_write(null(), room, 64, &mut length),
            grn_message_write(&good, null_mut(), 64, &mut length),
            grn_message_write(&good, room, 64, null_mut()),
            grn_message_read(null(), 8, &mut got),
            grn_message_read(room, 8, null_mut()),
            grn_message_fragment(null(), 0, 8, 0, room, &mut length),
            grn_message_fragment(&good, 0, 8, 0, null_mut(), &mut length),
            grn_message_fragment(&good, 0, 8, 0, room, null_mut()),
            grn_assembler_receive(null_mut(), size, 0, room, 3, &mut got),
            grn_assembler_receive(&mut assembler, size, 0, null(), 3, &mut got),
            grn_assembler_receive(&mut assembler, size, 0, room, 3, null_mut()),
        ]
    };
    assert_eq!(refused, [GrnStatus::NullPointer; 11]);
    let refused = unsafe {
        [
            grn_message_write(&good, room, 36, &mut length),
            grn_message_write(&damaged, room, 64, &mut length),
            grn_message_fragment(&damaged, 0, 8, 0, room, &mut length),
            grn_message_fragment(&good, 0, 1, 0, room, &mut length),
            grn_assembler_receive(&mut assembler, size - 1, 0, room, 3, &mut got),
        ]
    };
    let expected = [
        GrnStatus::BufferTooSmall,
        GrnStatus::TooManyReported,
        GrnStatus::TooManyReported,
        GrnStatus::PayloadTooSmall,
        GrnStatus::StorageTooSmall,
    ];
    assert_eq!((refused, length, got), (expected, 0, GrnMessage::default()));
    assert_eq!(bytes, [0; 64]);
}
