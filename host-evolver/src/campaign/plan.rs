//! What a campaign is made of: scenarios, methods, models and transfers, and how many seeds.

use super::method::Method;
use super::simulate::Simulate;
use crate::evolve::Task;
use firmware_sim::scenario::Scenario;
use grn_core::network::Network;
use grn_input::file_name;

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
    /// What runs in the scenario at this place are for; swarms are tried under the conditions in which knees are simulated.
    pub fn task(&self, scenario: usize) -> Task {
        let swarm = self.simulate.clone().unwrap_or_default().config();
        Task::in_one(self.scenarios[scenario].scenario.clone(), swarm)
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
    /// Its network.
    pub network: Network<f32>,
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
