//! The state of a search in a file, which opens only if it is what was saved, of the same run.
//!
//! Only states after whole generations are saved. The last generation of a budget may be cut short; it is done again on
//! resuming, so that a run with a larger budget goes on exactly as if it had had that from the start.

use crate::evolve::{Individual, Settings, State};
use crate::files::{self, FileError};
use grn_core::network::THETA_RANGE;
use serde::{Deserialize, Serialize};
use std::path::Path;

const WAY_OUT: &str =
    "bring it back from a copy, delete it to begin the search anew, or choose another folder with --out";

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Checkpoint {
    /// SHA-256 of the run's identity and of the state.
    sha256: String,
    state: State,
}

fn digest(identity: &str, state: &State) -> String {
    files::sha256(format!("{}\n{}", files::sha256(identity), files::json(state)))
}

/// Whether no generation of it was cut short by the budget.
pub(super) fn is_whole(state: &State, settings: &Settings) -> bool {
    let each = settings.population.saturating_mul(settings.evaluations_each());
    (state.generation as usize).checked_mul(each) == Some(state.evaluations)
}

pub(super) fn save(path: &Path, identity: &str, state: &State) -> Result<(), FileError> {
    let checkpoint = Checkpoint { sha256: digest(identity, state), state: state.clone() };
    files::write(path, files::json(&checkpoint))
}

/// The saved state.
///
/// # Errors
/// A file that is not what was saved, of another run, or beyond the budget.
pub(super) fn load(path: &Path, identity: &str, settings: &Settings) -> Result<State, FileError> {
    let refused = |fault: &str| FileError::new(path, format!("{fault}; {WAY_OUT}"));
    let bytes = std::fs::read(path).map_err(|error| FileError::from_system(path, "read", error))?;
    let damaged = |error| refused(&format!("damaged: {error}"));
    let Checkpoint { sha256, state } = serde_json::from_slice(&bytes).map_err(damaged)?;
    check(&state, settings).map_err(|fault| refused(&format!("damaged: {fault}")))?;
    if sha256 != digest(identity, &state) {
        return Err(refused("damaged, or of another run: its SHA-256 is not that of its content in this run"));
    }
    Ok(state)
}

/// Refuses what no search with these settings can have come to.
fn check(state: &State, settings: &Settings) -> Result<(), String> {
    let State { generation, evaluations, population, history } = state;
    if *evaluations > settings.evaluations {
        return Err(format!("evaluations = {evaluations} is beyond the budget of {}", settings.evaluations));
    }
    if !is_whole(state, settings) {
        return Err(format!("evaluations = {evaluations} are not {generation} whole generations"));
    }
    if population.is_empty() || population.len() > settings.population {
        return Err(format!("{} individuals in a population of {}", population.len(), settings.population));
    }
    if history.len() != *generation as usize || history.last().map(|last| last.evaluations) != Some(*evaluations) {
        return Err(format!("its history does not end at generation {generation}"));
    }
    population.iter().try_for_each(|individual| check_individual(individual, settings))
}

fn check_individual(individual: &Individual, settings: &Settings) -> Result<(), String> {
    let count = settings.objectives.names().count();
    let Individual { tree, objectives, f2, violation, trials } = individual;
    let (low, high) = (f64::from(THETA_RANGE.0), f64::from(THETA_RANGE.1));
    let theta = tree.thetas().into_iter().find(|theta| !(low..=high).contains(theta));
    match theta {
        Some(theta) => Err(format!("theta = {theta} is not in [{low}, {high}]")),
        None if !(0.0..=2.0).contains(f2) => Err(format!("f2 = {f2} is not in [0, 2]")),
        None if objectives.len() != count || !objectives.iter().all(|value| value.is_finite()) => {
            Err(format!("objectives = {objectives:?} are not {count} finite numbers"))
        }
        None if trials.len() > settings.realities || !trials.iter().all(|cost| cost.is_finite() && *cost >= 0.0) => {
            Err(format!("trials = {trials:?} are not at most {} finite costs", settings.realities))
        }
        None if violation.is_nan() || *violation < 0.0 => Err(format!("violation = {violation} is negative")),
        None => Ok(()),
    }
}
