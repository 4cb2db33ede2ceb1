//! Packed messages cut into pieces for radios with small payloads.
//!
//! ```text
//! payload of 2 bytes           a little-endian number: data (6 bits), place (6), number (1), sender (its lowest 3)
//! payload of 3 bytes or more   sender (its lowest 8 bits), place (6 bits) and number (2), data (1 byte or more)
//! ```
//!
//! The place is where the data begin in the packed message: in units of 6 bits in fragments of 2 bytes, else in bytes. So
//! every fragment can be understood alone, in any order, and radios with payloads of different sizes understand each other.

use super::packed::{MAX_PACKED, Packed, write};
use crate::robot::message::Message;
use core::fmt;
use heapless::Vec;

/// The smallest payload of a radio, bytes.
pub const MIN_PAYLOAD: usize = 2;
/// The most bytes of a fragment: those of a whole message.
pub const MAX_FRAGMENT: usize = HEAD + MAX_PACKED;

/// A fragment's bytes.
pub type Fragment = Vec<u8, MAX_FRAGMENT>;

/// Bytes before the data, where there is room for them.
const HEAD: usize = 2;
/// In the second byte: place, and above it the message's number.
const PLACE: u8 = 0b0011_1111;
const NUMBER_SHIFT: u32 = 6;
/// Bits of the message in a fragment of 2 bytes.
const SMALL_DATA: usize = 6;

/// More fragments than this no message has.
const NO_MORE: usize = (MAX_PACKED * 8).div_ceil(SMALL_DATA);

/// A radio's payload is too small for fragments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PayloadError {
    /// Its bytes.
    pub payload: usize,
}

impl fmt::Display for PayloadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a payload of {} bytes is too small: fragments need at least {MIN_PAYLOAD}", self.payload)
    }
}

impl core::error::Error for PayloadError {}

/// The fragments of one message, in order; `nth` of a clone gives any of them.
#[derive(Clone, Debug)]
pub struct Fragments {
    packed: Packed,
    payload: usize,
    number: u8,
    next: usize,
}

impl Fragments {
    /// Of a message, for a radio that carries `payload` bytes at a time.
    ///
    /// `number`: counts the messages that this robot sends; only its lowest bits are used, and it may wrap around.
    ///
    /// # Errors
    /// [`PayloadError`].
    pub fn new(message: &Message, payload: usize, number: u8) -> Result<Self, PayloadError> {
        if payload < MIN_PAYLOAD {
            return Err(PayloadError { payload });
        }
        Ok(Fragments { packed: write(message), payload: payload.min(MAX_FRAGMENT), number, next: 0 })
    }

    fn small(&self) -> Option<Fragment> {
        let [sender, byte, above] = [1, self.next * SMALL_DATA / 8, self.next * SMALL_DATA / 8 + 1]
            .map(|index| self.packed.get(index).copied());
        let pair = u16::from_le_bytes([byte?, above.unwrap_or(0)]);
        let data = pair >> (self.next * SMALL_DATA % 8) & u16::from(PLACE);
        let number = u16::from(self.number & 1);
        let bits = data | (self.next as u16) << 6 | number << 12 | u16::from(sender?) << 13;
        let mut fragment = Fragment::new();
        fragment.extend_from_slice(&bits.to_le_bytes()).ok()?;
        Some(fragment)
    }

    fn large(&self) -> Option<Fragment> {
        let size = self.payload - HEAD;
        let place = self.next * size;
        let data = self.packed.get(place..).and_then(|rest| rest.chunks(size).next())?;
        let mut fragment = Fragment::new();
        let head = [*self.packed.get(1)?, place as u8 | self.number << NUMBER_SHIFT];
        fragment.extend_from_slice(&head).ok()?;
        fragment.extend_from_slice(data).ok()?;
        Some(fragment)
    }
}

impl Iterator for Fragments {
    type Item = Fragment;

    fn next(&mut self) -> Option<Fragment> {
        let fragment = if self.payload == MIN_PAYLOAD { self.small() } else { self.large() }?;
        self.next += 1;
        Some(fragment)
    }

    /// Without making those before.
    fn nth(&mut self, n: usize) -> Option<Fragment> {
        self.next = self.next.saturating_add(n).min(NO_MORE);
        self.next()
    }
}

/// What a fragment says, whether or not it is true.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Piece<'a> {
    /// Of which message.
    pub key: Key,
    /// What of it.
    pub data: Data<'a>,
}

/// Tells messages apart as far as their fragments do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Key {
    /// Sender, or what is known of it.
    pub sender: u8,
    /// Which bits of a sender are known.
    pub known: u8,
    /// Number of the message, its lowest bits.
    pub number: u8,
}

/// A part of a packed message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Data<'a> {
    /// Whole bytes from a place on.
    Bytes(usize, &'a [u8]),
    /// Six bits from so many times six bits on.
    Bits(usize, u8),
}

impl<'a> Piece<'a> {
    /// Reads a fragment; `None` if none has such a form.
    pub fn read(fragment: &'a [u8]) -> Option<Self> {
        match fragment {
            [low, high] => {
                let bits = u16::from_le_bytes([*low, *high]);
                let key = Key { sender: high >> 5, known: 0b111, number: high >> 4 & 1 };
                Some(Piece { key, data: Data::Bits(usize::from(bits >> 6 & 0b11_1111), low & PLACE) })
            }
            [sender, place, data @ ..] if !data.is_empty() => {
                let key = Key { sender: *sender, known: u8::MAX, number: place >> NUMBER_SHIFT };
                Some(Piece { key, data: Data::Bytes(usize::from(place & PLACE), data) })
            }
            _ => None,
        }
    }
}
