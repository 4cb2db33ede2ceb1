//! `grn evolve`.

use super::conditions::Conditions;
use super::simulate::{check_swarm, table, watched};
use super::{Answer, Failure, about, interrupt, options, output, progress, this_command};
use crate::evaluation::{Contours, Model, Snapshot, Tracer, World};
use crate::evolve::{Advance, FrontMember, MOST_EVALUATIONS, Objectives, Search, Settings};
use crate::files::FileError;
use crate::model::deploy::DEFAULT_SCALE;
use crate::model::notation::Digits;
use crate::model::variation::MotifSet;
use crate::record;
use crate::run::{Manifest, Results, RunFolder};
use crate::simulation::usual_config;
use clap::ValueEnum;
use firmware_sim::scenario::Scenario;
use grn_core::scalar::NumberType;
use grn_input::{Range, file_name};
use indicatif::ProgressBar;
use std::io::ErrorKind;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

#[derive(clap::Args)]
pub struct Arguments {
    /// The world to evolve for.
    scenario: PathBuf,
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
    /// What to minimise: two or three of the objectives' names, separated by commas.
    #[arg(long, default_value_t = Objectives::paper(), value_name = "NAMES")]
    objectives: Objectives,
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

pub fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let scenario = Scenario::load(&arguments.scenario)?;
    let settings = Settings {
        seed: arguments.seed,
        evaluations: arguments.evaluations,
        motifs: match arguments.motifs {
            Motifs::All => MotifSet::All,
            Motifs::Binary => MotifSet::Binary,
        },
        objectives: arguments.objectives.clone(),
        ..Settings::default()
    };
    let config = usual_config(arguments.scale, arguments.conditions.laboratory()?);
    check_swarm(&arguments.scenario, &scenario, &config)?;
    let manifest = Manifest::new(&scenario, settings.clone(), arguments.scale, config.lab.clone());
    let stop = interrupt::watch()?;
    // Settings are checked before anything is written.
    let world = World::new(scenario.clone());
    Search::new(&world, settings.clone(), None).map_err(about("--evaluations"))?;
    let folder = folder(arguments, scenario.name())?;
    let (mut run, state) = if arguments.resume {
        RunFolder::resume(&folder, &this_command(), manifest, &scenario)?
    } else {
        (RunFolder::create(&folder, &this_command(), manifest, &scenario)?, None)
    };
    run.notices().iter().for_each(output::notice);
    let mut search = Search::new(&world, settings.clone(), state).map_err(|error| Failure::from(error).of_program())?;
    search_on(&mut search, &run, arguments.threads, &stop, &folder)?;
    let front = search.front();
    let is_feasible = front.iter().all(|member| member.is_feasible());
    let Results { mut contents, knee, not_drawn } = run.results(&search, &world, arguments.scale)?;
    run.add(&contents)?;
    not_drawn.iter().for_each(output::notice);
    output::report(front_table(&settings.objectives, &front));
    output::report(format!("\nresults in {}\n", folder.display()));
    if !is_feasible {
        run.finish(&contents)?;
        output::report(infeasible(&world, &front));
        return Ok(Answer::No);
    }
    let (robots, lab) = (config.lab.robots.count, config.lab.name.clone());
    let mut recorder = record::recorder(&scenario, &config);
    let knee_path = run.path("knee.grn");
    let simulation = watched(&knee_path, &knee, &scenario, config, NumberType::F32, &mut recorder, &stop);
    // World, swarm and models were checked before the search.
    let simulation = simulation.map_err(Failure::of_program)?;
    let (recorded, not_drawn) = record::contents(&simulation, recorder.trace(), &scenario, &knee);
    not_drawn.iter().for_each(output::notice);
    contents.extend(recorded.into_iter().map(|(name, content)| (format!("simulation/{name}"), content)));
    run.finish(&contents)?;
    output::report(format!("the knee on {robots} simulated robots in the laboratory {lab} (simulation/trace.svg):"));
    output::report(table(&simulation));
    Ok(if simulation.verdict().works() { Answer::Yes } else { Answer::No })
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

/// Why no model is good enough, by the best one.
fn infeasible(world: &World, front: &[FrontMember]) -> String {
    let best = front.iter().min_by(|a, b| a.violation.total_cmp(&b.violation));
    let model = best.and_then(|best| Model::new(&best.network, world.scenario().morphogen().level).ok());
    let mut tracer = Tracer::new(world);
    let lost = |(snapshot, contours): (&Snapshot, Contours)| {
        let target = contours.enclosed.iter().position(|enclosed| !enclosed)?;
        snapshot.targets.get(target).copied()
    };
    let lost: Vec<_> = match &model {
        Some(model) => tracer.trace_all(model).map(lost).enumerate().collect(),
        None => Vec::new(),
    };
    let mut places = lost.iter().filter_map(|(snapshot, place)| Some((snapshot, (*place)?)));
    let reason = match (places.next(), model) {
        (Some((snapshot, place)), _) => format!(
            "the best one loses a target at {} of {} snapshots, first at snapshot {snapshot} at [{:.1}, {:.1}]",
            places.count() + 1,
            lost.len(),
            place.x,
            place.y
        ),
        (None, Some(_)) => "the ring of the best one comes too near to a wall".into(),
        (None, None) => "the best one has no pattern".into(),
    };
    format!(
        "infeasible: no model encloses every target everywhere with room to the walls; {reason}; try more --evaluations, or \
         make room there"
    )
}

fn search_on(
    search: &mut Search<'_>,
    run: &RunFolder,
    threads: Option<NonZeroUsize>,
    stop: &AtomicBool,
    folder: &Path,
) -> Result<(), Failure> {
    let pool = options::pool(threads)?;
    let found = progress::Found::default();
    found.add(search.state().evaluations as u64);
    let bar = ProgressBar::new(search.settings().evaluations as u64)
        .with_style(progress::style("evolving {bar:40} {pos}/{len} evaluations · {msg} · {left}", &found));
    let each = search.settings().evaluations_each() as u64;
    let best = Mutex::new(search.state().history.last().and_then(|milestone| milestone.best_f2));
    bar.set_message(best_text(*best.lock().unwrap_or_else(|poisoned| poisoned.into_inner())));
    loop {
        bar.set_position(search.state().evaluations as u64);
        let advance = pool.install(|| {
            search.advance(stop, &|individual| {
                bar.inc(each);
                let mut best = best.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
                if individual.is_feasible() && best.is_none_or(|best| individual.f2 < best) {
                    *best = Some(individual.f2);
                    bar.set_message(best_text(*best));
                }
            })
        });
        match advance {
            Advance::Generation => {
                run.save(search.state())?;
                if bar.is_hidden() {
                    let best = search.state().history.last().and_then(|milestone| milestone.best_f2);
                    output::notice(format_args!(
                        "generation {}: {} evaluations, {}",
                        search.state().generation,
                        search.state().evaluations,
                        best_text(best)
                    ));
                }
            }
            Advance::Finished => {
                bar.finish_and_clear();
                return Ok(());
            }
            Advance::Interrupted => {
                bar.abandon();
                let way_on = format!(
                    "{} evaluations are kept; go on with the same command and --resume --out {}",
                    search.state().evaluations,
                    folder.display()
                );
                return Err(Failure::Interrupted(way_on));
            }
        }
    }
}

fn best_text(best: Option<f64>) -> String {
    best.map_or("nothing feasible yet".into(), |f2| format!("best f2 {f2:.5}"))
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
