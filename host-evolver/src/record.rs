//! The files that a simulated run leaves.

use crate::faults;
use crate::figures;
use crate::files::{self, Contents};
use crate::simulation::Simulation;
use firmware_sim::config::SwarmConfig;
use firmware_sim::scenario::Scenario;
use firmware_sim::trace::{Recorder, Trace, TraceHeader};
use grn_core::blob::Blob;
use serde_json::{Value, json};

/// The most memory that the record of a run takes, bytes. To write it as text and as bytes takes four times as much more.
const MOST_RECORD: usize = 100_000_000;

/// Keeps a run for its files.
pub fn recorder(scenario: &Scenario, config: &SwarmConfig) -> Recorder {
    Recorder::new(TraceHeader::of(scenario, config), MOST_RECORD)
}

/// Trace, metrics and picture of a run, by the names of their files; and why there is no picture, if there is none.
pub fn contents(
    simulation: &Simulation,
    trace: &Trace,
    scenario: &Scenario,
    blob: &Blob,
) -> (Contents, Option<String>) {
    let mut contents = Contents::from([
        ("trace.bin".into(), trace.encode()),
        ("trace.csv".into(), trace.to_csv()),
        ("metrics.json".into(), files::json(&metrics(simulation, scenario)).into_bytes()),
    ]);
    match figures::run(simulation, trace, scenario, blob) {
        Ok(svg) => {
            contents.insert("trace.svg".into(), svg.into_bytes());
            (contents, None)
        }
        Err(error) => (contents, Some(format!("no trace.svg: {error}"))),
    }
}

/// What a run was worth, and what it was made from: `metrics.json`.
pub fn metrics(simulation: &Simulation, scenario: &Scenario) -> Value {
    let identity: String = simulation.blob.iter().map(|byte| format!("{byte:02x}")).collect();
    json!({
        "grn": files::VERSION,
        "blob": identity,
        "number": simulation.number,
        "scenario": scenario.name(),
        "seed": simulation.config.seed,
        "robots": simulation.config.lab.robots.count,
        "laboratory": simulation.config.lab.name,
        "scale": simulation.config.scale,
        "swarm": simulation.config,
        "ring_radius_m": simulation.ring_radius_m,
        "radial_error_share": simulation.radial_error_share(),
        "caged_share": simulation.caging.caged_share,
        "pen": simulation.caging.pen,
        "in_band_share": simulation.caging.in_band_share,
        "contact_share": simulation.caging.contact_share,
        "lost_share": simulation.lost_share(),
        "formed_at_s": simulation.caging.formed_at_s,
        "cost": simulation.caging.cost(),
        "metrics": simulation.metrics,
        "faults": faults::happened(simulation),
        "base_station": simulation.base,
        "verdict": simulation.verdict(),
        "works": simulation.verdict().works(),
    })
}
