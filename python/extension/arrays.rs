//! Conversion between NumPy arrays and the data of the core. Arrays are copied on the way in and on
//! the way out, and NumPy makes the copies that go in.
//!
//! Another Python thread may write to a user's array while a search runs without the GIL, and NumPy
//! has no means to forbid that. In Rust it is undefined behavior to read memory while it is written.
//! So Rust never reads a user's array: NumPy copies it to memory that no other code refers to. A write
//! during the copy can mix old and new numbers; after the copy it has no effect.

use numpy::ndarray::ArrayView2;
use numpy::{
    Element, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyMemoryError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PySlice;
use sweep_and_prune_bindings::Kind;

use crate::run::call;
use crate::whole::convert;

pub type Array<'py> = Bound<'py, PyAny>;

/// Copies the boxes of an array to rows, and returns their number. `rows` allocates the memory of
/// that many boxes of this kind, which stay valid until this function returns.
pub fn copy_boxes(
    array: &Array<'_>,
    kind: Kind,
    rows: impl FnOnce(usize) -> Option<*mut u8>,
) -> PyResult<usize> {
    let (shape, memory) = reserve(array, kind, rows)?;
    match kind.is_double {
        true => copy_rows::<f64>(array, shape, memory.cast())?,
        false => copy_rows::<f32>(array, shape, memory.cast())?,
    }
    Ok(shape[0])
}

/// Copies boxes of integers to rows of double precision as [`copy_boxes`] does, and changes them as [`convert`] does. `None`,
/// with rows that are changed in part, if it finds numbers or boxes that it refuses.
pub fn convert_boxes(
    array: &Array<'_>,
    kind: Kind,
    take_ends: bool,
    rows: impl FnOnce(usize) -> Option<*mut u8>,
) -> PyResult<Option<usize>> {
    let ([count, width], memory) = reserve(array, kind, rows)?;
    if !kind.is_double {
        return Ok(None);
    }
    for start in (0..count).step_by(ROWS_AT_A_TIME) {
        let end = count.min(start + ROWS_AT_A_TIME);
        let part = PySlice::new(array.py(), start as isize, end as isize, 1);
        let memory = memory.cast::<f64>().wrapping_add(start * width);
        copy_rows(&array.get_item(part)?, [end - start, width], memory)?;
        // SAFETY: these rows were written just now, and nothing else refers to them.
        #[allow(unsafe_code)]
        let numbers = unsafe { std::slice::from_raw_parts_mut(memory, (end - start) * width) };
        if !convert(numbers, width, take_ends) {
            return Ok(None);
        }
    }
    Ok(Some(count))
}

/// Rows that are converted at a time: few enough that they stay in the cache until they are checked.
const ROWS_AT_A_TIME: usize = 1 << 13;

/// The shape of an array of boxes, and memory for them.
fn reserve(
    array: &Array<'_>,
    kind: Kind,
    rows: impl FnOnce(usize) -> Option<*mut u8>,
) -> PyResult<([usize; 2], *mut u8)> {
    let shape = match *array.cast::<PyUntypedArray>()?.shape() {
        [count, width] if width == 2 * kind.dimensions => [count, width],
        _ => return Err(PyValueError::new_err("rows of the right width are expected")),
    };
    let memory = rows(shape[0]).ok_or_else(|| PyMemoryError::new_err("no memory for the boxes"))?;
    Ok((shape, memory))
}

fn copy_rows<T: Element>(array: &Array<'_>, shape: [usize; 2], memory: *mut T) -> PyResult<()> {
    static COPYTO: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let py = array.py();
    // SAFETY: the memory is large enough for these boxes, and a box is `repr(C)`: scalars without padding.
    // The only reference to this view of it is dropped when this function returns.
    #[allow(unsafe_code)]
    let view = unsafe {
        let view = ArrayView2::from_shape_ptr(shape, memory.cast_const());
        PyArray2::borrow_from_array(&view, py.None().into_bound(py))
    };
    call(numpy(py, &COPYTO, "copyto")?, (&view, array)).map(drop)
}

/// A private copy of the numbers of an array, of any shape.
pub fn copy_numbers<'py, T: Element>(array: &Array<'py>) -> PyResult<PyReadonlyArray1<'py, T>> {
    static ARRAY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let copy = call(numpy(array.py(), &ARRAY, "array")?, (array,))?;
    let flat = call(&copy.getattr("reshape")?, (-1,))?;
    flat.cast::<PyArray1<T>>()?.try_readonly().map_err(|_| borrowed())
}

/// The type of the indices in a result.
#[derive(Clone, Copy)]
pub enum Index {
    Int32,
    Uint32,
    Int64,
    Uint64,
}

impl Index {
    /// The type of this name in NumPy.
    pub fn of(name: &str) -> PyResult<Self> {
        Ok(match name {
            "int32" => Self::Int32,
            "uint32" => Self::Uint32,
            "int64" => Self::Int64,
            "uint64" => Self::Uint64,
            _ => return Err(PyValueError::new_err("an integer type of 32 or 64 bits is expected")),
        })
    }

    /// A new array of pairs. All indices fit: the package limits the number of boxes.
    pub fn pairs<'py>(self, py: Python<'py>, found: &[[u32; 2]]) -> PyResult<Array<'py>> {
        let found = found.iter().copied();
        match self {
            Self::Int32 => pairs(py, found.map(|pair| pair.map(|index| index as i32))),
            Self::Uint32 => pairs(py, found),
            Self::Int64 => pairs(py, found.map(|pair| pair.map(i64::from))),
            Self::Uint64 => pairs(py, found.map(|pair| pair.map(u64::from))),
        }
    }
}

/// From this many pairs on, their memory is given away instead of kept for the next call.
pub const MANY: usize = 1 << 20;

/// Many pairs in an array, which owns its memory if it `is_owned`. Converted pairs are freed at once, so that both together
/// take little more memory than the array.
pub fn many_pairs<'py, V: Element + Copy>(
    py: Python<'py>,
    found: Vec<[u32; 2]>,
    is_owned: bool,
    convert: impl Fn(u32) -> V,
) -> PyResult<Array<'py>> {
    let count = found.len();
    if is_owned {
        let array = empty::<V>(py, (count, 2))?;
        let mut into = array.cast::<PyArray2<V>>()?.try_readwrite().map_err(|_| borrowed())?;
        let into = into.as_slice_mut().map_err(|_| borrowed())?.as_chunks_mut().0;
        convert_and_free(found, |at, pair| into[at] = pair.map(&convert));
        return Ok(array);
    }
    let mut pairs = Vec::new();
    let reserved = pairs.try_reserve_exact(count);
    reserved.map_err(|_| PyMemoryError::new_err("no memory for the pairs"))?;
    let into = pairs.spare_capacity_mut();
    convert_and_free(found, |at, pair| {
        into[at].write(pair.map(&convert));
    });
    // SAFETY: all of them were written just now.
    #[allow(unsafe_code)]
    unsafe {
        pairs.set_len(count);
    }
    owned_by_rust(py, pairs)
}

/// Passes on all pairs and their places, and frees them from the end on.
fn convert_and_free(mut found: Vec<[u32; 2]>, mut convert: impl FnMut(usize, [u32; 2])) {
    while !found.is_empty() {
        let rest = found.len().saturating_sub(MANY);
        (rest..).zip(&found[rest..]).for_each(|(at, &pair)| convert(at, pair));
        found.truncate(rest);
        // Elsewhere this might copy, which takes memory instead of freeing it.
        if cfg!(target_os = "linux") {
            found.shrink_to_fit();
        }
    }
}

/// A new array of pairs.
pub fn pairs<'py, V: Element + Copy>(
    py: Python<'py>,
    pairs: impl ExactSizeIterator<Item = [V; 2]>,
) -> PyResult<Array<'py>> {
    let array = empty::<V>(py, (pairs.len(), 2))?;
    {
        let mut into = array.cast::<PyArray2<V>>()?.try_readwrite().map_err(|_| borrowed())?;
        let into = into.as_slice_mut().map_err(|_| borrowed())?.as_chunks_mut().0;
        into.iter_mut().zip(pairs).for_each(|(into, pair)| *into = pair);
    }
    Ok(array)
}

/// An array of pairs in the memory in which they are.
pub fn owned_by_rust<V: Element>(py: Python<'_>, pairs: Vec<[V; 2]>) -> PyResult<Array<'_>> {
    let shape = [pairs.len(), 2];
    Ok(PyArray1::from_vec(py, pairs.into_flattened()).reshape(shape)?.into_any())
}

/// A new array of numbers.
pub fn numbers<'py, V: Element + Copy>(
    py: Python<'py>,
    numbers: impl ExactSizeIterator<Item = V>,
) -> PyResult<Array<'py>> {
    let array = empty::<V>(py, (numbers.len(),))?;
    {
        let mut into = array.cast::<PyArray1<V>>()?.try_readwrite().map_err(|_| borrowed())?;
        let into = into.as_slice_mut().map_err(|_| borrowed())?;
        into.iter_mut().zip(numbers).for_each(|(into, number)| *into = number);
    }
    Ok(array)
}

/// A new array without values. NumPy reports too little memory by an exception.
fn empty<'py, V: Element>(py: Python<'py>, shape: impl IntoPyObject<'py>) -> PyResult<Array<'py>> {
    static EMPTY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    call(numpy(py, &EMPTY, "empty")?, (shape, numpy::dtype::<V>(py)))
}

/// A function of NumPy.
fn numpy<'py>(
    py: Python<'py>,
    function: &'static PyOnceLock<Py<PyAny>>,
    name: &str,
) -> PyResult<&'py Array<'py>> {
    let import = || py.import("numpy")?.getattr(name).map(Bound::unbind);
    Ok(function.get_or_try_init(py, import)?.bind(py))
}

fn borrowed() -> PyErr {
    PyValueError::new_err("another extension module is writing to the array")
}
