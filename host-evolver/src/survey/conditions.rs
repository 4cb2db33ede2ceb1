//! What is tried, and how.

use crate::baselines::circle_blob;
use crate::files::{VERSION, blob_bytes, sha256};
use crate::missions::MissionRow;
use crate::model::deploy::DEFAULT_SCALE;
use crate::simulation::{SimulationError, usual_config};
use firmware_sim::config::SwarmConfig;
use firmware_sim::lab::Laboratory;
use firmware_sim::scenario::Scenario;
use grn_core::blob::Blob;
use grn_core::scalar::NumberType;

/// How many hexadecimal digits of a hash make a key: two trials of a million have the same one with a probability of 1 in 10^8.
const DIGITS: usize = 16;

/// A model and what it is called.
pub struct Contender {
    /// What tables call it.
    pub name: String,
    /// What robots run.
    pub controller: Controller,
}

/// What robots run.
pub enum Controller {
    /// The same blob in every mission.
    Blob(Box<Blob>),
    /// In each mission its best circle, at this scale.
    BestCircle(f32),
}

impl Contender {
    /// A blob.
    pub fn blob(name: String, blob: Blob) -> Contender {
        Contender { name, controller: Controller::Blob(Box::new(blob)) }
    }

    /// The best circle of each mission, at this scale or the usual one.
    pub fn best_circle(scale: Option<f32>) -> Contender {
        Contender { name: "circle".into(), controller: Controller::BestCircle(scale.unwrap_or(DEFAULT_SCALE)) }
    }

    /// World metres per scenario metre.
    pub fn scale(&self) -> f32 {
        match &self.controller {
            Controller::Blob(blob) => blob.scale,
            Controller::BestCircle(scale) => *scale,
        }
    }

    /// What it runs in a mission.
    ///
    /// # Errors
    /// As of [`circle_blob`].
    pub fn in_mission(&self, mission: &MissionRow, scenario: &Scenario) -> Result<Blob, SimulationError> {
        match &self.controller {
            Controller::Blob(blob) => Ok((**blob).clone()),
            Controller::BestCircle(scale) => circle_blob(mission.circle_radius_m, &scenario.morphogen(), *scale),
        }
    }
}

/// How every trial is simulated.
pub struct Conditions {
    /// The laboratory; what missions say of their swarm goes before it.
    pub lab: Laboratory,
    /// How many realities of it, 1 or more.
    pub realities: u64,
    /// Seed of all of them.
    pub seed: u64,
    /// Speed of the fastest target, metres per second in the world.
    pub speed_m_per_s: f64,
    /// What robots compute in.
    pub number: NumberType,
}

impl Conditions {
    /// The run of a blob of this scale, before a mission says which swarm it is for.
    pub fn config(&self, scale: f32) -> SwarmConfig {
        let usual = usual_config(scale, self.lab.clone());
        SwarmConfig { seed: self.seed, target_speed_m_per_s: self.speed_m_per_s, ..usual }
    }

    /// What distinguishes a trial from all that may come out otherwise.
    pub(super) fn key(&self, world: &str, blob: &Blob, config: &SwarmConfig) -> String {
        let blob = blob_bytes(blob).unwrap_or_default();
        let told = serde_json::json!([VERSION, world, blob, config, self.realities, self.number]);
        sha256(told.to_string())[..DIGITS].to_owned()
    }
}
