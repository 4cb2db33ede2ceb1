//! A controller that runs in Python.

use crate::blob::Blob;
use crate::errors::{about, refused};
use crate::message::Message;
use crate::units::{TICK, direction, free_distance, micrometres, microseconds, millimetres, milliseconds, pair};
use grn_core::robot::epuck2::{METRES_PER_STEP, PROXIMITY_SENSORS, STEPS_PER_TURN};
use grn_core::robot::percept::{MAX_HEARD, MAX_SEEN_OBSTACLES, MAX_TARGETS};
use grn_core::robot::{Controller, Fix, Heard, Percept, Sighting};
use grn_core::scalar::{NumberType, Q8_24};
use heapless::Vec;
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

enum Native {
    F32(Box<Controller<f32>>),
    Q8_24(Box<Controller<Q8_24>>),
}

/// A blob running on one robot: the same code, and the same bits, as on the real one.
#[pyclass(module = "grn")]
pub struct Robot {
    controller: Native,
    number: u16,
    dtype: NumberType,
}

/// What a robot does until the next tick.
#[pyclass(frozen, eq, module = "grn")]
#[derive(PartialEq)]
pub struct Command {
    /// Left and right wheel, motor steps per second, forward positive, within 1100.
    #[pyo3(get)]
    steps_per_s: (i16, i16),
    /// What the robot broadcasts in this tick, or None.
    #[pyo3(get)]
    broadcast: Option<Message>,
}

#[pymethods]
impl Command {
    /// Left and right wheel of an e-puck2, radians per second, forward positive.
    #[getter]
    fn rad_per_s(&self) -> (f64, f64) {
        self.times(TAU / f64::from(STEPS_PER_TURN))
    }

    /// Left and right wheel's rim, metres per second, forward positive: for robots with other wheels.
    #[getter]
    fn m_per_s(&self) -> (f64, f64) {
        self.times(METRES_PER_STEP)
    }

    fn __repr__(&self) -> String {
        let says = if self.broadcast.is_some() { "a message" } else { "None" };
        format!("<Command steps_per_s={:?}, broadcast={says}>", self.steps_per_s)
    }
}

impl Command {
    fn times(&self, unit: f64) -> (f64, f64) {
        let (left, right) = self.steps_per_s;
        (f64::from(left) * unit, f64::from(right) * unit)
    }
}

#[pymethods]
impl Robot {
    #[new]
    #[pyo3(signature = (blob, number=0, dtype="f32"))]
    fn new(blob: &Blob, number: u16, dtype: &str) -> PyResult<Robot> {
        let dtype = number_type(dtype)?;
        let controller = match dtype {
            NumberType::F32 => Controller::new(&blob.inner, number).map(|controller| Native::F32(controller.into())),
            NumberType::Q8_24 => {
                Controller::new(&blob.inner, number).map(|controller| Native::Q8_24(controller.into()))
            }
        };
        Ok(Robot { controller: controller.map_err(about("Robot"))?, number, dtype })
    }

    /// Its number, unique in the swarm.
    #[getter]
    fn number(&self) -> u16 {
        self.number
    }

    /// What it computes in: "f32" or "q8.24".
    #[getter]
    fn dtype(&self) -> &'static str {
        self.dtype.name()
    }

    /// M where the robot is, as its genes express it now.
    #[getter]
    fn morphogen(&self) -> f64 {
        use grn_core::scalar::Scalar;
        match &self.controller {
            Native::F32(controller) => controller.morphogen().to_f64(),
            Native::Q8_24(controller) => controller.morphogen().to_f64(),
        }
    }

    /// One control tick: perceive, express genes, move; with `home`, a place in metres, the robot drives there instead.
    #[pyo3(signature = (*, position=None, heading=None, pose_age=0.0, elapsed=TICK, proximity=None, targets=None,
        obstacles=None, heard=None, home=None))]
    #[expect(clippy::too_many_arguments, reason = "each is a keyword of its own in Python")]
    fn tick(
        &mut self,
        position: Option<&Bound<'_, PyAny>>,
        heading: Option<f64>,
        pose_age: f64,
        elapsed: f64,
        proximity: Option<&Bound<'_, PyAny>>,
        targets: Option<BTreeMap<u8, Bound<'_, PyAny>>>,
        obstacles: Option<&Bound<'_, PyAny>>,
        heard: Option<&Bound<'_, PyAny>>,
        home: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Command> {
        let percept = Percept {
            fix: fix(position, heading, pose_age)?,
            elapsed_us: microseconds("elapsed", elapsed)?,
            proximity: proximity.map_or(Ok([u16::MAX; PROXIMITY_SENSORS]), ring)?,
            targets: targets.map_or(Ok(Vec::new()), sightings)?,
            obstacles: obstacles.map_or(Ok(Vec::new()), |points| {
                listed("obstacles", points, MAX_SEEN_OBSTACLES, |point| millimetres("obstacles", point))
            })?,
            heard: heard.map_or(Ok(Vec::new()), |messages| listed("heard", messages, MAX_HEARD, hearing))?,
        };
        let home = home.map(|place| millimetres("home", place)).transpose()?;
        let command = match (&mut self.controller, home) {
            (Native::F32(controller), None) => controller.tick(&percept),
            (Native::Q8_24(controller), None) => controller.tick(&percept),
            (Native::F32(controller), Some(home)) => controller.tick_home(&percept, home),
            (Native::Q8_24(controller), Some(home)) => controller.tick_home(&percept, home),
        };
        let command = command.map_err(refused)?;
        let broadcast = command.broadcast.map(|inner| Message { inner });
        Ok(Command { steps_per_s: (command.left, command.right), broadcast })
    }

    fn __repr__(&self) -> String {
        format!("<Robot {} in {}>", self.number, self.dtype)
    }
}

/// A number type by its name.
pub fn number_type(name: &str) -> PyResult<NumberType> {
    name.parse().map_err(about(&format!("dtype = {name:?}")))
}

/// The eight free distances.
fn ring(distances: &Bound<'_, PyAny>) -> PyResult<[u16; PROXIMITY_SENSORS]> {
    let distances: std::vec::Vec<Option<f64>> =
        distances.try_iter()?.map(|distance| distance?.extract()).collect::<PyResult<_>>()?;
    let count = distances.len();
    let sensed: std::vec::Vec<u16> = distances.into_iter().map(free_distance).collect::<PyResult<_>>()?;
    sensed.try_into().map_err(|_| {
        refused(format_args!(
            "proximity has {count} distances: give {PROXIMITY_SENSORS}, one a sensor, None for nothing in reach"
        ))
    })
}

/// In the order of their numbers: mother robots share targets out by it.
fn sightings(targets: BTreeMap<u8, Bound<'_, PyAny>>) -> PyResult<Vec<Sighting, MAX_TARGETS>> {
    let count = targets.len();
    let mut seen = Vec::new();
    for (target, position) in targets {
        let sighting = Sighting { target, position: millimetres("targets", &position)? };
        seen.push(sighting).map_err(|_| too_many("targets", count, MAX_TARGETS))?;
    }
    Ok(seen)
}

/// A pose, if there is one.
fn fix(position: Option<&Bound<'_, PyAny>>, heading: Option<f64>, pose_age: f64) -> PyResult<Option<Fix>> {
    match (position, heading) {
        (None, None) => Ok(None),
        (Some(position), Some(heading)) => Ok(Some(Fix {
            position: micrometres("position", pair("position", position)?)?,
            heading: direction(heading)?,
            age_ms: milliseconds("pose_age", pose_age)?,
        })),
        _ => Err(refused("position and heading belong together: give both, or neither where the pose is not known")),
    }
}

/// A message, or a message with the seconds that it was on its way.
fn hearing(value: &Bound<'_, PyAny>) -> PyResult<Heard> {
    if let Ok(message) = value.extract::<Message>() {
        return Ok(Heard { message: message.inner, age_ms: 0 });
    }
    match value.extract::<(Message, f64)>() {
        Ok((message, age)) => Ok(Heard { message: message.inner, age_ms: milliseconds("heard", age)? }),
        Err(_) => Err(refused(format_args!("heard: {value} is neither a message nor (message, age in seconds)"))),
    }
}

fn listed<T, const N: usize>(
    what: &str,
    values: &Bound<'_, PyAny>,
    most: usize,
    one: impl Fn(&Bound<'_, PyAny>) -> PyResult<T>,
) -> PyResult<Vec<T, N>> {
    let mut list = Vec::new();
    for value in values.try_iter()? {
        list.push(one(&value?)?).map_err(|_| too_many(what, values.len().unwrap_or(most + 1), most))?;
    }
    Ok(list)
}

fn too_many(what: &str, count: usize, most: usize) -> PyErr {
    refused(format_args!(
        "{what}: {count} in one tick: a robot takes at most {most}; give the nearest, or the others in the next tick"
    ))
}
