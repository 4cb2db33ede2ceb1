//! Controllers as files.

use crate::errors::{about, failed, refused};
use crate::scenario::GivenScenario;
use grn_core::blob;
use grn_core::network::Network;
use grn_core::scalar::{NumberType, Q8_24, Scalar};
use host_evolver::evaluation::{Evaluator, Model, World};
use host_evolver::files;
use host_evolver::model::describe;
use host_evolver::model::notation::Digits;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::path::PathBuf;

/// The largest input, as of `grn eval`: Q8.24 holds numbers below 128.
const LARGEST: f64 = 100.0;

/// A controller: what `grn evolve` finds, `grn flash` brings onto robots, and `Robot` runs.
#[pyclass(frozen, eq, module = "grn")]
#[derive(Clone, PartialEq)]
pub struct Blob {
    pub inner: blob::Blob,
}

/// What the evaluation of a model in a scenario finds.
#[pyclass(frozen, get_all, module = "grn")]
pub struct Evaluation {
    /// The paper's f2: how far the ring is from the wanted distances, over all snapshots; 0 to 2, less is better.
    f2: f64,
    /// How much of the constraints is violated: targets not enclosed, candidate points too close to obstacles; 0 to 2.
    violation: f64,
    /// Whether nothing is.
    feasible: bool,
}

#[pymethods]
impl Evaluation {
    fn __repr__(&self) -> String {
        format!("Evaluation(f2={}, violation={})", self.f2, self.violation)
    }
}

/// What functions take where they need a controller.
#[derive(FromPyObject)]
pub enum GivenBlob<'py> {
    Loaded(PyRef<'py, Blob>),
    Path(PathBuf),
}

impl GivenBlob<'_> {
    /// The blob, loaded if it is not yet.
    pub fn get(self) -> PyResult<blob::Blob> {
        match self {
            GivenBlob::Loaded(blob) => Ok(blob.inner.clone()),
            GivenBlob::Path(path) => files::read_blob(&path).map_err(|error| failed(&error)),
        }
    }
}

impl Blob {
    /// The model with its level; `None` without a pattern.
    fn model(&self) -> Option<Model> {
        Model::new(&self.inner.network, f64::from(self.inner.level_fraction)).ok()
    }
}

#[pymethods]
impl Blob {
    /// The blob in a file.
    #[staticmethod]
    fn load(path: PathBuf) -> PyResult<Blob> {
        files::read_blob(&path).map(|inner| Blob { inner }).map_err(|error| failed(&error))
    }

    /// The blob in its bytes.
    #[staticmethod]
    fn from_bytes(data: &[u8]) -> PyResult<Blob> {
        blob::Blob::decode(data).map(|inner| Blob { inner }).map_err(about("Blob.from_bytes"))
    }

    /// Its bytes, as they are flashed.
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        files::blob_bytes(&self.inner).map(|bytes| PyBytes::new(py, &bytes)).map_err(|error| failed(&error))
    }

    /// Writes it to a file, whole or not at all.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        let bytes = files::blob_bytes(&self.inner).map_err(|error| failed(&error))?;
        files::write(&path, bytes).map_err(|error| failed(&error))
    }

    /// The same controller for a world of another scale.
    fn with_scale(&self, scale: f32) -> PyResult<Blob> {
        let inner = blob::Blob { scale, ..self.inner.clone() };
        files::blob_bytes(&inner).map_err(about("scale"))?;
        Ok(Blob { inner })
    }

    /// World metres per model metre.
    #[getter]
    fn scale(&self) -> f32 {
        self.inner.scale
    }

    /// The first 8 bytes of its SHA-256, hexadecimal.
    #[getter]
    fn identity(&self) -> String {
        self.inner.identity().iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// f1: nodes of the tree, functions and terminals.
    #[getter]
    fn nodes(&self) -> usize {
        describe::tree_size(&self.inner.network)
    }

    /// The model in one expression.
    #[getter]
    fn expression(&self) -> String {
        describe::expression(&self.inner.network, Digits::All)
    }

    /// One equation for each gene.
    #[getter]
    fn equations(&self) -> Vec<String> {
        describe::equations(&self.inner.network, Digits::All)
    }

    /// Level of M on the pattern; None if the model has none.
    #[getter]
    fn level(&self) -> Option<f64> {
        self.model().map(|model| model.pattern().level())
    }

    /// Radius of the ring around a lone target in free space, metres in the world; None if there is no ring.
    #[getter]
    fn ring_radius(&self) -> Option<f64> {
        let model = self.model()?;
        let radius = model.pattern().free_space_radius(model.network(), &self.inner.field.field(1.0))?;
        Some(radius * f64::from(self.inner.scale))
    }

    /// Steady state of the pattern morphogen M for inputs x1 and x2, computed in "f64", "f32" or "q8.24".
    #[pyo3(signature = (x1, x2, dtype="f64"))]
    fn steady_state(&self, x1: f64, x2: f64, dtype: &str) -> PyResult<f64> {
        fn steady<S: Scalar>(network: &Network<f32>, x1: f64, x2: f64) -> f64 {
            network.cast::<S>().steady_state(S::from_f64(x1), S::from_f64(x2)).to_f64()
        }
        if !(x1.abs() <= LARGEST && x2.abs() <= LARGEST) {
            return Err(refused(format_args!("x1 = {x1}, x2 = {x2}: must be within {LARGEST} of 0")));
        }
        let network = &self.inner.network;
        match dtype {
            "f64" => Ok(steady::<f64>(network, x1, x2)),
            _ => match dtype.parse() {
                Ok(NumberType::F32) => Ok(steady::<f32>(network, x1, x2)),
                Ok(NumberType::Q8_24) => Ok(steady::<Q8_24>(network, x1, x2)),
                Err(_) => Err(refused(format_args!("dtype = {dtype:?}: f64, f32 or q8.24 is needed"))),
            },
        }
    }

    /// f2 and constraint violation in a scenario, as evolution sees them.
    fn evaluate(&self, py: Python<'_>, scenario: GivenScenario<'_>) -> PyResult<Evaluation> {
        let scenario = scenario.get()?;
        let found = py.detach(|| {
            let world = World::new(scenario);
            let model = self.model();
            model.map_or(host_evolver::evaluation::Evaluation::NO_PATTERN, |model| {
                Evaluator::new(&world).evaluate(&model)
            })
        });
        Ok(Evaluation { f2: found.f2, violation: found.violation, feasible: found.is_feasible() })
    }

    fn __repr__(&self) -> String {
        format!("<Blob {}: {}>", self.identity(), describe::expression(&self.inner.network, Digits::Four))
    }
}
