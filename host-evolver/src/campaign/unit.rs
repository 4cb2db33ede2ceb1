//! One run of one method in one scenario with one seed: the unit of work, whole in its folder or not there.

use super::method::{Method, Outcome};
use super::plan::{Plan, slug};
use crate::evaluation::World;
use crate::evolve::{FrontMember, Milestone, deployed};
use crate::files::{self, FileError};
use crate::model::deploy::{self, DEFAULT_SCALE};
use crate::results;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

const MANIFEST: &str = "manifest.json";

/// What decides a run; equal manifests give equal results.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Manifest {
    grn: String,
    scenario: String,
    scenario_sha256: String,
    evaluations: usize,
    method: Method,
    seed: u64,
}

/// A run by its places in the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unit {
    /// Place of the scenario.
    pub scenario: usize,
    /// Place of the method.
    pub method: usize,
    /// Seed.
    pub seed: u64,
}

impl Unit {
    /// All runs of a plan.
    pub fn all(plan: &Plan) -> Vec<Unit> {
        let pairs = (0..plan.scenarios.len())
            .flat_map(|scenario| (0..plan.methods.len()).map(move |method| (scenario, method)));
        pairs.flat_map(|(scenario, method)| (1..=plan.seeds).map(move |seed| Unit { scenario, method, seed })).collect()
    }

    /// Its folder within the campaign's.
    pub fn folder(self, plan: &Plan) -> PathBuf {
        let scenario = slug(plan.scenarios[self.scenario].scenario.name());
        let method = slug(&plan.methods[self.method].name);
        Path::new("runs").join(scenario).join(method).join(format!("{:03}", self.seed))
    }

    fn manifest(self, plan: &Plan) -> Manifest {
        let planned = &plan.scenarios[self.scenario];
        Manifest {
            grn: env!("CARGO_PKG_VERSION").into(),
            scenario: planned.scenario.name().into(),
            scenario_sha256: files::sha256(planned.scenario.to_toml()),
            evaluations: planned.evaluations,
            method: plan.methods[self.method].method.clone(),
            seed: self.seed,
        }
    }

    /// Whether the run is in a campaign's folder.
    ///
    /// # Errors
    /// A run with this name that was made from something else.
    pub fn is_done(self, plan: &Plan, campaign: &Path) -> Result<bool, FileError> {
        let path = campaign.join(self.folder(plan)).join(MANIFEST);
        if !path.exists() {
            return Ok(false);
        }
        match files::difference(&self.manifest(plan), &files::read_json(&path)?) {
            None => Ok(true),
            Some(difference) => {
                let way_out = "choose another folder with --out, or delete this run";
                Err(FileError::new(path, format!("not the same run: {difference}; {way_out}")))
            }
        }
    }

    /// Runs it and puts its folder in place. Returns whether it was done, and not stopped.
    ///
    /// # Errors
    /// What the operating system says.
    pub fn run(self, plan: &Plan, campaign: &Path, world: &World, stop: &AtomicBool) -> Result<bool, FileError> {
        let planned = &plan.scenarios[self.scenario];
        let method = &plan.methods[self.method].method;
        let Some(outcome) = method.run(world, planned.evaluations, self.seed, stop) else { return Ok(false) };
        let place = campaign.join(self.folder(plan));
        files::write_folder(&place, |folder| self.write(plan, folder, &outcome))?;
        Ok(true)
    }

    fn write(self, plan: &Plan, folder: &Path, outcome: &Outcome) -> Result<(), FileError> {
        let morphogen = plan.scenarios[self.scenario].scenario.morphogen();
        let mut blobs = Vec::new();
        for (place, member) in outcome.front.iter().enumerate() {
            let blob = deploy::blob(member.network.clone(), &morphogen, DEFAULT_SCALE);
            let name = format!("{place:02}-{}-nodes.grn", member.nodes);
            if place == deployed(&outcome.front) {
                files::write_blob(&folder.join("knee.grn"), &blob)?;
            }
            files::write_blob(&folder.join(&name), &blob)?;
            blobs.push(name);
        }
        results::write_front(folder, &plan.methods[self.method].method.objectives(), &outcome.front, &blobs)?;
        results::write_history(folder, &outcome.history)?;
        files::write(&folder.join(MANIFEST), files::json(&self.manifest(plan)))
    }

    /// The front of a run that is done.
    ///
    /// # Errors
    /// A damaged file.
    pub fn front(self, plan: &Plan, campaign: &Path) -> Result<Vec<FrontMember>, FileError> {
        results::read_front(&campaign.join(self.folder(plan)))
    }

    /// The history of a run that is done.
    ///
    /// # Errors
    /// A damaged file.
    pub fn history(self, plan: &Plan, campaign: &Path) -> Result<Vec<Milestone>, FileError> {
        results::read_history(&campaign.join(self.folder(plan)))
    }
}
