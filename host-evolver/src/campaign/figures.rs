//! The pictures of a campaign.

use super::plan::{Plan, PlannedScenario, slug};
use super::rows::{Measure, RunRow, SimulationSummary, TransferRow};
use super::simulate::Simulate;
use super::tables::Tables;
use super::unit::Unit;
use crate::evaluation::{Model, World};
use crate::evolve::Milestone;
use crate::figures::{self, Pictures};
use crate::files::{Contents, FileError, read_blob};
use crate::realities::reality;
use crate::record;
use crate::run::of_world;
use crate::simulation::simulate as simulate_one;
use firmware_sim::scenario::Scenario;
use grn_core::blob::Blob;
use grn_figures::FigureError;
use grn_optimisers::statistics::quartiles;
use std::ops::ControlFlow;
use std::path::Path;

/// Draws everything; `notice` hears of what cannot be drawn. Variations of a scenario are in the tables only, and so is what
/// became of one model in one world.
pub(super) fn draw(
    plan: &Plan,
    tables: &Tables,
    campaign: &Path,
    notice: &dyn Fn(&str),
) -> Result<Contents, FileError> {
    let scenarios: Vec<&PlannedScenario> = plan.scenarios.iter().filter(|planned| !planned.varied).collect();
    let mut pictures = Pictures::default();
    let measures = [
        (Measure::KneeF2, "f2-of-knees"),
        (Measure::BestF2, "f2"),
        (Measure::BestNodes, "nodes"),
        (Measure::KneeNodes, "nodes-of-knees"),
        (Measure::Cost, "cost-of-knees"),
    ];
    let is_measured = |(measure, _): &(Measure, &str)| *measure != Measure::Cost || plan.simulate.is_some();
    for (measure, stem) in measures.into_iter().filter(is_measured) {
        pictures.add_pages(stem, boxes(plan, &scenarios, tables, measure));
    }
    pictures.add_pages("convergence", grn_figures::convergence(&convergence(plan, campaign)?));
    let rates = rates(plan, tables);
    if !rates.groups.is_empty() {
        pictures.add_pages("transfers", grn_figures::rates(&rates));
    }
    let simulated = simulated(plan, tables);
    if !simulated.groups.is_empty() {
        pictures.add_pages("simulations", grn_figures::rates(&simulated));
    }
    for (place, planned) in plan.scenarios.iter().enumerate().filter(|(_, planned)| !planned.varied) {
        let worlds: Vec<World> = planned.worlds.iter().cloned().map(World::new).collect();
        let first = &planned.worlds[0];
        let models = plan.methods.iter().enumerate().filter(|(_, planned)| !planned.method.follows_rules());
        for (method, planned_method) in models {
            let Some(unit) = typical(plan, tables, place, method) else { continue };
            let name =
                |what: &str| format!("typical/{}/{}/{what}.svg", slug(&planned.name), slug(&planned_method.name));
            let front = unit.front(plan, campaign)?;
            pictures
                .add(&name("pareto"), figures::front(&planned_method.method.objectives(), &front, &[], &first.ring()));
            let knee = read_blob(&campaign.join(unit.folder(plan)).join("knee.grn"))?;
            if let Some(simulate) = &plan.simulate {
                let blob = Blob { scale: simulate.scale, ..knee.clone() };
                for (place, world) in planned.worlds.iter().enumerate() {
                    let name = name(&of_world("trace", place, worlds.len(), ""));
                    swarm(&mut pictures, &name, &blob, world, simulate);
                }
            }
            let network = knee.network;
            pictures.add(&name("tree"), Ok(figures::tree(&network)));
            pictures.add(&name("grn"), figures::grn(&network));
            if let Ok(model) = Model::new(&network, first.morphogen().level) {
                for (place, world) in worlds.iter().enumerate() {
                    pictures.add(&name(&of_world("pattern", place, worlds.len(), "")), figures::pattern(world, &model));
                }
            }
        }
    }
    pictures.not_drawn.iter().for_each(|line| notice(line));
    Ok(pictures.contents)
}

/// Draws the first of the realities that knees are simulated in.
fn swarm(pictures: &mut Pictures, name: &str, blob: &Blob, world: &Scenario, simulate: &Simulate) {
    let config = reality(&world.configured(simulate.config()), 1);
    let mut recorder = record::recorder(world, &config);
    match simulate_one(blob, world, config, simulate.number, &mut recorder, |_| ControlFlow::Continue(())) {
        Ok(Some(simulation)) => pictures.add(name, figures::run(&simulation, recorder.trace(), world, blob)),
        Ok(None) => {}
        Err(error) => pictures.not_drawn.push(format!("{name} is not drawn: {error}")),
    }
}

/// The run whose knee has the median cost of a method in a scenario, or the median f2 if knees are not simulated.
fn typical(plan: &Plan, tables: &Tables, scenario: usize, method: usize) -> Option<Unit> {
    let (scenario_name, method_name) = (&plan.scenarios[scenario].name, &plan.methods[method].name);
    let mut rows: Vec<&RunRow> =
        tables.runs.iter().filter(|run| run.scenario == *scenario_name && run.method == *method_name).collect();
    let measure = if plan.simulate.is_some() { Measure::Cost } else { Measure::KneeF2 };
    rows.sort_by(|a, b| measure.of(a).total_cmp(&measure.of(b)).then(a.seed.cmp(&b.seed)));
    let seed = rows.get(rows.len().saturating_sub(1) / 2)?.seed;
    Some(Unit { scenario, method, seed })
}

fn boxes(
    plan: &Plan,
    scenarios: &[&PlannedScenario],
    tables: &Tables,
    measure: Measure,
) -> Result<Vec<String>, FigureError> {
    let value = |run: &RunRow| match measure {
        Measure::Cost => run.cost,
        Measure::KneeF2 | Measure::KneeNodes => (run.knee_violation == 0.0).then(|| measure.of(run)),
        _ => (run.best_violation == 0.0).then(|| measure.of(run)),
    };
    let panel = |planned: &&PlannedScenario| grn_figures::BoxPanel {
        title: planned.name.clone(),
        groups: plan
            .methods
            .iter()
            .map(|method| {
                let of_it = |run: &&RunRow| run.scenario == planned.name && run.method == method.name;
                let values = tables.runs.iter().filter(of_it).map(value).collect();
                grn_figures::BoxGroup { label: method.name.clone(), values }
            })
            .collect(),
    };
    let panels = scenarios.iter().map(panel).collect();
    grn_figures::boxes(&grn_figures::BoxFigure { panels, y_label: measure.words().into() })
}

fn convergence(plan: &Plan, campaign: &Path) -> Result<grn_figures::ConvergenceFigure, FileError> {
    let mut panels = Vec::new();
    for (scenario, planned) in plan.scenarios.iter().enumerate().filter(|(_, planned)| !planned.varied) {
        let mut series = Vec::new();
        for (method, planned_method) in plan.methods.iter().enumerate() {
            let units = 1..=planned_method.method.runs(plan.seeds);
            let units = units.map(|seed| Unit { scenario, method, seed });
            let histories: Vec<Vec<Milestone>> =
                units.map(|unit| unit.history(plan, campaign)).collect::<Result<_, _>>()?;
            let moments = histories.iter().map(Vec::len).min().unwrap_or(0);
            let point = |moment: usize| {
                let values: Vec<f64> = histories.iter().map(|history| history[moment].hypervolume).collect();
                Some((histories.first()?[moment].evaluations as u64, quartiles(&values)?))
            };
            let points = (0..moments).filter_map(point).collect();
            series.push(grn_figures::ConvergenceSeries { label: planned_method.name.clone(), points });
        }
        panels.push(grn_figures::ConvergencePanel { title: planned.name.clone(), series });
    }
    Ok(grn_figures::ConvergenceFigure { panels, y_label: Measure::Hypervolume.words().into() })
}

fn rates(plan: &Plan, tables: &Tables) -> grn_figures::RatesFigure {
    let is_varied =
        |row: &TransferRow| plan.transfers.iter().any(|planned| planned.varied && planned.name == row.transfer);
    let mut groups: Vec<grn_figures::RateGroup> = Vec::new();
    for row in tables.transfers.iter().filter(|row| row.trials() > 1 && row.world.is_empty() && !is_varied(row)) {
        let title = match row.from.as_str() {
            "" => format!("given models in {}", row.transfer),
            from => format!("evolved for {from}, in {}", row.transfer),
        };
        let line = grn_figures::RateRow {
            label: row.method.clone(),
            successes: row.successes as u64,
            trials: row.trials() as u64,
            interval: row.low.zip(row.high),
        };
        match groups.iter_mut().find(|group| group.title == title) {
            Some(group) => group.rows.push(line),
            None => groups.push(grn_figures::RateGroup { title, rows: vec![line] }),
        }
    }
    grn_figures::RatesFigure { groups, x_label: "worlds with the pattern kept throughout, %".into() }
}

/// Knees in their training worlds and in those of transfers, all worlds of a group together.
fn simulated(plan: &Plan, tables: &Tables) -> grn_figures::RatesFigure {
    let is_varied = |row: &SimulationSummary| {
        let scenario = plan.scenarios.iter().any(|planned| planned.varied && planned.name == row.scenario);
        scenario || plan.transfers.iter().any(|planned| planned.varied && planned.name == row.transfer)
    };
    let mut groups: Vec<grn_figures::RateGroup> = Vec::new();
    for row in tables.simulated.iter().filter(|row| row.world.is_empty() && !is_varied(row)) {
        let title = match row.transfer.as_str() {
            "" => format!("knees in {}, laboratory {}", row.scenario, row.laboratory),
            transfer => format!("knees of {} in {transfer}, laboratory {}", row.scenario, row.laboratory),
        };
        let line = grn_figures::RateRow {
            label: row.method.clone(),
            successes: row.works as u64,
            trials: row.simulations() as u64,
            interval: row.low.zip(row.high),
        };
        match groups.iter_mut().find(|group| group.title == title) {
            Some(group) => group.rows.push(line),
            None => groups.push(grn_figures::RateGroup { title, rows: vec![line] }),
        }
    }
    grn_figures::RatesFigure { groups, x_label: "simulations that work, %".into() }
}
