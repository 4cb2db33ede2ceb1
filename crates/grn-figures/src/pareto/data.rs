//! What a figure of a front takes.

use crate::canvas::paint::{Mark, Paint};
use crate::canvas::style::{INK, THIN, VERMILLION};
use grn_optimisers::knee::Knee;

/// The words and the mark of a knee; none for a point that is no knee.
pub(crate) fn knee_look(knee: Knee) -> Option<(&'static str, Mark)> {
    if knee.parsimony {
        return Some(("knee (parsimony)", Mark::Diamond));
    }
    match (knee.angle, knee.utility) {
        (true, true) => Some(("knee (both)", Mark::Diamond)),
        (true, false) => Some(("knee (angle)", Mark::Triangle)),
        (false, true) => Some(("knee (utility)", Mark::Square)),
        (false, false) => None,
    }
}

/// How a model that is not on the front is marked.
pub(crate) fn other_look(feasible: bool) -> (Mark, f64, Paint) {
    if feasible {
        (Mark::Circle, 1.7, Paint::fill("#C4C4C4"))
    } else {
        (Mark::Cross, 1.6, Paint::stroke("#B0B0B0", 0.7))
    }
}

/// How a model on the front is marked.
pub(crate) fn front_look(knee: Knee) -> (Mark, f64, Paint) {
    match knee_look(knee) {
        Some((_, mark)) => (mark, 3.2, Paint::stroke(INK, THIN).filled(VERMILLION)),
        None => (Mark::Circle, 2.4, Paint::stroke(INK, 0.9).filled("#FFFFFF")),
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
    /// By which measures it is a knee of the front; a knee is drawn as one where it is feasible.
    pub knee: Knee,
    /// Its expression, written beside a knee.
    pub label: String,
}

impl ParetoPoint {
    /// Whether it is marked and labelled.
    pub(crate) fn is_knee(&self) -> bool {
        self.feasible && self.knee != Knee::default()
    }
}

/// A horizontal line to compare with, such as the error of a perfect circle.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// Its f2.
    pub f2: f64,
    /// What it is.
    pub label: String,
}
