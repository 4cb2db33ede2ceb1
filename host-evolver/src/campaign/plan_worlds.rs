//! The worlds of a campaign file: those of scenarios, which models are evolved for, and those of transfers, which they are tested in.

use super::plan::{PlannedMethod, PlannedScenario, PlannedTransfer, check_folder};
use super::vary::Variations;
use crate::evolve::MOST_EVALUATIONS;
use firmware_sim::scenario::{RandomObstacles, Scenario};
use grn_input::{InputError, Pair, Range, check_name};
use serde::Deserialize;
use std::path::Path;

/// The most worlds of all scenarios, variations included: each is kept with its walls.
const MOST_WORLDS: usize = 200;
/// The most worlds of random obstacles altogether: each is kept with its walls, which takes a quarter of a megabyte.
const MOST_RANDOM_WORLDS: u64 = 1000;

/// Evaluations of a run.
const EVALUATIONS: Range<i64> = Range::new(1, MOST_EVALUATIONS as i64, "(a whole one)");
const RANDOM_WORLDS: Range<i64> = Range::new(1, MOST_RANDOM_WORLDS as i64, "(a whole one)");
/// Seeds of worlds: TOML's integers, with room for the worlds that follow the first.
const RANDOM_SEED: Range<i64> = Range::new(0, i64::MAX - MOST_RANDOM_WORLDS as i64, "(a whole one)");

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ScenarioTable {
    name: Option<String>,
    file: Option<String>,
    files: Option<Vec<String>>,
    evaluations: i64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TransferTable {
    name: String,
    from: Vec<String>,
    file: Option<String>,
    files: Option<Vec<String>>,
    random: Option<RandomTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RandomTable {
    worlds: i64,
    seed: i64,
    density: f64,
    radius: Pair,
    clearance: f64,
}

/// A world, and the key that names its file.
struct Named {
    key: String,
    file: String,
    world: Scenario,
}

/// The worlds of a table that names one with `file` or several with `files`, relative to `folder`.
fn named(
    table: &str,
    file: Option<String>,
    files: Option<Vec<String>>,
    folder: &Path,
) -> Result<Vec<Named>, InputError> {
    let (file_key, files_key) = (format!("{table}.file"), format!("{table}.files"));
    let named: Vec<(String, String)> = match (file, files) {
        (Some(file), None) => vec![(file_key, file)],
        (None, Some(files)) if files.is_empty() => {
            return Err(InputError::new(files_key, "[]", "names no world; name at least one"));
        }
        (None, Some(files)) => {
            files.into_iter().enumerate().map(|(place, file)| (format!("{files_key}[{place}]"), file)).collect()
        }
        (Some(_), Some(_)) => {
            return Err(InputError::new(
                files_key,
                "",
                "stands beside file; name one world with file, or several with files",
            ));
        }
        (None, None) => {
            return Err(InputError::new(file_key, "", "is missing; name a world with file, or several with files"));
        }
    };
    let mut worlds: Vec<Named> = Vec::new();
    for (key, file) in named {
        let world = world(&key, &file, folder)?;
        check_folder(&key, "world of these", world.name(), worlds.iter().map(|other| other.world.name()))?;
        worlds.push(Named { key, file, world });
    }
    Ok(worlds)
}

/// The world in a file that the campaign names. What is wrong within that file is told with its own place.
fn world(key: &str, file: &str, folder: &Path) -> Result<Scenario, InputError> {
    Scenario::load(folder.join(file)).map_err(|error| match error.place() {
        Some(_) => error,
        None => InputError::new(key, format!("{file:?}"), error.to_string()).from_source(error),
    })
}

/// The worlds and their variations, the unchanged ones first, each with what its change adds to names.
fn variations(worlds: &[Named], vary: &Variations) -> Result<Vec<(String, Vec<Scenario>)>, InputError> {
    let mut all: Vec<(String, Vec<Scenario>)> = Vec::new();
    for Named { world, .. } in worlds {
        for (number, varied) in vary.of(world)?.into_iter().enumerate() {
            let change = varied.name().strip_prefix(world.name()).unwrap_or_default().to_owned();
            match all.get_mut(number) {
                Some((_, these)) => these.push(varied),
                None => all.push((change, vec![varied])),
            }
        }
    }
    Ok(all)
}

pub(super) fn planned_scenarios(
    tables: Vec<ScenarioTable>,
    methods: &[PlannedMethod],
    vary: &Variations,
    folder: &Path,
) -> Result<Vec<PlannedScenario>, InputError> {
    let mut scenarios: Vec<PlannedScenario> = Vec::new();
    for (place, ScenarioTable { name, file, files, evaluations }) in tables.into_iter().enumerate() {
        let table = format!("scenario[{place}]");
        let key = format!("{table}.evaluations");
        let evaluations = EVALUATIONS.check(&key, evaluations)? as usize;
        if let Some(dear) = methods.iter().find(|planned| planned.method.least_evaluations() > evaluations) {
            let least = dear.method.least_evaluations();
            let expected =
                format!("the first generation of method {:?} alone takes {least}; give so many or more", dear.name);
            return Err(InputError::new(key, evaluations, expected));
        }
        let name_key = format!("{table}.name");
        if let Some(name) = &name {
            check_name(&name_key, name)?;
        } else if files.is_some() {
            return Err(InputError::new(name_key, "", "is missing; tables call several files by it"));
        }
        let worlds = named(&table, file, files, folder)?;
        let first = &worlds[0];
        if let Some(other) = worlds.iter().find(|other| other.world.morphogen() != first.world.morphogen()) {
            let expected = format!(
                "has another [morphogen] than {:?}, and a blob holds one: make them equal, or a [[scenario]] of each",
                first.file
            );
            return Err(InputError::new(&other.key, format!("{:?}", other.file), expected));
        }
        let (key, name) = match name {
            Some(name) => (&name_key, name),
            None => (&first.key, first.world.name().to_owned()),
        };
        for (change, worlds) in variations(&worlds, vary)? {
            let name = format!("{name}{change}");
            check_folder(key, "scenario", &name, scenarios.iter().map(|other| other.name.as_str()))?;
            scenarios.push(PlannedScenario { name, worlds, evaluations, varied: !change.is_empty() });
        }
        if scenarios.iter().map(|planned| planned.worlds.len()).sum::<usize>() > MOST_WORLDS {
            let expected =
                format!("with its variations there are more than {MOST_WORLDS} worlds; make several campaigns of it");
            return Err(InputError::new(&first.key, format!("{:?}", first.file), expected));
        }
    }
    Ok(scenarios)
}

pub(super) fn planned_transfers(
    tables: Vec<TransferTable>,
    scenarios: &[PlannedScenario],
    vary: &Variations,
    folder: &Path,
) -> Result<Vec<PlannedTransfer>, InputError> {
    let known: Vec<&str> = scenarios.iter().map(|planned| planned.name.as_str()).collect();
    let mut transfers: Vec<PlannedTransfer> = Vec::new();
    let mut random_worlds = 0;
    for (place, TransferTable { name, from, file, files, random }) in tables.into_iter().enumerate() {
        let table = format!("transfer[{place}]");
        let key = |name: &str| format!("{table}.{name}");
        for (index, scenario) in from.iter().enumerate() {
            let key = key(&format!("from[{index}]"));
            if !known.contains(&scenario.as_str()) {
                let expected = format!("is no scenario of this campaign; there are {}", known.join(", "));
                return Err(InputError::new(key, format!("{scenario:?}"), expected));
            }
            if from[..index].contains(scenario) {
                return Err(InputError::new(key, format!("{scenario:?}"), "is named twice; name it once"));
            }
        }
        let is_several = files.is_some();
        let worlds = named(&table, file, files, folder)?;
        if random.is_none() {
            let trained = scenarios.iter().filter(|planned| from.contains(&planned.name));
            check_unseen(&worlds, trained)?;
        }
        let before = transfers.len();
        match random {
            Some(_) if is_several => {
                return Err(InputError::new(
                    key("files"),
                    "",
                    "obstacles are thrown into one world; name it with file",
                ));
            }
            Some(random) => {
                random_worlds += RANDOM_WORLDS.check(&key("random.worlds"), random.worlds)? as u64;
                if random_worlds > MOST_RANDOM_WORLDS {
                    let expected = format!(
                        "with this transfer there are {random_worlds} random worlds, of at most {MOST_RANDOM_WORLDS}"
                    );
                    return Err(InputError::new(key("random.worlds"), random.worlds, expected));
                }
                let worlds = random.worlds(&key("random."), &worlds[0].world)?;
                transfers.push(PlannedTransfer { name, from, worlds, random: true, varied: false });
            }
            None => {
                for (change, worlds) in variations(&worlds, vary)? {
                    transfers.push(PlannedTransfer {
                        name: format!("{name}{change}"),
                        from: from.iter().map(|from| format!("{from}{change}")).collect(),
                        worlds,
                        random: false,
                        varied: !change.is_empty(),
                    });
                }
            }
        }
        let (others, these) = transfers.split_at(before);
        for transfer in these {
            let taken = known.iter().copied().chain(others.iter().map(|other| other.name.as_str()));
            check_folder(&key("name"), "world", &transfer.name, taken)?;
        }
    }
    Ok(transfers)
}

/// Refuses test worlds that these scenarios train for.
fn check_unseen<'a>(tests: &[Named], trained: impl Iterator<Item = &'a PlannedScenario>) -> Result<(), InputError> {
    for PlannedScenario { name, worlds, .. } in trained {
        for Named { key, file, world } in tests {
            if worlds.iter().any(|trained| trained.to_toml() == world.to_toml()) {
                let expected = format!("the scenario {name:?} trains for this world; name one that it has not seen");
                return Err(InputError::new(key, format!("{file:?}"), expected));
            }
        }
    }
    Ok(())
}

impl TransferTable {
    pub(super) fn name(&self) -> &str {
        &self.name
    }
}

impl RandomTable {
    fn worlds(&self, prefix: &str, world: &Scenario) -> Result<Vec<Scenario>, InputError> {
        let RandomTable { worlds, seed, density, radius: Pair(radius), clearance } = *self;
        let first = RANDOM_SEED.check(&format!("{prefix}seed"), seed)? as u64;
        let obstacles = RandomObstacles { seed: first, density, radius, clearance };
        obstacles.check(prefix, world.region())?;
        let thrown = |seed| world.with_random_obstacles(&RandomObstacles { seed, ..obstacles });
        let keyed =
            |error: InputError| InputError::new(format!("{prefix}{}", error.key()), error.value(), error.expected());
        (first..first + worlds as u64).map(|seed| thrown(seed).map_err(keyed)).collect()
    }
}
