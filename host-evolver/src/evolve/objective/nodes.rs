//! f1.

use super::candidate::{Candidate, Objective};

/// f1: nodes of the tree, functions and terminals.
pub struct Nodes;

impl Objective for Nodes {
    fn name(&self) -> &'static str {
        "nodes"
    }
    fn description(&self) -> &'static str {
        "complexity f1, nodes of the tree"
    }
    fn value(&self, candidate: &Candidate<'_>) -> f64 {
        candidate.tree.size() as f64
    }
}
