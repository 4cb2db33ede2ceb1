//! f2.

use super::candidate::{Candidate, Objective};

/// f2: how far the ring is from the wanted distances, averaged over snapshots; in [0, 2].
pub struct RingError;

impl Objective for RingError {
    fn name(&self) -> &'static str {
        "f2"
    }
    fn description(&self) -> &'static str {
        "the paper's pattern error f2"
    }
    fn value(&self, candidate: &Candidate<'_>) -> f64 {
        candidate.evaluation.f2
    }
}
