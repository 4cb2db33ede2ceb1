//! A message as bytes: the same on every machine, and refused if any bit was flipped on the way.

use crate::bounded::filled;
use crate::robot::message::{MAX_REPORTED_OBSTACLES, Message, ObstacleReport, TargetReport};
use crate::robot::position::Millimetres;
use core::fmt;
use heapless::Vec;

/// The version of the packed form.
pub const PACKED_VERSION: u8 = 2;
/// The most bytes of a packed message.
pub const MAX_PACKED: usize = HEAD + TARGET + MAX_REPORTED_OBSTACLES * OBSTACLE + CRC_BYTES;
/// The fewest.
pub const MIN_PACKED: usize = HEAD + CRC_BYTES;

/// A packed message.
pub type Packed = Vec<u8, MAX_PACKED>;

/// First byte, sender and position.
const HEAD: usize = 7;
const TARGET: usize = 8;
const OBSTACLE: usize = 5;
const CRC_BYTES: usize = 2;
/// In the first byte: how many obstacle points there are, whether there is a target, and from here on the version.
const HAS_TARGET: u8 = 0b1000;
const COUNT: u8 = 0b0111;
const VERSION_SHIFT: u32 = 4;

/// It finds up to three flipped bits anywhere, and every burst of up to 16 bits.
const CRC: crc::Crc<u16> = crc::Crc::<u16>::new(&crc::CRC_16_IBM_3740);

/// Why bytes are not a packed message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PackedError {
    /// There are fewer or more bytes than the message has.
    Length {
        /// How many there are.
        found: usize,
    },
    /// The checksum is not that of the bytes.
    Damaged,
    /// The message is undamaged but of another version.
    Version {
        /// Its version.
        found: u8,
    },
}

impl fmt::Display for PackedError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PackedError::Length { found } => {
                write!(f, "{found} bytes are not the length of the message: give exactly the bytes of one message")
            }
            PackedError::Damaged => f.write_str("the message was damaged on the way: drop it"),
            PackedError::Version { found } => write!(
                f,
                "the message has version {found}, this robot reads {PACKED_VERSION}: update the firmware of the whole swarm"
            ),
        }
    }
}

impl core::error::Error for PackedError {}

/// How many bytes a message has whose first byte is this; `None` if there is no such message in this version.
pub(super) fn length(first: u8) -> Option<usize> {
    let obstacles = usize::from(first & COUNT);
    let target = if first & HAS_TARGET == 0 { 0 } else { TARGET };
    let known = first >> VERSION_SHIFT == PACKED_VERSION && obstacles <= MAX_REPORTED_OBSTACLES;
    known.then_some(HEAD + target + obstacles * OBSTACLE + CRC_BYTES)
}

/// The bytes of a message.
pub fn write(message: &Message) -> Packed {
    let Message { sender, position, target, obstacles } = message;
    let flag = if target.is_some() { HAS_TARGET } else { 0 };
    let first = PACKED_VERSION << VERSION_SHIFT | flag | obstacles.len() as u8;
    let mut packed = Packed::new();
    // There is room for the longest message.
    let mut put = |bytes: &[u8]| _ = packed.extend_from_slice(bytes);
    let [x0, x1, y0, y1] = bytes_of(*position);
    let [s0, s1] = sender.to_le_bytes();
    put(&[first, s0, s1, x0, x1, y0, y1]);
    if let Some(TargetReport { target, position, velocity: [east, north], age }) = *target {
        let [x0, x1, y0, y1] = bytes_of(position);
        put(&[target, x0, x1, y0, y1, east as u8, north as u8, age]);
    }
    for &ObstacleReport { position, age } in obstacles {
        let [x0, x1, y0, y1] = bytes_of(position);
        put(&[x0, x1, y0, y1, age]);
    }
    let crc = CRC.checksum(&packed).to_le_bytes();
    let _ = packed.extend_from_slice(&crc);
    packed
}

/// The message in bytes that [`write()`] gave.
///
/// # Errors
/// [`PackedError`]; for every message of which one bit was flipped, and for all but one in 65536 of those with greater
/// damage.
pub fn read(bytes: &[u8]) -> Result<Message, PackedError> {
    let wrong_length = PackedError::Length { found: bytes.len() };
    if !(MIN_PACKED..=MAX_PACKED).contains(&bytes.len()) {
        return Err(wrong_length);
    }
    let (body, crc) = bytes.split_last_chunk::<CRC_BYTES>().ok_or(wrong_length)?;
    if CRC.checksum(body) != u16::from_le_bytes(*crc) {
        return Err(PackedError::Damaged);
    }
    let ([first, s0, s1, position @ ..], mut rest) = body.split_first_chunk::<HEAD>().ok_or(wrong_length)?;
    let found = first >> VERSION_SHIFT;
    if found != PACKED_VERSION {
        return Err(PackedError::Version { found });
    }
    if length(*first) != Some(bytes.len()) {
        return Err(wrong_length);
    }
    let target = if first & HAS_TARGET == 0 {
        None
    } else {
        let ([target, x0, x1, y0, y1, east, north, age], others) = rest.split_first_chunk().ok_or(wrong_length)?;
        rest = others;
        let position = position_of([*x0, *x1, *y0, *y1]);
        Some(TargetReport { target: *target, position, velocity: [*east as i8, *north as i8], age: *age })
    };
    let (points, _) = rest.as_chunks();
    let point =
        |&[x0, x1, y0, y1, age]: &[u8; OBSTACLE]| ObstacleReport { position: position_of([x0, x1, y0, y1]), age };
    let obstacles = filled(points.iter().map(point));
    let sender = u16::from_le_bytes([*s0, *s1]);
    Ok(Message { sender, position: position_of(*position), target, obstacles })
}

fn bytes_of(Millimetres { x, y }: Millimetres) -> [u8; 4] {
    let ([x0, x1], [y0, y1]) = (x.to_le_bytes(), y.to_le_bytes());
    [x0, x1, y0, y1]
}

fn position_of([x0, x1, y0, y1]: [u8; 4]) -> Millimetres {
    Millimetres { x: i16::from_le_bytes([x0, x1]), y: i16::from_le_bytes([y0, y1]) }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::string::ToString;

    fn position() -> impl Strategy<Value = Millimetres> {
        any::<(i16, i16)>().prop_map(|(x, y)| Millimetres { x, y })
    }

    /// Any message.
    pub fn message() -> impl Strategy<Value = Message> {
        let target = (any::<u8>(), position(), any::<[i8; 2]>(), any::<u8>());
        let target =
            target.prop_map(|(target, position, velocity, age)| TargetReport { target, position, velocity, age });
        let obstacle = (position(), any::<u8>()).prop_map(|(position, age)| ObstacleReport { position, age });
        let obstacles = proptest::collection::vec(obstacle, 0..=MAX_REPORTED_OBSTACLES);
        (any::<u16>(), position(), proptest::option::of(target), obstacles).prop_map(
            |(sender, position, target, obstacles)| Message { sender, position, target, obstacles: filled(obstacles) },
        )
    }

    fn at(x: i16, y: i16) -> Millimetres {
        Millimetres { x, y }
    }

    /// The bytes of `docs/messages.md`.
    #[test]
    fn messages_have_exactly_these_bytes() {
        let mut message = Message { sender: 0x407, position: at(258, -259), target: None, obstacles: Vec::new() };
        assert_eq!(write(&message), [0x20, 7, 4, 0x02, 0x01, 0xfd, 0xfe, 0x6b, 0x6f]);
        message.target = Some(TargetReport { target: 1, position: at(-2, 300), velocity: [-5, 6], age: 200 });
        message.obstacles = filled([ObstacleReport { position: at(1000, -1000), age: 3 }]);
        let expected = [
            0x29, 7, 4, 0x02, 0x01, 0xfd, 0xfe, 1, 0xfe, 0xff, 0x2c, 0x01, 0xfb, 6, 200, 0xe8, 0x03, 0x18, 0xfc, 3,
            0x0d, 0xc3,
        ];
        assert_eq!(write(&message), expected);
        message.obstacles = filled([ObstacleReport { position: at(1000, -1000), age: 3 }; 4]);
        assert_eq!((write(&message).len(), MAX_PACKED), (37, 37));
    }

    #[test]
    fn undamaged_messages_of_another_version_or_length_are_told_from_damaged_ones() {
        let message = Message { sender: 7, position: at(1, 2), target: None, obstacles: Vec::new() };
        let sealed = |first: u8, body: &[u8]| {
            let mut bytes = std::vec![first];
            bytes.extend(body);
            let crc = CRC.checksum(&bytes).to_le_bytes();
            bytes.extend(crc);
            bytes
        };
        let body = &write(&message)[1..7];
        assert_eq!(read(&sealed(0x20, body)), Ok(message));
        assert_eq!(read(&sealed(0x10, body)), Err(PackedError::Version { found: 1 }));
        for first in [0x21, 0x24, 0x27, 0x28, 0x2f] {
            assert_eq!(read(&sealed(first, body)), Err(PackedError::Length { found: 9 }), "{first:x}");
        }
        // More obstacle points than a message has room for.
        assert_eq!(read(&sealed(0x25, &[0; 30])), Err(PackedError::Length { found: 33 }));
        for found in [0, 1, 8, 38, 400] {
            assert_eq!(read(&std::vec![0; found]), Err(PackedError::Length { found }));
        }
        let text = PackedError::Version { found: 3 }.to_string();
        assert!(text.contains("update the firmware"), "{text}");
    }

    proptest! {
        #[test]
        fn messages_come_back(message in message()) {
            let packed = write(&message);
            prop_assert_eq!(packed.first().copied().and_then(length), Some(packed.len()));
            prop_assert_eq!(read(&packed), Ok(message));
        }

        #[test]
        fn every_flipped_bit_is_found_and_every_pair_and_every_missing_or_added_byte(message in message(), second in 0_usize..296) {
            let packed = write(&message);
            let bits = packed.len() * 8;
            let flipped = |places: &[usize]| {
                let mut bytes = packed.clone();
                places.iter().for_each(|&bit| bytes[bit / 8] ^= 1 << (bit % 8));
                read(&bytes)
            };
            for bit in 0..bits {
                prop_assert_eq!(flipped(&[bit]), Err(PackedError::Damaged), "bit {}", bit);
                if bit != second % bits {
                    prop_assert_eq!(flipped(&[bit, second % bits]), Err(PackedError::Damaged));
                }
            }
            prop_assert!(read(&packed[..packed.len() - 1]).is_err());
            prop_assert!(read(&[&packed, &[0][..]].concat()).is_err());
        }

        #[test]
        fn whatever_is_read_is_what_would_be_written(bytes in proptest::collection::vec(any::<u8>(), 0..50)) {
            if let Ok(message) = read(&bytes) {
                prop_assert_eq!(write(&message).to_vec(), bytes);
            }
        }
    }
}
