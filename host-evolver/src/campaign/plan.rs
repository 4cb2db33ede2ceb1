//! What a campaign is made of: scenarios, methods, models and transfers, and how many seeds.

use super::method::Method;
use super::simulate::Simulate;
use crate::evolve::{Task, TaskError};
use crate::files;
use firmware_sim::config::SwarmConfig;
use firmware_sim::lab;
use firmware_sim::scenario::Scenario;
use grn_core::blob::Blob;
use grn_input::{InputError, file_name};
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
    ///
    /// # Errors
    /// None for a plan that was [loaded](Plan::load).
    pub fn task(&self, scenario: usize) -> Result<Task, TaskError> {
        Task::new(self.scenarios[scenario].worlds.clone(), self.swarm())
    }

    /// The worlds that knees of the scenario at this place are simulated in, if any are: those that it trains for, then those of
    /// transfers from it. Not those with obstacles thrown at random, which are many.
    pub fn simulated_in(&self, scenario: usize) -> Vec<Place> {
        let PlannedScenario { name, worlds, .. } = &self.scenarios[scenario];
        let own = (0..worlds.len()).map(|world| Place::Scenario(scenario, world));
        let transfers = self.transfers.iter().enumerate();
        let transfers = transfers.filter(|(_, transfer)| !transfer.random && transfer.from.contains(name));
        let others = transfers.flat_map(|(transfer, planned)| {
            (0..planned.worlds.len()).map(move |world| Place::Transfer(transfer, world))
        });
        own.chain(others).collect()
    }

    /// Whether a swarm can be set up and a run ends in every world that knees are simulated in, if they are.
    ///
    /// # Errors
    /// What is wrong, with the world's name.
    pub fn check_simulations(&self) -> Result<(), InputError> {
        self.simulate.as_ref().map_or(Ok(()), |simulate| simulate.check(self.worlds_simulated_in()))
    }

    /// The worlds of [`simulated_in`](Self::simulated_in), of all scenarios.
    pub fn worlds_simulated_in(&self) -> impl Iterator<Item = &Scenario> {
        let own = self.scenarios.iter().flat_map(|planned| &planned.worlds);
        let others = self.transfers.iter().filter(|planned| !planned.random).flat_map(|planned| &planned.worlds);
        own.chain(others)
    }

    /// Runs of all methods in one scenario.
    pub fn runs_each(&self) -> u64 {
        self.methods.iter().map(|planned| planned.method.runs(self.seeds)).sum()
    }

    /// How many models are tried in how many worlds, altogether.
    pub fn trials(&self) -> u64 {
        let knees = self.runs_each();
        let models = self.models.len() as u64;
        let own = self.scenarios.iter().map(|planned| {
            let knees = if planned.worlds.len() > 1 { knees } else { 0 };
            planned.worlds.len() as u64 * (models + knees)
        });
        let transfers = self.transfers.iter();
        let others = transfers.map(|t| t.worlds.len() as u64 * (models + t.from.len() as u64 * knees));
        own.chain(others).sum()
    }
}

/// One or several worlds to train for, with the budget.
pub struct PlannedScenario {
    /// Its name in all tables.
    pub name: String,
    /// The training worlds: a model is worth the mean of what it is in each.
    pub worlds: Vec<Scenario>,
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

/// A transfer: test worlds, which no search of it has seen.
pub struct PlannedTransfer {
    /// Its name in the tables.
    pub name: String,
    /// Names of the scenarios whose runs are tried.
    pub from: Vec<String>,
    /// The worlds.
    pub worlds: Vec<Scenario>,
    /// Whether they are one world with obstacles thrown in at random.
    pub random: bool,
    /// Whether it is a variation of another.
    pub varied: bool,
}

/// Where a world stands in a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Place {
    /// One of a scenario's: the place of the scenario, and the world's in it.
    Scenario(usize, usize),
    /// One of a transfer's, likewise.
    Transfer(usize, usize),
}

impl Plan {
    /// The world at a place of this plan.
    pub fn world(&self, place: Place) -> &Scenario {
        match place {
            Place::Scenario(scenario, world) => &self.scenarios[scenario].worlds[world],
            Place::Transfer(transfer, world) => &self.transfers[transfer].worlds[world],
        }
    }

    /// A digest of this program and of everything in the plan that results depend on: processes that have the same make the same.
    pub fn identity(&self) -> String {
        let Plan { name, seeds, scenarios, methods, models, transfers, simulate } = self;
        let mut text = format!("{}\n{name}\n{seeds}\n", files::VERSION);
        // Writing to memory cannot fail.
        for PlannedScenario { name, worlds, evaluations, varied } in scenarios {
            let _ = writeln!(text, "{name} {} {evaluations} {varied}", text_of(worlds));
        }
        for PlannedMethod { name, baseline, method } in methods {
            let _ = writeln!(text, "{name} {baseline} {}", files::json(method));
        }
        for PlannedModel { name, blob } in models {
            let _ = writeln!(text, "{name} {blob:?}");
        }
        for PlannedTransfer { name, from, worlds, random, varied } in transfers {
            let _ = writeln!(text, "{name} {from:?} {random} {varied} {}", text_of(worlds));
        }
        if let Some(Simulate { lab, realities, seed, scale, speed_m_per_s, number }) = simulate {
            let _ = writeln!(text, "{realities} {seed} {scale} {speed_m_per_s} {number} {}", lab::write(lab));
        }
        files::sha256(text)
    }
}

/// The canonical texts of worlds, one after the other.
pub fn text_of(worlds: &[Scenario]) -> String {
    worlds.iter().map(Scenario::to_toml).collect()
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

/// Refuses the name of a `what` whose folder one of `others` has already.
pub(super) fn check_folder<'a>(
    key: &str,
    what: &str,
    name: &str,
    mut others: impl Iterator<Item = &'a str>,
) -> Result<(), InputError> {
    let folder = slug(name);
    let Some(other) = others.find(|other| slug(other) == folder) else { return Ok(()) };
    let expected =
        format!("another {what}, {other:?}, has the folder {folder} already; names must differ in letters or digits");
    Err(InputError::new(key, format!("{name:?}"), expected))
}
