//! How far a run has come.

use super::individual::Individual;
use serde::{Deserialize, Serialize};

/// The state between two generations: all that a run needs to go on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// Generations done; the first is the initial population.
    pub generation: u32,
    /// Evaluations of f2 spent.
    pub evaluations: usize,
    /// The current population.
    pub population: Vec<Individual>,
    /// One line a generation.
    pub history: Vec<Milestone>,
}

/// How far a run had come after a generation: a line of `history.csv`, of every method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Milestone {
    /// Evaluations of f2 spent.
    pub evaluations: usize,
    /// Best f2 of a feasible model, if there is one.
    pub best_f2: Option<f64>,
    /// Least mean cost of a feasible model in its trials, if one was tried.
    #[serde(default)]
    pub best_cost: Option<f64>,
    /// Feasible models kept: in the population, or the best one of a method that keeps one.
    pub feasible: usize,
    /// Models on the feasible non-dominated front.
    pub front: usize,
    /// Of the feasible models, in (f1, f2): the share of the box below [`REFERENCE`](super::front::REFERENCE) that they
    /// dominate.
    pub hypervolume: f64,
}
