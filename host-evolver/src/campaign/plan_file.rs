//! The campaign file as it stands, and the checks that make it a [`Plan`].

use super::method::{Deploys, Method};
use super::plan::{Plan, PlannedMethod, PlannedModel, check_folder};
use super::plan_worlds::{ScenarioTable, TransferTable, planned_scenarios, planned_transfers};
use super::simulate::SimulateTable;
use super::vary::Variations;
use crate::evaluation::{ConstraintNames, Model};
use crate::evolve::eh_grn::Structure;
use crate::evolve::{MOST_REALITIES, Objectives};
use crate::files::read_blob;
use crate::model::variation::{Inputs, MotifSet};
use grn_input::{Found, InputError, Range, check_name};
use serde::Deserialize;
use std::path::Path;

/// The most methods of a campaign: figures tell so many apart.
const MOST_METHODS: usize = 6;
/// The most runs: each is a folder, and all are looked for at every start.
const MOST_RUNS: u64 = 100_000;
/// The most evaluations of all runs: ten days at a tenth of a millisecond each.
const MOST_WORK: u64 = 10_000_000_000;
/// The most models tried in worlds, one line of 100 bytes in memory each.
const MOST_TRIALS: u64 = 1_000_000;

/// Runs of one method in one scenario.
const SEEDS: Range<i64> = Range::new(1, 10_000, "(a whole one)");
/// Generations of DE: with 1000, one generation of the search takes 400,400 evaluations.
const DE_GENERATIONS: Range<i64> = Range::new(0, 1000, "(a whole one)");
/// Trials of models on the front.
const REALITIES: Range<i64> = Range::new(1, MOST_REALITIES as i64, "(a whole one)");

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
    RuleRing,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ModelTable {
    name: String,
    file: String,
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
        check_names("transfer", transfers.iter().map(TransferTable::name))?;
        vary.check()?;
        let methods = planned_methods(methods)?;
        let is_ruled = |planned: &PlannedMethod| planned.method.follows_rules();
        if let (Some(place), None) = (methods.iter().position(is_ruled), &simulate) {
            let expected = "evolves nothing: its robots are only simulated; say with [simulate] in what laboratory";
            return Err(InputError::new(format!("method[{place}].algorithm"), "\"rule-ring\"", expected));
        }
        let scenarios = planned_scenarios(scenarios, &methods, &vary, folder)?;
        let models = models.into_iter().enumerate().map(|(place, table)| planned_model(place, table, folder));
        let models = models.collect::<Result<Vec<_>, _>>()?;
        let transfers = planned_transfers(transfers, &scenarios, &vary, folder)?;
        let mut plan = Plan { name: self.name, seeds, scenarios, methods, models, transfers, simulate: None };
        if let Some(table) = simulate {
            table.check_set(plan.worlds_simulated_in())?;
            plan.simulate = Some(table.checked(folder)?);
        }
        plan.check_simulations()?;
        check_work(&plan)?;
        Ok(plan)
    }
}

/// Names that are names, and lead to folders of their own.
fn check_names<'a>(what: &str, names: impl Iterator<Item = &'a str>) -> Result<(), InputError> {
    let mut seen: Vec<&str> = Vec::new();
    for (place, name) in names.enumerate() {
        let key = format!("{what}[{place}].name");
        check_name(&key, name)?;
        check_folder(&key, what, name, seen.iter().copied())?;
        seen.push(name);
    }
    Ok(())
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
        let given = of_mogp.into_iter().find_map(|(name, is_given)| is_given.then_some(name));
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
            Algorithm::EhGrn => match given {
                Some(given) => return Err(foreign(given, "eh-grn")),
                None => Method::EhGrn { structure: structure.ok_or_else(|| missing("structure", "eh-grn"))? },
            },
            Algorithm::RuleRing => match given.or(structure.map(|_| "structure")) {
                Some(given) => return Err(foreign(given, "rule-ring")),
                None => Method::RuleRing,
            },
        };
        Ok(PlannedMethod { name, baseline, method })
    };
    tables.into_iter().enumerate().map(planned).collect()
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

/// What a campaign costs altogether.
fn check_work(plan: &Plan) -> Result<(), InputError> {
    let runs = plan.scenarios.len() as u64 * plan.runs_each();
    let evaluations: u64 = plan.scenarios.iter().map(|planned| planned.evaluations as u64).sum();
    let work = evaluations * plan.runs_each();
    let too_much = [
        (runs, MOST_RUNS, "runs of all methods in all scenarios"),
        (work, MOST_WORK, "evaluations of all runs"),
        (plan.trials(), MOST_TRIALS, "trials of models in worlds"),
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
