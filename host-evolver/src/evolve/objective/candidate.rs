//! What an objective is and what it sees.

use crate::evaluation::Evaluation;
use crate::model::tree::Tree;

/// What an objective is computed from: a model whose θ have been tuned.
#[derive(Clone, Copy)]
pub struct Candidate<'a> {
    /// The tree with its θ.
    pub tree: &'a Tree,
    /// The paper's f2 and the constraint violation in the worlds.
    pub evaluation: Evaluation,
    /// The cost of each simulated run so far.
    pub trials: &'a [f64],
}

/// Something to be minimised.
pub trait Objective: Sync {
    /// Its name on the command line, in files and in figures: lower case, digits, hyphens.
    fn name(&self) -> &'static str;
    /// What it measures and its unit, for people.
    fn description(&self) -> &'static str;
    /// Its value, less is better.
    fn value(&self, candidate: &Candidate<'_>) -> f64;
    /// Whether it is made from simulated runs.
    fn needs_trials(&self) -> bool {
        false
    }
}
