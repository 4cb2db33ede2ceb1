//! What a campaign says in numbers, made from the files of its units.

use super::plan::{Place, Plan};
use super::rows::{Comparison, Measure, RunRow, SimulationRow, SimulationSummary, Summary, TransferRow};
use super::tables_of_worlds::{costs, simulation_rows, transfer_rows};
use super::trial::Trial;
use super::unit::Unit;
use crate::evolve::{FrontMember, deployed, front_hypervolume};
use crate::files::{self, Contents, FileError};
use crate::realities::Reality;
use grn_optimisers::statistics::{a12, holm, mann_whitney, quartiles};
use std::path::Path;

const SIMULATIONS: &str = "simulations.csv";
const SIMULATED: &str = "simulation-summary.csv";

/// All tables of a campaign.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tables {
    /// One line a run.
    pub runs: Vec<RunRow>,
    /// One line a scenario, method and measure.
    pub summaries: Vec<Summary>,
    /// One line a scenario, measure, method and baseline.
    pub comparisons: Vec<Comparison>,
    /// One line a transfer and source of models.
    pub transfers: Vec<TransferRow>,
    /// One line a run, if knees were simulated.
    pub simulations: Vec<SimulationRow>,
    /// One line a scenario and method, if knees were simulated.
    pub simulated: Vec<SimulationSummary>,
}

impl Tables {
    /// The tables from the units in the folder, from the trials in each world, with the names of its group and itself, and from the
    /// realities of each knee in each world.
    pub(super) fn of(
        plan: &Plan,
        campaign: &Path,
        trials: &[((&str, &str), Vec<Trial>)],
        simulations: &[((Unit, Place), Vec<Reality>)],
    ) -> Result<Tables, FileError> {
        let runs = Unit::all(plan).into_iter();
        let runs = runs.map(|unit| run_row(unit, plan, campaign, costs(unit, simulations)));
        let runs = runs.collect::<Result<Vec<_>, _>>()?;
        let is_measured = |measure: &Measure| *measure != Measure::Cost || plan.simulate.is_some();
        let mut tables = Tables { transfers: transfer_rows(plan, trials), ..Tables::default() };
        if let Some(simulate) = &plan.simulate {
            (tables.simulations, tables.simulated) = simulation_rows(plan, simulate, simulations);
        }
        for scenario in plan.scenarios.iter().map(|planned| planned.name.as_str()) {
            let rows_of = |method: &str| -> Vec<&RunRow> {
                runs.iter().filter(|run| run.scenario == scenario && run.method == method).collect()
            };
            for planned in &plan.methods {
                let rows = rows_of(&planned.name);
                let measures = Measure::ALL.into_iter().filter(is_measured);
                tables.summaries.extend(measures.filter_map(|measure| summary(measure, &rows)));
            }
            for measure in Measure::ALL.into_iter().filter(is_measured) {
                for baseline in plan.methods.iter().filter(|planned| planned.baseline) {
                    for method in plan.methods.iter().filter(|planned| !planned.baseline) {
                        let (rows, against) = (rows_of(&method.name), rows_of(&baseline.name));
                        tables.comparisons.extend(comparison(measure, &rows, &against));
                    }
                }
            }
        }
        let corrected = holm(&tables.comparisons.iter().map(|comparison| comparison.p).collect::<Vec<_>>());
        for (comparison, p) in tables.comparisons.iter_mut().zip(corrected) {
            comparison.p_holm = p;
        }
        tables.runs = runs;
        Ok(tables)
    }

    /// The files; those of simulations only if there are some.
    pub(super) fn contents(&self) -> Contents {
        let mut contents = Contents::from([
            ("results.csv".into(), files::csv_records(&self.runs)),
            ("summary.csv".into(), files::csv_records(&self.summaries)),
            ("comparisons.csv".into(), files::csv_records(&self.comparisons)),
            ("transfers.csv".into(), files::csv_records(&self.transfers)),
        ]);
        if !self.simulations.is_empty() {
            contents.insert(SIMULATIONS.into(), files::csv_records(&self.simulations));
            contents.insert(SIMULATED.into(), files::csv_records(&self.simulated));
        }
        contents
    }

    pub(super) fn read(campaign: &Path) -> Result<Tables, FileError> {
        let simulated = campaign.join(SIMULATED).exists();
        Ok(Tables {
            runs: files::read_csv(&campaign.join("results.csv"))?,
            summaries: files::read_csv(&campaign.join("summary.csv"))?,
            comparisons: files::read_csv(&campaign.join("comparisons.csv"))?,
            transfers: files::read_csv(&campaign.join("transfers.csv"))?,
            simulations: if simulated { files::read_csv(&campaign.join(SIMULATIONS))? } else { Vec::new() },
            simulated: if simulated { files::read_csv(&campaign.join(SIMULATED))? } else { Vec::new() },
        })
    }
}

fn run_row(unit: Unit, plan: &Plan, campaign: &Path, costs: Option<(f64, f64)>) -> Result<RunRow, FileError> {
    let front = unit.front(plan, campaign)?;
    let empty = || FileError::new(campaign.join(unit.folder(plan)), "the front is empty; delete this run");
    let better = |a: &&FrontMember, b: &&FrontMember| a.violation.total_cmp(&b.violation).then(a.f2.total_cmp(&b.f2));
    let best = front.iter().min_by(better).ok_or_else(empty)?;
    let knee = &front[deployed(&front)];
    let feasible = front.iter().filter(|member| member.is_feasible());
    let planned = &plan.scenarios[unit.scenario];
    Ok(RunRow {
        scenario: planned.name.clone(),
        method: plan.methods[unit.method].name.clone(),
        seed: unit.seed,
        evaluations: unit.evaluations(plan),
        members: front.len(),
        best_f2: best.f2,
        best_nodes: best.nodes,
        best_violation: best.violation,
        knee_f2: knee.f2,
        knee_nodes: knee.nodes,
        knee_violation: knee.violation,
        hypervolume: front_hypervolume(feasible.map(|member| [member.nodes as f64, member.f2])),
        cost: costs.map(|(mean, _)| mean),
        worst_cost: costs.map(|(_, worst)| worst),
    })
}

fn summary(measure: Measure, rows: &[&RunRow]) -> Option<Summary> {
    let values: Vec<f64> = rows.iter().map(|run| measure.of(run)).collect();
    let quartiles = quartiles(&values)?;
    let first = rows.first()?;
    Some(Summary {
        scenario: first.scenario.clone(),
        method: first.method.clone(),
        measure,
        runs: rows.len(),
        feasible: rows.iter().filter(|run| run.best_violation == 0.0).count(),
        lower: quartiles.lower,
        median: quartiles.median,
        upper: quartiles.upper,
    })
}

fn comparison(measure: Measure, rows: &[&RunRow], against: &[&RunRow]) -> Option<Comparison> {
    let costs = |rows: &[&RunRow]| -> Vec<f64> { rows.iter().map(|run| measure.cost(run)).collect() };
    let median = |rows: &[&RunRow]| summary(measure, rows).map(|summary| summary.median);
    let (ours, theirs) = (costs(rows), costs(against));
    let p = mann_whitney(&ours, &theirs)?;
    Some(Comparison {
        scenario: rows.first()?.scenario.clone(),
        measure,
        method: rows.first()?.method.clone(),
        baseline: against.first()?.method.clone(),
        median: median(rows)?,
        baseline_median: median(against)?,
        p,
        p_holm: p,
        a12: a12(&ours, &theirs),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_trial_is_one_of_one_and_one_run_is_its_value() {
        let row = |runs, low, high| TransferRow {
            transfer: "t".into(),
            world: String::new(),
            from: String::new(),
            method: "m".into(),
            runs,
            worlds: 1,
            successes: runs,
            rate: 1.0,
            low,
            high,
            median_f2: 0.1,
        };
        assert_eq!(row(1, None, None).rate_words(), "1 of 1");
        assert_eq!(row(30, Some(0.88), Some(1.0)).rate_words(), "100.0 % (88.0 to 100.0)");
        let summary = |runs| Summary {
            scenario: "s".into(),
            method: "m".into(),
            measure: Measure::BestF2,
            runs,
            feasible: runs,
            lower: 1.0,
            median: 2.0,
            upper: 3.0,
        };
        let number = |value: f64| format!("{value}");
        assert_eq!(
            (summary(1).quartile_words(number), summary(3).quartile_words(number)),
            ("2".into(), "2 (1 to 3)".into())
        );
    }
}
