//! One run of one method in one scenario with one seed: the unit of work, whole in its folder or not there.

use super::method::Method;
use super::plan::{Plan, slug, text_of};
use crate::evolve::{FrontMember, Milestone};
use crate::files::{self, Contents, FileError, Ledger};
use crate::results;
use firmware_sim::config::SwarmConfig;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

const MANIFEST: &str = "manifest.json";

/// What decides a run; equal manifests give equal results.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Manifest {
    grn: String,
    scenario: String,
    /// Of the canonical texts of its worlds, one after the other.
    scenario_sha256: String,
    /// Names of the training worlds, if they are several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    worlds: Option<Vec<String>>,
    evaluations: usize,
    method: Method,
    seed: u64,
    /// The swarm that models are tried on, if they are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    swarm: Option<SwarmConfig>,
    /// The run's files with the SHA-256 of each.
    files: Ledger,
}

/// What there is of a run in a folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Found {
    /// All of it, as it was written.
    Whole,
    /// Something of it, but not all, or not as it was written: where, and what is wrong.
    Damaged(String),
    /// Nothing.
    Nothing,
}

/// A run by its places in the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
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
        let units = |(scenario, method): (usize, usize)| {
            let seeds = plan.methods[method].method.runs(plan.seeds);
            (1..=seeds).map(move |seed| Unit { scenario, method, seed })
        };
        pairs.flat_map(units).collect()
    }

    /// What it spends of its budget: evaluations of f2.
    pub fn evaluations(self, plan: &Plan) -> usize {
        plan.methods[self.method].method.spends(plan.scenarios[self.scenario].evaluations)
    }

    /// Its folder within the campaign's.
    pub fn folder(self, plan: &Plan) -> PathBuf {
        let scenario = slug(&plan.scenarios[self.scenario].name);
        let method = slug(&plan.methods[self.method].name);
        Path::new("runs").join(scenario).join(method).join(format!("{:03}", self.seed))
    }

    fn manifest(self, plan: &Plan) -> Manifest {
        let planned = &plan.scenarios[self.scenario];
        let (worlds, several) = (&planned.worlds, planned.worlds.len() > 1);
        let method = plan.methods[self.method].method.clone();
        Manifest {
            grn: files::VERSION.into(),
            scenario: planned.name.clone(),
            scenario_sha256: files::sha256(text_of(worlds)),
            worlds: several.then(|| worlds.iter().map(|world| world.name().into()).collect()),
            evaluations: planned.evaluations,
            swarm: method.objectives().need_trials().then(|| plan.swarm()),
            method,
            seed: self.seed,
            files: Ledger::default(),
        }
    }

    /// What there is of the run in a campaign's folder.
    ///
    /// # Errors
    /// A run with this name that was made from something else, or by another version.
    pub fn find(self, plan: &Plan, campaign: &Path) -> Result<Found, FileError> {
        let folder = campaign.join(self.folder(plan));
        if !folder.exists() {
            return Ok(Found::Nothing);
        }
        let path = folder.join(MANIFEST);
        let damaged = |fault: &dyn fmt::Display| Ok(Found::Damaged(fault.to_string()));
        if !path.exists() {
            return damaged(&format_args!("{}: not whole, {MANIFEST} is missing", folder.display()));
        }
        // A manifest that cannot be read says nothing of what the run was made from.
        let found: Manifest = match files::check_version(&path).and_then(|()| files::read_json(&path)) {
            Ok(found) => found,
            Err(error) if error.is_damage() => return damaged(&error),
            Err(error) => return Err(error),
        };
        let ours = Manifest { files: found.files.clone(), ..self.manifest(plan) };
        if let Some(difference) = files::difference(&ours, &found) {
            let way_out = "choose another folder with --out, or delete this run";
            return Err(FileError::new(path, format!("not the same run: {difference}; {way_out}")));
        }
        match found.files.first_damaged(&folder) {
            Some(name) => damaged(&format_args!("{}: missing or changed", folder.join(name).display())),
            None if results::ALWAYS.iter().any(|needed| !found.files.names().any(|name| name == *needed)) => {
                damaged(&format_args!("{}: does not tell of all files", path.display()))
            }
            None => Ok(Found::Whole),
        }
    }

    /// Takes the run over from another campaign's folder where it is whole.
    ///
    /// # Errors
    /// What the operating system says.
    pub fn copy(self, plan: &Plan, from: &Path, to: &Path) -> Result<(), FileError> {
        let source = from.join(self.folder(plan));
        let manifest: Manifest = files::read_json(&source.join(MANIFEST))?;
        let mut contents = Contents::new();
        for name in manifest.files.names() {
            let path = source.join(name);
            let content = std::fs::read(&path).map_err(|error| FileError::from_system(path, "read", error))?;
            contents.insert(name.to_owned(), content);
        }
        self.put(plan, to, contents)
    }

    /// Puts the files of a run in place in a campaign's folder, where nothing is or a damaged run. The manifest comes last.
    ///
    /// # Errors
    /// What the operating system says.
    pub fn put(self, plan: &Plan, campaign: &Path, contents: Contents) -> Result<(), FileError> {
        let place = &campaign.join(self.folder(plan));
        let manifest = Manifest { files: Ledger::of(&contents), ..self.manifest(plan) };
        if place.exists() {
            clear(place)?;
        }
        let mut files: Vec<_> = contents.into_iter().collect();
        files.push((MANIFEST.into(), files::json(&manifest).into_bytes()));
        if !place.exists() {
            return files::write_folder(place, |folder| {
                files.iter().try_for_each(|(name, content)| files::write(&folder.join(name), content))
            });
        }
        files.iter().try_for_each(|(name, content)| files::write(&place.join(name), content))
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

/// Deletes what is left of a damaged run, manifest first, and the folder if nothing else is in it. What no run writes stays.
fn clear(place: &Path) -> Result<(), FileError> {
    let is_model = |name: &str| {
        let parts = name.strip_suffix("-nodes.grn").and_then(|name| name.split_once('-'));
        parts.is_some_and(|(place, nodes)| place.parse::<u32>().is_ok() && nodes.parse::<u32>().is_ok())
    };
    let names = files::entries(place)?.into_iter().map(|(name, _)| name);
    let ours = names.filter(|name| is_model(name) || results::ALWAYS.contains(&name.as_str()));
    for name in std::iter::once(MANIFEST.to_owned()).chain(ours) {
        match std::fs::remove_file(place.join(&name)) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                return Err(FileError::from_system(place.join(name), "replaced", error));
            }
            _ => {}
        }
    }
    // Fails where something else lies in it, and that is meant.
    let _ = std::fs::remove_dir(place);
    Ok(())
}
