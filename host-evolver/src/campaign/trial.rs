//! Models in worlds that they were not evolved for.

use super::part;
use super::plan::{Plan, slug};
use super::unit::Unit;
use crate::evaluation::{Evaluation, Evaluator, Model, World};
use crate::files::{self, FileError, read_blob};
use firmware_sim::scenario::Scenario;
use grn_core::network::Network;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

pub const FOLDER: &str = "trials";

/// A model that is tried, and where it comes from.
pub struct Candidate {
    scenario: String,
    method: String,
    seed: u64,
    network: Network<f32>,
}

/// What became of one model in one world: a line of a trial's file.
#[derive(Clone, Debug, Deserialize)]
pub struct Trial {
    /// The scenario it was evolved for; empty for a given model.
    pub scenario: String,
    /// The method that found it, or the given model's name.
    pub method: String,
    /// The run's seed; 0 for a given model.
    pub seed: u64,
    /// f2 in this world.
    pub f2: f64,
    /// Constraint violation; 0 if every target is enclosed at every snapshot with room to the obstacles.
    pub violation: f64,
}

/// A group of worlds and the models tried in them.
pub struct Group<'p> {
    /// Its name in the tables.
    pub name: &'p str,
    worlds: Vec<&'p Scenario>,
    candidates: Vec<Candidate>,
}

impl<'p> Group<'p> {
    /// All groups of a plan: each transfer with the knees of its runs, and each scenario; given models in every one.
    ///
    /// # Errors
    /// A damaged run.
    pub fn all(plan: &'p Plan, campaign: &Path) -> Result<Vec<Group<'p>>, FileError> {
        let scenario = |planned: &'p super::plan::PlannedScenario| -> Result<Group<'p>, FileError> {
            let worlds = vec![&planned.scenario];
            Ok(Group { name: planned.scenario.name(), worlds, candidates: given(plan) })
        };
        let transfer = |transfer: &'p super::plan::PlannedTransfer| -> Result<Group<'p>, FileError> {
            let mut candidates = given(plan);
            for unit in Unit::all(plan) {
                let from = plan.scenarios[unit.scenario].scenario.name();
                if transfer.from.iter().any(|name| name == from) {
                    candidates.push(Candidate {
                        scenario: from.to_owned(),
                        method: plan.methods[unit.method].name.clone(),
                        seed: unit.seed,
                        network: read_blob(&campaign.join(unit.folder(plan)).join("knee.grn"))?.network,
                    });
                }
            }
            Ok(Group { name: &transfer.name, worlds: transfer.worlds.iter().collect(), candidates })
        };
        plan.scenarios.iter().map(scenario).chain(plan.transfers.iter().map(transfer)).collect()
    }

    /// How many worlds it has.
    pub fn worlds(&self) -> usize {
        if self.candidates.is_empty() { 0 } else { self.worlds.len() }
    }

    /// The trials of one world: read if they were made before and the file is whole, else made; `notice` hears of damage.
    /// `None` if stopped.
    ///
    /// # Errors
    /// A file that cannot be read or written.
    pub fn trials(
        &self,
        world: usize,
        campaign: &Path,
        stop: &AtomicBool,
        notice: &dyn Fn(&str),
    ) -> Result<Option<Vec<Trial>>, FileError> {
        let path = campaign.join(self.path(world));
        part::read_or_make(&path, &self.origin(world), notice, || {
            let lines = self.made(world, stop);
            Ok(lines.map(|lines| files::csv(["scenario", "method", "seed", "f2", "violation"], lines)))
        })
    }

    fn made(&self, world: usize, stop: &AtomicBool) -> Option<Vec<[String; 5]>> {
        let world = World::new(self.worlds[world].clone());
        let mut evaluator = Evaluator::new(&world);
        let mut line = |candidate: &Candidate| {
            if stop.load(Ordering::Relaxed) {
                return None;
            }
            let model = Model::new(&candidate.network, world.scenario().morphogen().level).ok();
            let Evaluation { f2, violation } = model.map_or(Evaluation::NO_PATTERN, |model| evaluator.evaluate(&model));
            let Candidate { scenario, method, seed, .. } = candidate;
            Some([scenario.clone(), method.clone(), seed.to_string(), f2.to_string(), violation.to_string()])
        };
        self.candidates.iter().map(&mut line).collect()
    }

    /// What the trials of a world are made from.
    fn origin(&self, world: usize) -> String {
        let mut text = self.worlds[world].to_toml();
        for Candidate { scenario, method, seed, network } in &self.candidates {
            text += &format!("{scenario}\n{method}\n{seed}\n{network:?}\n");
        }
        text
    }

    /// The file of a world's trials.
    pub fn path(&self, world: usize) -> PathBuf {
        Path::new(FOLDER).join(slug(self.name)).join(part::name(world as u64, &self.origin(world)))
    }
}

fn given(plan: &Plan) -> Vec<Candidate> {
    let candidate = |model: &super::plan::PlannedModel| Candidate {
        scenario: String::new(),
        method: model.name.clone(),
        seed: 0,
        network: model.network.clone(),
    };
    plan.models.iter().map(candidate).collect()
}
