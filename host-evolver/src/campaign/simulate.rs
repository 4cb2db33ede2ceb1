//! `[simulate]`: in what laboratory the knee of each run is simulated, and how often.

use crate::model::deploy::DEFAULT_SCALE;
use crate::simulation::{DEFAULT_SPEED, check_length, usual_config};
use firmware_sim::config::SwarmConfig;
use firmware_sim::lab::{self, Laboratory};
use firmware_sim::scenario::Scenario;
use firmware_sim::swarm;
use grn_core::scalar::NumberType;
use grn_input::{InputError, Range};
use serde::Deserialize;
use std::path::Path;

/// Realities of one knee; the same as of `grn simulate`.
const REALITIES: Range<i64> = Range::new(1, 10_000, "(a whole one)");
const SEED: Range<i64> = Range::new(0, i64::MAX, "(a whole one)");
/// A laboratory's name has none of these.
const OF_PATHS: [char; 3] = ['.', '/', '\\'];

/// What is simulated of each run.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulate {
    /// The nominal laboratory.
    pub lab: Laboratory,
    /// How many realities around it, numbers 1, 2, …: the same ones for every knee, so that knees can be compared.
    pub realities: u64,
    /// What realities and everything random in them are drawn from.
    pub seed: u64,
    /// World metres per scenario metre.
    pub scale: f32,
    /// Speed of the target with the longest path, metres per second in the world.
    pub speed_m_per_s: f64,
    /// What robots compute in.
    pub number: NumberType,
}

impl Default for Simulate {
    /// Twenty realities of the ideal laboratory.
    fn default() -> Self {
        Simulate {
            lab: Laboratory::default(),
            realities: 20,
            seed: 1,
            scale: DEFAULT_SCALE,
            speed_m_per_s: DEFAULT_SPEED,
            number: NumberType::F32,
        }
    }
}

impl Simulate {
    /// The experiment with a knee.
    pub fn config(&self) -> SwarmConfig {
        let usual = usual_config(self.scale, self.lab.clone());
        SwarmConfig { seed: self.seed, target_speed_m_per_s: self.speed_m_per_s, ..usual }
    }

    /// What the simulations of a knee are worth, in evaluations of f2: they take about as long.
    pub fn worth(&self) -> u64 {
        const OF_REALITY: u64 = 500;
        self.realities * OF_REALITY
    }

    /// Whether a swarm can be set up and a run ends in each of these worlds.
    ///
    /// # Errors
    /// What is wrong, with the world's name.
    pub fn check<'s>(&self, scenarios: impl Iterator<Item = &'s Scenario>) -> Result<(), InputError> {
        for scenario in scenarios {
            let config = scenario.configured(self.config());
            swarm::check(scenario, &config).and_then(|()| check_length(scenario, &config)).map_err(|error| {
                let expected = format!("{} (in the scenario {})", error.expected(), scenario.name());
                let key = match error.key() {
                    "scale" => "simulate.scale".to_owned(),
                    "target_speed_m_per_s" => "simulate.speed_m_per_s".to_owned(),
                    other => format!("simulate.lab: {other}"),
                };
                InputError::new(key, error.value(), expected)
            })?;
        }
        Ok(())
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SimulateTable {
    lab: Option<String>,
    #[serde(default)]
    set: Vec<String>,
    realities: Option<i64>,
    seed: Option<i64>,
    scale: Option<f64>,
    speed_m_per_s: Option<f64>,
    number: Option<String>,
}

impl SimulateTable {
    /// Refuses values that would have no effect in one of these worlds, because it says itself what swarm it is meant for.
    pub(super) fn check_set<'s>(&self, mut worlds: impl Iterator<Item = &'s Scenario>) -> Result<(), InputError> {
        worlds.try_for_each(|world| match world.settled(&self.set) {
            Some(setting) => {
                let expected =
                    format!("{} says in [swarm] itself what swarm it is meant for; leave this out", world.name());
                Err(InputError::new("simulate.set", format!("{setting:?}"), expected))
            }
            None => Ok(()),
        })
    }

    /// What it says; a laboratory's file is relative to `folder`. Scale and speed are checked with the worlds.
    pub(super) fn checked(self, folder: &Path) -> Result<Simulate, InputError> {
        let usual = Simulate::default();
        let SimulateTable { lab, set, realities, seed, scale, speed_m_per_s, number } = self;
        let mut found = match &lab {
            None => usual.lab,
            Some(name) if name.contains(OF_PATHS) => lab::find(&folder.join(name).display().to_string())?,
            Some(name) => {
                let unknown =
                    |error: InputError| InputError::new("simulate.lab", format!("{name:?}"), error.expected());
                lab::find(name).map_err(unknown)?
            }
        };
        for (place, assignment) in set.iter().enumerate() {
            found = lab::set(found, assignment).map_err(|error| {
                InputError::new(format!("simulate.set[{place}]"), format!("{assignment:?}"), error.to_string())
            })?;
        }
        let realities = realities.map(|count| REALITIES.check("simulate.realities", count)).transpose()?;
        let seed = seed.map(|seed| SEED.check("simulate.seed", seed)).transpose()?;
        let number = number.map(|name| {
            name.parse().map_err(|error: <NumberType as std::str::FromStr>::Err| {
                InputError::new("simulate.number", format!("{name:?}"), error.to_string())
            })
        });
        Ok(Simulate {
            lab: found,
            realities: realities.map_or(usual.realities, |count| count as u64),
            seed: seed.map_or(usual.seed, |seed| seed as u64),
            scale: scale.map_or(usual.scale, |scale| scale as f32),
            speed_m_per_s: speed_m_per_s.unwrap_or(usual.speed_m_per_s),
            number: number.transpose()?.unwrap_or(usual.number),
        })
    }
}
