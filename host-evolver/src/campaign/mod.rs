//! Campaigns: scenarios x methods x seeds, models tried in other worlds, and knees in simulated laboratories, with statistics.
//!
//! Every run, every world of trials and the simulations of every knee are a unit of its own that is in the campaign's folder
//! whole or not at all. So a campaign can be stopped anywhere, resumed, split over machines and merged, and its tables come out
//! the same: they are made from the files of the units alone.

mod figures;
mod job;
mod listener;
mod manifest;
mod method;
mod part;
mod plan;
mod plan_file;
mod plan_worlds;
mod rows;
mod simulate;
mod simulated;
mod tables;
mod tables_of_worlds;
mod team;
mod trial;
mod unit;
mod vary;

pub use job::{Job, Maker, Product, Refusal};
pub use listener::Listener;
pub use method::{Method, Outcome};
pub use plan::{Place, Plan, PlannedMethod, PlannedModel, PlannedScenario, PlannedTransfer};
pub use rows::{Comparison, Measure, RunRow, SimulationRow, SimulationSummary, Summary, TransferRow};
pub use simulate::Simulate;
pub use tables::Tables;
pub use team::{Team, follow};
pub use trial::Trial;
pub use unit::{Found, Unit};

use crate::files::{self, FileError, FolderLock};
use manifest::{BELOW, Manifest};
use part::Part;
use plan::slug;
use simulated::Knee;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use team::{Batch, Site};
use trial::Trials;

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

/// A plan and the folder where its units are collected.
pub struct Campaign {
    plan: Plan,
    lock: FolderLock,
    manifest: Manifest,
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
        Ok(Campaign { plan, lock, manifest })
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
        let runs: usize = Unit::all(&self.plan).into_iter().map(|unit| unit.evaluations(&self.plan)).sum();
        let simulations = self.plan.simulate.as_ref().map_or(0, |simulate| {
            let knee = |unit: Unit| self.plan.simulated_in(unit.scenario).len() as u64;
            Unit::all(&self.plan).into_iter().map(knee).sum::<u64>() * simulate.worth()
        });
        runs as u64 + self.plan.trials() + simulations
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

    /// Has what is missing made by `team`: the runs of `shard`, then, if all runs are there, trials, simulations and tables. Once
    /// `stop` is set it ends soon, and units under way are dropped.
    ///
    /// # Errors
    /// A unit that was made from something else, or a file that cannot be read or written.
    pub fn run(
        &self,
        shard: Shard,
        team: &mut Team,
        stop: &AtomicBool,
        listener: &dyn Listener,
    ) -> Result<Stage, FileError> {
        let maker = Maker::new(&self.plan);
        let site = Site { folder: self.folder(), maker: &maker, stop, listener };
        for name in self.runs_of_others()? {
            listener.notice(&format!("{name}: of another state of the campaign: kept, and in no table"));
        }
        let of = Unit::all(&self.plan).len();
        let done = self.runs(shard, &site, team)?;
        if done < of {
            return Ok(Stage::Runs { done, of });
        }
        let parts = Trials::all(&self.plan, self.folder())?;
        let Some(trials) = part::complete(&parts, &site, team)? else { return Ok(Stage::Trials) };
        let knees = Knee::all(&self.plan, self.folder())?;
        let Some(realities) = part::complete(&knees, &site, team)? else { return Ok(Stage::Trials) };
        let trials: Vec<_> = parts.iter().map(|part| (part.name, part.world_name())).zip(trials).collect();
        let simulations: Vec<_> = knees.iter().map(|knee| (knee.unit, knee.place)).zip(realities).collect();
        let tables = Tables::of(&self.plan, self.folder(), &trials, &simulations)?;
        let mut contents = figures::draw(&self.plan, &tables, self.folder(), &|text| listener.notice(text))?;
        contents.extend(tables.contents());
        self.manifest.publish(self.folder(), &contents)?;
        Ok(Stage::Done(Box::new(tables)))
    }

    /// Has the missing runs of a shard made. Returns how many runs, of all shards, are there then.
    fn runs(&self, shard: Shard, site: &Site<'_>, team: &mut Team) -> Result<usize, FileError> {
        let units = Unit::all(&self.plan);
        let worth = |unit: Unit| unit.evaluations(&self.plan) as u64;
        // What is refused is refused before the first run.
        let found: Vec<Found> =
            units.iter().map(|unit| unit.find(&self.plan, self.folder())).collect::<Result<_, _>>()?;
        let mut missing: Vec<Unit> = Vec::new();
        for (_, (&unit, found)) in units.iter().zip(&found).enumerate().filter(|&(place, _)| shard.holds(place)) {
            match found {
                Found::Whole => site.listener.found(worth(unit)),
                Found::Damaged(why) => site.listener.notice(&format!("{why}: this run is done again")),
                Found::Nothing => {}
            }
            if *found != Found::Whole {
                missing.push(unit);
            }
        }
        // Long runs first, so that no thread is left alone with one at the end.
        missing.sort_by_key(|&unit| std::cmp::Reverse(worth(unit)));
        let done = AtomicUsize::new(found.iter().filter(|&found| *found == Found::Whole).count());
        let batch = Batch { count: missing.len(), job: &|number| Job::Run(missing[number]) };
        team.make(site, &batch, &|number, product| {
            let unit = missing[number];
            let contents = match product {
                Ok(Product::Run(contents)) => Ok(contents),
                Ok(_) => Err(Refusal::internal("is made by another sort of job")),
                Err(refusal) => Err(refusal),
            };
            let contents = contents.map_err(|refusal| refusal.about(&self.folder().join(unit.folder(&self.plan))))?;
            unit.put(&self.plan, self.folder(), contents)?;
            done.fetch_add(1, Ordering::Relaxed);
            site.listener.done(worth(unit));
            Ok(())
        })?;
        Ok(done.into_inner())
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

    /// The tables of a campaign that is done, read back from its folder.
    ///
    /// # Errors
    /// A campaign that is not finished, or a file that is missing or changed.
    pub fn tables(folder: &Path) -> Result<Tables, FileError> {
        Manifest::check_finished(folder)?;
        Tables::read(folder)
    }
}

/// A path of each folder that a campaign fills.
fn paths(plan: &Plan) -> Vec<PathBuf> {
    let is_last = |unit: &Unit| unit.seed == plan.methods[unit.method].method.runs(plan.seeds);
    let units = Unit::all(plan).into_iter().filter(is_last);
    let runs = units.map(|unit| unit.folder(plan).join("00-31-nodes.grn"));
    let names = plan.transfers.iter().map(|planned| planned.name.as_str());
    let names = names.chain(plan.scenarios.iter().map(|planned| planned.name.as_str()));
    let trials = names.map(|name| Path::new(Trials::FOLDER).join(slug(name)).join("000-0123456789ab.csv"));
    let units = Unit::all(plan).into_iter().filter(|unit| plan.simulate.is_some() && is_last(unit));
    let simulations = units.flat_map(|unit| {
        let folder = move |place| Knee::folder(plan, unit, place).join("000-0123456789ab.csv");
        plan.simulated_in(unit.scenario).into_iter().map(folder)
    });
    runs.chain(trials).chain(simulations).collect()
}
