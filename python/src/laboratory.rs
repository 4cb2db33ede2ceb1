//! The conditions that robots work under.

use crate::errors::{failed, refused};
use firmware_sim::lab::{self, Laboratory};
use firmware_sim::scenario::Scenario;
use host_evolver::files;
use pyo3::prelude::*;

/// The laboratory of this name or in this file, with some of its values replaced (`radio.loss=0.3`).
pub fn found(name_or_path: &str, set: &[String]) -> PyResult<Laboratory> {
    let laboratory = lab::find(name_or_path);
    let changed = set.iter().try_fold(laboratory.map_err(|error| failed(&error))?, |laboratory, assignment| {
        lab::set(laboratory, assignment)
    });
    changed.map_err(|error| failed(&error))
}

/// Refuses settings that would have no effect in this world, because it says itself what swarm it is meant for.
pub fn check_settings(world: &Scenario, set: &[String]) -> PyResult<()> {
    match world.settled(set) {
        Some(setting) => Err(refused(format!(
            "set {setting}: {} says in [swarm] itself what swarm it is meant for; leave this out, or change [swarm] there",
            world.name()
        ))),
        None => Ok(()),
    }
}

/// A laboratory with every value, as JSON.
#[pyfunction]
pub fn laboratory_json(lab: &str, set: Vec<String>) -> PyResult<String> {
    Ok(files::json(&found(lab, &set)?))
}
