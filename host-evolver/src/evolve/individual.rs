//! A model that the search has tuned.

use super::objective::Candidate;
use super::objectives::Objectives;
use crate::evaluation::Evaluation;
use crate::model::tree::Tree;
use serde::{Deserialize, Serialize};

/// A tuned tree and what it is worth; nothing of it is computed again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Individual {
    /// The tree with its θ.
    pub tree: Tree,
    /// The values of the run's objectives, in their order, less is better.
    pub objectives: Vec<f64>,
    /// The paper's f2 in [0, 2], for which θ were tuned.
    pub f2: f64,
    /// Constraint violation, 0 for a feasible model.
    pub violation: f64,
    /// What it cost in each simulated trial, trial 1 first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub trials: Vec<f64>,
}

impl Individual {
    /// An individual that has not been tried.
    pub(super) fn new(tree: Tree, objectives: &Objectives, evaluation: Evaluation) -> Self {
        let Evaluation { f2, violation } = evaluation;
        let mut individual = Individual { tree, objectives: Vec::new(), f2, violation, trials: Vec::new() };
        individual.value_trials(objectives);
        individual
    }

    /// Takes the values of the objectives from what is known by now.
    pub(super) fn value_trials(&mut self, objectives: &Objectives) {
        let evaluation = Evaluation { f2: self.f2, violation: self.violation };
        self.objectives = objectives.values(&Candidate { tree: &self.tree, evaluation, trials: &self.trials });
    }

    /// (f1, f2): how many nodes, and the ring error.
    pub fn point(&self) -> [f64; 2] {
        [self.tree.size() as f64, self.f2]
    }

    /// Its mean cost in its trials, if it has been tried.
    pub fn cost(&self) -> Option<f64> {
        (!self.trials.is_empty()).then(|| self.trials.iter().sum::<f64>() / self.trials.len() as f64)
    }

    /// Whether it encloses every target everywhere without coming too close to a wall.
    pub fn is_feasible(&self) -> bool {
        self.violation == 0.0
    }
}
