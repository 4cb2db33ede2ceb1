//! What an objective is and what it sees.

use crate::evaluation::{Evaluation, Model, World};
use crate::model::tree::Tree;

/// What an objective is computed from: a model whose θ have been tuned, seen once.
#[derive(Clone, Copy)]
pub struct Candidate<'a> {
    /// The tree with its θ.
    pub tree: &'a Tree,
    /// The model that its blob holds; `None` if it has no pattern.
    pub model: Option<&'a Model>,
    /// The paper's f2 and the constraint violation in the world.
    pub evaluation: Evaluation,
    /// The world it was evaluated in.
    pub world: &'a World,
}

/// Something to be minimised.
pub trait Objective: Sync {
    /// Its name on the command line, in files and in figures: lower case, digits, hyphens.
    fn name(&self) -> &'static str;
    /// What it measures and its unit, for people.
    fn description(&self) -> &'static str;
    /// Its value, less is better.
    fn value(&self, candidate: &Candidate<'_>) -> f64;
}
