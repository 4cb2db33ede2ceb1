//! `grn draw`.

use super::{Answer, Failure, about, output};
use crate::evaluation::{Contours, Model, Snapshot, Tracer, World};
use crate::figures;
use crate::files::{self, read_blob};
use firmware_sim::scenario::Scenario;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub struct Arguments {
    /// The controller.
    blob: PathBuf,
    /// The world.
    scenario: PathBuf,
    /// Where to write the picture: FILE.svg, or FILE.png with 300 pixels an inch [default: BLOB-SCENARIO.svg here; with
    /// --json, none].
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Print what was drawn, per snapshot, as JSON.
    #[arg(long)]
    json: bool,
}

/// How a picture is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Svg,
    Png,
}

/// Of a picture in a journal.
const PIXELS_PER_INCH: f32 = 300.0;

impl Format {
    /// By the ending of the file's name; without one, as of a device or a pipe, it is SVG.
    fn of(path: &Path) -> Result<Format, Failure> {
        let Some(ending) = path.extension() else { return Ok(Format::Svg) };
        match ending.to_string_lossy().to_lowercase().as_str() {
            "svg" => Ok(Format::Svg),
            "png" => Ok(Format::Png),
            _ => Err(Failure::Input(format!(
                "--out {}: pictures are written as .svg or .png; name it {}, and convert that",
                path.display(),
                path.with_extension("svg").display()
            ))),
        }
    }

    fn encode(self, svg: String) -> Result<Vec<u8>, Failure> {
        match self {
            Format::Svg => Ok(svg.into_bytes()),
            Format::Png => Ok(grn_figures::png(&svg, PIXELS_PER_INCH)?),
        }
    }
}

pub fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let format = arguments.out.as_deref().map_or(Ok(Format::Svg), Format::of)?;
    let blob = read_blob(&arguments.blob)?;
    let world = World::new(Scenario::load(&arguments.scenario)?);
    let level = f64::from(blob.level_fraction);
    let model = match Model::new(&blob.network, level) {
        Ok(model) => model,
        Err(error) => {
            output::notice(format_args!("grn: {}: {error}", arguments.blob.display()));
            return Ok(Answer::No);
        }
    };
    let default = || {
        let stem = |path: &PathBuf| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let name = format!("{}-{}", stem(&arguments.blob), stem(&arguments.scenario));
        PathBuf::from(grn_input::file_name(&name) + ".svg")
    };
    let out = arguments.out.clone().or_else(|| (!arguments.json).then(default));
    if let Some(out) = &out {
        files::probe(out)?;
        let svg = figures::pattern(&world, &model).map_err(about(arguments.scenario.display()))?;
        files::write(out, format.encode(svg)?)?;
    }
    if arguments.json {
        output::product_json(&as_json(&world, &model))?;
    } else if let Some(out) = &out {
        output::report(format!("{} written", out.display()));
    }
    Ok(Answer::Yes)
}

fn as_json(world: &World, model: &Model) -> Value {
    let mut tracer = Tracer::new(world);
    let snapshots = tracer.trace_all(model).enumerate();
    let snapshots: Vec<Value> = snapshots.map(|(index, found)| snapshot_json(index, found)).collect();
    json!({ "scenario": world.scenario().name(), "snapshots": snapshots })
}

fn snapshot_json(index: usize, (snapshot, contours): (&Snapshot, Contours)) -> Value {
    let points = || contours.rings.iter().flatten();
    let radii = || {
        points().filter_map(|&point| {
            snapshot.targets.iter().map(|&target| (point - target).length()).min_by(f64::total_cmp)
        })
    };
    let clearances = points().map(|&point| snapshot.walls().signed_distance(point));
    let clearance = clearances.min_by(f64::total_cmp).filter(|clearance| clearance.is_finite());
    json!({
        "index": index,
        "targets": snapshot.targets.iter().map(|target| [target.x, target.y]).collect::<Vec<_>>(),
        "enclosed": contours.enclosed,
        "rings": contours.rings.len(),
        "radius_min": radii().min_by(f64::total_cmp),
        "radius_max": radii().max_by(f64::total_cmp),
        "clearance_min": clearance,
    })
}
