//! A network, as its figure takes it.

/// What a gene reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// The morphogen of the targets.
    X1,
    /// The morphogen of the obstacles.
    X2,
    /// An earlier gene, by its index.
    Gene(usize),
}

/// One regulation of a gene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Input {
    /// What regulates it.
    pub source: Source,
    /// Whether it promotes (arrow) or represses (bar).
    pub activates: bool,
}

/// A gene; the last of a network is the pattern morphogen.
#[derive(Debug, Clone, PartialEq)]
pub struct Gene {
    /// `G1`, `g1`, `y1`, `M`, …
    pub name: String,
    /// `NAND`, …
    pub motif: String,
    /// Its threshold.
    pub theta: f64,
    /// What it reads, in the motif's order; the same source may come twice.
    pub inputs: Vec<Input>,
}
