//! The campaign file: which scenarios, methods, models and transfers, and how many seeds.

use super::method::Method;
use crate::evaluation::Model;
use crate::files::{self, FileError, read_blob};
use firmware_sim::scenario::{RandomObstacles, Scenario};
use grn_core::network::Network;
use serde::Deserialize;
use std::collections::HashSet;
use std::path::Path;

/// The most runs of one method in one scenario.
const MOST_SEEDS: u64 = 10_000;

/// The most methods of a campaign.
const MOST_METHODS: usize = 6;

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
#[derive(Deserialize)]
pub struct PlannedMethod {
    /// Its name.
    pub name: String,
    /// Whether it is a baseline: all methods that are none are compared with it.
    #[serde(default)]
    pub baseline: bool,
    /// What it does.
    #[serde(flatten)]
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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PlanFile {
    name: String,
    seeds: u64,
    #[serde(rename = "scenario")]
    scenarios: Vec<ScenarioTable>,
    #[serde(rename = "method")]
    methods: Vec<PlannedMethod>,
    #[serde(default, rename = "model")]
    models: Vec<ModelTable>,
    #[serde(default, rename = "transfer")]
    transfers: Vec<TransferTable>,
    #[serde(default)]
    vary: super::vary::Variations,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ScenarioTable {
    file: String,
    evaluations: usize,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ModelTable {
    name: String,
    file: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TransferTable {
    name: String,
    from: Vec<String>,
    file: String,
    random: Option<RandomTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RandomTable {
    worlds: u64,
    #[serde(flatten)]
    obstacles: RandomObstacles,
}

impl Plan {
    /// Reads a campaign file; files it names are relative to it.
    ///
    /// # Errors
    /// What is wrong, with the file and the place.
    pub fn load(path: &Path) -> Result<Plan, FileError> {
        let text = files::read_text(path)?;
        let file: PlanFile = toml::from_str(&text).map_err(|error| FileError::new(path, error.to_string().trim()))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let load = |name: &str| Scenario::load(folder.join(name)).map_err(|error| FileError::new(path, error));
        let mut scenarios = Vec::new();
        for ScenarioTable { file: name, evaluations } in file.scenarios {
            let original = load(&name)?;
            for scenario in file.vary.of(&original).map_err(|error| FileError::new(path, error))? {
                let varied = scenario.name() != original.name();
                scenarios.push(PlannedScenario { scenario, evaluations, varied });
            }
        }
        let model = |table: ModelTable| -> Result<PlannedModel, FileError> {
            let network = read_blob(&folder.join(&table.file))?.network;
            Model::new(&network, 0.5).map_err(|error| FileError::new(folder.join(&table.file), error))?;
            Ok(PlannedModel { name: table.name, network })
        };
        let models = file.models.into_iter().map(model).collect::<Result<_, _>>()?;
        let mut transfers = Vec::new();
        for table in file.transfers {
            let world = load(&table.file)?;
            let fault = |error| FileError::new(path, format!("transfer {:?}: {error}", table.name));
            match &table.random {
                Some(random) => transfers.push(PlannedTransfer {
                    worlds: random.worlds(&world).map_err(fault)?,
                    name: table.name,
                    from: table.from,
                    varied: false,
                }),
                None => {
                    for varied in file.vary.of(&world).map_err(fault)? {
                        let change = varied.name().strip_prefix(world.name()).unwrap_or_default();
                        transfers.push(PlannedTransfer {
                            name: format!("{}{change}", table.name),
                            from: table.from.iter().map(|from| format!("{from}{change}")).collect(),
                            varied: !change.is_empty(),
                            worlds: vec![varied],
                        });
                    }
                }
            }
        }
        let plan = Plan { name: file.name, seeds: file.seeds, scenarios, methods: file.methods, models, transfers };
        plan.check().map_err(|fault| FileError::new(path, fault))?;
        Ok(plan)
    }

    fn check(&self) -> Result<(), String> {
        if !(1..=MOST_SEEDS).contains(&self.seeds) {
            return Err(format!("seeds = {}: a number from 1 to {MOST_SEEDS} is needed", self.seeds));
        }
        unique("scenario", self.scenarios.iter().map(|planned| planned.scenario.name()))?;
        unique("method", self.methods.iter().map(|planned| planned.name.as_str()))?;
        let transfers = self.transfers.iter().map(|planned| planned.name.as_str());
        unique("transfer", self.scenarios.iter().map(|planned| planned.scenario.name()).chain(transfers))?;
        unique("model", self.models.iter().map(|planned| planned.name.as_str()))?;
        if self.scenarios.is_empty() || self.methods.is_empty() {
            return Err("at least one [[scenario]] and one [[method]] are needed".into());
        }
        if self.methods.len() > MOST_METHODS {
            let found = self.methods.len();
            return Err(format!(
                "{found} methods: figures tell at most {MOST_METHODS} apart; make two campaigns of it"
            ));
        }
        let known: Vec<&str> = self.scenarios.iter().map(|planned| planned.scenario.name()).collect();
        for transfer in &self.transfers {
            if let Some(unknown) = transfer.from.iter().find(|name| !known.contains(&name.as_str())) {
                return Err(format!(
                    "transfer {:?}: from = {unknown:?} is no scenario of this campaign; there are {known:?}",
                    transfer.name
                ));
            }
        }
        for planned in &self.scenarios {
            for method in &self.methods {
                method.method.check(planned.evaluations).map_err(|fault| {
                    format!("scenario {:?}, method {:?}: {fault}", planned.scenario.name(), method.name)
                })?;
            }
        }
        Ok(())
    }
}

impl RandomTable {
    fn worlds(&self, world: &Scenario) -> Result<Vec<Scenario>, firmware_sim::scenario::InputError> {
        let first = self.obstacles.seed;
        let seeds = first..first.saturating_add(self.worlds);
        seeds.map(|seed| world.with_random_obstacles(&RandomObstacles { seed, ..self.obstacles })).collect()
    }
}

/// A name as part of a path: letters and digits, the rest as single dashes.
pub fn slug(name: &str) -> String {
    let mut slug = String::new();
    for character in name.chars() {
        if character.is_alphanumeric() {
            slug.extend(character.to_lowercase());
        } else if !slug.ends_with('-') && !slug.is_empty() {
            slug.push('-');
        }
    }
    slug.trim_end_matches('-').to_owned()
}

fn unique<'a>(what: &str, names: impl Iterator<Item = &'a str>) -> Result<(), String> {
    let mut seen = HashSet::new();
    for name in names {
        if slug(name).is_empty() {
            return Err(format!("{what} {name:?}: a name with letters or digits is needed"));
        }
        if !seen.insert(slug(name)) {
            return Err(format!("{what} {name:?}: another has this name too; names must differ in letters or digits"));
        }
    }
    Ok(())
}
