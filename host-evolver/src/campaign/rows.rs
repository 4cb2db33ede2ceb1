//! The lines of a campaign's tables, and what is measured of a run.

use firmware_sim::metrics::WORST_COST;
use serde::{Deserialize, Serialize};

/// What an infeasible model counts as where f2 is compared: worse than every feasible one, by its violation.
pub(super) const INFEASIBLE: f64 = 2.0;

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
    /// Cost J of the knee on simulated swarms, mean over training worlds and realities.
    Cost,
}

impl Measure {
    /// All of them; the last is of campaigns that simulate knees.
    pub const ALL: [Measure; 6] =
        [Measure::BestF2, Measure::BestNodes, Measure::KneeF2, Measure::KneeNodes, Measure::Hypervolume, Measure::Cost];

    /// What it is called where there is room.
    pub fn words(self) -> &'static str {
        match self {
            Measure::BestF2 => "f2 of the best model",
            Measure::BestNodes => "nodes of the best model",
            Measure::KneeF2 => "f2 of the knee",
            Measure::KneeNodes => "nodes of the knee",
            Measure::Hypervolume => "hypervolume",
            Measure::Cost => "cost J of the knee",
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
            Measure::Cost => "cost J",
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
            Measure::Cost => run.cost.unwrap_or(WORST_COST),
        }
    }

    /// The same with its sign such that less is better.
    pub(super) fn cost(self, run: &RunRow) -> f64 {
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
    /// Cost J of the knee, mean over the realities in which it was simulated in the training worlds; nothing if it was not, or cannot
    /// drive a robot.
    pub cost: Option<f64>,
    /// The same in the training world in which it is highest.
    pub worst_cost: Option<f64>,
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
    /// The transfer tried in, or the scenario.
    pub transfer: String,
    /// Which of its worlds; empty: all of them together.
    pub world: String,
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

/// What became of a run's knee in simulated laboratories, in one world: a line of `simulations.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SimulationRow {
    /// Scenario evolved for.
    pub scenario: String,
    /// Method.
    pub method: String,
    /// Seed of the run.
    pub seed: u64,
    /// The transfer that the world is of; empty for a training world.
    pub transfer: String,
    /// The world simulated in.
    pub world: String,
    /// The laboratory.
    pub laboratory: String,
    /// Realities around it.
    pub realities: usize,
    /// In how many of them it works.
    pub works: usize,
    /// The same as a share.
    pub rate: f64,
    /// Lower end of Wilson's 95 % interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Mean share of the time in which targets were caged; 0 for a knee that cannot drive a robot.
    pub caged: f64,
    /// Mean cost J; nothing for a knee that cannot drive a robot.
    pub cost: Option<f64>,
    /// Median radial error as a share of the ring's radius; where it is not known it is longer than any other, and nothing if
    /// that is the median.
    pub radial_error: Option<f64>,
}

/// All knees of a method in simulated laboratories, in the training worlds or those of a transfer: a line of
/// `simulation-summary.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SimulationSummary {
    /// Scenario evolved for.
    pub scenario: String,
    /// Method.
    pub method: String,
    /// The transfer that the worlds are of; empty for the training worlds.
    pub transfer: String,
    /// Which of the worlds; empty: all of them together.
    pub world: String,
    /// The laboratory.
    pub laboratory: String,
    /// Knees that were simulated.
    pub runs: usize,
    /// Worlds that each was simulated in.
    pub worlds: usize,
    /// Realities in each of them.
    pub realities: usize,
    /// Simulations that work.
    pub works: usize,
    /// The same as a share.
    pub rate: f64,
    /// Lower end of the 95 % interval, made as that of [`TransferRow::low`].
    pub low: Option<f64>,
    /// Upper end.
    pub high: Option<f64>,
    /// Mean share of the time in which targets were caged; a knee that cannot drive a robot cages nothing.
    pub caged: f64,
    /// The same of each knee in the world in which it is lowest for it, mean over knees.
    pub worst_caged: f64,
    /// Mean cost J; a knee that cannot drive a robot has the highest possible.
    pub cost: f64,
    /// The same of each knee in the world in which it is highest for it, mean over knees.
    pub worst_cost: f64,
}

impl SimulationSummary {
    /// The rate and its interval as a person reads them.
    pub fn rate_words(&self) -> String {
        rate_words(self.works, self.simulations(), self.rate, self.low.zip(self.high))
    }

    /// Simulations: runs times worlds times realities.
    pub fn simulations(&self) -> usize {
        self.runs * self.worlds * self.realities
    }

    /// What the worlds are called where they stand in one column.
    pub fn worlds_words(&self) -> &str {
        match (self.transfer.as_str(), self.world.as_str()) {
            ("", "") if self.worlds == 1 => "its world",
            ("", "") => "all its worlds",
            (transfer, "") => transfer,
            (_, world) => world,
        }
    }
}

/// `80.0 % (63.0 to 90.0)`; of a single trial `1 of 1`.
fn rate_words(successes: usize, trials: usize, rate: f64, interval: Option<(f64, f64)>) -> String {
    match interval {
        Some((low, high)) if trials > 1 => {
            format!("{:.1} % ({:.1} to {:.1})", 100.0 * rate, 100.0 * low, 100.0 * high)
        }
        _ => format!("{successes} of {trials}"),
    }
}

impl TransferRow {
    /// What the worlds are called where they stand in one column.
    pub fn worlds_words(&self) -> &str {
        if self.world.is_empty() { &self.transfer } else { &self.world }
    }

    /// Trials: runs times worlds.
    pub fn trials(&self) -> usize {
        self.runs * self.worlds
    }

    /// The rate and its interval as a person reads them.
    pub fn rate_words(&self) -> String {
        rate_words(self.successes, self.trials(), self.rate, self.low.zip(self.high))
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
