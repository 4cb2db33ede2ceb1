//! The five models whose parameters the paper prints, as networks.

use grn_core::motif::Motif;
use grn_core::network::{Gene, Network, NetworkError, Source};

/// A printed model: its short name and its genes in the paper's order.
pub struct Published {
    /// Name of its blob in `models/`, without the ending.
    pub name: &'static str,
    /// Where the paper prints it.
    pub origin: &'static str,
    genes: &'static [(Motif, &'static [Source], f32)],
}

impl Published {
    /// The network, with k = 1.
    ///
    /// # Errors
    /// Never for the models of [`PUBLISHED`]; the type is that of any construction.
    pub fn network(&self) -> Result<Network<f32>, NetworkError> {
        self.with(self.genes.iter().map(|&(_, _, theta)| theta))
    }

    /// The same structure with other θ, in the order of the genes; the network ends where the θ end.
    ///
    /// # Errors
    /// No θ, or one out of range.
    pub fn with_thetas(&self, thetas: &[f64]) -> Result<Network<f32>, NetworkError> {
        self.with(thetas.iter().map(|&theta| theta as f32))
    }

    fn with(&self, thetas: impl Iterator<Item = f32>) -> Result<Network<f32>, NetworkError> {
        let genes = self.genes.iter().zip(thetas).map(|(&(motif, inputs, _), theta)| Gene {
            motif,
            inputs: inputs.iter().copied().collect(),
            theta,
        });
        Network::new(1.0, genes)
    }

    /// How many genes it has.
    pub fn gene_count(&self) -> usize {
        self.genes.len()
    }
}

use Source::{Gene as G, X1, X2};

/// All five. EH-GRN's genes are y1 … y6, then g1, g2, g3, y7, y8, y9 and M; θ1 … θ13 are printed in another order.
pub const PUBLISHED: [Published; 5] = [
    Published {
        name: "nand-xnor",
        origin: "task 1, point B",
        genes: &[(Motif::Nand, &[X1, X1], 0.8393), (Motif::Xnor, &[G(0), X2], 0.9256)],
    },
    Published {
        name: "andn-xnor",
        origin: "task 2, point A",
        genes: &[(Motif::Andn, &[X2, X1], 1.3072), (Motif::Xnor, &[G(0), X1], 0.7472)],
    },
    Published {
        name: "andn-nand-xnor",
        origin: "task 2, point B",
        genes: &[
            (Motif::Andn, &[X2, X1], 1.5441),
            (Motif::Nand, &[X1, X1], 0.0904),
            (Motif::Xnor, &[G(0), G(1)], 0.2414),
        ],
    },
    Published {
        name: "eh-grn-1",
        origin: "task 1, EH-GRN",
        genes: &[
            (Motif::Neg, &[X1], 1.0),
            (Motif::Neg, &[X2], 0.5328),
            (Motif::Pos, &[X1], 1.0),
            (Motif::Pos, &[X2], 0.4448),
            (Motif::Pos, &[X1], 0.0),
            (Motif::Pos, &[X2], 0.934),
            (Motif::And, &[G(0), G(1)], 2.0),
            (Motif::Or, &[G(2), G(3)], 1.2095),
            (Motif::And, &[G(4), G(5)], 1.6798),
            (Motif::Neg, &[G(6)], 1.0),
            (Motif::Pos, &[G(7)], 0.5385),
            (Motif::Pos, &[G(8)], 0.2763),
            (Motif::Or, &[G(9), G(10), G(11)], 1.3445),
        ],
    },
    Published {
        name: "eh-grn-2",
        origin: "task 2, EH-GRN",
        genes: &[
            (Motif::Pos, &[X1], 0.1438),
            (Motif::Neg, &[X2], 1.0),
            (Motif::Pos, &[X1], 0.3457),
            (Motif::Neg, &[X2], 0.8571),
            (Motif::Pos, &[X1], 0.3827),
            (Motif::Neg, &[X2], 1.0),
            (Motif::And, &[G(0), G(1)], 1.5841),
            (Motif::And, &[G(2), G(3)], 1.1972),
            (Motif::Or, &[G(4), G(5)], 0.4208),
            (Motif::Pos, &[G(6)], 0.0),
            (Motif::Pos, &[G(7)], 0.0),
            (Motif::Neg, &[G(8)], 0.5977),
            (Motif::Or, &[G(9), G(10), G(11)], 0.6777),
        ],
    },
];
