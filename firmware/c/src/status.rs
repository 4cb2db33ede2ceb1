//! What every call returns.

use core::ffi::CStr;
use grn_core::blob::{BlobError, FORMAT_VERSION};
use grn_core::network::NetworkError;
use grn_core::robot::{LoadError, PerceptError};

/// What became of a call. The numbers of released statuses never change; grn_status_text says what to do.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum GrnStatus {
    /// Done.
    Ok = 0,
    /// A pointer is null.
    NullPointer = 1,
    /// A pointer is not aligned for what it points to.
    Misaligned = 2,
    /// The storage is smaller than this library's GrnController.
    StorageTooSmall = 3,
    /// No controller is loaded in this storage.
    NotLoaded = 4,
    /// The number type is none of GrnNumber.
    UnknownNumber = 5,
    /// The percept counts more than GRN_MAX_TARGETS targets.
    TooManyTargets = 10,
    /// The percept counts more than GRN_MAX_SEEN_OBSTACLES obstacle points.
    TooManyObstacles = 11,
    /// The percept counts more than GRN_MAX_HEARD messages.
    TooManyHeard = 12,
    /// A message counts more than GRN_MAX_REPORTED_OBSTACLES obstacle points.
    TooManyReported = 13,
    /// The percept's heading is not a unit vector: its length is not 16384, give or take a 32nd.
    Heading = 14,
    /// The percept's position is farther from the origin than 32767000 micrometres, east or north.
    Position = 15,
    /// The percept's time since the last tick is not 1000 to 250000 microseconds.
    Elapsed = 16,
    /// The bytes end before the blob's header does.
    BlobTruncated = 20,
    /// The bytes do not begin as a blob does.
    NotABlob = 21,
    /// The blob has an older format version than this library reads.
    BlobTooOld = 22,
    /// The blob has a newer format version than this library reads.
    BlobTooNew = 23,
    /// There are more or fewer bytes than the blob's header says.
    BlobLength = 24,
    /// The blob's checksum or identity is not that of its content.
    BlobDamaged = 25,
    /// The blob has another convention for frame, units and normalisation.
    BlobConvention = 26,
    /// The blob's content is not, byte for byte, what a writer of this format writes.
    BlobMalformed = 27,
    /// The blob's network has more genes than this build holds.
    NetworkTooLarge = 28,
    /// A gene's input or a parameter in the blob is out of its range.
    BlobOutOfRange = 29,
    /// The blob has a motif or kernel that this library does not know.
    BlobUnknownCode = 30,
    /// The model does not tell targets from empty space.
    NoPattern = 40,
    /// The model's pattern does not close around a lone target.
    NoRing = 41,
    /// Time scale and integration step do not give a whole number of steps in a tick, or too many.
    StepsPerTick = 42,
    /// The packed message does not fit the bytes that are there for it.
    BufferTooSmall = 50,
    /// There are more or fewer bytes than the packed message has.
    MessageLength = 51,
    /// The packed message was damaged on the way.
    MessageDamaged = 52,
    /// The packed message is undamaged but of another version.
    MessageVersion = 53,
    /// The radio's payload is smaller than GRN_MIN_PAYLOAD_BYTES.
    PayloadTooSmall = 54,
    /// No fault: the fragment was taken in, and its message is not complete yet, or was before.
    MessageIncomplete = 55,
}

impl GrnStatus {
    const TEXTS: [(Self, &CStr); 33] = [
        (Self::Ok, c"done"),
        (Self::NullPointer, c"a pointer is null: pass the address of an object"),
        (
            Self::Misaligned,
            c"a pointer is misaligned: declare the object with the type of grn.h instead of casting bytes",
        ),
        (
            Self::StorageTooSmall,
            c"the storage is too small: pass sizeof(GrnController), and use the grn.h of this library",
        ),
        (Self::NotLoaded, c"no controller is loaded: call grn_load first, and look at what it returns"),
        (Self::UnknownNumber, c"unknown number type: pass GRN_NUMBER_F32 or GRN_NUMBER_Q8_24"),
        (Self::TooManyTargets, c"too many targets in the percept: give the nearest GRN_MAX_TARGETS"),
        (Self::TooManyObstacles, c"too many obstacle points in the percept: give the nearest GRN_MAX_SEEN_OBSTACLES"),
        (Self::TooManyHeard, c"too many messages in the percept: give the strongest GRN_MAX_HEARD"),
        (
            Self::TooManyReported,
            c"a message has more than GRN_MAX_REPORTED_OBSTACLES obstacle points: drop it, it is damaged",
        ),
        (Self::Heading, c"the heading is not a unit vector: give its cosine and sine times 16384"),
        (
            Self::Position,
            c"the position is out of range: give micrometres, within 32767000 of the origin in both directions",
        ),
        (
            Self::Elapsed,
            c"the time since the last tick is not 1000 to 250000 microseconds: begin with GRN_PERCEPT_NOTHING",
        ),
        (Self::BlobTruncated, c"the blob is cut short: copy or upload it again"),
        (Self::NotABlob, c"not a GRN blob, it does not begin with \"GRNb\": pass a file that grn evolve wrote"),
        (Self::BlobTooOld, c"the blob has an old format version: write it again with this library's release of grn"),
        (Self::BlobTooNew, c"the blob has a newer format version: update this library"),
        (
            Self::BlobLength,
            c"the blob is longer or shorter than its header says: pass its exact length, or copy it again",
        ),
        (Self::BlobDamaged, c"the blob is damaged: copy or upload it again"),
        (
            Self::BlobConvention,
            c"the blob has an unknown convention for frame, units and normalisation: update this library",
        ),
        (Self::BlobMalformed, c"the blob does not have the form of a controller: write it again with grn"),
        (Self::NetworkTooLarge, c"the network has too many genes for this build: evolve a smaller one"),
        (
            Self::BlobOutOfRange,
            c"a gene or a parameter in the blob is out of range: grn show names it; write the blob again",
        ),
        (Self::BlobUnknownCode, c"the blob has a motif or kernel that this library does not know: update this library"),
        (Self::NoPattern, c"the model does not tell targets from empty space: evolve another one"),
        (Self::NoRing, c"the model's pattern does not close around a lone target: evolve another one"),
        (
            Self::StepsPerTick,
            c"time_scale and step do not give 1 to 64 whole steps in a tick: write the blob with others",
        ),
        (Self::BufferTooSmall, c"the packed message does not fit: give room for GRN_PACKED_MESSAGE_BYTES"),
        (Self::MessageLength, c"not the length of a packed message: give exactly the bytes of one message"),
        (Self::MessageDamaged, c"the message was damaged on the way: drop it"),
        (Self::MessageVersion, c"the message has another version: use one release of this library in the whole swarm"),
        (Self::PayloadTooSmall, c"the radio's payload is too small: give at least GRN_MIN_PAYLOAD_BYTES"),
        (Self::MessageIncomplete, c"no fault: the message is complete only when further fragments have come"),
    ];

    /// The status of a call that does `work`.
    pub(crate) fn of(work: impl FnOnce() -> Result<(), GrnStatus>) -> GrnStatus {
        work().err().unwrap_or(Self::Ok)
    }

    /// The text for a status or any other number.
    pub(crate) fn text(number: i32) -> &'static CStr {
        let known = Self::TEXTS.iter().find(|(status, _)| *status as i32 == number);
        known.map_or(c"not a status of this library: use the grn.h of this library", |(_, text)| *text)
    }
}

impl From<BlobError> for GrnStatus {
    fn from(error: BlobError) -> Self {
        match error {
            BlobError::Truncated => Self::BlobTruncated,
            BlobError::NotABlob { .. } => Self::NotABlob,
            BlobError::Version { found } if found < FORMAT_VERSION => Self::BlobTooOld,
            BlobError::Version { .. } => Self::BlobTooNew,
            BlobError::Length { .. } => Self::BlobLength,
            BlobError::Crc { .. } | BlobError::Identity => Self::BlobDamaged,
            BlobError::Convention(_) => Self::BlobConvention,
            BlobError::Network(NetworkError::TooManyGenes { .. }) => Self::NetworkTooLarge,
            BlobError::Opcode { .. } | BlobError::Kernel(_) => Self::BlobUnknownCode,
            BlobError::Step(_) | BlobError::Network(_) | BlobError::Parameter { .. } => Self::BlobOutOfRange,
            // Malformed, not canonical, and faults that later versions of the core may name.
            _ => Self::BlobMalformed,
        }
    }
}

impl From<PerceptError> for GrnStatus {
    fn from(error: PerceptError) -> Self {
        match error {
            PerceptError::Position { .. } => Self::Position,
            PerceptError::Heading { .. } => Self::Heading,
            PerceptError::Elapsed { .. } => Self::Elapsed,
        }
    }
}

impl From<LoadError> for GrnStatus {
    fn from(error: LoadError) -> Self {
        match error {
            LoadError::NoPattern(_) => Self::NoPattern,
            LoadError::NoRing => Self::NoRing,
            // And faults that later versions of the core may name.
            _ => Self::StepsPerTick,
        }
    }
}
