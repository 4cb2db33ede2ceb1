//! What can go wrong with slots.

use super::MAX_BLOB;
use crate::blob::BlobError;
use core::fmt;
use embedded_storage::nor_flash::{NorFlashError, NorFlashErrorKind};

/// Why a slot operation was not done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SlotError {
    /// The layout does not fit the flash, its erase size or [`MIN_SLOT`](super::MIN_SLOT), or the flash writes units of more than 8 bytes.
    Layout,
    /// The flash failed.
    Flash(NorFlashErrorKind),
    /// A blob of more than [`MAX_BLOB`] bytes was announced.
    TooLong,
    /// The blob in charge is on trial: confirm it or roll it back first.
    OnTrial,
    /// No upload has begun since the start.
    NoUpload,
    /// The chunk does not begin where the last one ended, is not a multiple of 8 bytes though not the last, or passes
    /// the end of the blob.
    Chunk {
        /// Where the next chunk must begin.
        expected: u32,
    },
    /// What arrived is not a sound blob.
    Blob(BlobError),
    /// What arrived is sound, but not the blob that was announced.
    OtherBlob,
    /// No slot in the needed stage holds this blob.
    NotThere,
    /// There is no other blob to fall back to.
    NoFallback,
    /// All marks of the slot are used up; upload again.
    MarksUsedUp,
    /// The slot that stays has the highest sequence number there is: no upload could be newer.
    SequenceUsedUp,
}

impl fmt::Display for SlotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SlotError::Layout => f.write_str("the slots do not fit the flash"),
            SlotError::Flash(kind) => write!(f, "the flash failed: {kind}"),
            SlotError::TooLong => write!(f, "a blob has at most {MAX_BLOB} bytes"),
            SlotError::OnTrial => f.write_str("the blob in charge is on trial; confirm it or roll it back first"),
            SlotError::NoUpload => f.write_str("no upload has begun"),
            SlotError::Chunk { expected } => write!(f, "the next chunk begins at {expected}"),
            SlotError::Blob(error) => error.fmt(f),
            SlotError::OtherBlob => f.write_str("not the blob that was announced; upload again"),
            SlotError::NotThere => f.write_str("no slot holds this blob; upload it"),
            SlotError::NoFallback => f.write_str("there is no other blob to fall back to"),
            SlotError::MarksUsedUp => f.write_str("the slot's marks are used up; upload again"),
            SlotError::SequenceUsedUp => f.write_str(
                "no upload can have a number above 4294967295, which the blob in charge has; roll it back, or write its \
                 slot with a lower number",
            ),
        }
    }
}

impl core::error::Error for SlotError {}

impl<E: NorFlashError> From<E> for SlotError {
    fn from(error: E) -> Self {
        SlotError::Flash(error.kind())
    }
}
