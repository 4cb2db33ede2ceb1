//! The files that a simulated run leaves.

use crate::figures;
use crate::files::{self, Contents};
use crate::simulation::Simulation;
use firmware_sim::scenario::Scenario;
use grn_core::blob::Blob;
use serde_json::{Value, json};

/// What a run may leave, by name.
pub const FILES: [&str; 4] = ["metrics.json", "trace.bin", "trace.csv", "trace.svg"];

/// Trace, metrics and picture of a run, by the names of their files; and why there is no picture, if there is none.
pub fn contents(simulation: &Simulation, scenario: &Scenario, blob: &Blob) -> (Contents, Option<String>) {
    let mut csv = Vec::new();
    // Writing to memory cannot fail.
    let _ = simulation.trace.to_csv(&mut csv);
    let mut contents = Contents::from([
        ("trace.bin".into(), simulation.trace.encode()),
        ("trace.csv".into(), csv),
        ("metrics.json".into(), files::json(&metrics(simulation)).into_bytes()),
    ]);
    match figures::run(simulation, scenario, blob) {
        Ok(svg) => {
            contents.insert("trace.svg".into(), svg.into_bytes());
            (contents, None)
        }
        Err(error) => (contents, Some(format!("no trace.svg: {error}"))),
    }
}

/// What a run was worth, and what it was made from: `metrics.json`.
pub fn metrics(simulation: &Simulation) -> Value {
    let identity: String = simulation.blob.iter().map(|byte| format!("{byte:02x}")).collect();
    json!({
        "grn": files::VERSION,
        "blob": identity,
        "number": simulation.number,
        "scenario": simulation.trace.header().scenario,
        "seed": simulation.config.seed,
        "robots": simulation.config.robots,
        "scale": simulation.config.scale,
        "swarm": simulation.config,
        "ring_radius_m": simulation.ring_radius_m,
        "radial_error_share": simulation.radial_error_share(),
        "metrics": simulation.metrics,
        "verdict": simulation.verdict(),
        "works": simulation.verdict().works(),
    })
}
