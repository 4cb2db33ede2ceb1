//! Campaigns: scenarios x methods x seeds, and models tried in other worlds, with statistics.
//!
//! Every run and every world of trials is a unit of its own that is in the campaign's folder whole or not at all. So a
//! campaign can be stopped anywhere, resumed, split over machines and merged, and its tables come out the same: they are
//! made from the files of the units alone.

mod figures;
mod method;
mod plan;
mod tables;
mod trial;
mod unit;
mod vary;

pub use method::{Method, Outcome};
pub use plan::{Plan, PlannedMethod, PlannedModel, PlannedScenario, PlannedTransfer};
pub use tables::{Comparison, Measure, RunRow, Summary, Tables, TransferRow};
pub use trial::Trial;
pub use unit::Unit;

use crate::evaluation::World;
use crate::files::{self, FileError};
use rayon::prelude::*;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use trial::Group;

/// One part of a campaign of which there are several: number 2 of 3 does runs 2, 5, 8, ….
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
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Some runs are missing: of other shards, or it was stopped.
    Runs {
        /// Runs that are in the folder.
        done: usize,
        /// Runs of the plan.
        of: usize,
    },
    /// All runs are there, trials are missing: it was stopped.
    Trials,
    /// All units are there, and the tables are written.
    Done,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Stage::Runs { done, of } => write!(f, "{done} of {of} runs are there"),
            Stage::Trials => write!(f, "all runs are there, some trials are not"),
            Stage::Done => write!(f, "everything is there"),
        }
    }
}

/// Hears of units that are done: how many evaluations of f2 each was worth.
pub type Heard<'a> = &'a (dyn Fn(u64) + Sync);

/// A plan and the folder where its units are collected.
pub struct Campaign {
    plan: Plan,
    folder: PathBuf,
    worlds: Vec<OnceLock<World>>,
}

impl Campaign {
    /// A campaign in a folder, which may hold some of its units already.
    pub fn new(plan: Plan, folder: &Path) -> Campaign {
        let worlds = plan.scenarios.iter().map(|_| OnceLock::new()).collect();
        Campaign { plan, folder: folder.to_owned(), worlds }
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
        runs as u64 + trials + models * self.plan.scenarios.len() as u64
    }

    /// Takes over the units of another folder that are missing here. Returns how many runs.
    ///
    /// # Errors
    /// A run there that was made from something else, or a file that cannot be copied.
    pub fn merge(&self, other: &Path) -> Result<usize, FileError> {
        let mut taken = 0;
        for unit in Unit::all(&self.plan) {
            if unit.is_done(&self.plan, other)? && !unit.is_done(&self.plan, &self.folder)? {
                let from = other.join(unit.folder(&self.plan));
                files::write_folder(&self.folder.join(unit.folder(&self.plan)), |to| files::copy_files(&from, to))?;
                taken += 1;
            }
        }
        Ok(taken)
    }

    /// Does what is missing on the current thread pool: the runs of `shard`, then, if all runs are there, trials and
    /// tables. Once `stop` is set it ends soon, and units under way are dropped.
    ///
    /// # Errors
    /// A unit that was made from something else, or a file that cannot be read or written.
    pub fn run(&self, shard: Shard, stop: &AtomicBool, heard: Heard<'_>) -> Result<Stage, FileError> {
        let units = Unit::all(&self.plan);
        let mine = units.iter().enumerate().filter(|&(place, _)| shard.holds(place)).map(|(_, &unit)| unit);
        // Long runs first, so that no thread is left alone with one at the end.
        let mut mine: Vec<Unit> = mine.collect();
        mine.sort_by_key(|unit| std::cmp::Reverse(self.plan.scenarios[unit.scenario].evaluations));
        mine.into_par_iter().with_max_len(1).try_for_each(|unit| self.run_unit(unit, stop, heard))?;
        let mut done = 0;
        for unit in &units {
            done += usize::from(unit.is_done(&self.plan, &self.folder)?);
        }
        if done < units.len() {
            return Ok(Stage::Runs { done, of: units.len() });
        }
        let groups = Group::all(&self.plan, &self.folder)?;
        let places = groups.iter().flat_map(|group| (0..group.worlds()).map(move |world| (group, world)));
        let places: Vec<_> = places.collect();
        let trials: Vec<Option<Vec<Trial>>> = places
            .par_iter()
            .with_max_len(1)
            .map(|(group, world)| {
                let trials = group.trials(*world, &self.folder, stop)?;
                heard(trials.as_ref().map_or(0, |trials| trials.len() as u64));
                Ok(trials)
            })
            .collect::<Result<_, FileError>>()?;
        let Some(trials) = trials.into_iter().collect::<Option<Vec<_>>>() else { return Ok(Stage::Trials) };
        let named = places.iter().zip(trials).map(|((group, world), trials)| (group.name, *world, trials));
        let tables = Tables::of(&self.plan, &self.folder, named.collect())?;
        tables.write(&self.folder)?;
        figures::write(&self.plan, &tables, &self.folder)?;
        files::remove_unfinished(&self.folder)?;
        Ok(Stage::Done)
    }

    fn run_unit(&self, unit: Unit, stop: &AtomicBool, heard: Heard<'_>) -> Result<(), FileError> {
        if !unit.is_done(&self.plan, &self.folder)? {
            if stop.load(Ordering::Relaxed) {
                return Ok(());
            }
            let world = self.worlds[unit.scenario]
                .get_or_init(|| World::new(self.plan.scenarios[unit.scenario].scenario.clone()));
            if !unit.run(&self.plan, &self.folder, world, stop)? {
                return Ok(());
            }
        }
        heard(self.plan.scenarios[unit.scenario].evaluations as u64);
        Ok(())
    }

    /// The tables of a campaign that is done, read back from its folder.
    ///
    /// # Errors
    /// A missing or damaged file.
    pub fn tables(folder: &Path) -> Result<Tables, FileError> {
        Tables::read(folder)
    }
}
