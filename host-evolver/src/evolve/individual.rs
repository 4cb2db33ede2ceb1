//! A model that the search has tuned.

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
}

impl Individual {
    pub(super) fn new(tree: Tree, objectives: Vec<f64>, evaluation: Evaluation) -> Self {
        Individual { tree, objectives, f2: evaluation.f2, violation: evaluation.violation }
    }

    /// (f1, f2): how many nodes, and the ring error.
    pub fn point(&self) -> [f64; 2] {
        [self.tree.size() as f64, self.f2]
    }

    /// Whether it encloses every target everywhere without coming too close to a wall.
    pub fn is_feasible(&self) -> bool {
        self.violation == 0.0
    }
}
