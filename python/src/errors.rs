//! Errors of the core as exceptions of `sweep_and_prune/_errors.py`.

use pyo3::exceptions::{PyMemoryError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use sweep_and_prune::{Error, SnapshotFault};

/// The exception of an error; `argument` names the boxes at fault, `ids` are those passed.
pub fn raise(py: Python<'_>, error: Error, argument: &str, ids: &[u64]) -> PyErr {
    match error {
        Error::InvalidBox { index, axis, .. } => make(py, "InvalidBoxError", (index, axis, argument)),
        Error::InvalidQuery { index, .. } => make(py, "InvalidQueryError", (index,)),
        Error::StaleProxy { index, .. } => match ids.get(index) {
            Some(&id) => make(py, "StaleProxyError", (id, index)),
            None => PyRuntimeError::new_err(error.to_string()),
        },
        Error::OutOfMemory => PyMemoryError::new_err(error.to_string()),
        Error::InvalidSnapshot(fault) => make(py, "SnapshotError", (say(fault),)),
        error => PyValueError::new_err(error.to_string()),
    }
}

/// An object that another thread, or a callback, has in use.
pub fn busy(name: &str) -> PyErr {
    PyRuntimeError::new_err(format!(
        "this {name} is at work, in another thread or around this callback: use one for each"
    ))
}

fn say(fault: SnapshotFault) -> String {
    Error::InvalidSnapshot(fault).to_string()
}

fn make<'py>(
    py: Python<'py>,
    name: &str,
    arguments: impl IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>, Error = PyErr>,
) -> PyErr {
    let made = (|| {
        let arguments = arguments.into_pyobject(py)?;
        py.import("sweep_and_prune._errors")?.getattr(name)?.call1(arguments)
    })();
    made.map_or_else(|error| error, PyErr::from_value)
}
