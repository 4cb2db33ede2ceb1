//! Surveys: what models are worth in many missions, each in many realities of its laboratory.
//!
//! How a survey goes:
//!
//! 1. [`Survey::new`] loads every mission once and finds out whether its swarm can be set up for every model.
//! 2. A trial is one model in one mission, in all its realities; [`Row`] is what came out. Trials and their realities run on several threads,
//!    and a row depends on its trial alone.
//! 3. Rows that are there already, of the same trial, are taken over: its key tells.
//! 4. [`Group`] counts in how many missions of a class, or of a third of the difficulties, a model caged the targets.

mod conditions;
mod group;
mod row;

pub use conditions::{Conditions, Contender, Controller};
pub use group::{Group, Tally, groups};
pub use row::{Row, Third, thirds};

use crate::missions::MissionRow;
use crate::realities;
use crate::simulation::{SimulationError, check_length, check_model};
use firmware_sim::scenario::{Course, InputError, Scenario};
use firmware_sim::swarm::{self, arrival_tick};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};

/// Models to be tried in missions.
pub struct Survey {
    folder: PathBuf,
    missions: Vec<MissionRow>,
    thirds: Vec<Third>,
    contenders: Vec<Contender>,
    conditions: Conditions,
    /// Of every mission and model, missions first.
    keys: Vec<String>,
}

/// Why there is no survey, or no trial.
#[derive(Debug)]
pub enum SurveyError {
    /// A mission's file.
    World(InputError),
    /// A mission in which a swarm cannot be set up.
    Swarm(PathBuf, InputError),
    /// A model that cannot drive robots.
    Model(String, SimulationError),
}

impl fmt::Display for SurveyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SurveyError::World(error) => error.fmt(f),
            SurveyError::Swarm(path, error) => write!(f, "{}: {error}", path.display()),
            SurveyError::Model(name, error) => write!(f, "{name}: {error}"),
        }
    }
}

impl std::error::Error for SurveyError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            SurveyError::World(error) | SurveyError::Swarm(_, error) => Some(error),
            SurveyError::Model(_, error) => Some(error),
        }
    }
}

/// What a survey tells while it runs.
pub struct Listener<'a> {
    /// A simulation has come to its end.
    pub simulated: &'a (dyn Fn() + Sync),
    /// So many rows, of the trials that are done, in their order. It may keep them.
    pub rows: &'a (dyn Fn(&[Option<Row>]) + Sync),
}

impl Survey {
    /// Loads and checks everything: `missions` are the lines of the table in `folder`.
    ///
    /// # Errors
    /// [`SurveyError`] of the first mission or model that is at fault.
    pub fn new(
        folder: &Path,
        missions: Vec<MissionRow>,
        contenders: Vec<Contender>,
        conditions: Conditions,
    ) -> Result<Survey, SurveyError> {
        let of_mission = |mission: &MissionRow| {
            let path = folder.join(&mission.file);
            let scenario = Scenario::load(&path).map_err(SurveyError::World)?;
            let text = scenario.to_toml();
            contenders
                .iter()
                .map(|contender| {
                    let config = scenario.configured(conditions.config(contender.scale()));
                    let fits = swarm::check(&scenario, &config).and_then(|()| check_length(&scenario, &config));
                    fits.map_err(|error| SurveyError::Swarm(path.clone(), error))?;
                    let failed = |error| SurveyError::Model(contender.name.clone(), error);
                    let blob = contender.in_mission(mission, &scenario).map_err(failed)?;
                    check_model(&blob, &scenario, conditions.number).map_err(failed)?;
                    Ok(conditions.key(&text, &blob, &config))
                })
                .collect::<Result<Vec<String>, SurveyError>>()
        };
        let keys: Vec<Result<Vec<String>, SurveyError>> = missions.par_iter().map(of_mission).collect();
        let keys = keys.into_iter().collect::<Result<Vec<_>, _>>()?.concat();
        let thirds = thirds(&missions);
        Ok(Survey { folder: folder.to_owned(), missions, thirds, contenders, conditions, keys })
    }

    /// How many trials there are.
    pub fn trials(&self) -> usize {
        self.keys.len()
    }

    /// The missions, with the third of the difficulties that each is in.
    pub fn missions(&self) -> impl Iterator<Item = (&MissionRow, Third)> {
        self.missions.iter().zip(self.thirds.iter().copied())
    }

    /// How trials are simulated.
    pub fn conditions(&self) -> &Conditions {
        &self.conditions
    }

    /// The models.
    pub fn contenders(&self) -> &[Contender] {
        &self.contenders
    }

    /// Puts rows that are there already in their places: those of trials of this survey; the others come back.
    pub fn known(&self, rows: Vec<Row>) -> (Vec<Option<Row>>, Vec<Row>) {
        let mut places: BTreeMap<(&str, &str), usize> = BTreeMap::new();
        for (place, key) in self.keys.iter().enumerate() {
            places.insert((&self.mission(place).file, key), place);
        }
        let mut known = vec![None; self.trials()];
        let mut others = Vec::new();
        for row in rows {
            match places.get(&(row.mission.as_str(), row.key.as_str())) {
                Some(&place) if self.contender(place).name == row.model => {
                    // Where a mission ranks depends on the others.
                    let third = self.thirds[place / self.contenders.len()];
                    known[place] = Some(Row { third, ..row });
                }
                _ => others.push(row),
            }
        }
        (known, others)
    }

    /// Tries what is not known, on the threads of the pool that this is called in. The rows come back in the order of missions, then
    /// models; those of trials that were not done are missing if `stop` was set.
    ///
    /// # Errors
    /// [`SurveyError::Model`], of the first trial that fails.
    pub fn run(
        &self,
        known: Vec<Option<Row>>,
        stop: &AtomicBool,
        listener: &Listener<'_>,
    ) -> Result<Vec<Option<Row>>, SurveyError> {
        let missing: Vec<usize> = (0..self.trials()).filter(|&place| known[place].is_none()).collect();
        let rows = Mutex::new(known);
        let one = |place: usize| {
            // To set a trial up takes time, too, and there may be thousands of them.
            if stop.load(Relaxed) {
                return Ok(());
            }
            let Some(row) = self.trial(place, stop, listener.simulated)? else { return Ok(()) };
            let mut rows = rows.lock().unwrap_or_else(PoisonError::into_inner);
            rows[place] = Some(row);
            (listener.rows)(&rows);
            Ok(())
        };
        missing.into_par_iter().with_max_len(1).map(one).collect::<Vec<_>>().into_iter().collect::<Result<(), _>>()?;
        Ok(rows.into_inner().unwrap_or_else(PoisonError::into_inner))
    }

    fn mission(&self, place: usize) -> &MissionRow {
        &self.missions[place / self.contenders.len()]
    }

    fn contender(&self, place: usize) -> &Contender {
        &self.contenders[place % self.contenders.len()]
    }

    fn trial(&self, place: usize, stop: &AtomicBool, done: &(dyn Fn() + Sync)) -> Result<Option<Row>, SurveyError> {
        let (mission, contender) = (self.mission(place), self.contender(place));
        // Loaded anew, so that the memory that is needed does not grow with the number of missions.
        let scenario = Scenario::load(self.folder.join(&mission.file)).map_err(SurveyError::World)?;
        let failed = |error| SurveyError::Model(format!("{} in {}", contender.name, mission.file), error);
        let blob = contender.in_mission(mission, &scenario).map_err(failed)?;
        let config = scenario.configured(self.conditions.config(blob.scale));
        let numbers = 1..=self.conditions.realities;
        let tried = realities::try_all(&blob, &scenario, &config, self.conditions.number, numbers, stop, done);
        let Some(came_out) = tried.map_err(failed)? else { return Ok(None) };
        let course = Course::of(&scenario.scaled(config.scale), &config);
        let ticks = arrival_tick(&course) * config.lab.robots.count as u64 * self.conditions.realities;
        let third = self.thirds[place / self.contenders.len()];
        Ok(Some(Row::of(mission, third, &contender.name, &came_out, ticks, &self.keys[place])))
    }
}
