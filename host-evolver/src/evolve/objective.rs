//! What the search minimises. A further objective is a type that implements [`Objective`], given to
//! [`Search::with`](crate::evolve::Search::with).

use super::individual::Individual;
use grn_optimisers::nsga2::Scores;

/// Something to be minimised. It is asked for several times an individual, so one that costs much should remember.
pub trait Objective: Sync {
    /// Its name in tables.
    fn name(&self) -> &'static str;
    /// Its value, less is better.
    fn value(&self, individual: &Individual) -> f64;
}

/// f1: nodes of the tree, functions and terminals.
pub struct Nodes;

impl Objective for Nodes {
    fn name(&self) -> &'static str {
        "nodes"
    }
    fn value(&self, individual: &Individual) -> f64 {
        individual.tree.size() as f64
    }
}

/// f2: how far the ring is from the wanted distances, averaged over snapshots; in [0, 2].
pub struct RingError;

impl Objective for RingError {
    fn name(&self) -> &'static str {
        "f2"
    }
    fn value(&self, individual: &Individual) -> f64 {
        individual.f2
    }
}

/// The objectives' values of an individual and its violation, for Deb's rule.
pub fn scores<const M: usize>(individual: &Individual, objectives: &[&dyn Objective; M]) -> Scores<M> {
    Scores { objectives: objectives.map(|objective| objective.value(individual)), violation: individual.violation }
}
