//! What can be wrong with a blob.

use super::FORMAT_VERSION;
use crate::dynamics::StepError;
use crate::network::NetworkError;
use core::fmt;

/// Why bytes are not a blob this build can run, or a blob cannot be written.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BlobError {
    /// The file ends before the envelope does.
    Truncated,
    /// The first bytes are not those of a blob.
    NotABlob {
        /// The first four bytes.
        found: [u8; 4],
    },
    /// Another format version.
    Version {
        /// The version in the file.
        found: u8,
    },
    /// The file is longer or shorter than its header says.
    Length {
        /// Bytes by the header.
        expected: usize,
        /// Bytes in the file.
        found: usize,
    },
    /// Stored and computed CRC-32 differ.
    Crc {
        /// In the file.
        stored: u32,
        /// Of the file's content.
        computed: u32,
    },
    /// The stored identity is not the hash of the payload.
    Identity,
    /// Frame, units and normalisation this build does not know.
    Convention(u8),
    /// The payload is not a postcard message of the expected shape.
    Malformed,
    /// A gene's motif opcode is none of 1 to 10.
    Opcode {
        /// Position of the gene, from 0.
        gene: usize,
        /// The opcode.
        opcode: u8,
    },
    /// Neither gaussian (1) nor exponential (2).
    Kernel(u8),
    /// The integration step is out of range.
    Step(StepError),
    /// The genes do not form a network, or not one this build holds.
    Network(NetworkError),
    /// A parameter is not a number in its range.
    Parameter {
        /// Its name.
        name: &'static str,
        /// Its value.
        value: f32,
        /// Lowest legal value.
        low: f32,
        /// Highest legal value.
        high: f32,
    },
    /// The bytes decode, but encoding the result gives other bytes.
    NotCanonical,
    /// The buffer to encode into is too small.
    BufferTooSmall {
        /// Its size in bytes.
        capacity: usize,
    },
}

impl fmt::Display for BlobError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            BlobError::Truncated => write!(f, "the blob is cut short; copy or upload it again"),
            BlobError::NotABlob { found } => {
                write!(f, "not a GRN blob: it begins with bytes {found:02x?} instead of \"GRNb\"; choose a .grn file")
            }
            BlobError::Version { found } if found > FORMAT_VERSION => {
                write!(
                    f,
                    "format version {found}, this build reads {FORMAT_VERSION}: update the software that reads it"
                )
            }
            BlobError::Version { found } => {
                write!(
                    f,
                    "format version {found}, this build reads {FORMAT_VERSION}: write the blob again with this release"
                )
            }
            BlobError::Length { expected, found } => {
                write!(f, "{found} bytes where the header says {expected}; copy or upload it again")
            }
            BlobError::Crc { stored, computed } => {
                write!(f, "CRC-32 {computed:08x} where {stored:08x} is stored: damaged; copy or upload it again")
            }
            BlobError::Identity => write!(
                f,
                "the stored identity is not the hash of the content: damaged or forged; copy or upload it again"
            ),
            BlobError::Convention(found) => {
                write!(
                    f,
                    "unknown convention {found} for frame, units and normalisation: update the software that reads it"
                )
            }
            BlobError::Malformed => {
                write!(f, "the payload does not have the shape of a controller; write the blob again")
            }
            BlobError::Opcode { gene, opcode } => {
                write!(f, "gene {gene}: {opcode} is no motif's opcode (1 to 10): update the software that reads it")
            }
            BlobError::Kernel(code) => {
                write!(
                    f,
                    "kernel {code} is neither gaussian (1) nor exponential (2): update the software that reads it"
                )
            }
            BlobError::Step(error) => error.fmt(f),
            BlobError::Network(error) => error.fmt(f),
            BlobError::Parameter { name, value, low, high } => {
                write!(f, "{name} = {value} is not in [{low}, {high}]")
            }
            BlobError::NotCanonical => write!(f, "the payload is not in canonical form; write the blob again"),
            BlobError::BufferTooSmall { capacity } => write!(f, "the blob does not fit a buffer of {capacity} bytes"),
        }
    }
}

impl core::error::Error for BlobError {}
