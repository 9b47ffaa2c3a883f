//! Looks numbers up in sorted ones.

use std::hint::select_unpredictable;

use numpy::{Element, PyArray1, PyArrayMethods};
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;

use crate::arrays::{Array, numbers};
use crate::run::run;

/// This many numbers are looked up at the same time: the processor waits for the memory of all of them together.
const LANES: usize = 16;

/// How many of the sorted numbers are less than each value; or, with `or_equal`, less or equal. Both arrays are of `f64`
/// or of `i64`, without NaN, and the package's own: nothing writes to them during the call.
///
/// O(values · log sorted). No branch depends on a value: with a branch instead of `select_unpredictable`, values in no order
/// take 7 to 46 times as long (1,000 to 1,000,000 values, a tenth as many sorted, paired runs on a busy machine).
#[pyfunction]
pub fn ranks<'py>(
    sorted: &Bound<'py, PyAny>,
    values: &Bound<'py, PyAny>,
    or_equal: bool,
) -> PyResult<Array<'py>> {
    if sorted.cast::<PyArray1<f64>>().is_ok() {
        return ranks_of::<f64>(sorted, values, or_equal);
    }
    ranks_of::<i64>(sorted, values, or_equal)
}

fn ranks_of<'py, T: Element + Copy + PartialOrd + Sync>(
    sorted: &Bound<'py, PyAny>,
    values: &Bound<'py, PyAny>,
    or_equal: bool,
) -> PyResult<Array<'py>> {
    let py = sorted.py();
    let sorted = sorted.cast::<PyArray1<T>>()?.try_readonly()?;
    let values = values.cast::<PyArray1<T>>()?.try_readonly()?;
    let (sorted, values) = (sorted.as_slice()?, values.as_slice()?);
    let mut found = Vec::new();
    let reserved = found.try_reserve_exact(values.len());
    reserved.map_err(|_| PyMemoryError::new_err("no memory to count the intervals"))?;
    run(py, values.len(), 1, None, |_| {
        if or_equal {
            look_up(sorted, values, |one, value| one <= value, &mut found);
        } else {
            look_up(sorted, values, |one, value| one < value, &mut found);
        }
    })?;
    numbers(py, found.into_iter())
}

/// How many sorted numbers come before each value.
fn look_up<T: Copy>(
    sorted: &[T],
    values: &[T],
    is_before: impl Fn(T, T) -> bool,
    found: &mut Vec<i64>,
) {
    let mut chunks = values.chunks_exact(LANES);
    for chunk in &mut chunks {
        let mut lanes = [0; LANES];
        // Halves what is left for all lanes together, so that each has the same number of steps.
        let mut left = sorted.len();
        while left > 1 {
            let half = left / 2;
            for (begin, &value) in lanes.iter_mut().zip(chunk) {
                let is_right = is_before(sorted[*begin + half - 1], value);
                *begin = select_unpredictable(is_right, *begin + half, *begin);
            }
            left -= half;
        }
        for (begin, &value) in lanes.iter_mut().zip(chunk) {
            *begin += usize::from(left == 1 && is_before(sorted[*begin], value));
        }
        found.extend(lanes.map(|rank| rank as i64));
    }
    let rest = chunks.remainder().iter();
    found.extend(rest.map(|&value| sorted.partition_point(|&one| is_before(one, value)) as i64));
}
