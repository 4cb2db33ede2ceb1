//! What robots tell each other.

use crate::errors::about;
use crate::units::{TICK, metres};
use grn_core::robot;
use grn_core::robot::radio::packed;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// A broadcast of a robot, to be given to those that hear it.
#[pyclass(frozen, eq, module = "grn", from_py_object)]
#[derive(Clone, PartialEq)]
pub struct Message {
    pub inner: robot::Message,
}

/// A target as the sender of a message knows it.
#[pyclass(frozen, eq, get_all, module = "grn")]
#[derive(Clone, Copy, PartialEq)]
pub struct TargetReport {
    /// Which target.
    target: u8,
    /// Where the sender expects it, metres.
    position: (f64, f64),
    /// Its velocity, metres per second.
    velocity: (f64, f64),
    /// Seconds since somebody saw it, at most 8.
    age: f64,
}

#[pymethods]
impl TargetReport {
    fn __repr__(&self) -> String {
        let TargetReport { target, position, velocity, age } = self;
        format!("TargetReport(target={target}, position={position:?}, velocity={velocity:?}, age={age})")
    }
}

#[pymethods]
impl Message {
    /// The message in bytes that `pack` gave.
    #[staticmethod]
    fn unpack(data: &[u8]) -> PyResult<Message> {
        packed::read(data).map(|inner| Message { inner }).map_err(about("Message.unpack"))
    }

    /// At most 37 bytes with a checksum, as radios carry them.
    fn pack<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &packed::write(&self.inner))
    }

    /// Number of the robot that sends.
    #[getter]
    fn sender(&self) -> u16 {
        self.inner.sender
    }

    /// Where it is, metres.
    #[getter]
    fn position(&self) -> (f64, f64) {
        metres(self.inner.position)
    }

    /// One of the targets it knows, if any.
    #[getter]
    fn target(&self) -> Option<TargetReport> {
        let robot::TargetReport { target, position, velocity, age } = self.inner.target?;
        let [east, north] = velocity.map(|speed| f64::from(speed) * 1e-3);
        Some(TargetReport { target, position: metres(position), velocity: (east, north), age: f64::from(age) * TICK })
    }

    /// Some of the obstacle points it knows, metres.
    #[getter]
    fn obstacles(&self) -> Vec<(f64, f64)> {
        self.inner.obstacles.iter().map(|report| metres(report.position)).collect()
    }

    fn __repr__(&self) -> String {
        let (sender, position, obstacles) = (self.sender(), self.position(), self.inner.obstacles.len());
        let target = self.inner.target.map_or("None".into(), |report| report.target.to_string());
        format!("<Message of robot {sender} at {position:?}, target {target}, {obstacles} obstacle points>")
    }
}
