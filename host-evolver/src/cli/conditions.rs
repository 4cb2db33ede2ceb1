//! The options that choose a laboratory.

use super::Failure;
use firmware_sim::lab::{self, Laboratory};
use firmware_sim::scenario::Scenario;
use grn_input::InputError;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub struct Conditions {
    /// The laboratory: one of those that `grn lab` lists, or a file.
    #[arg(long, value_name = "NAME|FILE", default_value = "ideal")]
    lab: String,
    /// Replace one value of the laboratory, such as radio.loss=0.3; may be given several times.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

impl Conditions {
    /// The laboratory that was asked for.
    pub fn laboratory(&self) -> Result<Laboratory, Failure> {
        set_all(lab::find(&self.lab)?, &self.set)
    }

    /// [`check_world`](Self::check_world) for the worlds in these files.
    pub fn check_files(&self, mut paths: impl Iterator<Item = PathBuf>) -> Result<(), Failure> {
        if self.set.is_empty() {
            return Ok(());
        }
        paths.try_for_each(|path| self.check_world(&path, &Scenario::load(&path)?))
    }

    /// [`check_set`] for the world of this file.
    pub fn check_world(&self, path: &Path, world: &Scenario) -> Result<(), Failure> {
        check_set(&self.set, world, &path.display().to_string())
    }
}

/// Refuses values that would have no effect in this world, because it says itself what swarm it is meant for.
pub fn check_set(set: &[String], world: &Scenario, name: &str) -> Result<(), Failure> {
    match world.settled(set) {
        Some(assignment) => Err(Failure::Input(format!(
            "--set {assignment}: {name} says in [swarm] itself what swarm it is meant for; leave --set out, or change [swarm] there"
        ))),
        None => Ok(()),
    }
}

/// A laboratory with these values replaced.
pub fn set_all(laboratory: Laboratory, assignments: &[String]) -> Result<Laboratory, Failure> {
    let set =
        |laboratory, assignment: &String| lab::set(laboratory, assignment).map_err(|error| in_set(assignment, error));
    assignments.iter().try_fold(laboratory, set)
}

fn in_set(assignment: &str, error: InputError) -> Failure {
    if error.key() == "--set" { error.into() } else { Failure::from(error).about(format_args!("--set {assignment}")) }
}
