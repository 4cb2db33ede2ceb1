//! `grn draw`.

use super::{Answer, Failure, about, output};
use crate::evaluation::{Contours, Model, Snapshot, Tracer, World};
use crate::figures;
use crate::files::{self, read_blob};
use firmware_sim::scenario::Scenario;
use serde_json::{Value, json};
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Arguments {
    /// The controller.
    blob: PathBuf,
    /// The world.
    scenario: PathBuf,
    /// Where to write the picture [default: BLOB-SCENARIO.svg here; with --json, none].
    #[arg(long, value_name = "FILE.svg")]
    out: Option<PathBuf>,
    /// Print what was drawn, per snapshot, as JSON.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> Result<Answer, Failure> {
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
        PathBuf::from(format!("{}-{}.svg", stem(&arguments.blob), stem(&arguments.scenario)))
    };
    let out = arguments.out.clone().or_else(|| (!arguments.json).then(default));
    if let Some(out) = &out {
        files::probe(out)?;
        let svg = figures::pattern(&world, &model).map_err(about(arguments.scenario.display()))?;
        files::write(out, svg)?;
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
    let snapshots: Vec<Value> = snapshots.map(|(index, found)| snapshot_json(world, index, found)).collect();
    json!({ "scenario": world.scenario().name(), "snapshots": snapshots })
}

fn snapshot_json(world: &World, index: usize, (snapshot, contours): (&Snapshot, Contours)) -> Value {
    let points = || contours.rings.iter().flatten();
    let radii = || {
        points().filter_map(|&point| {
            snapshot.targets.iter().map(|&target| (point - target).length()).min_by(f64::total_cmp)
        })
    };
    let clearances = points().map(|&point| world.scenario().walls().signed_distance(point));
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
