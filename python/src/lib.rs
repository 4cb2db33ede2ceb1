//! The compiled part of the Python package grn: the libraries as Python sees them. What a user imports is `grn/__init__.py`, which adds
//! NumPy and pandas; the types are in `grn/_native.pyi`.

mod attention;
mod blob;
mod errors;
mod evolution;
mod laboratory;
mod message;
mod recorded;
mod robot;
mod scenario;
mod simulation;
mod units;

use pyo3::prelude::*;

/// The compiled part of grn.
#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::blob::{Blob, Evaluation};
    #[pymodule_export]
    use crate::errors::GrnError;
    #[pymodule_export]
    use crate::evolution::{Found, Progress, evolve};
    #[pymodule_export]
    use crate::laboratory::laboratory_json;
    #[pymodule_export]
    use crate::message::{Message, TargetReport};
    #[pymodule_export]
    use crate::recorded::{Run, trace_arrays};
    #[pymodule_export]
    use crate::robot::{Command, Robot};
    #[pymodule_export]
    use crate::scenario::Scenario;
    #[pymodule_export]
    use crate::simulation::{measure, realities_json, simulate};
    #[pymodule_export]
    const VERSION: &str = host_evolver::files::VERSION;
}
