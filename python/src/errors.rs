//! How refusals of the library become Python's exceptions.

use pyo3::exceptions::PyValueError;
use pyo3::{PyErr, create_exception};
use std::error::Error;
use std::fmt;

create_exception!(
    grn,
    GrnError,
    PyValueError,
    "What grn refuses, in its own words: what is wrong, where, and what would be right."
);

/// A refusal in words.
pub fn refused(text: impl fmt::Display) -> PyErr {
    GrnError::new_err(text.to_string())
}

/// An error of the library with the causes that it does not name itself.
pub fn failed(error: &(dyn Error + 'static)) -> PyErr {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let more = error.to_string();
        if !text.contains(&more) {
            text = format!("{text}: {more}");
        }
        cause = error.source();
    }
    refused(text)
}

/// An error about something that it does not name.
pub fn about<E: fmt::Display>(what: &str) -> impl FnOnce(E) -> PyErr + '_ {
    move |error| refused(format_args!("{what}: {error}"))
}
