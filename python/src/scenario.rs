//! Worlds.

use crate::errors::{failed, refused};
use crate::units::pair;
use firmware_sim::geometry::Walls;
use firmware_sim::scenario::{self, OBSTACLE_SPACING};
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

fn corners(walls: &Walls) -> Vec<Vec<Place>> {
    walls.polygons().map(|wall| wall.vertices().iter().map(place).collect()).collect()
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

    /// The corners of the walls that are always where they are drawn, one list a wall.
    #[getter]
    fn walls(&self) -> Vec<Vec<Place>> {
        corners(self.inner.fixed_walls())
    }

    /// The corners of all walls that are there after this share of the time, 0 to 1.
    fn walls_at(&self, share: f64) -> Vec<Vec<Place>> {
        corners(&self.inner.walls_at(share))
    }

    /// The times, shares of the run, at which a target or a wall comes or goes.
    #[getter]
    fn changes(&self) -> Vec<f64> {
        self.inner.changes()
    }

    /// Whether a wall moves, comes or goes.
    #[getter]
    fn walls_change(&self) -> bool {
        self.inner.walls_change()
    }

    /// The targets' paths, one list of points a target.
    #[getter]
    fn paths(&self) -> Vec<Vec<Place>> {
        self.inner.targets().iter().map(|target| target.path().points().iter().map(place).collect()).collect()
    }

    /// The longest way that anything would go in the whole run at its greatest speed: the length of the longest path, if all
    /// targets move at constant speed.
    #[getter]
    fn longest_path(&self) -> f64 {
        self.inner.longest_path()
    }

    /// Nearest and farthest wanted distance from a target.
    #[getter]
    fn ring(&self) -> (f64, f64) {
        (self.inner.ring().d_min, self.inner.ring().d_max)
    }

    /// How long the run takes after settling if nothing is faster than this, seconds.
    fn travel_s(&self, speed: f64) -> f64 {
        self.inner.travel_s(speed)
    }

    /// Where each target is after this share of the time, 0 to 1; `None` while it is not there.
    fn targets_at(&self, share: f64) -> Vec<Option<Place>> {
        self.inner.targets().iter().map(|target| target.at(share).as_ref().map(place)).collect()
    }

    /// Points on the outlines of `walls` as mother robots see them, for a scenario in model metres: scale them, not it.
    fn boundary_samples(&self) -> Vec<Place> {
        self.inner.fixed_walls().boundary_samples(OBSTACLE_SPACING).iter().map(place).collect()
    }

    /// Distance from a place to the nearest of `walls`, negative inside one; infinite without walls.
    fn clearance(&self, position: &Bound<'_, PyAny>) -> PyResult<f64> {
        let [x, y] = pair("position", position)?;
        Ok(self.inner.fixed_walls().signed_distance(Point::new(x, y)))
    }

    fn __repr__(&self) -> String {
        let walls = self.inner.fixed_walls().fixed().len() + self.inner.moving_walls().len();
        let targets = self.inner.targets().len();
        format!("<Scenario {:?}: targets {targets}, walls {walls}>", self.inner.name())
    }
}
