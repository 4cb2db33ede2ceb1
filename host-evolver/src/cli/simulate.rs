//! `grn simulate`.

use super::conditions::Conditions;
use super::robustness;
use super::{Answer, Failure, about, interrupt, options, output, progress, take_folder};
#[cfg(unix)]
use crate::emulation::{self, Emulation, EmulationError};
use crate::faults;
use crate::files::{self, Contents, FileError, FolderLock, read_blob};
use crate::realities;
use crate::record;
use crate::simulation::verdict::{ENOUGH_CAGED, ENOUGH_IN_BAND, MOST_CONTACT, MOST_LOST};
use crate::simulation::{self, DEFAULT_SPEED, Simulation, SimulationError, doubts, usual_config};
use firmware_sim::base_station::Dispatch;
use firmware_sim::config::SwarmConfig;
use firmware_sim::lab::MAX_ROBOTS;
use firmware_sim::scenario::Scenario;
use firmware_sim::swarm;
use firmware_sim::trace::Observer;
use grn_core::blob::Blob;
use grn_core::scalar::NumberType;
use grn_input::{Found, InputError, Range};
use indicatif::ProgressBar;
use std::io::ErrorKind;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Robots in QEMU when nothing else is said.
const DEFAULT_EMULATED: usize = 4;
const BARS: &str = "\
A run works (exit code 0) if all of this holds, once the targets have settled:
  caged         targets can leave nowhere in at least 95 % of the moments: every way out of the ring is shut by walls, or by
                robots that are nearer to each other than half of d_max
  in the band   robots are within d_min and d_max of a target in at least half of their moments
  in contact    robots touch walls or each other in at most 2 % of their time
  robots lost   at most 5 % are off the pattern at the end: farther from it than half a ring radius and from every target than
                1.5 ring radii, for 5 s already
  formed        targets were caged for the first time before a robot could have driven once around a ring of radius d_max";

#[derive(clap::Args)]
#[command(after_help = BARS)]
pub struct Arguments {
    /// The controller.
    blob: PathBuf,
    /// The world.
    scenario: PathBuf,
    /// Seed of everything random.
    #[arg(long, default_value_t = 1, value_parser = options::seed, allow_hyphen_values = true)]
    seed: u64,
    /// How many robots, two of them mothers [default: the world's, if it says so, or the laboratory's].
    #[arg(long, value_parser = robots, allow_hyphen_values = true)]
    robots: Option<usize>,
    #[command(flatten)]
    conditions: Conditions,
    /// Simulate in so many laboratories drawn around this one, and say in how many of them it works.
    #[arg(long, value_name = "N", value_parser = robustness::count, allow_hyphen_values = true, conflicts_with_all = ["reality", "target"])]
    realities: Option<u64>,
    /// Simulate in one of these laboratories, by its number; 0 is the laboratory itself.
    #[arg(long, value_name = "NUMBER", default_value_t = 0, value_parser = robustness::number, allow_hyphen_values = true)]
    reality: u64,
    /// Threads to work with, up to 8 a core; the results do not depend on it [default: all cores].
    #[arg(long, value_parser = options::threads, allow_hyphen_values = true)]
    threads: Option<NonZeroUsize>,
    /// World metres per scenario metre [default: the blob's].
    #[arg(long, value_parser = options::scale, allow_hyphen_values = true)]
    scale: Option<f32>,
    /// Speed of the target with the longest path, metres per second in the world. Slow targets make long runs.
    #[arg(long, default_value_t = DEFAULT_SPEED, value_parser = options::speed, allow_hyphen_values = true)]
    speed: f64,
    /// Number type the robots compute in.
    #[arg(long, default_value = "f32")]
    number: NumberType,
    /// Where controllers run: all in this process, or some in QEMU, from the image that is flashed.
    #[arg(long, default_value = "native")]
    target: Target,
    /// How many of the robots are emulated with --target qemu [default: 4, or all if there are fewer].
    #[arg(long, value_parser = robots, allow_hyphen_values = true)]
    emulated: Option<usize>,
    /// Image for --target qemu [default: what `cargo xtask target` builds for the number type].
    #[arg(long, value_name = "ELF")]
    image: Option<PathBuf>,
    /// Folder for trace.csv, trace.bin, metrics.json and trace.svg; with --realities for realities.csv and realities.json. A
    /// trace has every tick, or of a run that is too long for the memory every second, fourth, ….
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON instead of a table.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Target {
    Native,
    Qemu,
}

/// What may be in the folder of `--out`.
const FILES: [&str; 6] = ["metrics.json", "realities.csv", "realities.json", "trace.bin", "trace.csv", "trace.svg"];

/// Where `cargo xtask target` leaves images.
const IMAGES: &str = "firmware/target/thumbv7em-none-eabihf/release";

pub fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut blob = read_blob(&arguments.blob)?;
    if let Some(scale) = arguments.scale {
        blob.scale = scale;
        files::blob_bytes(&blob).map_err(about("--scale"))?;
    }
    let scenario = Scenario::load(&arguments.scenario)?;
    let lab = arguments.conditions.laboratory()?;
    arguments.conditions.check_world(&arguments.scenario, &scenario)?;
    let config =
        SwarmConfig { seed: arguments.seed, target_speed_m_per_s: arguments.speed, ..usual_config(blob.scale, lab) };
    let config = scenario.configured(config);
    let config = match arguments.robots {
        Some(count) => config.with_robots(count),
        None => config,
    };
    check_emulation(arguments, config.lab.robots.count)?;
    check_swarm(&arguments.scenario, &scenario, &config)?;
    let stop = interrupt::watch()?;
    let lock = arguments.out.as_deref().map(take).transpose()?;
    let pool = options::pool(arguments.threads)?;
    if let Some(count) = arguments.realities {
        let experiment =
            robustness::Experiment { blob: &blob, scenario: &scenario, config: &config, number: arguments.number };
        let robustness = pool.install(|| experiment.run(&arguments.blob, count, &stop))?;
        if let Some(lock) = &lock {
            keep(lock.folder(), &experiment.files(&robustness)?)?;
        }
        return experiment.tell(&robustness, arguments.json);
    }
    let config = realities::reality(&config, arguments.reality);
    let simulation = match &lock {
        Some(lock) => {
            let mut recorder = record::recorder(&scenario, &config);
            let simulation = pool.install(|| simulated(arguments, &blob, &scenario, config, &mut recorder, &stop))?;
            let (contents, not_drawn) = record::contents(&simulation, recorder.trace(), &scenario, &blob);
            not_drawn.iter().for_each(output::notice);
            keep(lock.folder(), &contents)?;
            simulation
        }
        None => pool.install(|| simulated(arguments, &blob, &scenario, config, &mut (), &stop))?,
    };
    if arguments.json {
        output::product_json(&record::metrics(&simulation, &scenario))?;
    } else {
        output::report(table(&simulation));
    }
    Ok(if simulation.verdict().works() { Answer::Yes } else { Answer::No })
}

/// Refuses options of emulators without emulators, which would not do what they say, and more emulators than robots.
fn check_emulation(arguments: &Arguments, robots: usize) -> Result<(), Failure> {
    let Arguments { target, emulated, image, .. } = arguments;
    let without = |option: String| {
        Err(Failure::Input(format!("{option} is for robots in emulators; add --target qemu, or leave it out")))
    };
    match (target, image, emulated) {
        (Target::Native, Some(image), _) => without(format!("--image {}", image.display())),
        (Target::Native, None, Some(emulated)) => without(format!("--emulated {emulated}")),
        (Target::Qemu, _, &Some(emulated)) if emulated > robots => {
            Err(Failure::Input(format!("--emulated {emulated}: must be at most the number of robots, {robots}")))
        }
        _ => Ok(()),
    }
}

fn simulated(
    arguments: &Arguments,
    blob: &Blob,
    scenario: &Scenario,
    config: SwarmConfig,
    observer: &mut dyn Observer,
    stop: &AtomicBool,
) -> Result<Simulation, Failure> {
    let number = arguments.number;
    match arguments.target {
        Target::Native => watched(&arguments.blob, blob, scenario, config, number, observer, stop),
        #[cfg(unix)]
        Target::Qemu => {
            let image = arguments.image.clone().unwrap_or_else(|| {
                Path::new(IMAGES).join(match number {
                    NumberType::F32 => "robot-f32",
                    NumberType::Q8_24 => "robot-q8_24",
                })
            });
            let robots = arguments.emulated.unwrap_or(DEFAULT_EMULATED.min(config.lab.robots.count));
            let emulation = Emulation { image, robots };
            with_progress(stop, |watch| {
                let simulated = emulation::simulate(blob, scenario, config, number, &emulation, observer, watch);
                simulated.map_err(|error| match error {
                    EmulationError::Simulation(error) => of_blob(&arguments.blob)(error),
                    error => error.into(),
                })
            })
        }
        #[cfg(not(unix))]
        Target::Qemu => Err(Failure::Input("--target qemu needs Unix sockets, which this system has not".into())),
    }
}

fn robots(text: &str) -> Result<usize, String> {
    options::within(text, &Range::new(1, MAX_ROBOTS, "(a whole one)"))
}

/// Whether a swarm can be set up in the world of a scenario's file.
pub fn check_swarm(path: &Path, scenario: &Scenario, config: &SwarmConfig) -> Result<(), Failure> {
    let fits = swarm::check(scenario, config).and_then(|()| simulation::check_length(scenario, config));
    if fits.is_ok() {
        let of_world = |doubt: &String| output::notice(format_args!("{}: {doubt}", scenario.name()));
        doubts(scenario, config).iter().for_each(of_world);
    }
    fits.map_err(|error| match error.key() {
        "target_speed_m_per_s" => Failure::Input(format!("--speed {}: {}", error.value(), error.expected())),
        "scale" | "robots" => {
            let [east, north] = scenario.region();
            let fault = format!("--{} {}: {}", error.key(), error.value(), error.expected());
            in_scenario(path, InputError::new("region", format!("[{east:?}, {north:?}]"), fault))
        }
        key if key.starts_with("start") => in_scenario(path, error),
        _ => error.into(),
    })
}

/// A fault of a scenario's file, with its place there.
fn in_scenario(path: &Path, error: InputError) -> Failure {
    let text = grn_input::read_text(path, Found::Scenario).unwrap_or_default();
    grn_input::locate(&text, error).in_file(path).into()
}

/// Runs a simulation with a progress bar and Ctrl-C.
pub fn watched(
    path: &Path,
    blob: &Blob,
    scenario: &Scenario,
    config: SwarmConfig,
    number: NumberType,
    observer: &mut dyn Observer,
    stop: &AtomicBool,
) -> Result<Simulation, Failure> {
    with_progress(stop, |watch| {
        simulation::simulate(blob, scenario, config, number, observer, watch).map_err(of_blob(path))
    })
}

/// Names the blob where that is what is wrong.
fn of_blob(path: &Path) -> impl Fn(SimulationError) -> Failure {
    move |error| match error {
        SimulationError::Load(_) | SimulationError::NoPattern(_) => about(path.display())(error),
        SimulationError::Config(_) | SimulationError::Brain(_) => error.into(),
    }
}

fn with_progress(
    stop: &AtomicBool,
    simulate: impl FnOnce(&mut dyn FnMut(f64) -> ControlFlow<()>) -> Result<Option<Simulation>, Failure>,
) -> Result<Simulation, Failure> {
    let style = progress::style("simulating {bar:40} {percent:>3} % · {left}", &progress::Found::default());
    let bar = ProgressBar::new(1000).with_style(style);
    let result = simulate(&mut |share| {
        bar.set_position((share * 1000.0) as u64);
        if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    bar.finish_and_clear();
    result?.ok_or_else(|| Failure::Interrupted("The simulation was not kept; run it again.".into()))
}

/// Takes the folder of `--out` before anything is computed for it.
fn take(folder: &Path) -> Result<FolderLock, Failure> {
    let lock = take_folder(folder)?;
    FILES.iter().try_for_each(|name| files::probe(&folder.join(name)))?;
    Ok(lock)
}

/// Writes the files of a run, and removes those of an earlier one that this one has not.
fn keep(folder: &Path, contents: &Contents) -> Result<(), FileError> {
    files::write_together(contents.iter().map(|(name, content)| (folder.join(name), content.as_slice())))?;
    for stale in FILES.iter().filter(|name| !contents.contains_key(**name)).map(|name| folder.join(name)) {
        match std::fs::remove_file(&stale) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                return Err(FileError::from_system(stale, "removed", error));
            }
            _ => {}
        }
    }
    Ok(())
}

/// What came out, one bar a line.
pub fn table(simulation: &Simulation) -> String {
    let (metrics, caging) = (&simulation.metrics, &simulation.caging);
    let verdict = simulation.verdict();
    let percent = |share: f64| format!("{:.1} %", share * 100.0);
    let known = |share: Option<f64>| share.map_or("unknown".into(), percent);
    let seconds = |time: Option<f64>| time.map_or("never".into(), |time| format!("{time:.0} s"));
    let mark = |good: bool| if good { "yes" } else { "NO" };
    let least = |share: f64| format!("at least {:.0} %", share * 100.0);
    let most = |share: f64| format!("at most {:.0} %", share * 100.0);
    let bar = |name, measured: String, wanted: String, met| (name, measured, wanted, mark(met));
    let told = |name, measured: String| (name, measured, String::new(), "");
    let mut rows = vec![
        bar("caged", percent(caging.caged_share), least(ENOUGH_CAGED), verdict.caged),
        bar("in the band", percent(caging.in_band_share), least(ENOUGH_IN_BAND), verdict.in_band),
        bar("in contact", percent(caging.contact_share), most(MOST_CONTACT), verdict.clear),
        bar("robots lost", percent(simulation.lost_share()), most(MOST_LOST), verdict.together),
        bar(
            "formed after",
            seconds(caging.formed_at_s),
            format!("at most {:.0} s", simulation.time_to_form_s),
            verdict.formed,
        ),
        told("cost J", format!("{:.3}", caging.cost())),
        told("median radial error / ring", known(simulation.radial_error_share())),
        told("wall, peer contacts", format!("{}, {}", metrics.wall_contacts, metrics.peer_contacts)),
    ];
    if !metrics.recoveries.is_empty() {
        let reformed = metrics.recoveries.iter().filter(|recovery| recovery.reformed_at_s.is_some()).count();
        let least = metrics.recoveries.iter().filter_map(|recovery| recovery.encircled_share).reduce(f64::min);
        rows.push((
            "re-formed after disturbances",
            format!("{reformed} of {}", metrics.recoveries.len()),
            String::new(),
            "",
        ));
        rows.push(("then encircled, at least", known(least), String::new(), ""));
    }
    if let Some(base) = &simulation.base {
        let count = |what| base.dispatched.iter().filter(|deed| deed.what == what).count().to_string();
        let needed = format!("{} needed", base.most_needed);
        rows.push(("robots out at once, most", base.most_out.to_string(), needed, ""));
        rows.push(("robots sent by the base", count(Dispatch::Sent), String::new(), ""));
        rows.push(("robots called home", count(Dispatch::CalledHome), String::new(), ""));
        rows.push(("base had too few for", format!("{:.0} s", base.short_s), String::new(), ""));
    }
    rows.push(("works", String::new(), String::new(), mark(verdict.works())));
    let mut text = format!("{:<28}{:>14}   {:<14}{}\n", "", "measured", "wanted", "met");
    for (name, measured, wanted, met) in rows {
        text += format!("{name:<28}{measured:>14}   {wanted:<14}{met}").trim_end();
        text += "\n";
    }
    text += &faults::list(&faults::happened(simulation));
    text.trim_end().to_owned()
}
