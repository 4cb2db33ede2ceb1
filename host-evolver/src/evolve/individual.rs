//! A model that the search has tuned.

use super::objective::Candidate;
use super::objectives::Objectives;
use super::settings::Settings;
use crate::evaluation::{Evaluation, Evaluator, TargetDistance};
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
    /// The paper's f2 in [0, 2].
    pub f2: f64,
    /// f2 by the nearest target, if θ were tuned for that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub f2_nearest: Option<f64>,
    /// Constraint violation, 0 for a feasible model.
    pub violation: f64,
    /// What it cost in each simulated trial, trial 1 first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub trials: Vec<f64>,
}

impl Individual {
    /// An individual that has not been tried, from its evaluation by the distance that the evaluator uses.
    pub(super) fn evaluated(
        evaluator: &mut Evaluator<'_>,
        settings: &Settings,
        tree: Tree,
        evaluation: Evaluation,
    ) -> Self {
        let by_nearest = evaluator.distance() == TargetDistance::OfNearest;
        let of_all = match evaluator.model_of(&tree, settings.steepness) {
            Some(model) if by_nearest => evaluator.evaluate_by(TargetDistance::OfAll, &model),
            _ => evaluation,
        };
        let mut individual = Individual {
            tree,
            objectives: Vec::new(),
            f2: of_all.f2,
            f2_nearest: by_nearest.then_some(evaluation.f2),
            violation: evaluation.violation,
            trials: Vec::new(),
        };
        individual.value_trials(&settings.objectives);
        individual
    }

    /// Takes the values of the objectives from what is known by now.
    pub(super) fn value_trials(&mut self, objectives: &Objectives) {
        let evaluation = Evaluation { f2: self.f2, violation: self.violation };
        let f2_nearest = self.f2_nearest.unwrap_or(self.f2);
        let candidate = Candidate { tree: &self.tree, evaluation, f2_nearest, trials: &self.trials };
        self.objectives = objectives.values(&candidate);
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
