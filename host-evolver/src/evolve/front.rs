//! What a run leaves: its non-dominated front.

use crate::model::describe;
use crate::model::notation::Digits;
use grn_core::network::Network;
use grn_optimisers::hypervolume::hypervolume;
use grn_optimisers::knee::Knee;

/// A member of a non-dominated front: a line of `front.csv` and its blob.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontMember {
    /// The model.
    pub network: Network<f32>,
    /// f1: nodes of the tree, functions and terminals.
    pub nodes: usize,
    /// The paper's f2, in [0, 2].
    pub f2: f64,
    /// The values of the run's objectives other than these two, in their order.
    pub further: Vec<f64>,
    /// Constraint violation, 0 for a feasible model.
    pub violation: f64,
    /// Whether it is a knee of its front.
    pub knee: Knee,
}

impl FrontMember {
    /// The model in the one [notation](crate::model::notation).
    pub fn expression(&self, digits: Digits) -> String {
        describe::expression(&self.network, digits)
    }

    /// Whether it encloses every target everywhere without coming too close to a wall.
    pub fn is_feasible(&self) -> bool {
        self.violation == 0.0
    }
}

/// The place of the knee that is deployed: the one by parsimony where models were tried, else by marginal utility; the first
/// member's if there is none.
pub fn deployed(front: &[FrontMember]) -> usize {
    let parsimonious = front.iter().position(|member| member.knee.parsimony);
    parsimonious.or_else(|| front.iter().position(|member| member.knee.utility)).unwrap_or(0)
}

/// The nodes and the f2 beyond which a model counts for nothing in a hypervolume.
pub const REFERENCE: [f64; 2] = [32.0, 0.2];

/// The share of the box from the origin to [`REFERENCE`] that feasible (f1, f2) dominate, within [0, 1].
pub fn front_hypervolume(points: impl Iterator<Item = [f64; 2]>) -> f64 {
    hypervolume(&points.collect::<Vec<_>>(), REFERENCE) / (REFERENCE[0] * REFERENCE[1])
}
