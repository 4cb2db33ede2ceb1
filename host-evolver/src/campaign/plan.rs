//! What a campaign is made of: scenarios, methods, models and transfers, and how many seeds.

use super::method::Method;
use super::simulate::Simulate;
use crate::evolve::Task;
use crate::files;
use firmware_sim::config::SwarmConfig;
use firmware_sim::lab;
use firmware_sim::scenario::Scenario;
use grn_core::blob::Blob;
use grn_input::file_name;
use serde::{Deserialize, Serialize};
use std::fmt::Write;

/// A checked campaign, its files read.
pub struct Plan {
    /// Name of the campaign.
    pub name: String,
    /// Runs of each method in each scenario; their seeds are 1, 2, ….
    pub seeds: u64,
    /// Worlds to evolve for, variations included.
    pub scenarios: Vec<PlannedScenario>,
    /// What to evolve with.
    pub methods: Vec<PlannedMethod>,
    /// Given models, tried in every scenario and transfer.
    pub models: Vec<PlannedModel>,
    /// Worlds that evolved models are tried in unchanged.
    pub transfers: Vec<PlannedTransfer>,
    /// The laboratory that the knee of each run is simulated in, if it is.
    pub simulate: Option<Simulate>,
}

impl Plan {
    /// The swarm that models are tried on: under the conditions in which knees are simulated.
    pub fn swarm(&self) -> SwarmConfig {
        self.simulate.clone().unwrap_or_default().config()
    }

    /// What runs in the scenario at this place are for.
    pub fn task(&self, scenario: usize) -> Task {
        Task::in_one(self.scenarios[scenario].scenario.clone(), self.swarm())
    }
}

/// A world with its budget.
pub struct PlannedScenario {
    /// The world; its name is the scenario's name in all tables.
    pub scenario: Scenario,
    /// Budget of each run: evaluations of f2.
    pub evaluations: usize,
    /// Whether it is a variation of another.
    pub varied: bool,
}

/// A method under its name in the tables.
pub struct PlannedMethod {
    /// Its name.
    pub name: String,
    /// Whether it is a baseline: all methods that are none are compared with it.
    pub baseline: bool,
    /// What it does.
    pub method: Method,
}

/// A given model.
pub struct PlannedModel {
    /// Its name in the tables.
    pub name: String,
    /// Its blob.
    pub blob: Blob,
}

/// A transfer: worlds that nothing is evolved for.
pub struct PlannedTransfer {
    /// Its name in the tables.
    pub name: String,
    /// Names of the scenarios whose runs are tried.
    pub from: Vec<String>,
    /// The worlds.
    pub worlds: Vec<Scenario>,
    /// Whether it is a variation of another.
    pub varied: bool,
}

/// Where a world stands in a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Place {
    /// That of a scenario.
    Scenario(usize),
    /// One of a transfer's.
    Transfer(usize, usize),
}

impl Plan {
    /// The world at a place of this plan.
    pub fn world(&self, place: Place) -> &Scenario {
        match place {
            Place::Scenario(scenario) => &self.scenarios[scenario].scenario,
            Place::Transfer(transfer, world) => &self.transfers[transfer].worlds[world],
        }
    }

    /// A digest of this program and of everything in the plan that results depend on: processes that have the same make the same.
    pub fn identity(&self) -> String {
        let Plan { name, seeds, scenarios, methods, models, transfers, simulate } = self;
        let mut text = format!("{}\n{name}\n{seeds}\n", files::VERSION);
        // Writing to memory cannot fail.
        for PlannedScenario { scenario, evaluations, varied } in scenarios {
            let _ = writeln!(text, "{} {evaluations} {varied}", scenario.to_toml());
        }
        for PlannedMethod { name, baseline, method } in methods {
            let _ = writeln!(text, "{name} {baseline} {}", files::json(method));
        }
        for PlannedModel { name, blob } in models {
            let _ = writeln!(text, "{name} {blob:?}");
        }
        for PlannedTransfer { name, from, worlds, varied } in transfers {
            let worlds: String = worlds.iter().map(Scenario::to_toml).collect();
            let _ = writeln!(text, "{name} {from:?} {varied} {worlds}");
        }
        if let Some(Simulate { lab, realities, seed, scale, speed_m_per_s, number }) = simulate {
            let _ = writeln!(text, "{realities} {seed} {scale} {speed_m_per_s} {number} {}", lab::write(lab));
        }
        files::sha256(text)
    }
}

/// The folder of something with this name, within a campaign's: small letters and digits, the rest as single dashes, as a
/// safe [`file_name`]. Names that get the same are refused by [`Plan::load`].
pub fn slug(name: &str) -> String {
    let mut slug = String::new();
    for character in name.chars() {
        if character.is_alphanumeric() {
            slug.extend(character.to_lowercase());
        } else if !slug.ends_with('-') && !slug.is_empty() {
            slug.push('-');
        }
    }
    file_name(slug.trim_end_matches('-'))
}
