//! What a run of the search is for.

use crate::evaluation::{Evaluator, World, constraints::clearance_for};
use crate::evolve::settings::Settings;
use firmware_sim::config::SwarmConfig;
use firmware_sim::scenario::Scenario;
use std::fmt;

/// Worlds that a model is to be good in, and the swarm that is to work there with it.
#[derive(Clone, Debug)]
pub struct Task {
    worlds: Vec<World>,
    swarm: SwarmConfig,
}

/// Worlds that no model can be evolved for together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TaskError {
    /// None was given.
    NoWorld,
    /// A blob has one morphogen field and one ring, and these two worlds differ in them: their places.
    DifferentMorphogens(usize, usize),
}

impl fmt::Display for TaskError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TaskError::NoWorld => f.write_str("no world: at least one is needed"),
            TaskError::DifferentMorphogens(first, other) => write!(
                f,
                "worlds {} and {} have different [morphogen] tables, and a blob holds one: make them equal, or evolve for each by \
                 itself",
                first + 1,
                other + 1
            ),
        }
    }
}

impl std::error::Error for TaskError {}

impl Task {
    /// Models for these worlds, tried on this swarm.
    ///
    /// # Errors
    /// [`TaskError`].
    pub fn new(scenarios: Vec<Scenario>, swarm: SwarmConfig) -> Result<Self, TaskError> {
        let morphogen = scenarios.first().ok_or(TaskError::NoWorld)?.morphogen();
        match scenarios.iter().position(|scenario| scenario.morphogen() != morphogen) {
            Some(other) => Err(TaskError::DifferentMorphogens(0, other)),
            None => Ok(Task { worlds: scenarios.into_iter().map(World::new).collect(), swarm }),
        }
    }

    /// Models for one world, tried on this swarm.
    pub fn in_one(scenario: Scenario, swarm: SwarmConfig) -> Self {
        Task { worlds: vec![World::new(scenario)], swarm }
    }

    /// The worlds, at least one.
    pub fn worlds(&self) -> &[World] {
        &self.worlds
    }

    /// The scenarios of the worlds.
    pub fn scenarios(&self) -> impl ExactSizeIterator<Item = &Scenario> {
        self.worlds.iter().map(World::scenario)
    }

    /// The swarm and its nominal laboratory.
    pub fn swarm(&self) -> &SwarmConfig {
        &self.swarm
    }

    /// World metres per scenario metre of the blobs.
    pub fn scale(&self) -> f32 {
        self.swarm.scale as f32
    }

    /// An evaluator under the constraints of these settings.
    pub(super) fn evaluator(&self, settings: &Settings) -> Evaluator<'_> {
        let clearance = settings.clearance.unwrap_or_else(|| clearance_for(self.scale()));
        Evaluator::among(&self.worlds, settings.constraints.with_clearance(clearance))
    }
}
