//! `grn missions`.

use super::options::{self, within};
use super::{Answer, Failure, interrupt, output, progress, take_folder};
use crate::files::{self, FolderLock};
use crate::missions::{Difficulty, MissionRow, TABLE};
use firmware_sim::missions::sampling::{CLEARANCE, ROBOTS, TARGETS};
use firmware_sim::missions::{Class, Mission, Sampling};
use firmware_sim::scenario::InputError;
use grn_input::Range;
use indicatif::ProgressBar;
use rayon::prelude::*;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

/// How many missions may be drawn at once: their names have four digits.
const COUNT: Range<usize> = Range::new(1, 10_000, "(a whole one)");

#[derive(clap::Args)]
pub struct Arguments {
    /// Seed of the missions.
    #[arg(long, default_value_t = 1, value_parser = options::seed, allow_hyphen_values = true)]
    seed: u64,
    /// How many missions; the classes take turns.
    #[arg(long, value_name = "N", value_parser = |text: &str| within(text, &COUNT), allow_hyphen_values = true)]
    count: usize,
    /// Folder for the world of each mission, and missions.csv.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Only missions of these classes: corridor, door, columns, corner, sliding-door, sweeping-bar, drifting-disc.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    class: Vec<Class>,
    /// Least and most targets.
    #[arg(long, num_args = 2, value_names = ["LEAST", "MOST"], default_values_t = [TARGETS.low, TARGETS.high], value_parser = |text: &str| within(text, &TARGETS), allow_hyphen_values = true)]
    targets: Vec<usize>,
    /// Least and most robots; 10 to 20 go to each target.
    #[arg(long, num_args = 2, value_names = ["LEAST", "MOST"], default_values_t = [ROBOTS.low, ROBOTS.high], value_parser = |text: &str| within(text, &ROBOTS), allow_hyphen_values = true)]
    robots: Vec<usize>,
    /// Least and most that is kept free on both sides of every target's path, metres.
    #[arg(long, num_args = 2, value_names = ["LEAST", "MOST"], default_values_t = [0.6, 1.2], value_parser = |text: &str| within(text, &CLEARANCE), allow_hyphen_values = true)]
    clearance: Vec<f64>,
    /// Threads to work with, up to 8 a core; the results do not depend on it [default: all cores].
    #[arg(long, value_parser = options::threads, allow_hyphen_values = true)]
    threads: Option<NonZeroUsize>,
}

impl Arguments {
    fn sampling(&self) -> Result<Sampling, Failure> {
        let [targets, robots] = [&self.targets, &self.robots].map(|counts| [counts[0], counts[1]]);
        Sampling::new(&self.class, targets, robots, [self.clearance[0], self.clearance[1]]).map_err(|error| {
            let option = format!("--{}", error.key());
            InputError::new(option, error.value(), error.expected()).into()
        })
    }
}

pub fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let sampling = arguments.sampling()?;
    let stop = interrupt::watch()?;
    let lock = take_folder(&arguments.out)?;
    files::remove_unfinished(&lock, &[""; 0])?;
    check_ours(&lock, arguments, &sampling)?;
    let table = arguments.out.join(TABLE);
    files::probe(&table)?;
    let pool = options::pool(arguments.threads)?;
    // The table comes last: what stands in one is there. Only its lines are kept in mind meanwhile.
    let rows = pool.install(|| drawn(arguments, &sampling, &stop))?;
    files::write(&table, files::csv_records(&rows))?;
    output::report(format!("{} missions in {}", rows.len(), arguments.out.display()));
    Ok(Answer::Yes)
}

/// Refuses a folder in which missions would remain that are none of these, or be replaced by others.
fn check_ours(lock: &FolderLock, arguments: &Arguments, sampling: &Sampling) -> Result<(), Failure> {
    for (name, _) in files::entries(lock.folder())? {
        let Some((number, class)) = name.strip_suffix(".toml").and_then(|mission| mission.split_once('-')) else {
            continue;
        };
        let (Ok(number), Ok(_)) = (number.parse::<usize>(), class.parse::<Class>()) else { continue };
        let is_ours = || {
            let mission = Mission::drawn(arguments.seed, number, sampling).ok()?;
            let text = std::fs::read_to_string(lock.folder().join(&name)).ok()?;
            (mission.file() == name && mission.text() == text).then_some(())
        };
        if number >= arguments.count || is_ours().is_none() {
            let path = lock.folder().join(name).display().to_string();
            let fault = "is a mission that this command does not draw; choose another folder with --out, or delete it";
            return Err(Failure::Input(format!("{path}: {fault}")));
        }
    }
    Ok(())
}

/// Draws every mission, writes those that are not there yet, and measures how difficult it is.
fn drawn(arguments: &Arguments, sampling: &Sampling, stop: &AtomicBool) -> Result<Vec<MissionRow>, Failure> {
    let style = progress::style("drawing {bar:40} {pos}/{len} missions · {left}", &progress::Found::default());
    let bar = ProgressBar::new(arguments.count as u64).with_style(style);
    let mission = |number: usize| {
        if stop.load(Ordering::Relaxed) {
            return Err(Failure::Interrupted(format!("The same command goes on in {}.", arguments.out.display())));
        }
        let refused = |fault: String| Failure::Program(format!("mission {number} of seed {}: {fault}", arguments.seed));
        let mission = Mission::drawn(arguments.seed, number, sampling).map_err(|error| refused(error.to_string()))?;
        let difficulty = Difficulty::of(&mission.scenario).ok_or_else(|| refused("no circle has room".into()))?;
        let path = arguments.out.join(mission.file());
        if !path.exists() {
            files::write(&path, mission.text())?;
        }
        bar.inc(1);
        Ok(MissionRow::of(&mission, &difficulty))
    };
    let rows: Result<Vec<_>, Failure> = (0..arguments.count).into_par_iter().map(mission).collect();
    bar.finish_and_clear();
    rows
}
