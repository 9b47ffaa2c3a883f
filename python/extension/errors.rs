//! Converts errors of the core to exceptions of `sweep_and_prune/_errors.py`.

use pyo3::exceptions::{PyMemoryError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use sweep_and_prune::Error;

use crate::run::call;

/// The exception for an error. `argument` is the one that held the boxes, `ids` are those passed.
pub fn raise(py: Python<'_>, error: Error, argument: &str, ids: &[i64]) -> PyErr {
    match error {
        Error::InvalidBox { index, axis, min, max, .. } => {
            make(py, "InvalidBoxError", (index, axis, argument, min.get(), max.get()))
        }
        Error::InvalidQuery { index, .. } => make(py, "InvalidQueryError", (index,)),
        Error::StaleProxy { index, .. } => match ids.get(index) {
            Some(&id) => make(py, "StaleProxyError", (id, index)),
            None => PyRuntimeError::new_err(error.to_string()),
        },
        Error::OutOfMemory => PyMemoryError::new_err(error.to_string()),
        Error::InvalidSnapshot(_) => make(py, "SnapshotError", (error.to_string(),)),
        error => PyValueError::new_err(error.to_string()),
    }
}

/// An object that another thread, or a callback, is using.
pub fn busy(name: &str) -> PyErr {
    PyRuntimeError::new_err(format!(
        "this {name} is in use, by another thread or by the call that runs this callback: \
         create one {name} for each"
    ))
}

fn make<'py, A>(py: Python<'py>, name: &str, arguments: A) -> PyErr
where
    A: IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>, Error = PyErr>,
{
    let made = || call(&py.import("sweep_and_prune._errors")?.getattr(name)?, arguments);
    made().map_or_else(|error| error, PyErr::from_value)
}
