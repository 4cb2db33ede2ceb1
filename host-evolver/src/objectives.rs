//! What the search minimises. A further objective is a type that implements [`Objective`], given to
//! [`Search::with`](crate::evolve::Search::with).

use crate::evolve::Individual;

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
