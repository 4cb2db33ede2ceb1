//! Worlds.

use crate::errors::{failed, refused};
use crate::units::pair;
use firmware_sim::scenario;
use grn_core::geometry::Point;
use pyo3::prelude::*;
use std::path::PathBuf;

type Place = (f64, f64);

fn place(point: &Point<f64>) -> Place {
    (point.x, point.y)
}

/// A world: region, targets' paths, walls. All in metres.
#[pyclass(frozen, eq, module = "grn")]
#[derive(PartialEq)]
pub struct Scenario {
    pub inner: scenario::Scenario,
}

/// What functions take where they need a world.
#[derive(FromPyObject)]
pub enum GivenScenario<'py> {
    Loaded(PyRef<'py, Scenario>),
    Path(PathBuf),
}

impl GivenScenario<'_> {
    /// The world, loaded if it is not yet.
    pub fn get(self) -> PyResult<scenario::Scenario> {
        match self {
            GivenScenario::Loaded(scenario) => Ok(scenario.inner.clone()),
            GivenScenario::Path(path) => scenario::Scenario::load(path).map_err(|error| failed(&error)),
        }
    }
}

#[pymethods]
impl Scenario {
    /// The scenario in a TOML file.
    #[staticmethod]
    fn load(path: PathBuf) -> PyResult<Scenario> {
        scenario::Scenario::load(path).map(|inner| Scenario { inner }).map_err(|error| failed(&error))
    }

    /// The scenario in TOML text.
    #[staticmethod]
    fn from_toml(text: &str) -> PyResult<Scenario> {
        scenario::Scenario::parse(text).map(|inner| Scenario { inner }).map_err(|error| failed(&error))
    }

    /// The canonical TOML text.
    fn to_toml(&self) -> String {
        self.inner.to_toml()
    }

    /// The same world with every length multiplied by a factor.
    fn scaled(&self, factor: f64) -> PyResult<Scenario> {
        if factor > 0.0 && factor.is_finite() {
            return Ok(Scenario { inner: self.inner.scaled(factor) });
        }
        Err(refused(format_args!("factor = {factor}: must be above 0 and finite")))
    }

    /// What it is called.
    #[getter]
    fn name(&self) -> &str {
        self.inner.name()
    }

    /// Extent from the origin, (east, north).
    #[getter]
    fn region(&self) -> (f64, f64) {
        self.inner.region().into()
    }

    /// The walls' corners, one list a wall.
    #[getter]
    fn walls(&self) -> Vec<Vec<Place>> {
        self.inner.walls().polygons().iter().map(|wall| wall.vertices().iter().map(place).collect()).collect()
    }

    /// The targets' paths, one list of points a target.
    #[getter]
    fn paths(&self) -> Vec<Vec<Place>> {
        self.inner.paths().iter().map(|path| path.points().iter().map(place).collect()).collect()
    }

    /// Length of the longest path.
    #[getter]
    fn longest_path(&self) -> f64 {
        self.inner.longest_path()
    }

    /// Nearest and farthest wanted distance from a target.
    #[getter]
    fn ring(&self) -> (f64, f64) {
        (self.inner.ring().d_min, self.inner.ring().d_max)
    }

    /// Where the targets are after this share of the time, 0 to 1.
    fn targets_at(&self, share: f64) -> Vec<Place> {
        self.inner.targets_at(share).iter().map(place).collect()
    }

    /// Points on the walls' outlines as mother robots see them, for a scenario in model metres: scale them, not it.
    fn boundary_samples(&self) -> Vec<Place> {
        self.inner.boundary_samples().iter().map(place).collect()
    }

    /// Distance from a place to the nearest wall, negative inside one; infinite without walls.
    fn clearance(&self, position: &Bound<'_, PyAny>) -> PyResult<f64> {
        let [x, y] = pair("position", position)?;
        Ok(self.inner.walls().signed_distance(Point::new(x, y)))
    }

    fn __repr__(&self) -> String {
        let (targets, walls) = (self.inner.paths().len(), self.inner.walls().polygons().len());
        format!("<Scenario {:?}: targets {targets}, walls {walls}>", self.inner.name())
    }
}
