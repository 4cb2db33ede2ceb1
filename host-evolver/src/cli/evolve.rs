//! `grn evolve`.

use super::conditions::Conditions;
use super::simulate::{check_swarm, table, watched};
use super::{Answer, Failure, about, interrupt, options, output, progress, this_command};
use crate::evaluation::{ConstraintNames, Contours, Model, Snapshot, Tracer, World};
use crate::evolve::{
    Advance, FrontMember, MOST_EVALUATIONS, MOST_REALITIES, Milestone, Objectives, Search, Settings, Task,
};
use crate::files::FileError;
use crate::model::deploy::DEFAULT_SCALE;
use crate::model::notation::Digits;
use crate::model::variation::MotifSet;
use crate::record;
use crate::run::{Manifest, Results, RunFolder, of_world};
use crate::simulation::usual_config;
use clap::ValueEnum;
use firmware_sim::scenario::Scenario;
use grn_core::scalar::NumberType;
use grn_input::{Range, file_name};
use indicatif::ProgressBar;
use std::io::ErrorKind;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// The most worlds of a run: each is kept with its walls.
const MOST_WORLDS: usize = 64;

#[derive(clap::Args)]
pub struct Arguments {
    /// The worlds to evolve for; a model is worth the mean of what it is in each.
    #[arg(required = true, value_name = "WORLD")]
    worlds: Vec<PathBuf>,
    /// Seed of everything random; equal seeds give equal fronts.
    #[arg(long, default_value_t = 1, value_parser = options::seed, allow_hyphen_values = true)]
    seed: u64,
    /// Threads to work with, up to 8 a core; the result does not depend on it [default: all cores].
    #[arg(long, value_parser = options::threads, allow_hyphen_values = true)]
    threads: Option<NonZeroUsize>,
    /// Budget: evaluations of f2; with --resume it may be larger than before.
    #[arg(long, default_value_t = Settings::default().evaluations, value_parser = evaluations, allow_hyphen_values = true)]
    evaluations: usize,
    /// Motifs to build with: all ten, or the eight with two inputs.
    #[arg(long, default_value = "all")]
    motifs: Motifs,
    /// The paper's algorithm to the letter: minimises nodes and f2, enclosed with a clearance of 0.05 m, without trials.
    #[arg(long, conflicts_with_all = ["objectives", "constraints", "realities"])]
    paper: bool,
    /// What to minimise: two or three of nodes, f2, closed-loop, worst, separated by commas; the last two are made from trials on
    /// simulated swarms in the laboratory [default: nodes,closed-loop].
    #[arg(long, value_name = "NAMES")]
    objectives: Option<Objectives>,
    /// What patterns must keep to: some of enclosed, clearance, no-islands, separated by commas, or none [default: all of them].
    #[arg(long, value_name = "NAMES")]
    constraints: Option<ConstraintNames>,
    /// Trials of each model on the front, in realities drawn around the laboratory [default: 16].
    #[arg(long, value_name = "N", value_parser = realities, allow_hyphen_values = true)]
    realities: Option<usize>,
    /// World metres per scenario metre of the blobs.
    #[arg(long, default_value_t = DEFAULT_SCALE, value_parser = options::scale, allow_hyphen_values = true)]
    scale: f32,
    #[command(flatten)]
    conditions: Conditions,
    /// Folder of the run, new or empty if it is not to be resumed [default: runs/SCENARIO-seed-N, or the next free name].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Continue the run in the folder, to the same files as if it had never stopped.
    #[arg(long)]
    resume: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum Motifs {
    All,
    Binary,
}

impl Arguments {
    fn settings(&self) -> Settings {
        let usual = if self.paper { Settings::default() } else { Settings::adaptive() };
        Settings {
            seed: self.seed,
            evaluations: self.evaluations,
            motifs: match self.motifs {
                Motifs::All => MotifSet::All,
                Motifs::Binary => MotifSet::Binary,
            },
            objectives: self.objectives.clone().unwrap_or(usual.objectives),
            constraints: self.constraints.unwrap_or(usual.constraints),
            realities: self.realities.unwrap_or(usual.realities),
            ..usual
        }
    }

    /// The worlds and the swarm, checked.
    fn task(&self) -> Result<Task, Failure> {
        let swarm = usual_config(self.scale, self.conditions.laboratory()?);
        let mut scenarios = Vec::new();
        for path in &self.worlds {
            let scenario = Scenario::load(path)?;
            self.conditions.check_world(path, &scenario)?;
            check_swarm(path, &scenario, &scenario.configured(swarm.clone()))?;
            scenarios.push(scenario);
        }
        if scenarios.len() > MOST_WORLDS {
            let fault = format!("{} worlds: at most {MOST_WORLDS} are possible", scenarios.len());
            return Err(Failure::Input(fault));
        }
        Task::new(scenarios, swarm).map_err(|error| {
            let given: Vec<_> = self.worlds.iter().map(|path| path.display().to_string()).collect();
            Failure::Input(format!("{}: {error}", given.join(" ")))
        })
    }
}

pub fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let settings = arguments.settings();
    let task = arguments.task()?;
    let manifest = Manifest::new(&task, settings.clone());
    let stop = interrupt::watch()?;
    // Settings are checked before anything is written.
    Search::new(&task, settings.clone(), None).map_err(about("--evaluations"))?;
    let pool = options::pool(arguments.threads)?;
    let name = task.worlds()[0].scenario().name();
    let folder = folder(arguments, name)?;
    let (mut run, state) = if arguments.resume {
        RunFolder::resume(&folder, &this_command(), manifest, &task)?
    } else {
        (RunFolder::create(&folder, &this_command(), manifest, &task)?, None)
    };
    run.notices().iter().for_each(output::notice);
    let mut search = Search::new(&task, settings.clone(), state).map_err(|error| Failure::from(error).of_program())?;
    search_on(&mut search, &run, &pool, &stop, &folder)?;
    let front = confirmed(&search, &pool, &stop).ok_or_else(|| interrupted(&search, &folder))?;
    let is_feasible = front.iter().all(|member| member.is_feasible());
    let Results { mut contents, knee, not_drawn } = run.results(&search, &front)?;
    run.add(&contents)?;
    not_drawn.iter().for_each(output::notice);
    output::report(front_table(&settings.objectives, &front));
    output::report(format!("\nresults in {}\n", folder.display()));
    if !is_feasible {
        run.finish(&contents)?;
        output::report(infeasible(&task, &settings, &front));
        return Ok(Answer::No);
    }
    let mut works = true;
    let count = task.worlds().len();
    for (place, scenario) in task.scenarios().enumerate() {
        let config = scenario.configured(task.swarm().clone());
        let below = of_world("simulation", place, count, "");
        let mut recorder = record::recorder(scenario, &config);
        let knee_path = run.path("knee.grn");
        let number = NumberType::F32;
        let simulation = watched(&knee_path, &knee, scenario, config.clone(), number, &mut recorder, &stop);
        // World, swarm and models were checked before the search.
        let simulation = simulation.map_err(Failure::of_program)?;
        let (recorded, not_drawn) = record::contents(&simulation, recorder.trace(), scenario, &knee);
        not_drawn.iter().for_each(output::notice);
        contents.extend(recorded.into_iter().map(|(name, content)| (format!("{below}/{name}"), content)));
        let (robots, lab) = (config.lab.robots.count, &config.lab.name);
        let world = if count == 1 { String::new() } else { format!(" in {}", scenario.name()) };
        output::report(format!(
            "the knee on {robots} simulated robots{world} in the laboratory {lab} ({below}/trace.svg):"
        ));
        output::report(table(&simulation));
        works &= simulation.verdict().works();
    }
    run.finish(&contents)?;
    Ok(if works { Answer::Yes } else { Answer::No })
}

/// The folder asked for, else the first of runs/NAME-seed-N, runs/NAME-seed-N-2, … that is free and is made here, so that no
/// other run chooses the same; or the first that is to be resumed.
fn folder(arguments: &Arguments, name: &str) -> Result<PathBuf, Failure> {
    if let Some(out) = &arguments.out {
        return Ok(out.clone());
    }
    let runs = Path::new("runs");
    let first = runs.join(format!("{}-seed-{}", file_name(name), arguments.seed));
    if arguments.resume {
        return Ok(first);
    }
    let cannot = |folder: &Path, error| FileError::from_system(folder, "written", error);
    std::fs::create_dir_all(runs).map_err(|error| cannot(runs, error))?;
    let mut folder = first.clone();
    let mut number = 1;
    loop {
        match std::fs::create_dir(&folder) {
            Ok(()) => return Ok(folder),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                number += 1;
                folder = PathBuf::from(format!("{}-{number}", first.display()));
            }
            Err(error) => return Err(cannot(&folder, error).into()),
        }
    }
}

fn evaluations(text: &str) -> Result<usize, String> {
    options::within(text, &Range::new(1, MOST_EVALUATIONS, "(a whole one)"))
}

fn realities(text: &str) -> Result<usize, String> {
    options::within(text, &Range::new(1, MOST_REALITIES, "(a whole one)"))
}

/// Why no model is good enough, by the best one.
fn infeasible(task: &Task, settings: &Settings, front: &[FrontMember]) -> String {
    let best = front.iter().min_by(|a, b| a.violation.total_cmp(&b.violation));
    let reasons = task.worlds().iter().filter_map(|world| Some((world, lost_in(world, best?)?)));
    let (count, mut reasons) = (task.worlds().len(), reasons);
    let reason = match (reasons.next(), best) {
        (Some((world, reason)), _) if count > 1 => format!("in {} {reason}", world.scenario().name()),
        (Some((_, reason)), _) => reason,
        (None, Some(_)) if settings.constraints == ConstraintNames::PAPER => {
            "the ring of the best one comes too near to a wall".into()
        }
        (None, _) => format!("the best one violates one of the constraints {}", settings.constraints),
    };
    format!(
        "infeasible: no model encloses every target everywhere with room to the walls; {reason}; try more --evaluations, or \
         make room there"
    )
}

/// Where a model loses a target in a world, in words.
fn lost_in(world: &World, member: &FrontMember) -> Option<String> {
    let Ok(model) = Model::new(&member.network, world.scenario().morphogen().level) else {
        return Some("the best one has no pattern".into());
    };
    let mut tracer = Tracer::new(world);
    let lost = |(snapshot, contours): (&Snapshot, Contours)| {
        let target = contours.enclosed.iter().position(|enclosed| !enclosed)?;
        snapshot.targets.get(target).copied()
    };
    let lost: Vec<_> = tracer.trace_all(&model).map(lost).enumerate().collect();
    let mut places = lost.iter().filter_map(|(snapshot, place)| Some((snapshot, (*place)?)));
    let (snapshot, place) = places.next()?;
    Some(format!(
        "the best one loses a target at {} of {} snapshots, first at snapshot {snapshot} at [{:.1}, {:.1}]",
        places.count() + 1,
        lost.len(),
        place.x,
        place.y
    ))
}

fn search_on(
    search: &mut Search<'_>,
    run: &RunFolder,
    pool: &rayon::ThreadPool,
    stop: &AtomicBool,
    folder: &Path,
) -> Result<(), Failure> {
    let found = progress::Found::default();
    found.add(search.state().evaluations as u64);
    let bar = ProgressBar::new(search.settings().evaluations as u64)
        .with_style(progress::style("evolving {bar:40} {pos}/{len} evaluations · {msg} · {left}", &found));
    let each = search.settings().evaluations_each() as u64;
    loop {
        bar.set_position(search.state().evaluations as u64);
        bar.set_message(best_text(search));
        let advance = pool.install(|| search.advance(stop, &|_| bar.inc(each)));
        match advance {
            Advance::Generation => {
                run.save(search.state())?;
                if bar.is_hidden() {
                    output::notice(format_args!(
                        "generation {}: {} evaluations, {}",
                        search.state().generation,
                        search.state().evaluations,
                        best_text(search)
                    ));
                }
            }
            Advance::Finished => {
                bar.finish_and_clear();
                return Ok(());
            }
            Advance::Interrupted => {
                bar.abandon();
                return Err(interrupted(search, folder));
            }
        }
    }
}

fn interrupted(search: &Search<'_>, folder: &Path) -> Failure {
    Failure::Interrupted(format!(
        "{} evaluations are kept; go on with the same command and --resume --out {}",
        search.state().evaluations,
        folder.display()
    ))
}

/// The front, judged anew on simulated swarms if the objectives are made from trials, with a progress bar.
fn confirmed(search: &Search<'_>, pool: &rayon::ThreadPool, stop: &AtomicBool) -> Option<Vec<FrontMember>> {
    if !search.settings().objectives.need_trials() {
        return Some(search.front());
    }
    let bar = ProgressBar::new_spinner().with_style(progress::style(
        "refining and confirming the best models · {pos} trials",
        &progress::Found::default(),
    ));
    if bar.is_hidden() {
        output::notice("refining and confirming the best models on simulated swarms");
    }
    let front = pool.install(|| search.confirmed_front(stop, &|| bar.inc(1)));
    bar.finish_and_clear();
    front
}

fn best_text(search: &Search<'_>) -> String {
    match search.state().history.last() {
        Some(Milestone { best_cost: Some(cost), .. }) => format!("best J {cost:.3}"),
        Some(Milestone { best_f2: Some(f2), .. }) => format!("best f2 {f2:.5}"),
        _ => "nothing feasible yet".into(),
    }
}

fn front_table(objectives: &Objectives, front: &[FrontMember]) -> String {
    let further: String = objectives.further_names().map(|name| format!("{name:<13}")).collect();
    let mut text = format!("{:>5}  {:<9}{further}{:<15}{}", "nodes", "f2", "knee", "expression");
    for member in front {
        let further: String = member.further.iter().map(|value| format!("{value:<13.5}")).collect();
        let (nodes, f2, knee) = (member.nodes, member.f2, member.knee.to_string());
        text += &format!("\n{nodes:>5}  {f2:<9.5}{further}{knee:<15}{}", member.expression(Digits::Four));
    }
    text
}
