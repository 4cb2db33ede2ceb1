//! What stands in front of a blob in its slot: a header, and marks that are only ever added.
//!
//! | offset | bytes | content |
//! |---|---|---|
//! | 0 | 4 | magic `GRNs` |
//! | 4 | 4 | length of the blob |
//! | 8 | 4 | sequence number; of two slots the one with the higher number is newer |
//! | 12 | 8 | identity of the blob |
//! | 20 | 4 | CRC-32 of the above |
//! | 24 | 8 | each: a mark and, in the upper half, its complement; [`MARKS`] of them, erased until used |
//! | 152 | | the blob |
//!
//! Integers are little-endian. Every unit of 8 bytes is written once between erasures. Of a mark and its complement each
//! bit is written in exactly one half, so a write that power loss cut short never looks like another mark.

use crate::blob::Identity;

/// The unit in which slots are written, bytes; a flash may demand less but not more.
pub const UNIT: usize = 8;
/// How many marks a slot has room for.
pub const MARKS: usize = 16;
/// Bytes of the header.
pub const HEADER: usize = 24;
/// Where the blob begins.
pub const CONTENT: u32 = (HEADER + MARKS * UNIT) as u32;

const MAGIC: [u8; 4] = *b"GRNs";
const CRC: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
const ERASED: [u8; UNIT] = [0xff; UNIT];

/// The header of a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header {
    /// Bytes of the blob.
    pub length: u32,
    /// Counts uploads.
    pub sequence: u32,
    /// What the blob is announced to be.
    pub identity: Identity,
}

impl Header {
    /// The header's bytes.
    pub fn encode(&self) -> [u8; HEADER] {
        let Header { length, sequence, identity } = self;
        let fields = [MAGIC, length.to_le_bytes(), sequence.to_le_bytes()];
        let mut bytes = [0; HEADER];
        let (body, crc) = bytes.split_at_mut(HEADER - 4);
        for (byte, value) in body.iter_mut().zip(fields.as_flattened().iter().chain(identity)) {
            *byte = *value;
        }
        crc.copy_from_slice(&CRC.checksum(body).to_le_bytes());
        bytes
    }

    /// The header in these bytes, if there is one.
    pub fn decode(bytes: &[u8; HEADER]) -> Option<Header> {
        let (body, crc) = bytes.split_last_chunk::<4>()?;
        let (magic, rest) = body.split_first_chunk::<4>()?;
        let (length, rest) = rest.split_first_chunk()?;
        let (sequence, identity) = rest.split_first_chunk()?;
        let whole = *magic == MAGIC && CRC.checksum(body) == u32::from_le_bytes(*crc);
        whole.then_some(Header {
            length: u32::from_le_bytes(*length),
            sequence: u32::from_le_bytes(*sequence),
            identity: *identity.first_chunk()?,
        })
    }
}

/// What can have happened to a slot since its header was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// The blob is complete and was read back.
    Verified = 1,
    /// It was put in charge.
    Activated = 2,
    /// It has proved itself.
    Confirmed = 3,
    /// It was taken out of charge.
    Rejected = 4,
}

impl Mark {
    /// The mark's bytes.
    pub fn encode(self) -> [u8; UNIT] {
        (u64::from(self as u32) | u64::from(!(self as u32)) << 32).to_le_bytes()
    }
}

/// The marks of a slot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Journal {
    verified: bool,
    activated: bool,
    confirmed: bool,
    rejected: bool,
    /// How many units come before the first that nothing was written to.
    used: usize,
}

impl Journal {
    /// Takes the next unit into account. A unit that holds no whole mark is ignored, but it is used up.
    pub fn read(&mut self, place: usize, unit: [u8; UNIT]) {
        if unit != ERASED {
            self.used = place + 1;
        }
        self.verified |= unit == Mark::Verified.encode();
        self.activated |= unit == Mark::Activated.encode();
        self.confirmed |= unit == Mark::Confirmed.encode();
        self.rejected |= unit == Mark::Rejected.encode();
    }

    /// The next free unit for a mark; `None` if all are used.
    pub fn free(&self) -> Option<usize> {
        (self.used < MARKS).then_some(self.used)
    }

    /// What the marks add up to.
    pub fn stage(&self) -> Stage {
        match self {
            Journal { rejected: true, .. } => Stage::Rejected,
            Journal { confirmed: true, .. } => Stage::Confirmed,
            Journal { activated: true, .. } => Stage::Trial,
            Journal { verified: true, .. } => Stage::Verified,
            _ => Stage::Partial,
        }
    }
}

/// How far the blob in a slot has come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Stage {
    /// There is none.
    #[default]
    Empty,
    /// Its upload has begun.
    Partial,
    /// It is complete and sound.
    Verified,
    /// It is in charge and has to prove itself.
    Trial,
    /// It is or was in charge and has proved itself.
    Confirmed,
    /// It was in charge and was rolled back.
    Rejected,
}
