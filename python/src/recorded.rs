//! Recorded runs as flat arrays, which Python shapes.

use crate::errors::{failed, refused};
use firmware_sim::contacts::ContactCounts;
use firmware_sim::scenario::Scenario;
use firmware_sim::trace::{Frame, NOT_THERE, Observer, RobotState, Trace, TraceHeader};
use host_evolver::simulation::Simulation;
use host_evolver::{files, record};
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyDict};
use std::path::PathBuf;

/// A simulated or measured run.
#[pyclass(frozen, module = "grn")]
pub struct Run {
    pub simulation: Simulation,
    pub trace: Trace,
    pub scenario: Scenario,
}

#[pymethods]
impl Run {
    /// Whether it met every bar.
    #[getter]
    fn works(&self) -> bool {
        self.simulation.verdict().works()
    }

    /// What `metrics.json` holds.
    fn metrics_json(&self) -> String {
        files::json(&record::metrics(&self.simulation, &self.scenario))
    }

    /// The trace's arrays.
    fn arrays<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        arrays(py, &self.trace)
    }

    /// Writes the trace in its binary layout.
    fn save_trace(&self, path: PathBuf) -> PyResult<()> {
        files::write(&path, self.trace.encode()).map_err(|error| failed(&error))
    }
}

/// The trace in a file, as arrays.
#[pyfunction]
pub fn trace_arrays(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    let name = path.display().to_string();
    let bytes = std::fs::read(&path).map_err(|error| refused(format_args!("{name}: cannot be read: {error}")))?;
    let trace = Trace::decode(&bytes).map_err(|error| refused(format_args!("{name}: {error}")))?;
    arrays(py, &trace)
}

/// The header's fields, and flat little-endian arrays: `positions_um` (frames × robots × 2, i32), `headings_q14` (the same
/// shape, i16), `wheels` (likewise, steps/s), `targets_um` (frames × targets × 2, i32; -2^31 while one is not there), `contacts` (frames × 4, u32).
fn arrays<'py>(py: Python<'py>, trace: &Trace) -> PyResult<Bound<'py, PyDict>> {
    let TraceHeader {
        scenario,
        seed,
        scale,
        settle_s,
        target_speed_m_per_s,
        ticks_per_second,
        ticks_per_frame,
        robots,
        mothers,
        targets,
    } = trace.header();
    let found = PyDict::new(py);
    found.set_item("scenario", scenario)?;
    found.set_item("seed", seed)?;
    found.set_item("scale", scale)?;
    found.set_item("settle_s", settle_s)?;
    found.set_item("target_speed_m_per_s", target_speed_m_per_s)?;
    found.set_item("ticks_per_second", ticks_per_second)?;
    found.set_item("ticks_per_frame", ticks_per_frame)?;
    found.set_item("mothers", mothers)?;
    found.set_item("robots", robots)?;
    found.set_item("targets", targets)?;
    found.set_item("frames", trace.len())?;
    let states = || trace.frames().flat_map(|frame| frame.robots.iter());
    let put = |name, bytes: Vec<u8>| found.set_item(name, PyByteArray::new(py, &bytes));
    put("positions_um", states().flat_map(|state| state.position_um).flat_map(i32::to_le_bytes).collect())?;
    put("headings_q14", states().flat_map(|state| state.heading_q14).flat_map(i16::to_le_bytes).collect())?;
    put("wheels", states().flat_map(|state| state.wheels).flat_map(i16::to_le_bytes).collect())?;
    let targets = trace.frames().flat_map(|frame| frame.targets_um.iter().map(|place| place.unwrap_or(NOT_THERE)));
    put("targets_um", targets.flatten().flat_map(i32::to_le_bytes).collect())?;
    let contacts = trace.frames().map(|frame| frame.contacts);
    let counts = |c: ContactCounts| [c.peer_events, c.wall_events, c.peers, c.walls];
    put("contacts", contacts.flat_map(counts).flat_map(u32::to_le_bytes).collect())?;
    Ok(found)
}

fn numbers<const N: usize, T>(bytes: &[u8], from: fn([u8; N]) -> T) -> Vec<T> {
    bytes.as_chunks().0.iter().copied().map(from).collect()
}

/// Shows a run in flat arrays, in the form that [`arrays`] gives them, to an observer; headings and wheels are not measured
/// and stay 0.
pub fn replay(
    header: &TraceHeader,
    positions_um: &[u8],
    targets_um: &[u8],
    contacts: &[u8],
    observer: &mut dyn Observer,
) -> PyResult<()> {
    let (robots, targets) = (usize::from(header.robots), usize::from(header.targets));
    let positions = numbers(positions_um, i32::from_le_bytes);
    let places = numbers(targets_um, i32::from_le_bytes);
    let counts = numbers(contacts, u32::from_le_bytes);
    let frames = counts.len() / 4;
    if positions.len() != frames * robots * 2 || places.len() != frames * targets * 2 || counts.len() != frames * 4 {
        return Err(refused("positions, targets and contacts must be of equally many moments"));
    }
    let mut robots_at = positions.as_chunks::<2>().0.chunks_exact(robots.max(1));
    let there = |&place: &[i32; 2]| (place != NOT_THERE).then_some(place);
    let places: Vec<Option<[i32; 2]>> = places.as_chunks::<2>().0.iter().map(there).collect();
    let mut targets_at = places.chunks_exact(targets.max(1));
    for (tick, &[peer_events, wall_events, peers, walls]) in (0..).zip(counts.as_chunks::<4>().0) {
        let here = robots_at.next().unwrap_or_default();
        let states = here.iter().map(|&position_um| RobotState { position_um, ..RobotState::default() });
        observer.observe(&Frame {
            tick,
            targets_um: targets_at.next().unwrap_or_default(),
            robots: &states.collect::<Vec<_>>(),
            contacts: ContactCounts { peer_events, wall_events, peers, walls },
        });
    }
    Ok(())
}
