//! Models in worlds that they were not evolved for.

use super::job::{Job, Product};
use super::part::{self, Part};
use super::plan::{Place, Plan, PlannedModel, PlannedScenario, PlannedTransfer, slug};
use super::unit::Unit;
use crate::files::{self, FileError, read_blob};
use firmware_sim::scenario::Scenario;
use grn_core::blob::Blob;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A model that is tried, and where it comes from.
struct Candidate {
    scenario: String,
    method: String,
    seed: u64,
    blob: Blob,
    /// The same as bytes.
    bytes: Vec<u8>,
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
struct Group<'p> {
    name: &'p str,
    worlds: Vec<(Place, &'p Scenario)>,
    candidates: Vec<Candidate>,
}

/// All groups of a plan: each scenario, and each transfer with the knees of its runs; given models in every one. The knees of a
/// scenario with several worlds are tried in each of them as well: what they are worth on average is known, but not where they fail.
fn groups<'p>(plan: &'p Plan, campaign: &Path) -> Result<Vec<Group<'p>>, FileError> {
    let candidates = |is_tried: &dyn Fn(&str) -> bool| -> Result<Vec<Candidate>, FileError> {
        let mut candidates = given(plan)?;
        for unit in Unit::all(plan) {
            let from = &plan.scenarios[unit.scenario].name;
            if is_tried(from) {
                let path = campaign.join(unit.folder(plan)).join("knee.grn");
                let method = plan.methods[unit.method].name.clone();
                candidates.push(Candidate::new(from.clone(), method, unit.seed, read_blob(&path)?, &path)?);
            }
        }
        Ok(candidates)
    };
    let scenario = |(place, planned): (usize, &'p PlannedScenario)| -> Result<Group<'p>, FileError> {
        let worlds = &planned.worlds;
        let candidates = candidates(&|from| worlds.len() > 1 && from == planned.name)?;
        let worlds = worlds.iter().enumerate().map(|(number, world)| (Place::Scenario(place, number), world));
        Ok(Group { name: &planned.name, worlds: worlds.collect(), candidates })
    };
    let transfer = |(place, transfer): (usize, &'p PlannedTransfer)| -> Result<Group<'p>, FileError> {
        let candidates = candidates(&|from| transfer.from.iter().any(|name| name == from))?;
        let worlds = transfer.worlds.iter().enumerate();
        let worlds = worlds.map(|(number, world)| (Place::Transfer(place, number), world)).collect();
        Ok(Group { name: &transfer.name, worlds, candidates })
    };
    let scenarios = plan.scenarios.iter().enumerate().map(scenario);
    scenarios.chain(plan.transfers.iter().enumerate().map(transfer)).collect()
}

fn given(plan: &Plan) -> Result<Vec<Candidate>, FileError> {
    let candidate = |model: &PlannedModel| {
        Candidate::new(String::new(), model.name.clone(), 0, model.blob.clone(), Path::new(&model.name))
    };
    plan.models.iter().map(candidate).collect()
}

impl Candidate {
    fn new(scenario: String, method: String, seed: u64, blob: Blob, path: &Path) -> Result<Candidate, FileError> {
        let bytes = files::blob_bytes(&blob).map_err(|error| FileError::new(path, error))?;
        Ok(Candidate { scenario, method, seed, blob, bytes })
    }
}

/// The trials of a world: one line for each model that is tried there.
pub struct Trials<'p> {
    /// The group's name in the tables.
    pub name: &'p str,
    /// The number of the world in the group.
    number: usize,
    place: Place,
    world: &'p Scenario,
    candidates: Arc<Vec<Candidate>>,
}

impl<'p> Trials<'p> {
    /// The world's name.
    pub fn world_name(&self) -> &'p str {
        self.world.name()
    }

    /// Those of all worlds of a plan in which any model is tried.
    ///
    /// # Errors
    /// A damaged run.
    pub fn all(plan: &'p Plan, campaign: &Path) -> Result<Vec<Trials<'p>>, FileError> {
        let of_group = |Group { name, worlds, candidates }: Group<'p>| {
            let candidates = Arc::new(candidates);
            let worlds = worlds.into_iter().enumerate().filter(|_| !candidates.is_empty());
            let of_world =
                |(number, (place, world))| Trials { name, number, place, world, candidates: candidates.clone() };
            worlds.map(of_world).collect::<Vec<_>>()
        };
        Ok(groups(plan, campaign)?.into_iter().flat_map(of_group).collect())
    }
}

impl Part for Trials<'_> {
    type Record = Trial;
    const FOLDER: &'static str = "trials";

    fn path(&self) -> PathBuf {
        Path::new(Self::FOLDER).join(slug(self.name)).join(part::name(self.number as u64, &self.origin()))
    }

    fn origin(&self) -> String {
        let mut text = self.world.to_toml();
        for Candidate { scenario, method, seed, blob, .. } in &*self.candidates {
            text += &format!("{scenario}\n{method}\n{seed}\n{:?}\n", blob.network);
        }
        text
    }

    fn worth(&self) -> u64 {
        self.candidates.len() as u64
    }

    fn job(&self) -> Job {
        Job::Trials {
            world: self.place,
            models: self.candidates.iter().map(|candidate| candidate.bytes.clone()).collect(),
        }
    }

    fn csv(&self, product: Product) -> Option<Vec<u8>> {
        let Product::Trials(evaluations) = product else { return None };
        let line = |(candidate, (f2, violation)): (&Candidate, (f64, f64))| {
            let Candidate { scenario, method, seed, .. } = candidate;
            [scenario.clone(), method.clone(), seed.to_string(), f2.to_string(), violation.to_string()]
        };
        let lines = self.candidates.iter().zip(evaluations).map(line);
        Some(files::csv(["scenario", "method", "seed", "f2", "violation"], lines))
    }
}
