//! The report that `cargo xtask reproduce` writes: each claim of the paper, our verdict, and the figures behind it.

pub mod adaptive;
mod claims;
mod sensitivity;

use host_evolver::campaign::{Comparison, Measure, Summary, Tables, TransferRow};
use std::fmt;

/// What the report is made from.
pub struct Campaigns {
    /// The paper's experiments.
    pub paper: Tables,
    /// One number at a time changed.
    pub sensitivity: Tables,
    /// Other numbers of DE generations.
    pub de: Tables,
}

/// A line that a table should have and has not.
#[derive(Debug)]
pub struct Missing(String);

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} is in no table; were the campaigns run with campaigns/*.toml as they are?", self.0)
    }
}

impl std::error::Error for Missing {}

const ALL: &str = "MOGP, all motifs";
const BINARY: &str = "MOGP, binary motifs";
const EH_1: &str = "EH-GRN, structure 1";
const EH_2: &str = "EH-GRN, structure 2";
const CHANNEL: &str = "channel";
const COMPOUND: &str = "compound-channel";
const NAND_XNOR: &str = "printed NAND-XNOR (1 B)";
const ANDN_XNOR: &str = "printed ANDN-XNOR (2 A)";
const ANDN_NAND_XNOR: &str = "printed ANDN-NAND-XNOR (2 B)";
const PRINTED_EH_1: &str = "printed EH-GRN (task 1)";
const PRINTED_EH_2: &str = "printed EH-GRN (task 2)";

/// Looking lines up.
trait Look {
    fn summary(&self, scenario: &str, method: &str, measure: Measure) -> Result<&Summary, Missing>;
    fn comparison(
        &self,
        scenario: &str,
        method: &str,
        baseline: &str,
        measure: Measure,
    ) -> Result<&Comparison, Missing>;
    fn transfer(&self, transfer: &str, from: &str, method: &str) -> Result<&TransferRow, Missing>;
}

impl Look for Tables {
    fn summary(&self, scenario: &str, method: &str, measure: Measure) -> Result<&Summary, Missing> {
        let found = self
            .summaries
            .iter()
            .find(|row| row.scenario == scenario && row.method == method && row.measure == measure);
        found.ok_or_else(|| Missing(format!("{} of {method} in {scenario}", measure.words())))
    }

    fn comparison(
        &self,
        scenario: &str,
        method: &str,
        baseline: &str,
        measure: Measure,
    ) -> Result<&Comparison, Missing> {
        let is_it = |row: &&Comparison| {
            row.scenario == scenario && row.method == method && row.baseline == baseline && row.measure == measure
        };
        let found = self.comparisons.iter().find(is_it);
        found.ok_or_else(|| Missing(format!("{} of {method} against {baseline} in {scenario}", measure.words())))
    }

    fn transfer(&self, transfer: &str, from: &str, method: &str) -> Result<&TransferRow, Missing> {
        let found =
            self.transfers.iter().find(|row| row.transfer == transfer && row.from == from && row.method == method);
        found.ok_or_else(|| Missing(format!("{method} of {from:?} in {transfer}")))
    }
}

/// `12.3 % (10.1 to 14.5)`, of a single trial `1 of 1`.
fn percent(row: &TransferRow) -> String {
    row.rate_words()
}

/// `0.0135 (0.0134 to 0.0136)`, whole numbers for nodes.
fn quartiles(row: &Summary) -> String {
    let number = |value: f64| match row.measure {
        Measure::BestNodes | Measure::KneeNodes => format!("{value}"),
        _ if value >= 2.0 => "infeasible".into(),
        _ => format!("{value:.5}"),
    };
    row.quartile_words(number)
}

/// `p < 0.0001` or `p = 0.0123`.
fn p_value(p: f64) -> String {
    if p < 1e-4 { "p < 0.0001".into() } else { format!("p = {p:.4}") }
}

/// The whole page.
///
/// # Errors
/// A table without a line that the page needs.
pub fn report(campaigns: &Campaigns) -> Result<String, Missing> {
    let seeds = campaigns.paper.summary(CHANNEL, ALL, Measure::BestF2)?.runs;
    let mut page = format!(
        "# The paper, reproduced\n\n\
         Fan et al. 2019, *An Automatic Design Framework of Swarm Pattern Formation based on Multi-objective Genetic \
         Programming*, in our reading (`docs/model.md`), run again with {seeds} seeds a method. `cargo xtask reproduce` makes this page and \
         everything in `docs/reproduction/` from three campaigns (`campaigns/*.toml`); nothing here is written by hand \
         but the words. The figures of the paper are lost, so the geometry of the worlds is ours.\n\n\
         Medians are given with quartiles over seeds, success rates with 95 % intervals (Wilson's for a given model, \
         else a bootstrap over runs and worlds). Tests are two-sided Mann-Whitney U tests, p after Holm's correction \
         over all lines of `comparisons.csv`; A12 is the probability that a run of the first method is better than one \
         of the second. An infeasible run counts as worse than every feasible one.\n\n"
    );
    page += &claims::section(&campaigns.paper)?;
    page += &claims::tables(&campaigns.paper);
    page += &claims::pictures();
    page += &sensitivity::section(&campaigns.sensitivity)?;
    page += &sensitivity::generations(&campaigns.de);
    page += READINGS;
    Ok(page)
}

const READINGS: &str = "\
## Where our reading had to choose

| question | our choice | why |
|---|---|---|
| Geometry of channel and compound channel | `scenarios/*.toml` | the figures are lost; widths are such that the printed models behave as the text says |
| What \"points above a percentage of the maximum\" are | the contour M = L, L half way between M(0,0) and M(1,0) | one printed model has its minimum at the target, so no filled region fits all |
| σ_t, σ_o, kernel | 1.5 m, 0.9 m, Gaussian | with these every printed ring lies within d_min and d_max; see the sensitivity table |
| Two printed equations of EH-GRN that do not agree with its drawing | the drawing | the equations read a concentration that is not there |
| Obstacle points of f2 | every 0.5 m of the walls within 5 m of a target | what mother robots perceive |
| Candidate points | 48 a ring, equally spaced | the paper gives no number |
| Feasible | every target enclosed at every snapshot, every candidate point at least 0.05 m from walls | \"can not collide\" |
| Motifs with one or more than two inputs | two rows: all ten, and the eight binary ones | the paper's fronts have 3, 5, 7, … nodes, which only binary motifs give |
| DE generations an individual gets | one | see the table of generations |
| CMA-ES | the tutorial's defaults with the damping of pycma 4.5.0, without negative weights, as in the version of 2001 that the paper cites; mean at random in [0, 2], σ = 0.6, samples folded into the box; started again when it has converged | the paper says population 40 and [0, 2] only |
| Size of EH-GRN | 19 nodes: its genes and the inputs they read, counted like a tree | so that both methods are counted alike |
| The model that is transferred | the knee by marginal utility; EH-GRN's best | what would be deployed |
| Hypervolume | of feasible models, reference 32 nodes and f2 = 0.2, as a share of that box | stated so that others can compare |
| Random obstacles | discs of 0.3 to 0.9 m over 5 % of 25 m x 25 m, at least 1.45 m from the target's path | announced by the paper without numbers; narrower than the compound channel's narrowest half width of 1.8 m |
";
