//! `grn scatter`.

use super::{Answer, Failure, output};
use crate::files;
use firmware_sim::scenario::{RandomObstacles, Scenario};
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Arguments {
    /// The world whose walls are replaced.
    scenario: PathBuf,
    /// Seed of the obstacles.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Share of the region that obstacles cover, at most 0.5.
    #[arg(long, default_value_t = 0.05)]
    density: f64,
    /// Least and greatest radius, metres.
    #[arg(long, num_args = 2, value_names = ["LEAST", "GREATEST"], default_values_t = [0.3, 0.9])]
    radius: Vec<f64>,
    /// Kept free on both sides of every target's path, metres.
    #[arg(long, default_value_t = 1.45)]
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
    let world = scenario.with_random_obstacles(&RandomObstacles { seed, density, radius, clearance })?;
    match &arguments.out {
        Some(path) => files::write(path, world.to_toml())?,
        None => {
            output::product(world.to_toml().trim_end())?;
        }
    }
    Ok(Answer::Yes)
}
