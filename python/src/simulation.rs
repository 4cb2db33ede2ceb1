//! Swarms in the simulator, and swarms that drove elsewhere measured with its ruler.

use crate::attention::attended;
use crate::blob::GivenBlob;
use crate::errors::{about, failed, refused};
use crate::laboratory::{check_settings, found};
use crate::recorded::{Run, replay};
use crate::robot::number_type;
use crate::scenario::GivenScenario;
use firmware_sim::config::SwarmConfig;
use firmware_sim::faults::FaultPlan;
use firmware_sim::lab::Laboratory;
use firmware_sim::scenario::Scenario;
use firmware_sim::trace::{Recorder, TraceHeader};
use grn_core::blob::Blob;
use grn_core::scalar::NumberType;
use host_evolver::files;
use host_evolver::realities;
use host_evolver::record;
use host_evolver::simulation::verdict::time_to_form_s;
use host_evolver::simulation::{self, Marks, PatternRuler, Simulation, check_length, meter, usual_config};
use pyo3::prelude::*;
use serde_json::json;
use std::ops::ControlFlow;
use std::sync::atomic::Ordering::Relaxed;

/// What a run is made from, as Python gives it.
#[derive(FromPyObject)]
pub struct Order<'py> {
    blob: GivenBlob<'py>,
    scenario: GivenScenario<'py>,
    robots: Option<usize>,
    seed: u64,
    scale: Option<f32>,
    speed: f64,
    dtype: String,
    lab: String,
    set: Vec<String>,
}

impl Order<'_> {
    /// Loads and checks everything.
    fn get(self) -> PyResult<(Blob, Scenario, SwarmConfig, NumberType)> {
        let (blob, scenario) = (scaled(self.blob.get()?, self.scale)?, self.scenario.get()?);
        check_settings(&scenario, &self.set)?;
        let usual = usual_config(blob.scale, found(&self.lab, &self.set)?);
        let config = SwarmConfig { seed: self.seed, target_speed_m_per_s: self.speed, ..usual };
        let mut config = scenario.configured(config);
        if let Some(count) = self.robots {
            config = config.with_robots(count);
        }
        check_length(&scenario, &config).map_err(|error| failed(&error))?;
        Ok((blob, scenario, config, number_type(&self.dtype)?))
    }
}

/// Runs a blob on every robot of a swarm until all targets have arrived.
#[pyfunction]
pub fn simulate(py: Python<'_>, order: Order<'_>) -> PyResult<Run> {
    let (blob, scenario, config, number) = order.get()?;
    let mut recorder = record::recorder(&scenario, &config);
    let simulated = attended(
        py,
        |_, ()| Ok(()),
        |stop, _| {
            let watch = |_| if stop.load(Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
            simulation::simulate(&blob, &scenario, config, number, &mut recorder, watch)
        },
    )?;
    let simulation = simulated.map_err(|error| failed(&error))?.ok_or_else(|| refused("interrupted"))?;
    Ok(Run { simulation, trace: recorder.into_trace(), scenario })
}

/// The same in laboratories number 1 to `count` drawn around the given one; what came out, as JSON.
#[pyfunction]
pub fn realities_json(py: Python<'_>, order: Order<'_>, count: u64) -> PyResult<String> {
    let (blob, scenario, config, number) = order.get()?;
    if count == 0 {
        return Err(refused("realities = 0: at least 1 is needed"));
    }
    let found = attended(
        py,
        |_, ()| Ok(()),
        |stop, _| realities::try_all(&blob, &scenario, &config, number, 1..=count, stop, &|| ()),
    )?;
    let robustness = found.map_err(|error| failed(&error))?.ok_or_else(|| refused("interrupted"))?;
    Ok(files::json(&json!({
        "works": robustness.works(),
        "interval": robustness.interval(),
        "realities": robustness.realities,
    })))
}

/// The blob for a world of this scale, or of its own.
fn scaled(blob: Blob, scale: Option<f32>) -> PyResult<Blob> {
    let blob = Blob { scale: scale.unwrap_or(blob.scale), ..blob };
    files::blob_bytes(&blob).map_err(about("scale"))?;
    Ok(blob)
}

/// What a swarm that drove elsewhere is worth, from flat arrays.
#[pyfunction]
#[pyo3(signature = (blob, scenario, *, scale, positions_um, targets_um, contacts, robots, targets, ticks_per_second))]
#[expect(clippy::too_many_arguments, reason = "each is a keyword of its own in Python")]
pub fn measure(
    py: Python<'_>,
    blob: GivenBlob<'_>,
    scenario: GivenScenario<'_>,
    scale: Option<f32>,
    positions_um: &[u8],
    targets_um: &[u8],
    contacts: &[u8],
    robots: u16,
    targets: u16,
    ticks_per_second: u16,
) -> PyResult<Run> {
    let (blob, scenario) = (scaled(blob.get()?, scale)?, scenario.get()?);
    if scenario.walls_change() {
        return Err(refused(format_args!(
            "{}: what drove elsewhere is not measured among walls that move",
            scenario.name()
        )));
    }
    let config = usual_config(blob.scale, Laboratory::default()).with_robots(robots.into());
    // Nor is the laboratory of elsewhere.
    let header =
        TraceHeader { ticks_per_second, robots, targets, laboratory: None, ..TraceHeader::of(&scenario, &config) };
    let world = scenario.clone();
    let ruler = PatternRuler::new(&blob, &world).map_err(|error| failed(&error))?;
    // What went wrong elsewhere is not told.
    let faults = FaultPlan::default();
    let marks = Marks::of(scenario.scaled(config.scale), &config, &faults);
    let mut meter = meter(&ruler, &marks, ticks_per_second);
    let mut caging = marks.caging_meter(ticks_per_second);
    let mut recorder = Recorder::new(header.clone(), usize::MAX);
    let mut observers = (&mut (&mut meter, &mut caging), &mut recorder);
    py.detach(|| replay(&header, positions_um, targets_um, contacts, &mut observers))?;
    let simulation = Simulation {
        caging: caging.caging(),
        metrics: meter.metrics(),
        time_to_form_s: time_to_form_s(&config, scenario.scaled(config.scale).ring()),
        faults,
        base: None,
        ring_radius_m: ruler.ring_radius(),
        blob: blob.identity(),
        number: NumberType::F32,
        config,
    };
    Ok(Run { simulation, trace: recorder.into_trace(), scenario })
}
