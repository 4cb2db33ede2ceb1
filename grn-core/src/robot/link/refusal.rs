//! Why a robot does not do what it is asked to, and what its user can do about it.

use super::message::VERSION;
use crate::blob::{BlobError, FORMAT_VERSION};
use crate::network::NetworkError;
use crate::robot::controller::LoadError;
use crate::robot::percept::PerceptError;
use crate::robot::slots::SlotError;
use core::fmt;
use serde::{Deserialize, Serialize};

/// Why a robot does not do what it is asked to.
///
/// The order of variants is that on the wire: new ones go to the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Refusal {
    /// The request is of another protocol version, and not one of those that are the same in all.
    Version {
        /// The version the robot speaks.
        spoken: u8,
    },
    /// No such request.
    Unknown,
    /// The payload is not that of the request.
    Malformed,
    /// The slots do not fit the flash.
    Layout,
    /// The flash failed.
    Flash,
    /// The blob is longer than any this robot holds.
    TooLong,
    /// The blob in charge is on trial.
    OnTrial,
    /// No upload has begun since the robot started.
    NoUpload,
    /// The next chunk begins elsewhere.
    Chunk {
        /// The offset at which it begins, bytes.
        expected: u32,
    },
    /// The blob is unsound.
    Blob(BlobFault),
    /// The blob is sound but not the one that was announced.
    OtherBlob,
    /// No slot in the needed stage holds the blob.
    NotThere,
    /// There is no other blob to fall back to.
    NoFallback,
    /// The slot's marks are used up.
    MarksUsedUp,
    /// The blob is sound but cannot drive this robot.
    Load(LoadFault),
    /// No blob is in charge.
    NoController,
    /// No robot can have this percept; it was not ticked.
    Percept(PerceptFault),
    /// The blob in charge has the highest upload number there is, so no upload could be newer.
    SequenceUsedUp,
}

/// What is wrong with a blob, as far as a robot tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum BlobFault {
    /// Cut short, or longer than it says.
    Length,
    /// Does not begin as a blob does.
    NotABlob,
    /// Of another format version.
    Version {
        /// The blob's.
        found: u8,
        /// What the robot reads.
        read: u8,
    },
    /// Checksum or identity do not fit the content.
    Damaged,
    /// Of an unknown convention for frame, units and normalisation.
    Convention(u8),
    /// More genes than the robot holds.
    TooManyGenes {
        /// The blob's.
        genes: u16,
        /// The most the robot holds.
        capacity: u16,
    },
    /// Not a network, a parameter out of range, or not in canonical form.
    Content,
    /// A motif or kernel that this firmware does not know.
    UnknownCode,
}

/// Why a sound blob cannot drive a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum LoadFault {
    /// The model does not tell targets from empty space.
    NoPattern,
    /// The pattern around a lone target does not close.
    NoRing,
    /// Time scale and step do not give whole RK4 steps in a tick.
    StepsPerTick,
}

/// What is wrong with a percept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum PerceptFault {
    /// The position is out of range.
    Position,
    /// The heading is not a unit vector.
    Heading,
    /// The time since the last tick is out of range.
    Elapsed,
}

impl From<BlobError> for BlobFault {
    fn from(error: BlobError) -> Self {
        let clipped = |number: usize| u16::try_from(number).unwrap_or(u16::MAX);
        match error {
            BlobError::Truncated | BlobError::Length { .. } => BlobFault::Length,
            BlobError::NotABlob { .. } => BlobFault::NotABlob,
            BlobError::Version { found } => BlobFault::Version { found, read: FORMAT_VERSION },
            BlobError::Crc { .. } | BlobError::Identity => BlobFault::Damaged,
            BlobError::Convention(found) => BlobFault::Convention(found),
            BlobError::Network(NetworkError::TooManyGenes { genes, capacity }) => {
                BlobFault::TooManyGenes { genes: clipped(genes), capacity: clipped(capacity) }
            }
            BlobError::Opcode { .. } | BlobError::Kernel(_) => BlobFault::UnknownCode,
            BlobError::Malformed
            | BlobError::Step(_)
            | BlobError::Network(_)
            | BlobError::Parameter { .. }
            | BlobError::NotCanonical
            | BlobError::BufferTooSmall { .. } => BlobFault::Content,
        }
    }
}

impl From<LoadError> for LoadFault {
    fn from(error: LoadError) -> Self {
        match error {
            LoadError::NoPattern(_) => LoadFault::NoPattern,
            LoadError::NoRing => LoadFault::NoRing,
            LoadError::StepsPerTick(_) => LoadFault::StepsPerTick,
        }
    }
}

impl From<SlotError> for Refusal {
    fn from(error: SlotError) -> Self {
        match error {
            SlotError::Layout => Refusal::Layout,
            SlotError::Flash(_) => Refusal::Flash,
            SlotError::TooLong => Refusal::TooLong,
            SlotError::OnTrial => Refusal::OnTrial,
            SlotError::NoUpload => Refusal::NoUpload,
            SlotError::Chunk { expected } => Refusal::Chunk { expected },
            SlotError::Blob(error) => Refusal::Blob(error.into()),
            SlotError::OtherBlob => Refusal::OtherBlob,
            SlotError::NotThere => Refusal::NotThere,
            SlotError::NoFallback => Refusal::NoFallback,
            SlotError::MarksUsedUp => Refusal::MarksUsedUp,
            SlotError::SequenceUsedUp => Refusal::SequenceUsedUp,
        }
    }
}

impl From<LoadError> for Refusal {
    fn from(error: LoadError) -> Self {
        Refusal::Load(error.into())
    }
}

impl From<PerceptError> for Refusal {
    fn from(error: PerceptError) -> Self {
        Refusal::Percept(match error {
            PerceptError::Position { .. } => PerceptFault::Position,
            PerceptError::Heading { .. } => PerceptFault::Heading,
            PerceptError::Elapsed { .. } => PerceptFault::Elapsed,
        })
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Refusal::Version { spoken } => {
                return write!(
                    f,
                    "it speaks version {spoken} of the link, not {VERSION}: uploads work all the same; for the rest update \
                     the robot's firmware or this program"
                );
            }
            Refusal::Unknown => "it does not know this request: update the robot's firmware",
            Refusal::Malformed => "it cannot read this request: update the robot's firmware or this program",
            Refusal::Layout => "its slots do not fit its flash: build its firmware with another slot layout",
            Refusal::Flash => "its flash failed: try again; if it fails again the sector may be worn out",
            Refusal::TooLong => "the blob is longer than any it holds: choose a model with fewer genes",
            Refusal::OnTrial => "the blob in charge is on trial: confirm it or roll it back first",
            Refusal::NoUpload => "it knows of no upload, perhaps because it was reset: upload again",
            Refusal::Chunk { expected } => {
                return write!(f, "it expected the blob's bytes from {expected} on: upload again");
            }
            Refusal::Blob(fault) => return fault.fmt(f),
            Refusal::OtherBlob => "what it received is not the blob that was announced: upload again",
            Refusal::NotThere => "none of its slots holds this blob ready: upload it",
            Refusal::NoFallback => "it holds no other blob to fall back to: upload one",
            Refusal::MarksUsedUp => "the slot's marks are used up: upload again",
            Refusal::Load(LoadFault::NoPattern) => {
                "the model does not tell targets from empty space: choose another front member"
            }
            Refusal::Load(LoadFault::NoRing) => {
                "the model's pattern does not close around a lone target: choose another front member"
            }
            Refusal::Load(LoadFault::StepsPerTick) => {
                "time_scale and step do not give 1 to 64 whole RK4 steps a tick: write the blob with others"
            }
            Refusal::NoController => "no blob is in charge: upload and activate one",
            Refusal::Percept(PerceptFault::Position) => {
                "the percept's position is out of range: give micrometres, within 32.767 m of the origin"
            }
            Refusal::Percept(PerceptFault::Heading) => {
                "the percept's heading is not a unit vector: give cosine and sine in units of 2^-14"
            }
            Refusal::Percept(PerceptFault::Elapsed) => {
                "the percept's time since the last tick is out of range: give 1000 to 250000 microseconds"
            }
            Refusal::SequenceUsedUp => {
                "the blob in charge has the highest upload number, 4294967295, so no upload could be newer: roll it back, or \
                 write its slot with a programmer and a lower number"
            }
        })
    }
}

impl fmt::Display for BlobFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            BlobFault::Length => f.write_str("the blob is cut short or too long: upload it again"),
            BlobFault::NotABlob => f.write_str("this is no GRN blob: choose a .grn file"),
            BlobFault::Version { found, read } if found > read => {
                write!(f, "format version {found}, the robot reads {read}: update the robot's firmware")
            }
            BlobFault::Version { found, read } => {
                write!(f, "format version {found}, the robot reads {read}: write the blob again with this release")
            }
            BlobFault::Damaged => f.write_str("the blob is damaged: upload it again"),
            BlobFault::Convention(found) => {
                write!(f, "unknown convention {found} for frame, units and normalisation: update the robot's firmware")
            }
            BlobFault::TooManyGenes { genes, capacity } => write!(
                f,
                "{genes} genes, the robot holds at most {capacity}: choose a smaller model or build its firmware for more"
            ),
            BlobFault::Content => f.write_str("the blob's content is not a legal controller: write it again"),
            BlobFault::UnknownCode => {
                f.write_str("the blob has a motif or kernel that the robot does not know: update the robot's firmware")
            }
        }
    }
}

impl core::error::Error for Refusal {}
