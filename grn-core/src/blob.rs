//! The flashed file: everything a robot needs to run a controller, in a checked envelope around a postcard payload.
//!
//! `docs/blob.md` is normative for the bytes. Decoding trusts nothing: magic, format version, length, CRC-32, content
//! hash, opcodes, ranges, topological order, capacity, and canonical form (the decoded blob encodes to the same bytes).
//! After decoding nothing can fail or panic any more.

mod error;
mod wire;

pub use error::BlobError;

use crate::dynamics::Step;
use crate::field::{Field, Kernel};
use crate::network::{DEFAULT_GENES, Network, within};
use crate::scalar::Scalar;
use wire::Payload;

/// First bytes of every blob.
pub const MAGIC: [u8; 4] = *b"GRNb";
/// The format version this build writes and reads.
pub const FORMAT_VERSION: u8 = 1;
/// Frame, units and normalisation that all version-1 blobs share; see `docs/blob.md`.
pub const CONVENTION: u8 = 1;

const IDENTITY_BYTES: usize = 8;
const HEADER: usize = MAGIC.len() + 1 + 2 + IDENTITY_BYTES;
const CRC_BYTES: usize = 4;
const CRC: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

/// The most bytes that a blob with this many genes can take.
pub const fn max_encoded_size(genes: usize) -> usize {
    HEADER + wire::FIXED_BYTES + genes * wire::MAX_GENE_BYTES + CRC_BYTES
}

/// How inputs are made from a world: kernel and widths in model metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldParameters {
    /// Shape of both morphogens.
    pub kernel: Kernel,
    /// σ_t, model metres, in [0.01, 100].
    pub target_width: f32,
    /// σ_o, model metres, in [0.01, 100].
    pub obstacle_width: f32,
}

impl FieldParameters {
    /// The field of a world of the given scale (world metres per model metre).
    pub fn field<S: Scalar>(&self, scale: f32) -> Field<S> {
        let (target, obstacle) = (self.target_width * scale, self.obstacle_width * scale);
        Field::new(self.kernel, S::from_f32(target), S::from_f32(obstacle))
    }
}

/// Gains of the motion law; see [`Controller`](crate::robot::controller).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains {
    /// a: pull towards the pattern, 1/s.
    pub attraction: f32,
    /// m: how strongly the motion protein p moves the robot, dimensionless.
    pub coupling: f32,
    /// c: decay of p, 1/s.
    pub decay: f32,
    /// k: production of p by the saturated distance to the pattern f(z), 1/s².
    pub drive: f32,
    /// b: production of p by the repulsion D from neighbours, m/s².
    pub repulsion: f32,
    /// How far repulsion reaches, in radii of the pattern around a lone target in free space.
    pub repulsion_range: f32,
    /// Highest speed asked of the body, world metres per second.
    pub cruise: f32,
    /// Turning rate per radian of heading error, 1/s.
    pub turn: f32,
}

impl Default for Gains {
    fn default() -> Self {
        Gains {
            attraction: 1.0,
            coupling: 1.0,
            decay: 8.0,
            drive: 0.0,
            repulsion: 8.0,
            repulsion_range: 1.3,
            cruise: 0.12,
            turn: 5.0,
        }
    }
}

/// A controller as it is stored and flashed. Every field is checked when encoding and when decoding.
#[derive(Clone, Debug, PartialEq)]
pub struct Blob<const N: usize = DEFAULT_GENES> {
    /// The regulatory network with its θ and k.
    pub network: Network<f32, N>,
    /// Kernel and widths of the morphogens.
    pub field: FieldParameters,
    /// c: where between M(0,0) and M(1,0) the pattern's level lies, in [0.01, 0.99].
    pub level_fraction: f32,
    /// World metres per model metre, in [0.01, 10].
    pub scale: f32,
    /// RK4 step in GRN seconds.
    pub step: Step,
    /// GRN seconds per second, in [2^-6, 2^10].
    pub time_scale: f32,
    /// Gains of the motion law.
    pub gains: Gains,
}

/// Identity of a blob: the first 8 bytes of the SHA-256 of its payload.
pub type Identity = [u8; IDENTITY_BYTES];

impl<const N: usize> Blob<N> {
    /// Reads a blob from exactly `bytes`.
    ///
    /// # Errors
    /// The first fault found, in the order of [`BlobError`].
    #[inline(never)]
    pub fn decode(bytes: &[u8]) -> Result<Self, BlobError> {
        let envelope = Envelope::open(bytes)?;
        match &Payload::read(envelope.payload) {
            Ok(payload) => Blob::canonical(payload, envelope.payload),
            Err(error) => Err(*error),
        }
    }

    /// The blob of a payload that was read from `bytes`.
    #[inline(never)]
    fn canonical(payload: &Payload<N>, bytes: &[u8]) -> Result<Self, BlobError> {
        let mut blob = payload.to_blob();
        let fault = match &blob {
            Ok(blob) => {
                let differs = || (!blob.encodes_to(bytes)).then_some(BlobError::NotCanonical);
                blob.check().err().or_else(differs)
            }
            Err(_) => None,
        };
        if let Some(fault) = fault {
            blob = Err(fault);
        }
        blob
    }

    #[inline(never)]
    fn encodes_to(&self, payload: &[u8]) -> bool {
        self.payload().matches(payload)
    }

    /// Writes the blob to the front of `buffer` and returns the bytes written.
    ///
    /// # Errors
    /// A parameter out of range, or a buffer smaller than the blob; [`max_encoded_size`] always suffices.
    pub fn encode<'a>(&self, buffer: &'a mut [u8]) -> Result<&'a [u8], BlobError> {
        self.check()?;
        let capacity = buffer.len();
        let too_small = BlobError::BufferTooSmall { capacity };
        let room = buffer.get_mut(HEADER..).ok_or(too_small)?;
        let payload = self.payload().write(room).ok_or(too_small)?;
        let length = payload.len();
        let identity = identity_of(payload);
        let declared = u16::try_from(length).map_err(|_| too_small)?;
        let header = MAGIC.into_iter().chain([FORMAT_VERSION]).chain(declared.to_le_bytes()).chain(identity);
        for (slot, byte) in buffer.iter_mut().zip(header) {
            *slot = byte;
        }
        let (body, rest) = buffer.split_at_mut_checked(HEADER + length).ok_or(too_small)?;
        let crc = rest.first_chunk_mut::<CRC_BYTES>().ok_or(too_small)?;
        *crc = CRC.checksum(body).to_le_bytes();
        buffer.get(..HEADER + length + CRC_BYTES).ok_or(too_small)
    }

    /// The blob's identity, the same for equal content.
    pub fn identity(&self) -> Identity {
        self.payload().identity()
    }

    fn payload(&self) -> Payload<N> {
        Payload::of(self)
    }

    fn check(&self) -> Result<(), BlobError> {
        const WIDTH: (f32, f32) = (0.01, 100.0);
        const GAIN: (f32, f32) = (0.0, 64.0);
        let gains = &self.gains;
        let parameters = [
            ("target_width", self.field.target_width, WIDTH),
            ("obstacle_width", self.field.obstacle_width, WIDTH),
            ("level_fraction", self.level_fraction, (0.01, 0.99)),
            ("scale", self.scale, (0.01, 10.0)),
            ("time_scale", self.time_scale, (1.0 / 64.0, 1024.0)),
            ("attraction", gains.attraction, GAIN),
            ("coupling", gains.coupling, GAIN),
            ("decay", gains.decay, GAIN),
            ("drive", gains.drive, GAIN),
            ("repulsion", gains.repulsion, GAIN),
            ("repulsion_range", gains.repulsion_range, (0.01, 16.0)),
            ("cruise", gains.cruise, (0.001, 16.0)),
            ("turn", gains.turn, GAIN),
        ];
        parameters.into_iter().try_for_each(|(name, value, range)| {
            let fault = BlobError::Parameter { name, value, low: range.0, high: range.1 };
            if within(value, range) { Ok(()) } else { Err(fault) }
        })
    }
}

fn identity_of(payload: &[u8]) -> Identity {
    use sha2::Digest;
    let digest: [u8; 32] = sha2::Sha256::digest(payload).into();
    digest.first_chunk().copied().unwrap_or_default()
}

/// The envelope, checked as far as it can be without reading the payload.
struct Envelope<'a> {
    payload: &'a [u8],
}

impl<'a> Envelope<'a> {
    fn open(bytes: &'a [u8]) -> Result<Self, BlobError> {
        let (magic, rest) = split::<4>(bytes)?;
        if magic != MAGIC {
            return Err(BlobError::NotABlob { found: magic });
        }
        let ([version], rest) = split::<1>(rest)?;
        if version != FORMAT_VERSION {
            return Err(BlobError::Version { found: version });
        }
        let (length, rest) = split::<2>(rest)?;
        let (identity, _) = split::<IDENTITY_BYTES>(rest)?;
        let length = usize::from(u16::from_le_bytes(length));
        let expected = HEADER + length + CRC_BYTES;
        if bytes.len() != expected {
            return Err(BlobError::Length { expected, found: bytes.len() });
        }
        let (body, crc) = bytes.split_at_checked(HEADER + length).ok_or(BlobError::Truncated)?;
        let (stored, _) = split::<CRC_BYTES>(crc)?;
        let (stored, computed) = (u32::from_le_bytes(stored), CRC.checksum(body));
        if stored != computed {
            return Err(BlobError::Crc { stored, computed });
        }
        let payload = body.get(HEADER..).ok_or(BlobError::Truncated)?;
        if identity_of(payload) != identity {
            return Err(BlobError::Identity);
        }
        Ok(Envelope { payload })
    }
}

fn split<const N: usize>(bytes: &[u8]) -> Result<([u8; N], &[u8]), BlobError> {
    bytes.split_first_chunk::<N>().map(|(head, rest)| (*head, rest)).ok_or(BlobError::Truncated)
}

#[cfg(test)]
mod tests;
