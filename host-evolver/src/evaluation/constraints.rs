//! What a pattern must keep to, whatever it is worth.

use super::lanes::{Lanes, WIDTH};
use super::model::Model;
use firmware_sim::scenario::Morphogen;
use grn_core::robot::epuck2::BODY_RADIUS;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// The paper's clearance: candidate points nearer to an obstacle than this (metres) violate the constraint.
pub const SMALLEST_CLEARANCE: f64 = 0.05;
/// Where x1 is at most this, targets are far: more than two of their widths away.
const FAR_X1: f64 = 0.1;
/// How finely x2 is looked at.
const X2_STEPS: u32 = 20;

/// What a pattern must keep to. Each part adds to the violation of a model that does not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constraints {
    /// The pattern encloses every target.
    pub enclosed: bool,
    /// The pattern keeps so far from walls, metres.
    pub clearance: Option<f64>,
    /// Walls far from any target are outside the pattern, as empty space is: φ(x1, x2) ≤ -c/2 wherever x1 ≤ 0.1, where φ of empty
    /// space is -c. Else robots are drawn to walls, and trapped there.
    pub no_islands: bool,
}

/// Which constraints hold, by name, in one order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Vec<String>", into = "Vec<String>")]
pub struct ConstraintNames {
    enclosed: bool,
    clearance: bool,
    no_islands: bool,
}

const NAMES: [&str; 3] = ["enclosed", "clearance", "no-islands"];

impl ConstraintNames {
    /// The paper's: enclosed and clearance.
    pub const PAPER: ConstraintNames = ConstraintNames { enclosed: true, clearance: true, no_islands: false };
    /// All there are.
    pub const ALL: ConstraintNames = ConstraintNames { no_islands: true, ..ConstraintNames::PAPER };

    /// Those that hold, in order.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        let ConstraintNames { enclosed, clearance, no_islands } = self;
        NAMES.into_iter().zip([enclosed, clearance, no_islands]).filter(|(_, holds)| *holds).map(|(name, _)| name)
    }

    /// These with so much clearance, metres, if clearance is one of them.
    pub fn with_clearance(self, clearance: f64) -> Constraints {
        let ConstraintNames { enclosed, no_islands, .. } = self;
        Constraints { enclosed, clearance: self.clearance.then_some(clearance), no_islands }
    }
}

impl TryFrom<Vec<String>> for ConstraintNames {
    type Error = UnknownConstraint;

    fn try_from(names: Vec<String>) -> Result<Self, UnknownConstraint> {
        if let Some(unknown) = names.iter().find(|name| !NAMES.contains(&name.as_str())) {
            return Err(UnknownConstraint(unknown.clone()));
        }
        let [enclosed, clearance, no_islands] = NAMES.map(|known| names.iter().any(|name| name == known));
        Ok(ConstraintNames { enclosed, clearance, no_islands })
    }
}

impl From<ConstraintNames> for Vec<String> {
    fn from(constraints: ConstraintNames) -> Self {
        constraints.names().map(String::from).collect()
    }
}

impl FromStr for ConstraintNames {
    type Err = UnknownConstraint;

    /// Names separated by commas: `enclosed,no-islands`; `none` for none.
    fn from_str(text: &str) -> Result<Self, UnknownConstraint> {
        let names = text.split(',').map(|name| name.trim().to_owned());
        ConstraintNames::try_from(if text == "none" { Vec::new() } else { names.collect() })
    }
}

impl fmt::Display for ConstraintNames {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<_> = self.names().collect();
        f.write_str(if names.is_empty() { "none".to_owned() } else { names.join(",") }.as_str())
    }
}

/// A name that no constraint has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownConstraint(String);

impl fmt::Display for UnknownConstraint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} is no constraint; there are {}, or none", self.0, NAMES.join(", "))
    }
}

impl std::error::Error for UnknownConstraint {}

/// The clearance in which a robot fits between pattern and wall in a world of this scale, scenario metres; never below
/// the paper's.
pub fn clearance_for(scale: f32) -> f64 {
    (BODY_RADIUS / f64::from(scale)).max(SMALLEST_CLEARANCE)
}

impl Constraints {
    /// The paper's.
    pub const PAPER: Constraints =
        Constraints { enclosed: true, clearance: Some(SMALLEST_CLEARANCE), no_islands: false };

    /// How far φ is above what it may be where targets are far, at most; 0 if nowhere or if islands are allowed.
    pub(super) fn islands(&self, model: &Model, morphogen: &Morphogen) -> f64 {
        if !self.no_islands {
            return 0.0;
        }
        let x2: Vec<f64> = (0..=X2_STEPS).map(|step| f64::from(step) / f64::from(X2_STEPS)).collect();
        let most = [0.0, FAR_X1 / 2.0, FAR_X1].into_iter().flat_map(|x1| {
            x2.chunks(WIDTH).flat_map(move |some| {
                let lanes = Lanes(std::array::from_fn(|lane| some.get(lane).copied().unwrap_or(0.0)));
                model.errors(Lanes::splat(x1), lanes).0
            })
        });
        (most.fold(f64::NEG_INFINITY, f64::max) + morphogen.level / 2.0).max(0.0)
    }
}
