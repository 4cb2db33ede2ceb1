//! What a figure of a front takes.

use crate::canvas::paint::Mark;

/// By which measure a point is a knee.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KneeKind {
    /// The angle between its neighbours (Branke et al. 2004, section 3.1).
    Angle,
    /// The expected marginal utility (Branke et al. 2004, section 3.2).
    Utility,
    /// Both.
    Both,
}

impl KneeKind {
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Angle => "knee (angle)",
            Self::Utility => "knee (utility)",
            Self::Both => "knee (both)",
        }
    }

    pub(crate) fn mark(self) -> Mark {
        match self {
            Self::Angle => Mark::Triangle,
            Self::Utility => Mark::Square,
            Self::Both => Mark::Diamond,
        }
    }
}

/// A solution of the final population.
#[derive(Debug, Clone, PartialEq)]
pub struct ParetoPoint {
    /// Objective f1: nodes of the tree, functions and terminals.
    pub nodes: u32,
    /// Objective f2: pattern error, dimensionless, 0 or more.
    pub f2: f64,
    /// Whether every target is enclosed and every obstacle cleared.
    pub feasible: bool,
    /// Whether it is a knee of the front.
    pub knee: Option<KneeKind>,
    /// Its expression, written beside a knee.
    pub label: String,
}

/// A horizontal line to compare with, such as the error of a perfect circle.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// Its f2.
    pub f2: f64,
    /// What it is.
    pub label: String,
}
