//! Whether messages fit into a radio's packets.

use grn_core::robot::Millimetres;
use grn_core::robot::message::{MAX_REPORTED_OBSTACLES, Message, ObstacleReport, TargetReport};
use grn_core::robot::radio::fragments::{Fragments, MIN_PAYLOAD};
use grn_core::robot::radio::packed::{self, MAX_PACKED};
use grn_input::InputError;

/// The most packets of a message: one a frame, and a robot speaks every eighth.
pub const MOST_PACKETS: usize = 8;

/// How many packets of so many bytes this message takes; 1 without a limit.
pub fn packets(message: &Message, payload_bytes: usize) -> usize {
    if payload_bytes == 0 || payload_bytes >= packed::write(message).len() {
        return 1;
    }
    Fragments::new(message, payload_bytes, 0).map_or(usize::MAX, Iterator::count)
}

/// A message that tells as much as one can.
fn longest_message() -> Message {
    let position = Millimetres::default();
    let obstacle = ObstacleReport { position, age: 0 };
    Message {
        sender: 0,
        position,
        target: Some(TargetReport { target: 0, position, velocity: [0; 2], age: 0 }),
        obstacles: [obstacle; MAX_REPORTED_OBSTACLES].into(),
    }
}

/// Whether every message can be sent in packets of so many bytes; 0 for no limit.
pub(super) fn check_payload(payload_bytes: usize) -> Result<(), InputError> {
    let longest = longest_message();
    let possible = |payload: &usize| packets(&longest, *payload) <= MOST_PACKETS;
    if payload_bytes == 0 || (payload_bytes >= MIN_PAYLOAD && possible(&payload_bytes)) {
        return Ok(());
    }
    let least = (MIN_PAYLOAD..=MAX_PACKED).find(possible).unwrap_or(MAX_PACKED);
    let why = format!(
        "a message has up to {MAX_PACKED} bytes, which must fit into {MOST_PACKETS} packets, one every 1/32 s, because a robot speaks \
         four times a second; at least {least} bytes are needed, or 0 for no limit"
    );
    Err(InputError::new("radio.payload_bytes", payload_bytes, why))
}
