//! The campaign file as it stands, and the checks that make it a [`Plan`].

use super::method::{Deploys, Method};
use super::plan::{Plan, PlannedMethod, PlannedModel, PlannedScenario, PlannedTransfer, slug};
use super::simulate::SimulateTable;
use super::vary::Variations;
use crate::evaluation::{ConstraintNames, Model};
use crate::evolve::eh_grn::Structure;
use crate::evolve::{MOST_EVALUATIONS, MOST_REALITIES, Objectives};
use crate::files::read_blob;
use crate::model::variation::{Inputs, MotifSet};
use firmware_sim::scenario::{RandomObstacles, Scenario};
use grn_input::{Found, InputError, Pair, Range, check_name};
use serde::Deserialize;
use std::path::Path;

/// The most methods of a campaign: figures tell so many apart.
const MOST_METHODS: usize = 6;
/// The most worlds to evolve for, variations included: each is kept with its walls.
const MOST_SCENARIOS: usize = 200;
/// The most runs: each is a folder, and all are looked for at every start.
const MOST_RUNS: u64 = 100_000;
/// The most evaluations of all runs: ten days at a tenth of a millisecond each.
const MOST_WORK: u64 = 10_000_000_000;
/// The most models tried in worlds, one line of 100 bytes in memory each.
const MOST_TRIALS: u64 = 1_000_000;
/// The most worlds of random obstacles altogether: each is kept with its walls, which takes a quarter of a megabyte.
const MOST_RANDOM_WORLDS: u64 = 1000;

/// Runs of one method in one scenario.
const SEEDS: Range<i64> = Range::new(1, 10_000, "(a whole one)");
/// Evaluations of a run.
const EVALUATIONS: Range<i64> = Range::new(1, MOST_EVALUATIONS as i64, "(a whole one)");
/// Generations of DE: with 1000, one generation of the search takes 400,400 evaluations.
const DE_GENERATIONS: Range<i64> = Range::new(0, 1000, "(a whole one)");
/// Trials of models on the front.
const REALITIES: Range<i64> = Range::new(1, MOST_REALITIES as i64, "(a whole one)");
const RANDOM_WORLDS: Range<i64> = Range::new(1, MOST_RANDOM_WORLDS as i64, "(a whole one)");
/// Seeds of worlds: TOML's integers, with room for the worlds that follow the first.
const RANDOM_SEED: Range<i64> = Range::new(0, i64::MAX - MOST_RANDOM_WORLDS as i64, "(a whole one)");

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PlanFile {
    name: String,
    seeds: i64,
    #[serde(default, rename = "scenario")]
    scenarios: Vec<ScenarioTable>,
    #[serde(default, rename = "method")]
    methods: Vec<MethodTable>,
    #[serde(default, rename = "model")]
    models: Vec<ModelTable>,
    #[serde(default, rename = "transfer")]
    transfers: Vec<TransferTable>,
    #[serde(default)]
    vary: Variations,
    simulate: Option<SimulateTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ScenarioTable {
    file: String,
    evaluations: i64,
}

/// All keys that some algorithm has; which of them is right follows from the algorithm. (An enum of tables would not tell
/// where a key is wrong.)
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MethodTable {
    name: String,
    #[serde(default)]
    baseline: bool,
    algorithm: Algorithm,
    motifs: Option<MotifSet>,
    de_generations: Option<i64>,
    objectives: Option<Objectives>,
    constraints: Option<ConstraintNames>,
    realities: Option<i64>,
    inputs: Option<Inputs>,
    random: Option<bool>,
    deploys: Option<Deploys>,
    structure: Option<Structure>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Algorithm {
    Mogp,
    EhGrn,
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
    worlds: i64,
    seed: i64,
    density: f64,
    radius: Pair,
    clearance: f64,
}

impl PlanFile {
    /// The plan; files it names are relative to `folder`.
    pub(super) fn checked(self, folder: &Path) -> Result<Plan, InputError> {
        check_name("name", &self.name)?;
        let seeds = SEEDS.check("seeds", self.seeds)? as u64;
        let PlanFile { scenarios, methods, models, transfers, vary, simulate, .. } = self;
        for (what, count) in [("scenario", scenarios.len()), ("method", methods.len())] {
            if count == 0 {
                return Err(InputError::new(what, "", format!("at least one [[{what}]] is needed")));
            }
        }
        if methods.len() > MOST_METHODS {
            let expected = format!("figures tell at most {MOST_METHODS} methods apart; make two campaigns of it");
            return Err(InputError::new("method", format!("{} of them", methods.len()), expected));
        }
        check_names("method", methods.iter().map(|method| method.name.as_str()))?;
        check_names("model", models.iter().map(|model| model.name.as_str()))?;
        check_names("transfer", transfers.iter().map(|transfer| transfer.name.as_str()))?;
        vary.check()?;
        let methods = planned_methods(methods)?;
        let scenarios = planned_scenarios(scenarios, &methods, &vary, folder)?;
        let models = models.into_iter().enumerate().map(|(place, table)| planned_model(place, table, folder));
        let models = models.collect::<Result<Vec<_>, _>>()?;
        let transfers = planned_transfers(transfers, &scenarios, &vary, folder)?;
        let simulate = simulate.map(|table| table.checked(folder)).transpose()?;
        if let Some(simulate) = &simulate {
            simulate.check(scenarios.iter().map(|planned| &planned.scenario))?;
        }
        let plan = Plan { name: self.name, seeds, scenarios, methods, models, transfers, simulate };
        check_work(&plan)?;
        Ok(plan)
    }
}

/// Names that are names, and lead to folders of their own.
fn check_names<'a>(what: &str, names: impl Iterator<Item = &'a str>) -> Result<(), InputError> {
    let mut seen: Vec<(String, &str)> = Vec::new();
    for (place, name) in names.enumerate() {
        let key = format!("{what}[{place}].name");
        check_name(&key, name)?;
        check_folder(&key, what, name, &seen)?;
        seen.push((slug(name), name));
    }
    Ok(())
}

fn check_folder(key: &str, what: &str, name: &str, seen: &[(String, &str)]) -> Result<(), InputError> {
    let folder = slug(name);
    let Some((_, other)) = seen.iter().find(|(taken, _)| *taken == folder) else { return Ok(()) };
    let expected =
        format!("another {what}, {other:?}, has the folder {folder} already; names must differ in letters or digits");
    Err(InputError::new(key, format!("{name:?}"), expected))
}

fn planned_methods(tables: Vec<MethodTable>) -> Result<Vec<PlannedMethod>, InputError> {
    let planned = |(place, table): (usize, MethodTable)| {
        let key = |name: &str| format!("method[{place}].{name}");
        let MethodTable { name, baseline, algorithm, structure, .. } = table;
        let MethodTable { motifs, de_generations, objectives, constraints, realities, inputs, random, deploys, .. } =
            table;
        let missing =
            |name: &str, of: &str| InputError::new(key(name), "", format!("is missing; algorithm \"{of}\" needs it"));
        let foreign = |name: &str, of: &str| {
            InputError::new(key(name), "", format!("algorithm \"{of}\" has no such key; remove it"))
        };
        let method = match algorithm {
            Algorithm::Mogp if structure.is_some() => return Err(foreign("structure", "mogp")),
            Algorithm::Mogp => {
                let generations = de_generations.map(|count| DE_GENERATIONS.check(&key("de_generations"), count));
                let realities = realities.map(|count| REALITIES.check(&key("realities"), count)).transpose()?;
                Method::Mogp {
                    motifs: motifs.ok_or_else(|| missing("motifs", "mogp"))?,
                    de_generations: generations.transpose()?.map(|count| count as usize),
                    objectives,
                    constraints,
                    realities: realities.map(|count| count as usize),
                    inputs,
                    random,
                    deploys,
                }
            }
            Algorithm::EhGrn => {
                let of_mogp = [
                    ("motifs", motifs.is_some()),
                    ("de_generations", de_generations.is_some()),
                    ("objectives", objectives.is_some()),
                    ("constraints", constraints.is_some()),
                    ("realities", realities.is_some()),
                    ("inputs", inputs.is_some()),
                    ("random", random.is_some()),
                    ("deploys", deploys.is_some()),
                ];
                if let Some((given, _)) = of_mogp.into_iter().find(|(_, is_given)| *is_given) {
                    return Err(foreign(given, "eh-grn"));
                }
                Method::EhGrn { structure: structure.ok_or_else(|| missing("structure", "eh-grn"))? }
            }
        };
        Ok(PlannedMethod { name, baseline, method })
    };
    tables.into_iter().enumerate().map(planned).collect()
}

fn planned_scenarios(
    tables: Vec<ScenarioTable>,
    methods: &[PlannedMethod],
    vary: &Variations,
    folder: &Path,
) -> Result<Vec<PlannedScenario>, InputError> {
    let mut scenarios: Vec<PlannedScenario> = Vec::new();
    for (place, ScenarioTable { file, evaluations }) in tables.into_iter().enumerate() {
        let key = format!("scenario[{place}].evaluations");
        let evaluations = EVALUATIONS.check(&key, evaluations)? as usize;
        if let Some(dear) = methods.iter().find(|planned| planned.method.least_evaluations() > evaluations) {
            let least = dear.method.least_evaluations();
            let expected =
                format!("the first generation of method {:?} alone takes {least}; give so many or more", dear.name);
            return Err(InputError::new(key, evaluations, expected));
        }
        let key = format!("scenario[{place}].file");
        let original = world(&key, &file, folder)?;
        for scenario in vary.of(&original)? {
            let varied = scenario.name() != original.name();
            let seen: Vec<_> =
                scenarios.iter().map(|other| (slug(other.scenario.name()), other.scenario.name())).collect();
            check_folder(&key, "scenario", scenario.name(), &seen)?;
            scenarios.push(PlannedScenario { scenario, evaluations, varied });
        }
        if scenarios.len() > MOST_SCENARIOS {
            let expected = format!(
                "with its variations there are more than {MOST_SCENARIOS} worlds; make several campaigns of it"
            );
            return Err(InputError::new(key, format!("{file:?}"), expected));
        }
    }
    Ok(scenarios)
}

/// The world in a file that the campaign names. What is wrong within that file is told with its own place.
fn world(key: &str, file: &str, folder: &Path) -> Result<Scenario, InputError> {
    Scenario::load(folder.join(file)).map_err(|error| match error.place() {
        Some(_) => error,
        None => InputError::new(key, format!("{file:?}"), error.to_string()).from_source(error),
    })
}

fn planned_model(place: usize, table: ModelTable, folder: &Path) -> Result<PlannedModel, InputError> {
    let ModelTable { name, file } = table;
    let key = format!("model[{place}].file");
    let blob = read_blob(&folder.join(&file));
    let blob =
        blob.map_err(|error| InputError::new(&key, format!("{file:?}"), error.to_string()).from_source(error))?;
    Model::new(&blob.network, 0.5).map_err(|error| InputError::new(&key, format!("{file:?}"), error.to_string()))?;
    Ok(PlannedModel { name, blob })
}

fn planned_transfers(
    tables: Vec<TransferTable>,
    scenarios: &[PlannedScenario],
    vary: &Variations,
    folder: &Path,
) -> Result<Vec<PlannedTransfer>, InputError> {
    let known: Vec<&str> = scenarios.iter().map(|planned| planned.scenario.name()).collect();
    let mut transfers: Vec<PlannedTransfer> = Vec::new();
    let mut random_worlds = 0;
    for (place, TransferTable { name, from, file, random }) in tables.into_iter().enumerate() {
        let key = |name: &str| format!("transfer[{place}].{name}");
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
        let world = world(&key("file"), &file, folder)?;
        let before = transfers.len();
        match random {
            Some(random) => {
                random_worlds += RANDOM_WORLDS.check(&key("random.worlds"), random.worlds)? as u64;
                if random_worlds > MOST_RANDOM_WORLDS {
                    let expected = format!(
                        "with this transfer there are {random_worlds} random worlds, of at most {MOST_RANDOM_WORLDS}"
                    );
                    return Err(InputError::new(key("random.worlds"), random.worlds, expected));
                }
                let worlds = random.worlds(&key("random."), &world)?;
                transfers.push(PlannedTransfer { name, from, worlds, varied: false });
            }
            None => {
                for varied in vary.of(&world)? {
                    let change = varied.name().strip_prefix(world.name()).unwrap_or_default();
                    transfers.push(PlannedTransfer {
                        name: format!("{name}{change}"),
                        from: from.iter().map(|from| format!("{from}{change}")).collect(),
                        varied: !change.is_empty(),
                        worlds: vec![varied],
                    });
                }
            }
        }
        let (others, these) = transfers.split_at(before);
        let names = known.iter().copied().chain(others.iter().map(|other| other.name.as_str()));
        let seen: Vec<_> = names.map(|name| (slug(name), name)).collect();
        for transfer in these {
            check_folder(&key("name"), "world", &transfer.name, &seen)?;
        }
    }
    Ok(transfers)
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

/// What a campaign costs altogether.
fn check_work(plan: &Plan) -> Result<(), InputError> {
    let runs = plan.scenarios.len() as u64 * plan.methods.len() as u64 * plan.seeds;
    let evaluations: u64 = plan.scenarios.iter().map(|planned| planned.evaluations as u64).sum();
    let work = evaluations * plan.methods.len() as u64 * plan.seeds;
    let knees = |from: &[String]| from.len() as u64 * plan.methods.len() as u64 * plan.seeds;
    let models = plan.models.len() as u64;
    let tried = plan.transfers.iter().map(|t| t.worlds.len() as u64 * (models + knees(&t.from)));
    let trials = tried.sum::<u64>() + models * plan.scenarios.len() as u64;
    let too_much = [
        (runs, MOST_RUNS, "runs of all methods in all scenarios"),
        (work, MOST_WORK, "evaluations of all runs"),
        (trials, MOST_TRIALS, "trials of models in worlds"),
    ];
    match too_much.into_iter().find(|(count, most, _)| count > most) {
        Some((count, most, what)) => {
            let expected = format!(
                "this makes {count} {what}, of at most {most}; take fewer seeds, or make several campaigns of it"
            );
            Err(InputError::new("seeds", plan.seeds, expected))
        }
        None => Ok(()),
    }
}

impl Plan {
    /// Reads a campaign file; files it names are relative to it.
    ///
    /// # Errors
    /// What is wrong, with the file and the place.
    pub fn load(path: &Path) -> Result<Plan, InputError> {
        let text = grn_input::read_text(path, Found::Campaign)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let plan = grn_input::parse(&text, |file: PlanFile| file.checked(folder));
        plan.map_err(|error| match Found::of(text.as_bytes()) {
            found @ Found::Scenario => InputError::new("", "", found.instead_of(Found::Campaign)).in_file(path),
            _ => error.in_file(path),
        })
    }
}
