//! f2 by the nearest target.

use super::candidate::{Candidate, Objective};

/// f2 with the distance of each candidate point from its nearest target; in [0, 2]. With a single target it is the paper's.
pub struct NearestRingError;

impl Objective for NearestRingError {
    fn name(&self) -> &'static str {
        "f2-nearest"
    }
    fn description(&self) -> &'static str {
        "pattern error f2 by the nearest target"
    }
    fn value(&self, candidate: &Candidate<'_>) -> f64 {
        candidate.f2_nearest
    }
}
