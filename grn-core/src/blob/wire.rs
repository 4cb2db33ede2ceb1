//! The payload's shape on the wire, and the way between it and [`Blob`].

use super::{Blob, BlobError, CONVENTION, FieldParameters, Gains, Identity};
use crate::bounded::filled;
use crate::dynamics::Step;
use crate::field::Kernel;
use crate::motif::{MAX_INPUTS, Motif};
use crate::network::{Gene, Network, NetworkError, Source};
use heapless::Vec;
use postcard::ser_flavors::{Flavor, Slice};
use serde::{Deserialize, Serialize};

/// Payload bytes besides the genes: convention, up to two for the gene count, kernel, step, and fourteen f32.
pub(super) const FIXED_BYTES: usize = 1 + 2 + 1 + 1 + 14 * 4;
/// Motif, input count, four inputs, θ.
pub(super) const MAX_GENE_BYTES: usize = 1 + 1 + MAX_INPUTS + 4;

/// Field order is wire order. Nothing may be inserted or moved within a format version.
#[derive(Serialize, Deserialize)]
pub(super) struct Payload<const N: usize> {
    convention: u8,
    genes: Vec<WireGene, N>,
    steepness: f32,
    kernel: u8,
    target_width: f32,
    obstacle_width: f32,
    level_fraction: f32,
    scale: f32,
    step_exponent: u8,
    time_scale: f32,
    attraction: f32,
    coupling: f32,
    decay: f32,
    drive: f32,
    repulsion: f32,
    repulsion_range: f32,
    cruise: f32,
    turn: f32,
}

#[derive(Serialize, Deserialize)]
struct WireGene {
    opcode: u8,
    inputs: Vec<u8, MAX_INPUTS>,
    theta: f32,
}

impl<const N: usize> Payload<N> {
    #[inline(never)]
    pub(super) fn read(bytes: &[u8]) -> Result<Self, BlobError> {
        let ((convention, genes), _): ((u8, u32), _) =
            postcard::take_from_bytes(bytes).map_err(|_| BlobError::Malformed)?;
        if convention != CONVENTION {
            return Err(BlobError::Convention(convention));
        }
        let genes = usize::try_from(genes).unwrap_or(usize::MAX);
        if genes > N {
            return Err(BlobError::Network(NetworkError::TooManyGenes { genes, capacity: N }));
        }
        postcard::from_bytes(bytes).map_err(|_| BlobError::Malformed)
    }

    pub(super) fn of(blob: &Blob<N>) -> Self {
        let genes = blob.network.genes().iter().map(|gene| WireGene {
            opcode: gene.motif.code(),
            inputs: filled(gene.inputs.iter().map(|input| input.code())),
            theta: gene.theta,
        });
        Payload {
            convention: CONVENTION,
            genes: filled(genes),
            steepness: blob.network.steepness(),
            kernel: blob.field.kernel.code(),
            target_width: blob.field.target_width,
            obstacle_width: blob.field.obstacle_width,
            level_fraction: blob.level_fraction,
            scale: blob.scale,
            step_exponent: blob.step.exponent(),
            time_scale: blob.time_scale,
            attraction: blob.gains.attraction,
            coupling: blob.gains.coupling,
            decay: blob.gains.decay,
            drive: blob.gains.drive,
            repulsion: blob.gains.repulsion,
            repulsion_range: blob.gains.repulsion_range,
            cruise: blob.gains.cruise,
            turn: blob.gains.turn,
        }
    }

    /// The blob, whose parameters may still be out of range.
    #[inline(never)]
    pub(super) fn to_blob(&self) -> Result<Blob<N>, BlobError> {
        let unknown = self.genes.iter().enumerate().find(|(_, gene)| Motif::from_code(gene.opcode).is_none());
        if let Some((index, gene)) = unknown {
            return Err(BlobError::Opcode { gene: index, opcode: gene.opcode });
        }
        let genes = self.genes.iter().filter_map(|gene| {
            Some(Gene {
                motif: Motif::from_code(gene.opcode)?,
                inputs: filled(gene.inputs.iter().map(|&code| Source::from_code(code))),
                theta: gene.theta,
            })
        });
        Ok(Blob {
            network: Network::new(self.steepness, genes).map_err(BlobError::Network)?,
            field: FieldParameters {
                kernel: Kernel::from_code(self.kernel).ok_or(BlobError::Kernel(self.kernel))?,
                target_width: self.target_width,
                obstacle_width: self.obstacle_width,
            },
            level_fraction: self.level_fraction,
            scale: self.scale,
            step: Step::from_exponent(self.step_exponent).map_err(BlobError::Step)?,
            time_scale: self.time_scale,
            gains: Gains {
                attraction: self.attraction,
                coupling: self.coupling,
                decay: self.decay,
                drive: self.drive,
                repulsion: self.repulsion,
                repulsion_range: self.repulsion_range,
                cruise: self.cruise,
                turn: self.turn,
            },
        })
    }

    /// Writes to the front of `buffer`; `None` if it is too small.
    pub(super) fn write<'a>(&self, buffer: &'a mut [u8]) -> Option<&'a [u8]> {
        let written = postcard::serialize_with_flavor(self, Slice::new(buffer)).ok()?;
        Some(written)
    }

    /// Whether this payload encodes to exactly `bytes`.
    pub(super) fn matches(&self, bytes: &[u8]) -> bool {
        postcard::serialize_with_flavor(self, Comparison { expected: bytes }).unwrap_or(false)
    }

    pub(super) fn identity(&self) -> Identity {
        use sha2::Digest;
        let digest = postcard::serialize_with_flavor(self, Hashing(sha2::Sha256::new())).unwrap_or_default();
        digest.first_chunk().copied().unwrap_or_default()
    }
}

/// Compares what is serialised with bytes that are already there.
struct Comparison<'a> {
    expected: &'a [u8],
}

impl Flavor for Comparison<'_> {
    type Output = bool;

    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        match self.expected.split_first() {
            Some((&expected, rest)) if expected == byte => {
                self.expected = rest;
                Ok(())
            }
            _ => Err(postcard::Error::SerializeBufferFull),
        }
    }

    fn finalize(self) -> postcard::Result<bool> {
        Ok(self.expected.is_empty())
    }
}

/// Hashes what is serialised.
struct Hashing(sha2::Sha256);

impl Flavor for Hashing {
    type Output = [u8; 32];

    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        sha2::Digest::update(&mut self.0, [byte]);
        Ok(())
    }

    fn finalize(self) -> postcard::Result<[u8; 32]> {
        Ok(sha2::Digest::finalize(self.0).into())
    }
}
