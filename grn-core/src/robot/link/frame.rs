//! Frames: how a message lies on a wire that loses, flips and doubles bytes.
//!
//! ```text
//! 0x00  COBS( version  sequence  operation  payload…  CRC-32, little-endian )  0x00
//! ```
//!
//! Consistent-overhead byte stuffing (Cheshire and Baker 1999) leaves no zero inside a frame. So a zero always ends a frame,
//! and after garbage a receiver finds the next frame at the next zero. The zero in front of a frame ends such garbage. COBS is
//! written out here because the decoder of the usual crate cannot be linked without panic machinery.

use heapless::Vec;

/// The most bytes of version, sequence, operation, payload and CRC together.
pub const MAX_CONTENT: usize = 576;
/// The most bytes of a frame on the wire: one more per started 254 bytes, and both zeros.
pub const MAX_WIRE: usize = MAX_CONTENT + MAX_CONTENT / 254 + 1 + 2;

const CRC: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
const CRC_BYTES: usize = 4;
/// Bytes in a COBS block that no zero ends.
const FULL_BLOCK: usize = 254;

/// A frame that arrived whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame<'a> {
    /// Protocol version of the sender.
    pub version: u8,
    /// Number of the request; its response has the same.
    pub sequence: u8,
    /// What is asked or answered.
    pub operation: u8,
    /// What belongs to the operation.
    pub payload: &'a [u8],
    /// CRC-32 of everything before.
    pub crc: u32,
}

/// A payload does not fit a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLong;

/// The bytes of a frame on the wire, whose payload `write` puts to the front of a buffer and returns.
///
/// # Errors
/// [`TooLong`] if `write` returns `None`.
pub fn encode(header: [u8; 3], write: impl FnOnce(&mut [u8]) -> Option<usize>) -> Result<Vec<u8, MAX_WIRE>, TooLong> {
    let mut content = [0; MAX_CONTENT];
    let (head, rest) = content.split_first_chunk_mut::<3>().ok_or(TooLong)?;
    *head = header;
    let room = rest.len() - CRC_BYTES;
    let payload = write(rest.get_mut(..room).ok_or(TooLong)?).ok_or(TooLong)?;
    let (body, rest) = content.split_at_mut_checked(header.len() + payload).ok_or(TooLong)?;
    *rest.first_chunk_mut().ok_or(TooLong)? = CRC.checksum(body).to_le_bytes();
    stuff(content.get(..header.len() + payload + CRC_BYTES).ok_or(TooLong)?)
}

fn stuff(content: &[u8]) -> Result<Vec<u8, MAX_WIRE>, TooLong> {
    let mut wire = Vec::new();
    wire.push(0).map_err(|_| TooLong)?;
    for run in content.split(|&byte| byte == 0) {
        let mut blocks = run.chunks_exact(FULL_BLOCK);
        for block in &mut blocks {
            wire.push(u8::MAX).map_err(|_| TooLong)?;
            wire.extend_from_slice(block).map_err(|_| TooLong)?;
        }
        let last = blocks.remainder();
        wire.push(last.len() as u8 + 1).map_err(|_| TooLong)?;
        wire.extend_from_slice(last).map_err(|_| TooLong)?;
    }
    wire.push(0).map_err(|_| TooLong)?;
    Ok(wire)
}

/// Puts frames together from bytes as they come.
#[derive(Debug, Default)]
pub struct Receiver {
    content: Vec<u8, MAX_CONTENT>,
    /// Bytes that the present COBS block still lacks.
    lacking: u8,
    /// Whether a zero stands between the present block and the next.
    zero_follows: bool,
    /// The frame is too long and will be dropped.
    overflow: bool,
    ended: bool,
}

impl Receiver {
    /// A receiver that has heard nothing.
    pub const fn new() -> Self {
        Receiver { content: Vec::new(), lacking: 0, zero_follows: false, overflow: false, ended: false }
    }

    /// Takes the next byte; a frame, if it ends one that arrived undamaged. Damaged ones are dropped.
    pub fn receive(&mut self, byte: u8) -> Option<Frame<'_>> {
        if self.ended {
            *self = Receiver::new();
        }
        if byte == 0 {
            self.ended = true;
            let whole = self.lacking == 0 && !self.overflow;
            return if whole { parse(&self.content) } else { None };
        }
        if self.lacking == 0 {
            if self.zero_follows {
                self.push(0);
            }
            self.lacking = byte - 1;
            self.zero_follows = byte != u8::MAX;
        } else {
            self.push(byte);
            self.lacking -= 1;
        }
        None
    }

    fn push(&mut self, byte: u8) {
        self.overflow |= self.content.push(byte).is_err();
    }
}

fn parse(content: &[u8]) -> Option<Frame<'_>> {
    let (body, stored) = content.split_last_chunk::<CRC_BYTES>()?;
    let crc = u32::from_le_bytes(*stored);
    let ([version, sequence, operation], payload) = body.split_first_chunk::<3>()?;
    let frame = Frame { version: *version, sequence: *sequence, operation: *operation, payload, crc };
    (CRC.checksum(body) == crc).then_some(frame)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn encoded(payload: &[u8]) -> Vec<u8, MAX_WIRE> {
        let write = |room: &mut [u8]| {
            room.get_mut(..payload.len())?.copy_from_slice(payload);
            Some(payload.len())
        };
        encode([1, 2, 3], write).unwrap()
    }

    fn received(receiver: &mut Receiver, wire: &[u8]) -> std::vec::Vec<std::vec::Vec<u8>> {
        let mut payloads = std::vec::Vec::new();
        for &byte in wire {
            if let Some(frame) = receiver.receive(byte) {
                assert_eq!((frame.version, frame.sequence, frame.operation), (1, 2, 3));
                payloads.push(frame.payload.to_vec());
            }
        }
        payloads
    }

    #[test]
    fn a_frame_has_exactly_these_bytes() {
        let wire = encoded(&[0, 9]);
        assert_eq!(wire.as_slice(), [0, 4, 1, 2, 3, 6, 9, 0xdb, 0x10, 0xd1, 0x2a, 0]);
    }

    #[test]
    fn what_is_too_long_is_refused_on_both_sides() {
        assert_eq!(encode([1, 2, 3], |_| None), Err(TooLong));
        let longest = [7; MAX_CONTENT - 7];
        let mut receiver = Receiver::new();
        assert_eq!(received(&mut receiver, &encoded(&longest)), [longest.to_vec()]);
        let endless = [7; 2 * MAX_WIRE];
        assert!(received(&mut receiver, &endless).is_empty());
        assert_eq!(received(&mut receiver, &encoded(&[5])), [[5]]);
    }

    proptest! {
        #[test]
        fn payloads_come_back_and_garbage_before_them_does_no_harm(
            payload in proptest::collection::vec(prop_oneof![Just(0), any::<u8>()], 0..MAX_CONTENT - 7),
            garbage in proptest::collection::vec(any::<u8>(), 0..600),
        ) {
            let mut receiver = Receiver::new();
            let wire = encoded(&payload);
            prop_assert!(!wire[1..wire.len() - 1].contains(&0));
            for byte in garbage {
                let _ = receiver.receive(byte);
            }
            prop_assert_eq!(received(&mut receiver, &wire), [payload]);
        }

        #[test]
        fn one_wrong_byte_is_noticed(payload in proptest::collection::vec(any::<u8>(), 0..60), at in 0_usize..64, flip in 1_u8..) {
            let mut wire = encoded(&payload);
            let at = 1 + at % (wire.len() - 2);
            wire[at] ^= flip;
            prop_assert!(received(&mut Receiver::new(), &wire).is_empty());
        }
    }
}
