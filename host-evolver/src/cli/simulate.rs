//! `grn simulate`.

use super::{Answer, Failure, about, interrupt, output};
#[cfg(unix)]
use crate::emulation::{self, Emulation};
use crate::figures;
use crate::files::{self, read_blob};
use crate::simulation::{self, ENOUGH_ACCURACY, ENOUGH_ENCIRCLED, Simulation, SimulationError};
use firmware_sim::config::SwarmConfig;
use firmware_sim::scenario::Scenario;
use grn_core::blob::Blob;
use grn_core::scalar::NumberType;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Robots of a simulation when nothing else is said.
pub const DEFAULT_ROBOTS: usize = 12;
/// Robots in QEMU when nothing else is said.
const DEFAULT_EMULATED: usize = 4;
/// Speed of the fastest target when nothing else is said, metres per second in the world.
pub const DEFAULT_SPEED: f64 = 0.03;

#[derive(clap::Args)]
pub struct Arguments {
    /// The controller.
    blob: PathBuf,
    /// The world.
    scenario: PathBuf,
    /// Seed of everything random.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How many robots.
    #[arg(long, default_value_t = DEFAULT_ROBOTS)]
    robots: usize,
    /// World metres per scenario metre [default: the blob's].
    #[arg(long)]
    scale: Option<f32>,
    /// Speed of the target with the longest path, metres per second in the world.
    #[arg(long, default_value_t = DEFAULT_SPEED)]
    speed: f64,
    /// Number type the robots compute in.
    #[arg(long, default_value = "f32")]
    number: NumberType,
    /// Where controllers run: all in this process, or some in QEMU, from the image that is flashed.
    #[arg(long, default_value = "native")]
    target: Target,
    /// How many of the robots are emulated with --target qemu.
    #[arg(long, default_value_t = DEFAULT_EMULATED)]
    emulated: usize,
    /// Image for --target qemu [default: what `cargo xtask target` builds for the number type].
    #[arg(long, value_name = "ELF")]
    image: Option<PathBuf>,
    /// Folder for trace.csv, trace.bin, metrics.json and trace.svg.
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

/// Where `cargo xtask target` leaves images.
const IMAGES: &str = "firmware/target/thumbv7em-none-eabihf/release";

pub fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut blob = read_blob(&arguments.blob)?;
    if let Some(scale) = arguments.scale {
        blob.scale = scale;
        files::blob_bytes(&blob).map_err(about("--scale"))?;
    }
    let scenario = Scenario::load(&arguments.scenario)?;
    let config = SwarmConfig {
        robots: arguments.robots,
        seed: arguments.seed,
        target_speed_m_per_s: arguments.speed,
        ..usual_config(&blob, arguments.robots)
    };
    let stop = interrupt::watch()?;
    let simulation = simulated(arguments, &blob, &scenario, config, &stop)
        .map_err(|failure| failure.about(arguments.blob.display()))?;
    if let Some(folder) = &arguments.out {
        write_folder(folder, &simulation, &scenario, &blob)?;
    }
    if arguments.json {
        output::product_json(&as_json(&simulation, arguments.number))?;
    } else {
        output::report(table(&simulation));
    }
    Ok(if simulation.verdict().works() { Answer::Yes } else { Answer::No })
}

fn simulated(
    arguments: &Arguments,
    blob: &Blob,
    scenario: &Scenario,
    config: SwarmConfig,
    stop: &AtomicBool,
) -> Result<Simulation, Failure> {
    let number = arguments.number;
    match arguments.target {
        Target::Native => watched(blob, scenario, config, number, stop),
        #[cfg(unix)]
        Target::Qemu => {
            let image = arguments.image.clone().unwrap_or_else(|| {
                Path::new(IMAGES).join(match number {
                    NumberType::F32 => "robot-f32",
                    NumberType::Q8_24 => "robot-q8_24",
                })
            });
            let emulation = Emulation { image, robots: arguments.emulated.min(config.robots) };
            with_progress(stop, |watch| emulation::simulate(blob, scenario, config, number, &emulation, watch))
        }
        #[cfg(not(unix))]
        Target::Qemu => Err(Failure::Input("--target qemu needs Unix sockets, which this system has not".into())),
    }
}

/// The usual swarm for a blob: two mother robots, or one if there is only one robot.
pub fn usual_config(blob: &Blob, robots: usize) -> SwarmConfig {
    SwarmConfig {
        robots,
        mothers: robots.clamp(1, 2),
        scale: f64::from(blob.scale),
        target_speed_m_per_s: DEFAULT_SPEED,
        ..SwarmConfig::default()
    }
}

/// Runs a simulation with a progress bar and Ctrl-C.
pub fn watched(
    blob: &Blob,
    scenario: &Scenario,
    config: SwarmConfig,
    number: NumberType,
    stop: &AtomicBool,
) -> Result<Simulation, Failure> {
    with_progress(stop, |watch| simulation::simulate(blob, scenario, config, number, watch))
}

fn with_progress(
    stop: &AtomicBool,
    simulate: impl FnOnce(&mut dyn FnMut(f64) -> ControlFlow<()>) -> Result<Option<Simulation>, SimulationError>,
) -> Result<Simulation, Failure> {
    let style = ProgressStyle::with_template("simulating {bar:40} {percent:>3} % · {eta} left");
    let bar = ProgressBar::new(1000).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let result = simulate(&mut |share| {
        bar.set_position((share * 1000.0) as u64);
        if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    bar.finish_and_clear();
    result?.ok_or_else(|| Failure::Interrupted("The simulation was not kept; run it again.".into()))
}

/// Writes trace, metrics and picture of a run.
pub fn write_folder(folder: &Path, simulation: &Simulation, scenario: &Scenario, blob: &Blob) -> Result<(), Failure> {
    let number = None;
    files::write(&folder.join("trace.bin"), simulation.trace.encode())?;
    let mut csv = Vec::new();
    simulation.trace.to_csv(&mut csv).map_err(about(folder.join("trace.csv").display()))?;
    files::write(&folder.join("trace.csv"), csv)?;
    let metrics = serde_json::to_string_pretty(&metrics_json(simulation, number))? + "\n";
    files::write(&folder.join("metrics.json"), metrics)?;
    let svg = figures::run(simulation, scenario, blob).map_err(about(folder.join("trace.svg").display()))?;
    files::write(&folder.join("trace.svg"), svg)?;
    Ok(())
}

fn as_json(simulation: &Simulation, number: NumberType) -> serde_json::Value {
    metrics_json(simulation, Some(number))
}

fn metrics_json(simulation: &Simulation, number: Option<NumberType>) -> serde_json::Value {
    json!({
        "scenario": simulation.trace.header().scenario,
        "seed": simulation.trace.header().seed,
        "robots": simulation.trace.header().robots,
        "scale": simulation.trace.header().scale,
        "number": number,
        "ring_radius_m": simulation.ring_radius_m,
        "radial_error_share": simulation.radial_error_share(),
        "metrics": simulation.metrics,
        "verdict": simulation.verdict(),
        "works": simulation.verdict().works(),
    })
}

/// What came out, one bar a line.
pub fn table(simulation: &Simulation) -> String {
    let metrics = &simulation.metrics;
    let verdict = simulation.verdict();
    let percent = |share: Option<f64>| share.map_or("never formed".into(), |share| format!("{:.1} %", share * 100.0));
    let seconds = |time: Option<f64>| time.map_or("never".into(), |time| format!("{time:.1} s"));
    let mark = |good: bool| if good { "yes" } else { "NO" };
    let rows = [
        (
            "encircled after forming",
            percent(metrics.encircled_share),
            format!("at least {:.0} %", ENOUGH_ENCIRCLED * 100.0),
            mark(verdict.encircled),
        ),
        (
            "median radial error / ring",
            percent(simulation.radial_error_share()),
            format!("below {:.0} %", ENOUGH_ACCURACY * 100.0),
            mark(verdict.accurate),
        ),
        ("wall contacts", metrics.wall_contacts.to_string(), "none".into(), mark(verdict.clear_of_walls)),
        ("peer contacts", metrics.peer_contacts.to_string(), String::new(), ""),
        ("formed after", seconds(metrics.formed_at_s), String::new(), ""),
        ("works", String::new(), String::new(), mark(verdict.works())),
    ];
    let mut text = format!("{:<28}{:>14}   {:<14}{}\n", "", "measured", "wanted", "met");
    for (name, measured, wanted, met) in rows {
        text += format!("{name:<28}{measured:>14}   {wanted:<14}{met}").trim_end();
        text += "\n";
    }
    text.trim_end().to_owned()
}
