//! `grn campaign`.

use super::{Answer, Failure, conditions, interrupt, options, output, progress, robustness, this_command};
use crate::campaign::{
    Campaign, Listener, Maker, Measure, Plan, Shard, Simulate, SimulationSummary, Stage, Tables, Team, follow,
};
use crate::cluster::{self, Follower, Leader, Role};
use firmware_sim::lab;
use grn_input::file_name;
use indicatif::ProgressBar;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// Where progress cannot be drawn it is told this often.
const SELDOM: Duration = Duration::from_secs(30);

#[derive(clap::Args)]
pub struct Arguments {
    /// The campaign: scenarios, methods, models, transfers, seeds.
    file: PathBuf,
    /// Folder of the campaign, new, empty, or with this campaign, which may have got more seeds: runs that are there whole are
    /// not done again [default: runs/NAME].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads to work with, of each rank if there are several, up to 8 a core; the results do not depend on it [default: all
    /// cores, or a rank's share of its machine's].
    #[arg(long, value_parser = options::threads, allow_hyphen_values = true)]
    threads: Option<NonZeroUsize>,
    /// Do only the runs of one part of several, for instance 2/3.
    #[arg(long, value_name = "I/N", allow_hyphen_values = true)]
    shard: Option<Shard>,
    /// Take over the runs of this folder first; may be given several times.
    #[arg(long, value_name = "DIR")]
    merge: Vec<PathBuf>,
    /// Simulate the knee of each run in this laboratory, one of those that `grn lab` lists or a file [default: what the campaign
    /// says in [simulate], if anything].
    #[arg(long, value_name = "NAME|FILE")]
    lab: Option<String>,
    /// Replace one value of the laboratory, such as radio.loss=0.3; may be given several times.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// In so many laboratories drawn around it [default: the campaign's, or 20].
    #[arg(long, value_name = "N", value_parser = robustness::count, allow_hyphen_values = true)]
    realities: Option<u64>,
}

impl Arguments {
    /// What is simulated: what the campaign says, with what the command line says instead.
    fn simulate(&self, planned: Option<Simulate>) -> Result<Option<Simulate>, Failure> {
        if self.lab.is_none() && self.set.is_empty() && self.realities.is_none() {
            return Ok(planned);
        }
        let mut simulate = planned.unwrap_or_default();
        if let Some(lab) = &self.lab {
            simulate.lab = lab::find(lab)?;
        }
        simulate.lab = conditions::set_all(simulate.lab, &self.set)?;
        simulate.realities = self.realities.unwrap_or(simulate.realities);
        Ok(Some(simulate))
    }
}

pub fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    match cluster::join()? {
        Role::Alone => lead(arguments, None),
        Role::Leader(leader) => lead(arguments, Some(leader)),
        Role::Follower(follower) => help(arguments, &follower),
    }
}

/// Reads and checks the campaign, with what the command line says instead.
fn planned(arguments: &Arguments) -> Result<Plan, Failure> {
    let mut plan = Plan::load(&arguments.file)?;
    plan.simulate = arguments.simulate(plan.simulate.take())?;
    plan.worlds_simulated_in().try_for_each(|world| conditions::check_set(&arguments.set, world, world.name()))?;
    plan.check_simulations()?;
    Ok(plan)
}

/// Leads the campaign: alone, or with others that make its units, too.
fn lead(arguments: &Arguments, mut leader: Option<Leader>) -> Result<Answer, Failure> {
    let plan = planned(arguments)?;
    let folder = arguments.out.clone().unwrap_or_else(|| Path::new("runs").join(file_name(&plan.name)));
    let stop = interrupt::watch()?;
    arguments.merge.iter().try_for_each(|other| Campaign::check_merge(&plan, &folder, other))?;
    let campaign = Campaign::begin(plan, &folder, &this_command())?;
    let progress = Progress::new(campaign.work());
    for other in &arguments.merge {
        let taken = campaign.merge(other, &progress)?;
        progress.notice(&format!("{taken} runs taken over from {}", other.display()));
    }
    if let Some(leader) = &mut leader {
        leader.gather(&campaign.plan().identity())?;
    }
    let share = leader.as_ref().and_then(|leader| NonZeroUsize::new(leader.threads()));
    let mut team = Team::new(options::pool(arguments.threads.or(share))?, leader);
    let stage = campaign.run(arguments.shard.unwrap_or(Shard::WHOLE), &mut team, &stop, &progress)?;
    progress.bar.finish_and_clear();
    let stopped = stop.load(Ordering::Relaxed);
    match stage {
        Stage::Done(tables) => {
            output::report(text(&tables));
            output::report(format!("\ntables and figures in {}", folder.display()));
            Ok(Answer::Yes)
        }
        stage if stopped => Err(Failure::Interrupted(format!("{stage}; go on with the same command"))),
        stage => {
            output::report(format!(
                "{stage} in {}; the tables follow when all are: run the other parts, then once more with --merge",
                folder.display()
            ));
            Ok(Answer::Yes)
        }
    }
}

/// Makes units for the leader. It has the folder and says all there is to say, also why this process cannot take part.
fn help(arguments: &Arguments, follower: &Follower) -> Result<Answer, Failure> {
    let ready = || -> Result<_, Failure> {
        let pool = options::pool(arguments.threads.or(NonZeroUsize::new(follower.threads())))?;
        Ok((interrupt::watch()?, pool, planned(arguments)?))
    };
    let ready = ready();
    let identity = match &ready {
        Ok((.., plan)) => Ok(plan.identity()),
        Err(failure) => Err(failure.message().unwrap_or_default().to_owned()),
    };
    if let (true, Ok((stop, pool, plan))) = (follower.join(identity)?, ready) {
        follow(follower, &pool, &Maker::new(&plan), &stop, &arguments.file)?;
    }
    Ok(Answer::Yes)
}

struct Progress {
    bar: ProgressBar,
    found: progress::Found,
    told: std::sync::Mutex<Instant>,
}

impl Progress {
    fn new(work: u64) -> Progress {
        let found = progress::Found::default();
        let style = progress::style("campaign {bar:40} {percent} % · {elapsed} · {left}", &found);
        let bar = ProgressBar::new(work).with_style(style);
        bar.enable_steady_tick(Duration::from_millis(500));
        Progress { bar, found, told: std::sync::Mutex::new(Instant::now()) }
    }
}

impl Listener for Progress {
    fn notice(&self, text: &str) {
        self.bar.suspend(|| output::notice(text));
    }

    fn found(&self, evaluations: u64) {
        self.found.add(evaluations);
        self.bar.inc(evaluations);
    }

    fn done(&self, evaluations: u64) {
        self.bar.inc(evaluations);
        let mut told = self.told.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if self.bar.is_hidden() && told.elapsed() > SELDOM {
            *told = Instant::now();
            let (position, total) = (self.bar.position(), self.bar.length().unwrap_or(1).max(1));
            let left = progress::words(self.found.left(self.bar.elapsed(), position, total));
            output::notice(format_args!("{} %, {left}", 100 * position / total));
        }
    }
}

/// The tables as a person reads them.
fn text(tables: &Tables) -> String {
    let number = |measure: Measure, value: f64| match measure {
        Measure::BestNodes | Measure::KneeNodes => format!("{value:.0}"),
        _ => format!("{value:.5}"),
    };
    let mut text = String::new();
    let is_measured = |measure: &Measure| tables.summaries.iter().any(|row| row.measure == *measure);
    for measure in Measure::ALL.into_iter().filter(is_measured) {
        let rows = tables.summaries.iter().filter(|row| row.measure == measure).map(|row| {
            let feasible = format!("{} of {}", row.feasible, row.runs);
            let quartiles = row.quartile_words(|value| number(measure, value));
            [row.scenario.clone(), row.method.clone(), feasible, quartiles]
        });
        text += &format!("{}\n", measure.words());
        text += &columns(["scenario", "method", "feasible", "median (quartiles)"], rows);
        text.push('\n');
    }
    let rows = tables.comparisons.iter().map(|row| {
        let pair = format!("{} / {}", row.method, row.baseline);
        let (p, a12) = (format!("{:.1e}", row.p_holm), format!("{:.3}", row.a12));
        [row.scenario.clone(), row.measure.short().into(), pair, p, a12]
    });
    text += &columns(["scenario", "measure", "better than the baseline?", "p (Holm)", "A12"], rows);
    if !tables.transfers.is_empty() {
        let rows = tables.transfers.iter();
        let rows = rows.map(|row| [row.worlds_words().into(), row.method.clone(), row.from.clone(), row.rate_words()]);
        text.push('\n');
        text += &columns(["tried in", "model", "evolved for", "success (95 % interval)"], rows);
    }
    if let Some(first) = tables.simulated.first() {
        let share = |share: f64| format!("{:.1} %", 100.0 * share);
        let both = |mean: String, worst: String, row: &SimulationSummary| {
            if row.worlds == 1 { mean } else { format!("{mean}, {worst}") }
        };
        let rows = tables.simulated.iter().map(|row| {
            let caged = both(share(row.caged), share(row.worst_caged), row);
            let cost = both(format!("{:.3}", row.cost), format!("{:.3}", row.worst_cost), row);
            let (scenario, method) = (row.scenario.clone(), row.method.clone());
            [scenario, row.worlds_words().into(), method, row.runs.to_string(), row.rate_words(), caged, cost]
        });
        text += &format!("\nknees simulated in {} realities of {} each\n", first.realities, first.laboratory);
        let (works, caged, cost) = ("works (95 % interval)", "caged: mean, worst world", "J: mean, worst world");
        text += &columns(["evolved for", "simulated in", "method", "knees", works, caged, cost], rows);
    }
    text
}

/// A table whose columns are as wide as the longest of their cells.
fn columns<const N: usize>(header: [&str; N], rows: impl Iterator<Item = [String; N]>) -> String {
    let rows: Vec<[String; N]> = std::iter::once(header.map(String::from)).chain(rows).collect();
    let letters = |cell: &String| cell.chars().count();
    let mut widths = [0; N];
    for row in &rows {
        for (width, cell) in widths.iter_mut().zip(row) {
            *width = letters(cell).max(*width);
        }
    }
    let line = |row: &[String; N]| {
        let cells = row.iter().zip(widths).map(|(cell, width)| format!("{cell:<width$}  "));
        format!("{}\n", cells.collect::<String>().trim_end())
    };
    rows.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_names_do_not_run_into_the_next_column() {
        let name = "channel with a name that is longer than any column was";
        let rows = [[name.to_owned(), "MOGP".into()], ["σ".into(), "EH-GRN".into()]];
        let table = columns(["scenario", "method"], rows.into_iter());
        let method = |line: &str| line.chars().skip(name.len() + 2).collect::<String>();
        assert_eq!(table.lines().map(method).collect::<Vec<_>>(), ["method", "MOGP", "EH-GRN"]);
    }
}
