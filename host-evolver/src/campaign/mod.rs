//! Campaigns: scenarios x methods x seeds, models tried in other worlds, and knees in simulated laboratories, with statistics.
//!
//! Every run, every world of trials and the simulations of every knee are a unit of its own that is in the campaign's folder
//! whole or not at all. So a campaign can be stopped anywhere, resumed, split over machines and merged, and its tables come out
//! the same: they are made from the files of the units alone.

mod figures;
mod manifest;
mod method;
mod part;
mod plan;
mod plan_file;
mod rows;
mod simulate;
mod simulated;
mod tables;
mod trial;
mod unit;
mod vary;

pub use method::{Method, Outcome};
pub use plan::{Plan, PlannedMethod, PlannedModel, PlannedScenario, PlannedTransfer};
pub use rows::{Comparison, Measure, RunRow, SimulationRow, SimulationSummary, Summary, TransferRow};
pub use simulate::Simulate;
pub use tables::Tables;
pub use trial::Trial;
pub use unit::{Found, Unit};

use crate::evolve::Task;
use crate::files::{self, FileError, FolderLock};
use crate::realities::Reality;
use manifest::{BELOW, Manifest};
use plan::slug;
use rayon::prelude::*;
use simulated::Knee;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use trial::Group;

/// One of several parts of a campaign, for several machines: part 2 of 3 does runs 2, 5, 8, ….
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: usize,
    of: usize,
}

impl Shard {
    /// The whole campaign.
    pub const WHOLE: Shard = Shard { number: 1, of: 1 };

    fn holds(self, place: usize) -> bool {
        place % self.of == self.number - 1
    }
}

impl FromStr for Shard {
    type Err = String;
    fn from_str(text: &str) -> Result<Shard, String> {
        let parts = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        match parts {
            Some((number, of)) if (1..=of).contains(&number) => Ok(Shard { number, of }),
            _ => Err(format!("{text:?} is no part of a campaign; write 2/3 for the second of three")),
        }
    }
}

/// How far a campaign has come.
#[derive(Clone, Debug, PartialEq)]
pub enum Stage {
    /// Some runs are missing: of other shards, or it was stopped.
    Runs {
        /// Runs that are in the folder.
        done: usize,
        /// Runs of the plan.
        of: usize,
    },
    /// All runs are there, trials or simulations are missing: it was stopped.
    Trials,
    /// All units are there, and the tables are written.
    Done(Box<Tables>),
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Stage::Runs { done, of } => write!(f, "{done} of {of} runs are there"),
            Stage::Trials => write!(f, "all runs are there, some trials or simulations are not"),
            Stage::Done(_) => write!(f, "everything is there"),
        }
    }
}

/// Hears how a campaign goes.
pub trait Listener: Sync {
    /// A unit was there already; it is worth this many evaluations of f2.
    fn found(&self, evaluations: u64);
    /// A unit is done; it cost this many evaluations of f2.
    fn done(&self, evaluations: u64);
    /// Something that the user should know.
    fn notice(&self, text: &str);
}

/// A plan and the folder where its units are collected.
pub struct Campaign {
    plan: Plan,
    lock: FolderLock,
    manifest: Manifest,
    tasks: Vec<OnceLock<Task>>,
}

impl Campaign {
    /// A campaign in a folder, which may hold some of its units already; `command` is told to others who want the folder.
    ///
    /// # Errors
    /// A folder that somebody else writes, that cannot be written, or that holds other things or a campaign with more seeds.
    pub fn begin(plan: Plan, folder: &Path, command: &str) -> Result<Campaign, FileError> {
        let lock = FolderLock::take(folder, command)?;
        let manifest = Manifest::begin(&plan, folder)?;
        files::remove_unfinished(&lock, &BELOW)?;
        files::probe_folder(&lock, &paths(&plan))?;
        let tasks = plan.scenarios.iter().map(|_| OnceLock::new()).collect();
        Ok(Campaign { plan, lock, manifest, tasks })
    }

    fn folder(&self) -> &Path {
        self.lock.folder()
    }

    /// The plan.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Evaluations of f2 that all runs and trials are worth, for a progress bar.
    pub fn work(&self) -> u64 {
        let runs: usize =
            Unit::all(&self.plan).into_iter().map(|unit| self.plan.scenarios[unit.scenario].evaluations).sum();
        let knees = |from: &[String]| from.len() as u64 * self.plan.methods.len() as u64 * self.plan.seeds;
        let models = self.plan.models.len() as u64;
        let trials: u64 = self.plan.transfers.iter().map(|t| t.worlds.len() as u64 * (models + knees(&t.from))).sum();
        let knees = Unit::all(&self.plan).len() as u64;
        let simulations = self.plan.simulate.as_ref().map_or(0, |simulate| knees * worth(simulate));
        runs as u64 + trials + models * self.plan.scenarios.len() as u64 + simulations
    }

    /// Whether runs of another folder can be taken over into `folder`: before it is made, and before others are copied.
    ///
    /// # Errors
    /// No campaign's folder, the campaign's own, one that somebody writes, or a run there that was made from something else.
    pub fn check_merge(plan: &Plan, folder: &Path, other: &Path) -> Result<(), FileError> {
        let refused = |fault: &str| Err(FileError::new(other, format!("{fault}; name another with --merge")));
        if !other.is_dir() {
            return refused("there is no such folder");
        }
        if other.canonicalize().ok() == folder.canonicalize().ok() {
            return refused("is the campaign's own folder");
        }
        if !other.join("runs").is_dir() {
            return refused("no campaign is in this folder");
        }
        FolderLock::check_free(other)?;
        Unit::all(plan).into_iter().try_for_each(|unit| unit.find(plan, other).map(drop))
    }

    /// Takes over the units of another folder that are missing here, after [`check_merge`](Self::check_merge). Returns how
    /// many runs.
    ///
    /// # Errors
    /// A folder that somebody writes, a run there that was made from something else, or a file that cannot be copied.
    pub fn merge(&self, other: &Path, listener: &dyn Listener) -> Result<usize, FileError> {
        FolderLock::check_free(other)?;
        let mut taken = 0;
        for unit in Unit::all(&self.plan) {
            match unit.find(&self.plan, other)? {
                Found::Whole if unit.find(&self.plan, self.folder())? != Found::Whole => {
                    unit.copy(&self.plan, other, self.folder())?;
                    taken += 1;
                }
                Found::Damaged(why) => listener.notice(&format!("{why}: not taken over")),
                _ => {}
            }
        }
        Ok(taken)
    }

    /// Does what is missing on the current thread pool: the runs of `shard`, then, if all runs are there, trials and
    /// tables. Once `stop` is set it ends soon, and units under way are dropped.
    ///
    /// # Errors
    /// A unit that was made from something else, or a file that cannot be read or written.
    pub fn run(&self, shard: Shard, stop: &AtomicBool, listener: &dyn Listener) -> Result<Stage, FileError> {
        let units = Unit::all(&self.plan);
        for name in self.runs_of_others()? {
            listener.notice(&format!("{name}: of another state of the campaign: kept, and in no table"));
        }
        // What is refused is refused before the first run.
        let found: Vec<Found> =
            units.iter().map(|unit| unit.find(&self.plan, self.folder())).collect::<Result<_, _>>()?;
        let mut mine: Vec<(Unit, Found)> = Vec::new();
        for (place, (&unit, found)) in units.iter().zip(&found).enumerate() {
            if shard.holds(place) {
                mine.push((unit, found.clone()));
            }
        }
        // Long runs first, so that no thread is left alone with one at the end.
        mine.sort_by_key(|(unit, _)| std::cmp::Reverse(self.plan.scenarios[unit.scenario].evaluations));
        let done: Vec<bool> = mine
            .into_par_iter()
            .with_max_len(1)
            .map(|(unit, found)| self.run_unit(unit, &found, stop, listener))
            .collect::<Result<_, _>>()?;
        let of_others =
            found.iter().enumerate().filter(|&(place, found)| !shard.holds(place) && *found == Found::Whole);
        let done = done.into_iter().filter(|&done| done).count() + of_others.count();
        if done < units.len() {
            return Ok(Stage::Runs { done, of: units.len() });
        }
        let Some(trials) = self.trials(stop, listener)? else { return Ok(Stage::Trials) };
        let Some(simulations) = self.simulations(stop, listener)? else { return Ok(Stage::Trials) };
        let named = trials.iter().map(|(group, world, trials)| (group.as_str(), *world, trials.clone()));
        let tables = Tables::of(&self.plan, self.folder(), named.collect(), &simulations)?;
        let mut contents = figures::draw(&self.plan, &tables, self.folder(), &|text| listener.notice(text))?;
        contents.extend(tables.contents());
        self.manifest.publish(self.folder(), &contents)?;
        Ok(Stage::Done(Box::new(tables)))
    }

    /// Folders of runs of scenarios and methods that the campaign has no longer. They took long, so they are kept.
    fn runs_of_others(&self) -> Result<Vec<String>, FileError> {
        let runs = self.folder().join("runs");
        if !runs.exists() {
            return Ok(Vec::new());
        }
        let ours: Vec<PathBuf> = Unit::all(&self.plan).iter().map(|unit| unit.folder(&self.plan)).collect();
        let mut others = Vec::new();
        for (scenario, entry) in files::entries(&runs)? {
            let methods = if entry.path().is_dir() { files::entries(&entry.path())? } else { Vec::new() };
            for (method, _) in methods {
                let folder = Path::new("runs").join(&scenario).join(method);
                if !ours.iter().any(|ours| ours.starts_with(&folder)) {
                    others.push(self.folder().join(folder).display().to_string());
                }
            }
        }
        Ok(others)
    }

    /// The trials by group and world; `None` if stopped.
    fn trials(&self, stop: &AtomicBool, listener: &dyn Listener) -> Result<Option<Vec<Tried>>, FileError> {
        let groups = Group::all(&self.plan, self.folder())?;
        let places = groups.iter().flat_map(|group| (0..group.worlds()).map(move |world| (group, world)));
        let places: Vec<_> = places.collect();
        let trials: Vec<Option<Tried>> = places
            .par_iter()
            .with_max_len(1)
            .map(|(group, world)| {
                let trials = group.trials(*world, self.folder(), stop, &|text| listener.notice(text))?;
                listener.done(trials.as_ref().map_or(0, |trials| trials.len() as u64));
                Ok(trials.map(|trials| (group.name.to_owned(), *world, trials)))
            })
            .collect::<Result<_, FileError>>()?;
        let trials: Option<Vec<Tried>> = trials.into_iter().collect();
        if trials.is_some() {
            let wanted = places.iter().map(|(group, world)| group.path(*world)).collect();
            part::remove_others(self.folder(), Path::new(trial::FOLDER), &wanted)?;
        }
        Ok(trials)
    }

    /// The realities of every run's knee, none if they are not to be simulated; `None` if stopped.
    fn simulations(&self, stop: &AtomicBool, listener: &dyn Listener) -> Result<Option<Vec<Simulated>>, FileError> {
        let knees = Knee::all(&self.plan, self.folder())?;
        let simulated: Vec<Option<Simulated>> = knees
            .par_iter()
            .with_max_len(1)
            .map(|knee| {
                let realities = knee.realities(self.folder(), stop, &|text| listener.notice(text))?;
                listener.done(self.plan.simulate.as_ref().map_or(0, worth));
                Ok(realities.map(|realities| (knee.unit, realities)))
            })
            .collect::<Result<_, FileError>>()?;
        let simulated: Option<Vec<Simulated>> = simulated.into_iter().collect();
        if simulated.is_some() {
            let wanted = knees.iter().map(Knee::path).collect();
            part::remove_others(self.folder(), Path::new(simulated::FOLDER), &wanted)?;
        }
        Ok(simulated)
    }

    /// Returns whether the run is there, and not stopped.
    fn run_unit(
        &self,
        unit: Unit,
        found: &Found,
        stop: &AtomicBool,
        listener: &dyn Listener,
    ) -> Result<bool, FileError> {
        let worth = self.plan.scenarios[unit.scenario].evaluations as u64;
        if *found == Found::Whole {
            listener.found(worth);
        } else {
            if stop.load(Ordering::Relaxed) {
                return Ok(false);
            }
            if let Found::Damaged(why) = found {
                listener.notice(&format!("{why}: this run is done again"));
            }
            let task = self.tasks[unit.scenario].get_or_init(|| self.plan.task(unit.scenario));
            if !unit.run(&self.plan, self.folder(), task, stop)? {
                return Ok(false);
            }
            listener.done(worth);
        }
        Ok(true)
    }

    /// The tables of a campaign that is done, read back from its folder.
    ///
    /// # Errors
    /// A campaign that is not finished, or a file that is missing or changed.
    pub fn tables(folder: &Path) -> Result<Tables, FileError> {
        Manifest::check_finished(folder)?;
        Tables::read(folder)
    }
}

/// A run and the realities of its knee.
type Simulated = (Unit, Vec<Reality>);

/// What the simulations of a knee are worth, in evaluations of f2: they take about as long.
fn worth(simulate: &Simulate) -> u64 {
    const OF_REALITY: u64 = 500;
    simulate.realities * OF_REALITY
}

/// A group, the number of a world in it, and the trials made there.
type Tried = (String, usize, Vec<Trial>);

/// A path of each folder that a campaign fills.
fn paths(plan: &Plan) -> Vec<PathBuf> {
    let units = Unit::all(plan).into_iter().filter(|unit| unit.seed == plan.seeds);
    let runs = units.map(|unit| unit.folder(plan).join("00-31-nodes.grn"));
    let names = plan.transfers.iter().map(|planned| planned.name.as_str());
    let names = names.chain(plan.scenarios.iter().map(|planned| planned.scenario.name()));
    let trials = names.map(|name| Path::new("trials").join(slug(name)).join("000-0123456789ab.csv"));
    let units = Unit::all(plan).into_iter().filter(|unit| plan.simulate.is_some() && unit.seed == plan.seeds);
    let simulations = units.map(|unit| {
        let folder = Path::new(simulated::FOLDER).join(slug(plan.scenarios[unit.scenario].scenario.name()));
        folder.join(slug(&plan.methods[unit.method].name)).join("000-0123456789ab.csv")
    });
    runs.chain(trials).chain(simulations).collect()
}
