//! `grn scatter`.

use super::options::{self, within};
use super::{Answer, Failure, output};
use crate::files;
use firmware_sim::scenario::{InputError, RandomObstacles, Scenario, random};
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Arguments {
    /// The world whose walls are replaced.
    scenario: PathBuf,
    /// Seed of the obstacles.
    #[arg(long, default_value_t = 1, value_parser = options::seed, allow_hyphen_values = true)]
    seed: u64,
    /// Share of the region that obstacles cover, at most 0.5.
    #[arg(long, default_value_t = 0.05, value_parser = |text: &str| within(text, &random::DENSITY), allow_hyphen_values = true)]
    density: f64,
    /// Least and greatest radius, metres.
    #[arg(long, num_args = 2, value_names = ["LEAST", "GREATEST"], default_values_t = [0.3, 0.9], value_parser = |text: &str| within(text, &random::RADIUS), allow_hyphen_values = true)]
    radius: Vec<f64>,
    /// Kept free on both sides of every target's path, metres.
    #[arg(long, default_value_t = 1.45, value_parser = |text: &str| within(text, &random::CLEARANCE), allow_hyphen_values = true)]
    clearance: f64,
    /// The file to write [default: standard output].
    #[arg(long, value_name = "FILE.toml")]
    out: Option<PathBuf>,
}

pub fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let scenario = Scenario::load(&arguments.scenario)?;
    if let Some(out) = &arguments.out {
        files::probe(out)?;
    }
    let radius = [arguments.radius[0], arguments.radius[1]];
    let Arguments { seed, density, clearance, .. } = *arguments;
    let obstacles = RandomObstacles { seed, density, radius, clearance };
    let world = scenario.with_random_obstacles(&obstacles).map_err(|error| {
        // Its keys are those of the options.
        let option = format!("--{}", error.key().split('[').next().unwrap_or_default());
        InputError::new(option, error.value(), error.expected()).in_file(&arguments.scenario)
    })?;
    match &arguments.out {
        Some(path) => files::write(path, world.to_toml())?,
        None => {
            output::product(world.to_toml().trim_end())?;
        }
    }
    Ok(Answer::Yes)
}
