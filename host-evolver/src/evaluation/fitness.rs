//! f2 and constraint violation of a model over a scenario's snapshots (model page, section 4).

use super::candidates::candidates;
use super::constraints::Constraints;
use super::distance_table::DistanceTable;
use super::lanes::{Lanes, WIDTH};
use super::tracer::Contours;
use super::world::{Snapshot, World};
use grn_core::geometry::Point;
use grn_optimisers::nsga2::Scores;
use std::cmp::Ordering;

/// Candidate points per ring that f2 averages over.
pub const CANDIDATES_PER_RING: usize = 48;
/// f2 of a snapshot without any ring: the worst its two terms can add up to.
pub const WORST_F2: f64 = 2.0;
/// Violation of a model without a pattern: no target is enclosed at any snapshot.
const NO_PATTERN_VIOLATION: f64 = 1.0;

/// What the evaluation of a model in a scenario finds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaluation {
    /// The paper's f2, averaged over snapshots; in [0, 2], less is better.
    pub f2: f64,
    /// Mean over snapshots of the share of targets not enclosed plus the share of candidate points too close; 0 for a
    /// feasible model, at most 2.
    pub violation: f64,
}

impl Evaluation {
    /// The evaluation of a model without a pattern.
    pub const NO_PATTERN: Evaluation = Evaluation { f2: WORST_F2, violation: NO_PATTERN_VIOLATION };

    /// The evaluation of a snapshot at which every target is outside the pattern.
    pub(super) fn all_lost(constraints: &Constraints) -> Evaluation {
        Evaluation { f2: WORST_F2, violation: f64::from(u8::from(constraints.enclosed)) }
    }

    pub(super) fn plus(self, other: Evaluation) -> Evaluation {
        Evaluation { f2: self.f2 + other.f2, violation: self.violation + other.violation }
    }

    pub(super) fn over(self, count: f64) -> Evaluation {
        Evaluation { f2: self.f2 / count, violation: self.violation / count }
    }

    /// Deb's rule: less violation, or the same and at most the f2.
    pub fn is_as_good_as(&self, other: &Evaluation) -> bool {
        let scores = |e: &Evaluation| Scores { objectives: [e.f2], violation: e.violation };
        !scores(other).dominates(&scores(self))
    }

    /// The order of the same rule, the better one first.
    pub fn order(&self, other: &Evaluation) -> Ordering {
        self.violation.total_cmp(&other.violation).then(self.f2.total_cmp(&other.f2))
    }

    /// Whether every target is enclosed everywhere and every candidate point is clear.
    pub fn is_feasible(&self) -> bool {
        self.violation == 0.0
    }
}

/// f2 and violation of a pattern at one snapshot.
pub(super) fn evaluate_snapshot(
    world: &World,
    snapshot: &Snapshot,
    contours: &Contours,
    constraints: &Constraints,
) -> Evaluation {
    let lost = contours.enclosed.iter().filter(|&&enclosed| !enclosed).count() as f64;
    let lost = if constraints.enclosed { lost / snapshot.targets.len() as f64 } else { 0.0 };
    let (mut to_targets, mut to_obstacles, mut close, mut count) = (0.0, 0.0, 0_usize, 0_usize);
    for ring in &contours.rings {
        let points = candidates(ring, CANDIDATES_PER_RING);
        to_targets += sum_over(&snapshot.targets, &points, &world.terms.target);
        to_obstacles += sum_over(&snapshot.obstacle_points, &points, &world.terms.obstacle);
        if let Some(clearance) = constraints.clearance {
            close += points.iter().filter(|&&point| world.is_closer_than(snapshot, point, clearance)).count();
        }
        count += points.len();
    }
    if count == 0 {
        return Evaluation { f2: WORST_F2, violation: lost };
    }
    let count = count as f64;
    let per_target = count * snapshot.targets.len() as f64;
    let per_obstacle = count * snapshot.obstacle_points.len().max(1) as f64;
    Evaluation { f2: to_targets / per_target + to_obstacles / per_obstacle, violation: lost + close as f64 / count }
}

/// The sum of a term over all pairs of sources and points.
fn sum_over(sources: &[Point<f64>], points: &[Point<f64>], term: &DistanceTable) -> f64 {
    let squared = |source: Point<f64>, point: Point<f64>| (point - source).dot(point - source);
    let (eights, rest) = points.as_chunks::<WIDTH>();
    let mut sums = Lanes::splat(0.0);
    for &source in sources {
        for eight in eights {
            sums = sums + term.at_all(Lanes(eight.map(|point| squared(source, point))));
        }
    }
    let sum: f64 = sums.0.iter().sum();
    sum + sources.iter().flat_map(|&source| rest.iter().map(move |&point| term.at(squared(source, point)))).sum::<f64>()
}
