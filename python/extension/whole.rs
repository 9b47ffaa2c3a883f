//! Whole numbers in double precision.

use numpy::{PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::run::run;

/// Double precision has all integers up to this one. Others may have been rounded to it.
pub const EXACT: f64 = 9_007_199_254_740_992.0;

/// Takes the ends from boxes of whole numbers: max corners become the next smaller whole ones, so that boxes that touched do not
/// overlap. The array is the package's own: nothing else reads or writes it during the call. One pass takes the time of one of
/// the five that NumPy needs.
///
/// What is returned, see [`convert`].
#[pyfunction]
pub fn take_ends(boxes: &Bound<'_, PyArray2<f64>>) -> PyResult<bool> {
    let (py, width) = (boxes.py(), boxes.shape()[1]);
    if !boxes.is_c_contiguous() {
        return Err(PyValueError::new_err("rows that follow each other are expected"));
    }
    let mut boxes = boxes.try_readwrite()?;
    let numbers = boxes.as_slice_mut()?;
    run(py, numbers.len(), 1, None, |_| convert(numbers, width, true))
}

/// Checks rows of whole numbers, and takes their ends if they have to be taken. False, with rows that are changed in part, if
/// there are numbers that may be rounded, or if ends are taken and a box has no length on some axis.
pub fn convert(numbers: &mut [f64], width: usize, take_ends: bool) -> bool {
    match (width, take_ends) {
        (2, true) => take_ends_of::<2>(numbers),
        (4, true) => take_ends_of::<4>(numbers),
        (6, true) => take_ends_of::<6>(numbers),
        // Without branches, so that compilers vectorize it.
        _ => !take_ends && numbers.iter().fold(true, |all, &number| all & (number.abs() < EXACT)),
    }
}

fn take_ends_of<const W: usize>(numbers: &mut [f64]) -> bool {
    let mut are_sound = true;
    for row in numbers.as_chunks_mut::<W>().0 {
        for axis in 0..W / 2 {
            let (low, high) = (row[axis], row[axis + W / 2]);
            are_sound &= (low < high) & (low > -EXACT) & (high < EXACT);
            row[axis + W / 2] = high - 1.0;
        }
    }
    are_sound
}
