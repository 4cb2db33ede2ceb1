//! Swarms in the simulator, and swarms that drove elsewhere measured with its ruler.

use crate::blob::GivenBlob;
use crate::errors::{about, failed, refused};
use crate::recorded::{Run, trace_of};
use crate::robot::number_type;
use crate::scenario::GivenScenario;
use firmware_sim::config::SwarmConfig;
use firmware_sim::trace::TraceHeader;
use grn_core::blob::Blob;
use grn_core::scalar::NumberType;
use host_evolver::files;
use host_evolver::simulation::{self, PatternRuler, check_length, usual_config};
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
    let mut raised = None;
    let found = py.detach(|| {
        simulation::simulate(&blob, &scenario, config, number, |_| match Python::attach(|py| py.check_signals()) {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                raised = Some(error);
                ControlFlow::Break(())
            }
        })
    });
    match (found.map_err(|error| failed(&error))?, raised) {
        (Some(simulation), None) => Ok(Run { simulation }),
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
    let header = TraceHeader {
        scenario: scenario.name().to_owned(),
        seed: config.seed,
        scale: config.scale,
        settle_s: config.settle_s,
        target_speed_m_per_s: config.target_speed_m_per_s,
        ticks_per_second,
        robots,
        mothers: config.mothers as u16,
        targets,
    };
    let trace = trace_of(header, positions_um, targets_um, contacts)?;
    let ruler = PatternRuler::new(&blob, &scenario).map_err(|error| failed(&error))?;
    let simulation = py.detach(|| simulation::measured(&blob, &ruler, trace, config, NumberType::F32));
    Ok(Run { simulation })
}
