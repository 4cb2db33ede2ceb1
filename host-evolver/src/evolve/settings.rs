//! What decides a run besides the scenario.

use super::objectives::Objectives;
use crate::evaluation::{ConstraintNames, SMALLEST_CLEARANCE};
use crate::model::variation::MotifSet;
use grn_optimisers::de;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The largest budget: some hours. The history of its 12,500 generations, written with every checkpoint, takes two
/// megabytes.
pub const MOST_EVALUATIONS: usize = 10_000_000;

/// The most trials of a model.
pub const MOST_REALITIES: usize = 1000;

/// Everything that decides a run besides the scenario.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Seed of all random numbers.
    pub seed: u64,
    /// Budget: evaluations of f2, all counted.
    pub evaluations: usize,
    /// What is minimised.
    pub objectives: Objectives,
    /// Individuals in a generation.
    pub population: usize,
    /// Motifs to build with.
    pub motifs: MotifSet,
    /// Least and greatest depth of a tree, in edges.
    pub depth: (usize, usize),
    /// Steepness k of every sigmoid.
    pub steepness: f32,
    /// Probability that an offspring has two parents instead of one.
    pub crossover: f64,
    /// Probability that an offspring is mutated.
    pub mutation: f64,
    /// Differential evolution of each new individual's θ.
    pub de: DeSettings,
    /// What a pattern must keep to.
    pub constraints: ConstraintNames,
    /// The clearance that the constraint of this name asks for, scenario metres; what a body needs at the blobs' scale if not given.
    pub clearance: Option<f64>,
    /// Trials of a model on the front, 1 to [`MOST_REALITIES`]; without effect if no objective is made from trials.
    pub realities: usize,
}

/// Parameters of DE/rand/1/bin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeSettings {
    /// Vectors: NP.
    pub population: usize,
    /// Differential weight F.
    pub weight: f64,
    /// Crossover probability CR.
    pub crossover: f64,
    /// Generations of trials after the initial vectors.
    pub generations: usize,
}

impl Default for Settings {
    /// The paper's settings for the channel.
    fn default() -> Self {
        Settings {
            seed: 1,
            evaluations: 4000,
            objectives: Objectives::paper(),
            population: 40,
            motifs: MotifSet::All,
            depth: (1, 4),
            steepness: 1.0,
            crossover: 1.0,
            mutation: 0.1,
            de: DeSettings { population: 10, weight: 0.5, crossover: 0.9, generations: 1 },
            constraints: ConstraintNames::PAPER,
            clearance: Some(SMALLEST_CLEARANCE),
            realities: 16,
        }
    }
}

/// Settings that no run can have.
#[derive(Clone, Debug, PartialEq)]
pub struct SettingsError(String);

impl fmt::Display for SettingsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for SettingsError {}

impl Settings {
    /// Settings for controllers that adapt: nodes and the closed loop are minimised under all constraints.
    pub fn adaptive() -> Self {
        Settings {
            objectives: Objectives::adaptive(),
            constraints: ConstraintNames::ALL,
            clearance: None,
            ..Settings::default()
        }
    }

    /// Evaluations one individual costs.
    pub fn evaluations_each(&self) -> usize {
        self.de.population * (1 + self.de.generations)
    }

    /// What of the budget is kept for refining the best models on the closed loop: a fifth, or what the first generation leaves;
    /// nothing if no objective is made from trials.
    pub fn refining_evaluations(&self) -> usize {
        let left = self.evaluations.saturating_sub(self.least_evaluations());
        if self.objectives.need_trials() { left.min(self.evaluations / 5) } else { 0 }
    }

    /// What of the budget the search has.
    pub fn searching_evaluations(&self) -> usize {
        self.evaluations - self.refining_evaluations()
    }

    /// Evaluations of the first generation.
    pub fn least_evaluations(&self) -> usize {
        self.population * self.evaluations_each()
    }

    pub(super) fn differential_evolution(&self) -> Result<de::Settings, SettingsError> {
        let DeSettings { population, weight, crossover, generations } = self.de;
        de::Settings::new(population, weight, crossover, generations).map_err(|error| SettingsError(error.to_string()))
    }

    pub(crate) fn check(&self) -> Result<(), SettingsError> {
        self.differential_evolution()?;
        let least = self.least_evaluations();
        let faults = [
            (self.population < 2, format!("population = {}: at least 2 are needed", self.population)),
            (
                self.evaluations < least,
                format!("evaluations = {}: the first generation alone takes {least}", self.evaluations),
            ),
            (
                self.evaluations > MOST_EVALUATIONS,
                format!("evaluations = {}: at most {MOST_EVALUATIONS} are possible", self.evaluations),
            ),
            (
                !(1..=MOST_REALITIES).contains(&self.realities),
                format!("realities = {}: 1 to {MOST_REALITIES} are possible", self.realities),
            ),
            (!(0.0..=1.0).contains(&self.crossover), format!("crossover = {} is no probability", self.crossover)),
            (!(0.0..=1.0).contains(&self.mutation), format!("mutation = {} is no probability", self.mutation)),
            (
                self.depth.0 < 1 || self.depth.0 > self.depth.1 || self.depth.1 > 4,
                format!("depth = {:?}: 1 ≤ least ≤ greatest ≤ 4 is needed", self.depth),
            ),
        ];
        match faults.into_iter().find(|(faulty, _)| *faulty) {
            Some((_, fault)) => Err(SettingsError(fault)),
            None => Ok(()),
        }
    }
}
