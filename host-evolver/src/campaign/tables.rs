//! What a campaign says in numbers, made from the files of its units.

use super::plan::Plan;
use super::trial::Trial;
use super::unit::Unit;
use crate::evolve::{FrontMember, deployed, front_hypervolume};
use crate::files::{self, Contents, FileError};
use grn_optimisers::statistics::{a12, bootstrap_rate, holm, mann_whitney, quartiles, wilson};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// What an infeasible model counts as where f2 is compared: worse than every feasible one, by its violation.
const INFEASIBLE: f64 = 2.0;

/// What is measured of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// f2 of the best feasible model of the front; 2 and the violation if none is feasible.
    BestF2,
    /// Its nodes.
    BestNodes,
    /// f2 of the knee that is deployed; 2 and the violation if it is infeasible.
    KneeF2,
    /// Its nodes.
    KneeNodes,
    /// Share of the box below the reference that the feasible front dominates.
    Hypervolume,
}

impl Measure {
    /// All of them.
    pub const ALL: [Measure; 5] =
        [Measure::BestF2, Measure::BestNodes, Measure::KneeF2, Measure::KneeNodes, Measure::Hypervolume];

    /// What it is called where there is room.
    pub fn words(self) -> &'static str {
        match self {
            Measure::BestF2 => "f2 of the best model",
            Measure::BestNodes => "nodes of the best model",
            Measure::KneeF2 => "f2 of the knee",
            Measure::KneeNodes => "nodes of the knee",
            Measure::Hypervolume => "hypervolume",
        }
    }

    /// What it is called where there is little.
    pub fn short(self) -> &'static str {
        match self {
            Measure::BestF2 => "best f2",
            Measure::BestNodes => "best nodes",
            Measure::KneeF2 => "knee f2",
            Measure::KneeNodes => "knee nodes",
            Measure::Hypervolume => "hypervolume",
        }
    }

    /// What it is of a run.
    pub fn of(self, run: &RunRow) -> f64 {
        let with_penalty = |f2: f64, violation: f64| if violation == 0.0 { f2 } else { INFEASIBLE + violation };
        match self {
            Measure::BestF2 => with_penalty(run.best_f2, run.best_violation),
            Measure::BestNodes => run.best_nodes as f64,
            Measure::KneeF2 => with_penalty(run.knee_f2, run.knee_violation),
            Measure::KneeNodes => run.knee_nodes as f64,
            Measure::Hypervolume => run.hypervolume,
        }
    }

    /// The same with its sign such that less is better.
    fn cost(self, run: &RunRow) -> f64 {
        if self == Measure::Hypervolume { -self.of(run) } else { self.of(run) }
    }
}

/// A run: a line of `results.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunRow {
    /// Scenario evolved for.
    pub scenario: String,
    /// Method.
    pub method: String,
    /// Seed.
    pub seed: u64,
    /// Budget spent.
    pub evaluations: usize,
    /// Models on the front.
    pub members: usize,
    /// Least f2 of the front.
    pub best_f2: f64,
    /// Nodes of that model.
    pub best_nodes: usize,
    /// Its violation; 0 if the run found anything feasible.
    pub best_violation: f64,
    /// f2 of the knee.
    pub knee_f2: f64,
    /// Nodes of the knee.
    pub knee_nodes: usize,
    /// Violation of the knee.
    pub knee_violation: f64,
    /// Share of the box below the reference that the feasible front dominates.
    pub hypervolume: f64,
}

/// Quartiles over the seeds: a line of `summary.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Scenario evolved for.
    pub scenario: String,
    /// Method.
    pub method: String,
    /// What is measured.
    pub measure: Measure,
    /// Runs.
    pub runs: usize,
    /// Runs that found a feasible model.
    pub feasible: usize,
    /// First quartile.
    pub lower: f64,
    /// Median.
    pub median: f64,
    /// Third quartile.
    pub upper: f64,
}

/// A method against a baseline: a line of `comparisons.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// Scenario evolved for.
    pub scenario: String,
    /// What is compared.
    pub measure: Measure,
    /// Method.
    pub method: String,
    /// What it is compared with.
    pub baseline: String,
    /// Median of the method.
    pub median: f64,
    /// Median of the baseline.
    pub baseline_median: f64,
    /// Two-sided p of the Mann-Whitney U test.
    pub p: f64,
    /// The same after Holm's correction over all lines of the table.
    pub p_holm: f64,
    /// Vargha-Delaney A12: the probability that a run of the method is better than one of the baseline.
    pub a12: f64,
}

/// A success rate over runs and worlds: a line of `transfers.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TransferRow {
    /// The worlds tried in.
    pub transfer: String,
    /// The scenario evolved for; empty for a given model.
    pub from: String,
    /// The method, or the given model's name.
    pub method: String,
    /// Runs whose knee was tried.
    pub runs: usize,
    /// Worlds tried in.
    pub worlds: usize,
    /// Trials that were feasible at every snapshot.
    pub successes: usize,
    /// Share of successes.
    pub rate: f64,
    /// Lower end of the 95 % interval: of the bootstrap over runs and worlds; Wilson's for a given model, and where every
    /// trial ended alike, then for as many trials as there are runs or worlds, whichever are more. A single trial is a
    /// fact: both ends are the rate.
    pub low: Option<f64>,
    /// Upper end.
    pub high: Option<f64>,
    /// Median f2 of the trials; an infeasible one counts as 2 and its violation.
    pub median_f2: f64,
}

impl TransferRow {
    /// Trials: runs times worlds.
    pub fn trials(&self) -> usize {
        self.runs * self.worlds
    }

    /// The rate and its interval as a person reads them, `80.0 % (63.0 to 90.0)`; of a single trial `1 of 1`.
    pub fn rate_words(&self) -> String {
        match (self.low, self.high) {
            (Some(low), Some(high)) if self.trials() > 1 => {
                format!("{:.1} % ({:.1} to {:.1})", 100.0 * self.rate, 100.0 * low, 100.0 * high)
            }
            _ => format!("{} of {}", self.successes, self.trials()),
        }
    }
}

impl Summary {
    /// The median and its quartiles as a person reads them, each by `number`; of a single run its value.
    pub fn quartile_words(&self, number: impl Fn(f64) -> String) -> String {
        match self.runs {
            1 => number(self.median),
            _ => format!("{} ({} to {})", number(self.median), number(self.lower), number(self.upper)),
        }
    }
}

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
}

impl Tables {
    /// The tables from the units in the folder, and from trials with their group's name and the world's number.
    pub(super) fn of(
        plan: &Plan,
        campaign: &Path,
        trials: Vec<(&str, usize, Vec<Trial>)>,
    ) -> Result<Tables, FileError> {
        let runs =
            Unit::all(plan).into_iter().map(|unit| run_row(unit, plan, campaign)).collect::<Result<Vec<_>, _>>()?;
        let mut tables = Tables { transfers: transfer_rows(&trials), ..Tables::default() };
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

    /// `results.csv`, `summary.csv`, `comparisons.csv` and `transfers.csv`.
    pub(super) fn contents(&self) -> Contents {
        Contents::from([
            ("results.csv".into(), files::csv_records(&self.runs)),
            ("summary.csv".into(), files::csv_records(&self.summaries)),
            ("comparisons.csv".into(), files::csv_records(&self.comparisons)),
            ("transfers.csv".into(), files::csv_records(&self.transfers)),
        ])
    }

    pub(super) fn read(campaign: &Path) -> Result<Tables, FileError> {
        Ok(Tables {
            runs: files::read_csv(&campaign.join("results.csv"))?,
            summaries: files::read_csv(&campaign.join("summary.csv"))?,
            comparisons: files::read_csv(&campaign.join("comparisons.csv"))?,
            transfers: files::read_csv(&campaign.join("transfers.csv"))?,
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
