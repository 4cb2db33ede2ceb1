//! Swarms in the simulator, and swarms that drove elsewhere measured with its ruler.

use crate::blob::GivenBlob;
use crate::errors::{about, failed, refused};
use crate::recorded::{Run, replay};
use crate::robot::number_type;
use crate::scenario::GivenScenario;
use firmware_sim::config::SwarmConfig;
use firmware_sim::trace::{Recorder, TraceHeader};
use grn_core::blob::Blob;
use grn_core::scalar::NumberType;
use host_evolver::files;
use host_evolver::record;
use host_evolver::simulation::{self, Marks, PatternRuler, Simulation, check_length, meter, usual_config};
use pyo3::prelude::*;
use std::ops::ControlFlow;

/// Runs a blob on every robot of a swarm until all targets have arrived.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "each is a keyword of its own in Python")]
#[pyo3(signature = (blob, scenario, *, robots, seed, scale, speed, dtype))]
pub fn simulate(
    py: Python<'_>,
    blob: GivenBlob<'_>,
    scenario: GivenScenario<'_>,
    robots: usize,
    seed: u64,
    scale: Option<f32>,
    speed: f64,
    dtype: &str,
) -> PyResult<Run> {
    let (blob, scenario) = (scaled(blob.get()?, scale)?, scenario.get()?);
    let config = SwarmConfig { seed, target_speed_m_per_s: speed, ..usual_config(blob.scale, robots) };
    check_length(&scenario, &config).map_err(|error| failed(&error))?;
    let number = number_type(dtype)?;
    let mut recorder = record::recorder(&scenario, &config);
    let mut raised = None;
    let found = py.detach(|| {
        simulation::simulate(&blob, &scenario, config, number, &mut recorder, |_| {
            match Python::attach(|py| py.check_signals()) {
                Ok(()) => ControlFlow::Continue(()),
                Err(error) => {
                    raised = Some(error);
                    ControlFlow::Break(())
                }
            }
        })
    });
    match (found.map_err(|error| failed(&error))?, raised) {
        (Some(simulation), None) => Ok(Run { simulation, trace: recorder.into_trace(), scenario }),
        (_, Some(error)) => Err(error),
        (None, None) => Err(refused("interrupted")),
    }
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
    let config = usual_config(blob.scale, robots.into());
    let header = TraceHeader { ticks_per_second, robots, targets, ..TraceHeader::of(&scenario, &config) };
    let world = scenario.clone();
    let ruler = PatternRuler::new(&blob, &world).map_err(|error| failed(&error))?;
    let marks = Marks::of(&scenario, &config);
    let mut meter = meter(&ruler, &marks, ticks_per_second);
    let mut recorder = Recorder::new(header.clone(), usize::MAX);
    py.detach(|| replay(&header, positions_um, targets_um, contacts, &mut (&mut meter, &mut recorder)))?;
    let (metrics, ring_radius_m) = (meter.metrics(), ruler.ring_radius());
    let simulation = Simulation { metrics, ring_radius_m, blob: blob.identity(), number: NumberType::F32, config };
    Ok(Run { simulation, trace: recorder.into_trace(), scenario })
}
