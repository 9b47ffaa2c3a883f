//! Finding pairs: a finder of any dimensions and type, chosen at run time.

use std::ops::ControlFlow;
use std::sync::Mutex;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use sweep_and_prune::{Aabb, Error, PairFinder};

use crate::arrays::{Coordinate, Rows, pairs};
use crate::errors::{busy, raise};
use crate::run::{processors, run};

type Array<'py> = Bound<'py, PyAny>;

/// A finder of any type. The second set is that of pairs between two.
trait Find: Send {
    fn find<'py>(&mut self, a: &Array<'py>, b: Option<&Array<'py>>) -> PyResult<Array<'py>>;
    fn count(&mut self, a: &Array<'_>, b: Option<&Array<'_>>) -> PyResult<u64>;
    /// Whether it came to the end.
    fn for_each(
        &mut self,
        a: &Array<'_>,
        b: Option<&Array<'_>>,
        each: &Array<'_>,
        size: usize,
    ) -> PyResult<bool>;
}

struct Typed<const D: usize, T: Coordinate> {
    finder: PairFinder<D, T>,
    threads: usize,
}

impl<const D: usize, T: Coordinate> Typed<D, T> {
    fn boxed(threads: usize) -> Box<dyn Find> {
        Box::new(Self { finder: Self::fresh(threads), threads })
    }

    fn fresh(threads: usize) -> PairFinder<D, T> {
        PairFinder::new().threads(threads)
    }
}

impl<const D: usize, T: Coordinate> Find for Typed<D, T> {
    fn find<'py>(&mut self, a: &Array<'py>, b: Option<&Array<'py>>) -> PyResult<Array<'py>> {
        let (py, threads) = (a.py(), self.threads);
        let (first, second) = (rows::<D, T>(a)?, b.map(rows::<D, T>).transpose()?);
        let (first, second) =
            (first.boxes::<D>()?, second.as_ref().map(Rows::boxes::<D>).transpose()?);
        let finder = &mut self.finder;
        let found = run(py, count(first, second), threads, move |watch| match second {
            None => finder.find_watched(first, watch),
            Some(second) => finder.find_between_watched(first, second, watch),
        });
        match found {
            Ok(Ok(found)) => pairs(py, found.unwrap_or(&[]).iter().copied()),
            Ok(Err(error)) => Err(fault(py, error, first, second)),
            Err(error) => {
                self.finder = Self::fresh(threads);
                Err(error)
            }
        }
    }

    fn count(&mut self, a: &Array<'_>, b: Option<&Array<'_>>) -> PyResult<u64> {
        let (py, threads) = (a.py(), self.threads);
        let (first, second) = (rows::<D, T>(a)?, b.map(rows::<D, T>).transpose()?);
        let (first, second) =
            (first.boxes::<D>()?, second.as_ref().map(Rows::boxes::<D>).transpose()?);
        let finder = &mut self.finder;
        let counted = run(py, count(first, second), threads, move |watch| match second {
            None => finder.count_watched(first, watch),
            Some(second) => finder.count_between_watched(first, second, watch),
        });
        match counted {
            Ok(Ok(counted)) => Ok(counted.unwrap_or(0)),
            Ok(Err(error)) => Err(fault(py, error, first, second)),
            Err(error) => {
                self.finder = Self::fresh(threads);
                Err(error)
            }
        }
    }

    fn for_each(
        &mut self,
        a: &Array<'_>,
        b: Option<&Array<'_>>,
        each: &Array<'_>,
        size: usize,
    ) -> PyResult<bool> {
        let py = a.py();
        // Copies: whoever is called back may well write to the boxes.
        let first = rows::<D, T>(a)?.boxes::<D>()?.to_vec();
        let second = match b {
            None => None,
            Some(b) => Some(rows::<D, T>(b)?.boxes::<D>()?.to_vec()),
        };
        let (finder, each) = (&mut self.finder, each.clone().unbind());
        let streamed = run(py, count(&first, second.as_deref()), 1, |_| {
            let mut chunk = Vec::new();
            let take = |pair| {
                chunk.push(pair);
                if chunk.len() < size {
                    return ControlFlow::Continue(());
                }
                hand_over(&each, &mut chunk)
            };
            let end = match &second {
                None => finder.for_each(&first, take),
                Some(second) => finder.for_each_between(&first, second, take),
            }?;
            Ok(match end {
                ControlFlow::Continue(()) if !chunk.is_empty() => hand_over(&each, &mut chunk),
                end => end,
            })
        });
        match streamed {
            Ok(Ok(ControlFlow::Continue(()))) => Ok(true),
            Ok(Ok(ControlFlow::Break(raised))) => raised.map_or(Ok(false), Err),
            Ok(Err(error)) => Err(fault(py, error, &first, second.as_deref())),
            Err(error) => {
                self.finder = Self::fresh(self.threads);
                Err(error)
            }
        }
    }
}

/// Hands a chunk of pairs to a function of Python's and empties it. Breaks with what that raised,
/// or with nothing if it returned `False`.
fn hand_over(each: &Py<PyAny>, chunk: &mut Vec<[u32; 2]>) -> ControlFlow<Option<PyErr>> {
    let wants_more = Python::attach(|py| {
        let wants_more = each.bind(py).call1((pairs(py, chunk.iter().copied())?,))?;
        py.check_signals()?;
        Ok(!wants_more.is(pyo3::types::PyBool::new(py, false)))
    });
    chunk.clear();
    match wants_more {
        Ok(true) => ControlFlow::Continue(()),
        Ok(false) => ControlFlow::Break(None),
        Err(raised) => ControlFlow::Break(Some(raised)),
    }
}

fn rows<'py, const D: usize, T: Coordinate>(array: &Array<'py>) -> PyResult<Rows<'py, T>> {
    Rows::of(array, 2 * D)
}

fn count<const D: usize, T>(a: &[Aabb<D, T>], b: Option<&[Aabb<D, T>]>) -> usize {
    a.len() + b.map_or(0, <[_]>::len)
}

/// The core counts the boxes of a second set after those of the first.
fn fault<const D: usize, T>(
    py: Python<'_>,
    error: Error,
    a: &[Aabb<D, T>],
    b: Option<&[Aabb<D, T>]>,
) -> PyErr {
    match error {
        Error::InvalidBox { index, axis, min, max } if index >= a.len() => {
            raise(py, Error::InvalidBox { index: index - a.len(), axis, min, max }, "b", &[])
        }
        error => raise(py, error, if b.is_some() { "a" } else { "boxes" }, &[]),
    }
}

/// A `PairFinder` of so many dimensions, of doubles or of singles.
#[pyclass(frozen, module = "sweep_and_prune._native")]
pub struct Finder(Mutex<Box<dyn Find>>);

#[pymethods]
impl Finder {
    #[new]
    fn new(dimensions: usize, double: bool, threads: usize) -> PyResult<Self> {
        let threads = if threads > 1 { threads.min(processors()) } else { 1 };
        let finder = match (dimensions, double) {
            (1, false) => Typed::<1, f32>::boxed(threads),
            (2, false) => Typed::<2, f32>::boxed(threads),
            (3, false) => Typed::<3, f32>::boxed(threads),
            (1, true) => Typed::<1, f64>::boxed(threads),
            (2, true) => Typed::<2, f64>::boxed(threads),
            (3, true) => Typed::<3, f64>::boxed(threads),
            _ => return Err(PyValueError::new_err("dimensions must be 1, 2 or 3")),
        };
        Ok(Self(Mutex::new(finder)))
    }

    #[pyo3(signature = (a, b=None))]
    fn find<'py>(&self, a: Array<'py>, b: Option<Array<'py>>) -> PyResult<Array<'py>> {
        self.with(|finder| finder.find(&a, b.as_ref()))
    }

    #[pyo3(signature = (a, b=None))]
    fn count(&self, a: Array<'_>, b: Option<Array<'_>>) -> PyResult<u64> {
        self.with(|finder| finder.count(&a, b.as_ref()))
    }

    fn for_each(
        &self,
        a: Array<'_>,
        b: Option<Array<'_>>,
        each: Array<'_>,
        size: usize,
    ) -> PyResult<bool> {
        self.with(|finder| finder.for_each(&a, b.as_ref(), &each, size))
    }
}

impl Finder {
    /// One call at a time: a second one is refused, not kept waiting for what may be itself.
    fn with<R>(&self, call: impl FnOnce(&mut dyn Find) -> PyResult<R>) -> PyResult<R> {
        let mut finder = self.0.try_lock().map_err(|_| busy("PairFinder"))?;
        call(&mut **finder)
    }
}
