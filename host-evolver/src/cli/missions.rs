//! `grn missions`.

use super::options::{self, within};
use super::{Answer, Failure, interrupt, output, progress, take_folder};
use crate::files::{self, Contents, FolderLock};
use crate::missions::{Class, Difficulty, Mission};
use grn_input::Range;
use indicatif::ProgressBar;
use rayon::prelude::*;
use serde::Serialize;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

/// How many missions may be drawn at once: their names have four digits.
const COUNT: Range<usize> = Range::new(1, 10_000, "(a whole one)");
/// The table of all missions.
const TABLE: &str = "missions.csv";

#[derive(clap::Args)]
pub struct Arguments {
    /// Seed of the missions.
    #[arg(long, default_value_t = 1, value_parser = options::seed, allow_hyphen_values = true)]
    seed: u64,
    /// How many missions; the classes take turns.
    #[arg(long, value_name = "N", value_parser = |text: &str| within(text, &COUNT), allow_hyphen_values = true)]
    count: usize,
    /// Folder for a world and a laboratory for each mission, and missions.csv.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Only missions of these classes.
    #[arg(long, value_name = "NAME", value_delimiter = ',', value_enum)]
    class: Vec<Class>,
    /// Threads to work with, up to 8 a core; the results do not depend on it [default: all cores].
    #[arg(long, value_parser = options::threads, allow_hyphen_values = true)]
    threads: Option<NonZeroUsize>,
}

/// A line of missions.csv.
#[derive(Serialize)]
struct Line<'m> {
    mission: &'m str,
    class: &'static str,
    seed: u64,
    targets: usize,
    robots: usize,
    walls_block: bool,
    moving: bool,
    clearance_m: f64,
    circle_radius_m: f64,
    circle_f2: f64,
    star_f2: f64,
    difficulty: f64,
    world: String,
    laboratory: String,
}

impl<'m> Line<'m> {
    fn of(mission: &'m Mission, difficulty: &Difficulty) -> Line<'m> {
        // Six digits: more are the grid's on which radii are tried.
        let digits = |value: f64| (value * 1e6).round() / 1e6;
        Line {
            mission: &mission.name,
            class: mission.class.name(),
            seed: mission.seed,
            targets: mission.scenario.targets().len(),
            robots: mission.robots,
            walls_block: mission.walls_block,
            moving: mission.scenario.walls_change(),
            clearance_m: mission.clearance,
            circle_radius_m: digits(difficulty.circle_radius),
            circle_f2: digits(difficulty.circle_f2),
            star_f2: digits(difficulty.star_f2),
            difficulty: digits(difficulty.gain()),
            world: mission.world_file(),
            laboratory: mission.laboratory_file(),
        }
    }
}

pub fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let classes = classes(&arguments.class);
    let stop = interrupt::watch()?;
    let lock = take_folder(&arguments.out)?;
    check_ours(&lock, arguments.count, &classes)?;
    files::probe(&arguments.out.join(TABLE))?;
    let pool = options::pool(arguments.threads)?;
    let missions = pool.install(|| drawn(arguments, &classes, &stop))?;
    let lines: Vec<Line<'_>> = missions.iter().map(|(mission, difficulty)| Line::of(mission, difficulty)).collect();
    let mut contents = Contents::new();
    contents.insert(TABLE.to_owned(), files::csv_records(&lines));
    for (mission, _) in &missions {
        contents.insert(mission.world_file(), mission.world().into_bytes());
        contents.insert(mission.laboratory_file(), mission.laboratory().into_bytes());
    }
    files::write_together(contents.iter().map(|(name, content)| (arguments.out.join(name), content.as_slice())))?;
    output::report(format!("{} missions in {}", missions.len(), arguments.out.display()));
    Ok(Answer::Yes)
}

/// The classes that were asked for, each once, in their own order; all of them if none was.
fn classes(asked: &[Class]) -> Vec<Class> {
    Class::ALL.into_iter().filter(|class| asked.is_empty() || asked.contains(class)).collect()
}

fn class_of(number: usize, classes: &[Class]) -> Class {
    classes[number % classes.len()]
}

/// Refuses a folder in which missions would remain that are none of these.
fn check_ours(lock: &FolderLock, count: usize, classes: &[Class]) -> Result<(), Failure> {
    for (name, _) in files::entries(lock.folder())? {
        let Some((number, class)) = name.split_once('.').and_then(|(mission, _)| mission.split_once('-')) else {
            continue;
        };
        let Some(class) = Class::ALL.into_iter().find(|known| known.name() == class) else { continue };
        let Ok(number) = number.parse::<usize>() else { continue };
        if number >= count || class_of(number, classes) != class {
            let path = lock.folder().join(name).display().to_string();
            let fault = "is a mission that this command does not write; choose another folder with --out, or delete it";
            return Err(Failure::Input(format!("{path}: {fault}")));
        }
    }
    Ok(())
}

fn drawn(arguments: &Arguments, classes: &[Class], stop: &AtomicBool) -> Result<Vec<(Mission, Difficulty)>, Failure> {
    let style = progress::style("drawing {bar:40} {pos}/{len} · {left}", &progress::Found::default());
    let bar = ProgressBar::new(arguments.count as u64).with_style(style);
    let mission = |number: usize| {
        if stop.load(Ordering::Relaxed) {
            return Err(Failure::Interrupted("No mission was written; run it again.".into()));
        }
        let refused = |fault: String| Failure::Program(format!("mission {number} of seed {}: {fault}", arguments.seed));
        let mission = Mission::drawn(arguments.seed, number, class_of(number, classes))
            .map_err(|error| refused(error.to_string()))?;
        let difficulty = Difficulty::of(&mission.scenario).ok_or_else(|| refused("no circle has room".into()))?;
        bar.inc(1);
        Ok((mission, difficulty))
    };
    let missions: Result<Vec<_>, Failure> = (0..arguments.count).into_par_iter().map(mission).collect();
    bar.finish_and_clear();
    missions
}
