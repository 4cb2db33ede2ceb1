//! The closed loop.

use super::candidate::{Candidate, Objective};

/// The mean cost J of simulated runs.
pub struct ClosedLoop;

/// The mean cost of the worst tenth of simulated runs.
pub struct Worst;

impl Objective for ClosedLoop {
    fn name(&self) -> &'static str {
        "closed-loop"
    }
    fn description(&self) -> &'static str {
        "cost J of simulated swarms, mean"
    }
    fn value(&self, candidate: &Candidate<'_>) -> f64 {
        mean(candidate.trials)
    }
    fn needs_trials(&self) -> bool {
        true
    }
}

impl Objective for Worst {
    fn name(&self) -> &'static str {
        "worst"
    }
    fn description(&self) -> &'static str {
        "cost J of simulated swarms, mean of the worst tenth"
    }
    fn value(&self, candidate: &Candidate<'_>) -> f64 {
        let mut costs = candidate.trials.to_vec();
        costs.sort_by(|a, b| b.total_cmp(a));
        costs.truncate(costs.len().div_ceil(10));
        mean(&costs)
    }
    fn needs_trials(&self) -> bool {
        true
    }
}

/// Infinite without trials.
fn mean(costs: &[f64]) -> f64 {
    if costs.is_empty() { f64::INFINITY } else { costs.iter().sum::<f64>() / costs.len() as f64 }
}
