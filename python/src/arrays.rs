//! Between NumPy's arrays and slices. Nothing is copied on the way in; on the way out each array
//! is the caller's own.

use numpy::{
    Element, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use sweep_and_prune::{Aabb, ProxyId, Scalar};

/// A coordinate that NumPy has too.
pub trait Coordinate: Scalar + Element {}

impl Coordinate for f32 {}
impl Coordinate for f64 {}

/// An array of rows, borrowed for reading.
pub struct Rows<'py, T: Element>(PyReadonlyArray2<'py, T>);

impl<'py, T: Coordinate> Rows<'py, T> {
    /// The rows of an array, each so wide.
    pub fn of(array: &Bound<'py, PyAny>, width: usize) -> PyResult<Self> {
        let array = array.cast::<PyArray2<T>>()?;
        if array.shape()[1] != width || !array.is_c_contiguous() {
            return Err(PyValueError::new_err("contiguous rows of the right width are expected"));
        }
        Ok(Self(array.try_readonly().map_err(|_| written())?))
    }

    pub fn numbers(&self) -> PyResult<&[T]> {
        self.0.as_slice().map_err(|_| PyTypeError::new_err("an aligned array is expected"))
    }

    /// The rows as boxes, in place.
    ///
    /// Another thread of Python may write to the array while it is read without the interpreter's
    /// lock: NumPy has no means to forbid that. The core reads coordinates with safe code, keeps
    /// copies of what it has put in order, and its vector kernels see only those copies: so
    /// whoever writes meanwhile gets pairs of neither state, or an error, and harms no memory.
    pub fn boxes<const D: usize>(&self) -> PyResult<&[Aabb<D, T>]> {
        let numbers = self.numbers()?;
        let (at, count) = (numbers.as_ptr().cast(), numbers.len() / (2 * D));
        // SAFETY: a box is `repr(C)`, two arrays of `D` scalars: aligned as they are, without
        // padding, and every pattern of their bits is a value. There are `2 * D` of them for each,
        // and they stay where they are as long as `self` refers to the array.
        #[allow(unsafe_code)]
        let boxes = unsafe { std::slice::from_raw_parts(at, count) };
        Ok(boxes)
    }

    /// The rows as points.
    pub fn points<const D: usize>(&self) -> PyResult<&[[T; D]]> {
        Ok(self.numbers()?.as_chunks().0)
    }
}

/// The ids in an array.
pub fn read_ids<'py>(array: &Bound<'py, PyAny>) -> PyResult<PyReadonlyArray1<'py, u64>> {
    array.cast::<PyArray1<u64>>()?.try_readonly().map_err(|_| written())
}

/// The numbers in an array.
pub fn read_numbers<'py, T: Coordinate>(
    array: &Bound<'py, PyAny>,
) -> PyResult<PyReadonlyArray1<'py, T>> {
    array.cast::<PyArray1<T>>()?.try_readonly().map_err(|_| written())
}

/// As ids of the core.
pub fn proxies(ids: &[u64]) -> Vec<ProxyId> {
    ids.iter().map(|&id| ProxyId::from_bits(id)).collect()
}

/// A new array of pairs.
pub fn pairs<'py, V: Element + Copy>(
    py: Python<'py>,
    pairs: impl ExactSizeIterator<Item = [V; 2]>,
) -> PyResult<Bound<'py, PyAny>> {
    let array = empty(py)?.call1(((pairs.len(), 2), numpy::dtype::<V>(py)))?;
    {
        let mut into = array.cast::<PyArray2<V>>()?.try_readwrite().map_err(|_| written())?;
        let into = into.as_slice_mut().map_err(|_| written())?.as_chunks_mut().0;
        into.iter_mut().zip(pairs).for_each(|(into, pair)| *into = pair);
    }
    Ok(array)
}

/// A new array of numbers.
pub fn numbers<'py, V: Element + Copy>(
    py: Python<'py>,
    numbers: impl ExactSizeIterator<Item = V>,
) -> PyResult<Bound<'py, PyAny>> {
    let array = empty(py)?.call1((numbers.len(), numpy::dtype::<V>(py)))?;
    {
        let mut into = array.cast::<PyArray1<V>>()?.try_readwrite().map_err(|_| written())?;
        let into = into.as_slice_mut().map_err(|_| written())?;
        into.iter_mut().zip(numbers).for_each(|(into, number)| *into = number);
    }
    Ok(array)
}

/// `numpy.empty`, which tells of too little memory by an exception.
fn empty<'py>(py: Python<'py>) -> PyResult<&'py Bound<'py, PyAny>> {
    static EMPTY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let empty =
        EMPTY.get_or_try_init(py, || py.import("numpy")?.getattr("empty").map(Bound::unbind));
    Ok(empty?.bind(py))
}

fn written() -> PyErr {
    PyValueError::new_err("the array is being written to by another extension")
}
