//! A feed-forward network of genes, validated once and then safe to evaluate.

use crate::bounded::filled;
use crate::motif::{MAX_INPUTS, Motif};
use crate::scalar::{Arithmetic, Scalar};
use core::fmt;
use heapless::Vec;

/// The default capacity of a [`Network`], in genes.
pub const DEFAULT_GENES: usize = 32;
/// Bounds of θ, inclusive (model page, section 1).
pub const THETA_RANGE: (f32, f32) = (0.0, 2.0);
/// Bounds of the sigmoid's steepness k, inclusive. The paper uses 1.
pub const STEEPNESS_RANGE: (f32, f32) = (1.0 / 16.0, 16.0);

/// Where a gene reads one of its inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Source {
    /// Morphogen of the targets.
    X1,
    /// Morphogen of the obstacles.
    X2,
    /// Expression level of an earlier gene, counted from 0.
    Gene(u8),
}

impl Source {
    /// The wire code: 0 for x1, 1 for x2, 2 + i for gene i.
    pub const fn code(self) -> u8 {
        match self {
            Source::X1 => 0,
            Source::X2 => 1,
            Source::Gene(index) => index.saturating_add(2),
        }
    }

    /// The source with this wire code.
    pub const fn from_code(code: u8) -> Source {
        match code {
            0 => Source::X1,
            1 => Source::X2,
            _ => Source::Gene(code - 2),
        }
    }
}

/// One gene: dy/dt = -y + R(inputs; θ, k).
#[derive(Clone, Debug, PartialEq)]
pub struct Gene<S> {
    /// How the inputs regulate it.
    pub motif: Motif,
    /// What it reads, in the operands' order.
    pub inputs: Vec<Source, MAX_INPUTS>,
    /// The regulatory threshold θ.
    pub theta: S,
}

impl<S> Gene<S> {
    /// Whether it reads x1 and x2 only, no gene.
    pub(crate) fn reads_inputs_only(&self) -> bool {
        self.inputs.iter().all(|source| !matches!(source, Source::Gene(_)))
    }
}

/// Why a list of genes is not a network.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum NetworkError {
    /// No genes at all.
    Empty,
    /// More genes than this build holds.
    TooManyGenes {
        /// How many genes were given, if countable.
        genes: usize,
        /// How many fit.
        capacity: usize,
    },
    /// The motif takes another number of inputs.
    Arity {
        /// Position of the gene, from 0.
        gene: usize,
        /// Its motif.
        motif: Motif,
        /// How many inputs it was given.
        inputs: usize,
    },
    /// A gene reads itself or a later gene.
    NotFeedForward {
        /// Position of the gene, from 0.
        gene: usize,
        /// The gene it reads.
        reads: usize,
    },
    /// θ is not a number in [`THETA_RANGE`].
    Theta {
        /// Position of the gene, from 0.
        gene: usize,
        /// The value.
        theta: f32,
    },
    /// k is not a number in [`STEEPNESS_RANGE`].
    Steepness(f32),
}

impl fmt::Display for NetworkError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            NetworkError::Empty => write!(f, "the network has no genes; it needs at least one"),
            NetworkError::TooManyGenes { genes, capacity } => {
                write!(
                    f,
                    "the network has {genes} genes, this build holds {capacity}: evolve a smaller one or build with a larger capacity"
                )
            }
            NetworkError::Arity { gene, motif, inputs } => {
                let arity = motif.arity();
                write!(
                    f,
                    "gene {gene}: {} takes {} to {} inputs, not {inputs}",
                    motif.name(),
                    arity.start(),
                    arity.end()
                )
            }
            NetworkError::NotFeedForward { gene, reads } => {
                write!(f, "gene {gene} reads gene {reads}; a gene may only read x1, x2 and genes before it")
            }
            NetworkError::Theta { gene, theta } => {
                write!(f, "gene {gene}: θ = {theta} is not in [{}, {}]", THETA_RANGE.0, THETA_RANGE.1)
            }
            NetworkError::Steepness(k) => {
                write!(f, "k = {k} is not in [{}, {}]", STEEPNESS_RANGE.0, STEEPNESS_RANGE.1)
            }
        }
    }
}

impl core::error::Error for NetworkError {}

/// Whether `value` is a number in the inclusive range.
pub(crate) fn within(value: f32, (low, high): (f32, f32)) -> bool {
    (low..=high).contains(&value)
}

/// A feed-forward network of at most `N` genes; the last gene is the pattern morphogen M.
///
/// Built by [`Network::new`] only, so that every network is non-empty, topologically ordered and in range.
///
/// ```
/// use grn_core::{motif::Motif, network::{Gene, Network, Source}};
/// let gene = |motif, inputs: &[Source], theta| Gene { motif, inputs: inputs.iter().copied().collect(), theta };
/// // The printed model of task 1, point B: XNOR(NAND(x1, x1), x2).
/// let network: Network<f32> = Network::new(1.0, [
///     gene(Motif::Nand, &[Source::X1, Source::X1], 0.8393),
///     gene(Motif::Xnor, &[Source::Gene(0), Source::X2], 0.9256),
/// ])?;
/// let tolerance = if cfg!(feature = "micromath") { 1e-3 } else { 1e-6 };
/// assert!((network.steady_state(1.0, 0.0) - 0.330545).abs() < tolerance);
/// # Ok::<(), grn_core::network::NetworkError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Network<S, const N: usize = DEFAULT_GENES> {
    genes: Vec<Gene<S>, N>,
    steepness: S,
}

impl<const N: usize> Network<f32, N> {
    /// Checks and builds a network with sigmoid steepness k and genes in topological order.
    ///
    /// # Errors
    /// Whatever [`NetworkError`] lists, first fault first.
    pub fn new(steepness: f32, genes: impl IntoIterator<Item = Gene<f32>>) -> Result<Self, NetworkError> {
        if !within(steepness, STEEPNESS_RANGE) {
            return Err(NetworkError::Steepness(steepness));
        }
        let mut network = Network { genes: Vec::new(), steepness };
        let mut genes = genes.into_iter();
        for gene in genes.by_ref() {
            network.check_next(&gene)?;
            if network.genes.push(gene).is_err() {
                return Err(NetworkError::TooManyGenes { genes: N + 1 + genes.count(), capacity: N });
            }
        }
        if network.genes.is_empty() { Err(NetworkError::Empty) } else { Ok(network) }
    }

    fn check_next(&self, gene: &Gene<f32>) -> Result<(), NetworkError> {
        let index = self.genes.len();
        if !gene.motif.arity().contains(&gene.inputs.len()) {
            return Err(NetworkError::Arity { gene: index, motif: gene.motif, inputs: gene.inputs.len() });
        }
        for input in &gene.inputs {
            if let Source::Gene(reads) = *input
                && usize::from(reads) >= index
            {
                return Err(NetworkError::NotFeedForward { gene: index, reads: usize::from(reads) });
            }
        }
        if !within(gene.theta, THETA_RANGE) {
            return Err(NetworkError::Theta { gene: index, theta: gene.theta });
        }
        Ok(())
    }

    /// The same network in another number type; θ and k are rounded to it.
    pub fn cast<S: Scalar>(&self) -> Network<S, N> {
        let genes = self.genes.iter().map(|gene| Gene {
            motif: gene.motif,
            inputs: gene.inputs.clone(),
            theta: S::from_f32(gene.theta),
        });
        Network { genes: filled(genes), steepness: S::from_f32(self.steepness) }
    }
}

impl<S: Scalar, const N: usize> Network<S, N> {
    /// The genes in topological order, at least one.
    pub fn genes(&self) -> &[Gene<S>] {
        &self.genes
    }

    /// The sigmoid's steepness k.
    pub fn steepness(&self) -> S {
        self.steepness
    }

    /// The regulation R of each gene in turn, given all expression levels; `visit` receives (gene index, R).
    ///
    /// With `visit` storing R as the gene's level this is the steady state; with it storing R - y it is the dynamics.
    pub(crate) fn regulate<A: Arithmetic<Real = S>, Y: Levels<A>>(
        &self,
        x: [A; 2],
        y: &mut Y,
        mut visit: impl FnMut(&mut Y, usize, A),
    ) {
        for (index, gene) in self.genes.iter().enumerate() {
            let regulation = self.regulation(gene, x, y);
            visit(y, index, regulation);
        }
    }

    /// The regulation R of one gene.
    #[inline]
    pub(crate) fn regulation<A: Arithmetic<Real = S>>(&self, gene: &Gene<S>, x: [A; 2], y: &impl Levels<A>) -> A {
        let inputs = gene.inputs.iter().map(|source| match *source {
            Source::X1 => x[0],
            Source::X2 => x[1],
            Source::Gene(earlier) => y.level(usize::from(earlier)),
        });
        gene.motif.regulation(inputs, gene.theta, self.steepness)
    }
}

/// Expression levels that regulation reads, one per gene.
pub(crate) trait Levels<A> {
    /// The level of a gene that exists.
    fn level(&self, gene: usize) -> A;
}

impl<A: Arithmetic, L: AsRef<[A]>> Levels<A> for L {
    fn level(&self, gene: usize) -> A {
        self.as_ref().get(gene).copied().unwrap_or(A::ZERO)
    }
}
