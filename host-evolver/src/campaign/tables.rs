//! What a campaign says in numbers, made from the files of its units.

use super::plan::Plan;
use super::rows::{Comparison, INFEASIBLE, Measure, RunRow, SimulationRow, SimulationSummary, Summary, TransferRow};
use super::simulate::Simulate;
use super::trial::Trial;
use super::unit::Unit;
use crate::evolve::{FrontMember, deployed, front_hypervolume};
use crate::files::{self, Contents, FileError};
use crate::realities::{Reality, Robustness};
use grn_optimisers::statistics::{a12, bootstrap_rate, holm, mann_whitney, quartiles, wilson};
use std::collections::BTreeMap;
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
    /// The tables from the units in the folder, from trials with their group's name and the world's number, and from realities.
    pub(super) fn of(
        plan: &Plan,
        campaign: &Path,
        trials: Vec<(&str, usize, Vec<Trial>)>,
        simulations: &[(Unit, Vec<Reality>)],
    ) -> Result<Tables, FileError> {
        let runs =
            Unit::all(plan).into_iter().map(|unit| run_row(unit, plan, campaign)).collect::<Result<Vec<_>, _>>()?;
        let mut tables = Tables { transfers: transfer_rows(&trials), ..Tables::default() };
        if let Some(simulate) = &plan.simulate {
            (tables.simulations, tables.simulated) = simulation_rows(plan, simulate, simulations);
        }
        for scenario in plan.scenarios.iter().map(|planned| planned.scenario.name()) {
            let rows_of = |method: &str| -> Vec<&RunRow> {
                runs.iter().filter(|run| run.scenario == scenario && run.method == method).collect()
            };
            for planned in &plan.methods {
                let rows = rows_of(&planned.name);
                tables.summaries.extend(Measure::ALL.iter().filter_map(|&measure| summary(measure, &rows)));
            }
            for measure in Measure::ALL {
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

fn run_row(unit: Unit, plan: &Plan, campaign: &Path) -> Result<RunRow, FileError> {
    let front = unit.front(plan, campaign)?;
    let empty = || FileError::new(campaign.join(unit.folder(plan)), "the front is empty; delete this run");
    let better = |a: &&FrontMember, b: &&FrontMember| a.violation.total_cmp(&b.violation).then(a.f2.total_cmp(&b.f2));
    let best = front.iter().min_by(better).ok_or_else(empty)?;
    let knee = &front[deployed(&front)];
    let feasible = front.iter().filter(|member| member.is_feasible());
    let planned = &plan.scenarios[unit.scenario];
    Ok(RunRow {
        scenario: planned.scenario.name().into(),
        method: plan.methods[unit.method].name.clone(),
        seed: unit.seed,
        evaluations: planned.evaluations,
        members: front.len(),
        best_f2: best.f2,
        best_nodes: best.nodes,
        best_violation: best.violation,
        knee_f2: knee.f2,
        knee_nodes: knee.nodes,
        knee_violation: knee.violation,
        hypervolume: front_hypervolume(feasible.map(|member| [member.nodes as f64, member.f2])),
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

/// The 95 % interval of a success rate over runs and worlds; a single trial has none.
fn interval(succeeded: &[Vec<bool>]) -> Option<(f64, f64)> {
    let worlds = succeeded.iter().map(Vec::len).max().unwrap_or(0);
    let successes = succeeded.iter().flatten().filter(|&&success| success).count();
    let count: usize = succeeded.iter().map(Vec::len).sum();
    let independent = succeeded.len().max(worlds);
    match successes {
        _ if count <= 1 => None,
        _ if succeeded.len() == 1 => Some(wilson(successes, count)),
        0 => Some(wilson(0, independent)),
        _ if successes == count => Some(wilson(independent, independent)),
        _ => Some(bootstrap_rate(succeeded)),
    }
}

fn transfer_rows(trials: &[(&str, usize, Vec<Trial>)]) -> Vec<TransferRow> {
    // In the order of the plan: groups as they come, in each the sources as they come.
    let mut sources: Vec<(&str, &str, &str)> = Vec::new();
    let mut outcomes: BTreeMap<(usize, u64), Vec<&Trial>> = BTreeMap::new();
    for (group, _, trials) in trials {
        for trial in trials {
            let source = (*group, trial.scenario.as_str(), trial.method.as_str());
            let place = sources.iter().position(|known| *known == source).unwrap_or_else(|| {
                sources.push(source);
                sources.len() - 1
            });
            outcomes.entry((place, trial.seed)).or_default().push(trial);
        }
    }
    let row = |(place, &(transfer, from, method)): (usize, &(&str, &str, &str))| {
        let runs: Vec<&Vec<&Trial>> =
            outcomes.range((place, 0)..=(place, u64::MAX)).map(|(_, trials)| trials).collect();
        let succeeded: Vec<Vec<bool>> =
            runs.iter().map(|trials| trials.iter().map(|trial| trial.violation == 0.0).collect()).collect();
        let count: usize = succeeded.iter().map(Vec::len).sum();
        let successes = succeeded.iter().flatten().filter(|&&success| success).count();
        let interval = interval(&succeeded);
        let f2 = |trial: &&&Trial| if trial.violation == 0.0 { trial.f2 } else { INFEASIBLE + trial.violation };
        let all: Vec<f64> = runs.iter().flat_map(|trials| trials.iter()).map(|trial| f2(&trial)).collect();
        TransferRow {
            transfer: transfer.into(),
            from: from.into(),
            method: method.into(),
            runs: runs.len(),
            worlds: runs.first().map_or(0, |trials| trials.len()),
            successes,
            rate: successes as f64 / count.max(1) as f64,
            low: interval.map(|ends| ends.0),
            high: interval.map(|ends| ends.1),
            median_f2: quartiles(&all).map_or(f64::NAN, |quartiles| quartiles.median),
        }
    };
    sources.iter().enumerate().map(row).collect()
}

fn simulation_rows(
    plan: &Plan,
    simulate: &Simulate,
    simulations: &[(Unit, Vec<Reality>)],
) -> (Vec<SimulationRow>, Vec<SimulationSummary>) {
    let count = simulate.realities as usize;
    let median = |realities: &[Reality], measure: &dyn Fn(&Reality) -> f64| {
        Robustness { realities: realities.to_vec() }.quantile(0.5, measure)
    };
    let mean = |realities: &[Reality], measure: &dyn Fn(&Reality) -> f64| {
        (!realities.is_empty()).then(|| Robustness { realities: realities.to_vec() }.mean(measure))
    };
    let row = |(unit, realities): &(Unit, Vec<Reality>)| {
        // A knee that cannot drive a robot works nowhere.
        let works = realities.iter().filter(|reality| reality.works).count();
        let (low, high) = wilson(works, count);
        let error = |reality: &Reality| reality.radial_error_share.unwrap_or(f64::INFINITY);
        SimulationRow {
            scenario: plan.scenarios[unit.scenario].scenario.name().into(),
            method: plan.methods[unit.method].name.clone(),
            seed: unit.seed,
            laboratory: simulate.lab.name.clone(),
            realities: count,
            works,
            rate: works as f64 / count as f64,
            low,
            high,
            caged: mean(realities, &|reality| reality.caged_share).unwrap_or(0.0),
            cost: mean(realities, &|reality| reality.cost),
            radial_error: median(realities, &error).filter(|error| error.is_finite()),
        }
    };
    // Runs come by scenario and method.
    let groups = simulations.chunk_by(|(a, _), (b, _)| (a.scenario, a.method) == (b.scenario, b.method));
    let summary = |group: &[(Unit, Vec<Reality>)]| {
        let works = |realities: &[Reality]| match realities {
            [] => vec![false; count],
            realities => realities.iter().map(|reality| reality.works).collect(),
        };
        let succeeded: Vec<Vec<bool>> = group.iter().map(|(_, realities)| works(realities)).collect();
        let works = succeeded.iter().flatten().filter(|&&works| works).count();
        let (first, interval) = (group.first()?.0, interval(&succeeded));
        Some(SimulationSummary {
            scenario: plan.scenarios[first.scenario].scenario.name().into(),
            method: plan.methods[first.method].name.clone(),
            laboratory: simulate.lab.name.clone(),
            runs: group.len(),
            realities: count,
            works,
            rate: works as f64 / (group.len() * count) as f64,
            low: interval.map(|ends| ends.0),
            high: interval.map(|ends| ends.1),
        })
    };
    (simulations.iter().map(row).collect(), groups.filter_map(summary).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_trial_is_one_of_one_and_one_run_is_its_value() {
        let row = |runs, low, high| TransferRow {
            transfer: "t".into(),
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

    #[test]
    fn intervals_tell_what_was_sampled() {
        assert_eq!(interval(&[vec![true]]), None, "one trial tells of no spread");
        let (low, high) = interval(&[vec![true, false, true, true]]).unwrap();
        assert!(low < 0.75 && 0.75 < high);
        let (low, high) = interval(&vec![vec![false; 200]; 30]).unwrap();
        assert!(low == 0.0 && (0.015..0.02).contains(&high), "30 runs of 200 worlds are not 6000 trials: {high}");
        let (low, high) = interval(&vec![vec![true]; 30]).unwrap();
        assert!((0.88..0.89).contains(&low) && high == 1.0, "{low}");
        let (low, high) = interval(&[vec![true, false], vec![true, true], vec![false, false]]).unwrap();
        assert!(low < 0.5 && 0.5 < high);
    }
}
