//! Finds pairs: a pair finder whose dimensions and precision are chosen at run time.

mod collected;
mod parts;

use std::mem::take;
use std::ops::ControlFlow;
use std::sync::Mutex;

use numpy::Element;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use sweep_and_prune::Error;
use sweep_and_prune_bindings::{ArrayPairFinder, Kind};

use self::collected::Collected;
use crate::arrays::{Array, Index, MANY, convert_boxes, copy_boxes, many_pairs, numbers, pairs};
use crate::errors::{busy, raise};
use crate::run::{attach, call_back, processors, run};

/// A pair finder, which one call uses at a time.
#[pyclass(frozen, module = "sweep_and_prune._native")]
pub struct Finder(Mutex<Search>);

struct Search {
    finder: Box<dyn ArrayPairFinder>,
    kind: Kind,
    /// The pairs of the last search on one thread, unless they were many.
    few: Vec<[u32; 2]>,
    /// How many may be used, and how many the last search used.
    most_threads: usize,
    threads: usize,
}

/// With fewer boxes than this the core uses one thread.
const MIN_FOR_THREADS: usize = 4096;
/// From this many boxes on, one thread's pairs are collected as they are found.
const MIN_TO_COLLECT: usize = 4096;
/// From this many boxes on, threads pay however few of them overlap.
const SURE_FOR_THREADS: usize = 1 << 17;
/// With less work threads do not pay: it takes 0.05 to 0.1 ms until another thread has begun and this one has heard that
/// it is done. (By the model of the plan, for one thread.)
const MIN_NS_FOR_THREADS: f64 = 1.0e6;

/// From this many pairs of a search on threads on, freed memory returns to the system: at most 64 MB stay. To look for it
/// takes as long as a search of a million boxes where the rest of the process has freed much, too.
const MANY_TO_TRIM: usize = 1 << 23;

/// The arrays of one or two sets. With `take_ends`, they are of integers, which are converted as `whole.rs` says.
#[derive(Clone, Copy)]
struct Arrays<'a, 'py> {
    a: &'a Array<'py>,
    b: Option<&'a Array<'py>>,
    take_ends: Option<bool>,
}

/// How many boxes one or two sets have.
#[derive(Clone, Copy)]
struct Sets {
    a: usize,
    b: Option<usize>,
}

impl Sets {
    fn boxes(self) -> usize {
        self.a + self.b.unwrap_or(0)
    }
}

#[pymethods]
impl Finder {
    #[new]
    fn new(dimensions: usize, double: bool, threads: usize) -> PyResult<Self> {
        let threads = at_most(threads);
        let kind = Kind { dimensions, is_double: double };
        let finder = kind.pair_finder(threads);
        let finder = finder.ok_or_else(|| PyValueError::new_err("dimensions must be 1, 2 or 3"))?;
        Ok(Self(Mutex::new(Search {
            finder,
            kind,
            few: Vec::new(),
            most_threads: threads,
            threads,
        })))
    }

    /// Uses at most `threads` threads from now on.
    fn use_threads(&self, threads: usize) -> PyResult<()> {
        self.with(|search| {
            search.most_threads = at_most(threads);
            Ok(())
        })
    }

    /// All pairs, in an array that owns its memory if it `is_owned`. With `take_ends`, boxes are integers that are converted
    /// as `whole.rs` says; None if they cannot be.
    fn find<'py>(
        &self,
        a: Array<'py>,
        b: Option<Array<'py>>,
        take_ends: Option<bool>,
        is_owned: bool,
        index: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Option<Array<'py>>> {
        let index = Index::of(index)?;
        self.with(|search| {
            let arrays = Arrays { a: &a, b: b.as_ref(), take_ends };
            let progress = progress.as_ref();
            match index {
                Index::Int32 => search.find(arrays, is_owned, progress, |index| index as i32),
                Index::Uint32 => search.find(arrays, is_owned, progress, |index| index),
                Index::Int64 => search.find(arrays, is_owned, progress, i64::from),
                Index::Uint64 => search.find(arrays, is_owned, progress, u64::from),
            }
        })
    }

    /// How many pairs there are; None as in `find`.
    fn count(
        &self,
        a: Array<'_>,
        b: Option<Array<'_>>,
        take_ends: Option<bool>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Option<u64>> {
        let py = a.py();
        self.with(|search| {
            let Some(sets) = search.copy(Arrays { a: &a, b: b.as_ref(), take_ends })? else {
                return Ok(None);
            };
            search.choose_threads(sets);
            let finder = &mut search.finder;
            let counted = run(py, sets.boxes(), search.threads, progress.as_ref(), |progress| {
                finder.count(sets.a, sets.b, progress).map(|count| count.unwrap_or(0))
            });
            match counted {
                Ok(Ok(count)) => Ok(Some(count)),
                Ok(Err(error)) => Err(raise_for(py, error, sets)),
                Err(error) => Err(search.fail(error)),
            }
        })
    }

    /// How many boxes each box of `a` overlaps; None as in `find`.
    fn counts<'py>(
        &self,
        a: Array<'py>,
        b: Option<Array<'py>>,
        take_ends: Option<bool>,
    ) -> PyResult<Option<Array<'py>>> {
        let py = a.py();
        self.with(|search| {
            let Some(sets) = search.copy(Arrays { a: &a, b: b.as_ref(), take_ends })? else {
                return Ok(None);
            };
            let finder = &mut search.finder;
            let counted = run(py, sets.boxes(), 1, None, |progress| {
                finder.counts(sets.a, sets.b, progress).map(Option::unwrap_or_default)
            });
            match counted {
                Ok(Ok(counts)) => numbers(py, counts.into_iter().map(i64::from)).map(Some),
                Ok(Err(error)) => Err(raise_for(py, error, sets)),
                Err(error) => Err(search.fail(error)),
            }
        })
    }

    /// Calls `each` with chunks of `size` pairs, and returns whether all pairs were passed to it.
    fn for_each_chunk(
        &self,
        a: Array<'_>,
        b: Option<Array<'_>>,
        each: Array<'_>,
        size: usize,
        index: &str,
    ) -> PyResult<bool> {
        let (py, index) = (a.py(), Index::of(index)?);
        self.with(|search| {
            let Some(sets) = search.copy(Arrays { a: &a, b: b.as_ref(), take_ends: None })? else {
                return Ok(true);
            };
            let (finder, each) = (&mut search.finder, each.unbind());
            let streamed = run(py, sets.boxes(), 1, None, |_| {
                let mut buffer: Vec<[u32; 2]> = Vec::new();
                let mut end = Ok(true);
                let mut hand_over = |chunk: &[[u32; 2]]| {
                    end = attach(|py| wants_more(each.bind(py), index.pairs(py, chunk)?));
                    match end {
                        Ok(true) => ControlFlow::Continue(()),
                        _ => ControlFlow::Break(()),
                    }
                };
                let complete = finder.for_each_chunk(sets.a, sets.b, &mut |mut found| {
                    while buffer.len() + found.len() >= size {
                        let (now, later) = found.split_at(size - buffer.len());
                        buffer.extend_from_slice(now);
                        hand_over(&buffer)?;
                        buffer.clear();
                        found = later;
                    }
                    buffer.extend_from_slice(found);
                    ControlFlow::Continue(())
                })?;
                if complete.is_continue() && !buffer.is_empty() {
                    // Its result counts as if more pairs could follow.
                    let _ = hand_over(&buffer);
                }
                Ok(end)
            });
            match streamed {
                Ok(Ok(end)) => end,
                Ok(Err(error)) => Err(raise_for(py, error, sets)),
                Err(error) => Err(search.fail(error)),
            }
        })
    }
}

/// The error names the argument: `boxes`, or `a` or `b` where there are two.
fn raise_for(py: Python<'_>, error: Error, sets: Sets) -> PyErr {
    let argument = match error {
        Error::InvalidBox { set: 1, .. } => "b",
        _ if sets.b.is_some() => "a",
        _ => "boxes",
    };
    raise(py, error, argument, &[])
}

/// Calls `each` with a chunk, and returns whether it wants another one.
fn wants_more<'py>(each: &Array<'py>, chunk: Array<'py>) -> PyResult<bool> {
    let answer = call_back(each, (chunk,))?;
    each.py().check_signals()?;
    Ok(answer.is_none() || answer.is_truthy()?)
}

impl Finder {
    /// Refuses a second call while one is running. The second cannot wait, since the first may be waiting for it.
    fn with<R>(&self, call: impl FnOnce(&mut Search) -> PyResult<R>) -> PyResult<R> {
        let mut search = self.0.try_lock().map_err(|_| busy("PairFinder"))?;
        call(&mut search)
    }
}

impl Search {
    /// Copies the boxes to the finder's rows. `None` if integers cannot be converted.
    fn copy(&mut self, Arrays { a, b, take_ends }: Arrays<'_, '_>) -> PyResult<Option<Sets>> {
        let Some(a) = self.copy_set(0, a, take_ends)? else { return Ok(None) };
        let Some(b) = b else { return Ok(Some(Sets { a, b: None })) };
        Ok(self.copy_set(1, b, take_ends)?.map(|b| Sets { a, b: Some(b) }))
    }

    /// Copies the boxes of a set to its rows, and returns how many there are. `None` if integers cannot be converted.
    fn copy_set(
        &mut self,
        set: usize,
        boxes: &Array<'_>,
        take_ends: Option<bool>,
    ) -> PyResult<Option<usize>> {
        let rows = |count| self.finder.rows(set, count);
        match take_ends {
            None => copy_boxes(boxes, self.kind, rows).map(Some),
            Some(take_ends) => convert_boxes(boxes, self.kind, take_ends, rows),
        }
    }

    /// All pairs, whose indices `convert` converts. `None` if integers cannot be converted.
    fn find<'py, V: Element + Copy>(
        &mut self,
        arrays: Arrays<'_, 'py>,
        is_owned: bool,
        progress: Option<&Py<PyAny>>,
        convert: impl Fn(u32) -> V + Copy + Send + Sync,
    ) -> PyResult<Option<Array<'py>>> {
        let py = arrays.a.py();
        if !is_owned && let Some(found) = self.find_in_parts(arrays, progress, convert)? {
            return Ok(Some(found));
        }
        let Some(sets) = self.copy(arrays)? else { return Ok(None) };
        self.choose_threads(sets);
        if self.threads == 1 && sets.boxes() >= MIN_TO_COLLECT && !is_owned {
            return self.collect(py, sets, progress, convert).map(Some);
        }
        let finder = &mut self.finder;
        let found = run(py, sets.boxes(), self.threads, progress, |progress| {
            finder.find(sets.a, sets.b, progress).map(|found| found.unwrap_or(&[]))
        });
        let pairs = match found {
            Ok(Ok(found)) if found.len() < MANY => {
                pairs(py, found.iter().map(|pair| pair.map(convert)))
            }
            Ok(Ok(_)) => {
                let found = self.finder.take_pairs();
                if self.threads > 1 && found.len() >= MANY_TO_TRIM {
                    return_freed_memory();
                }
                many_pairs(py, found, is_owned, convert)
            }
            Ok(Err(error)) => Err(raise_for(py, error, sets)),
            Err(error) => Err(self.fail(error)),
        };
        pairs.map(Some)
    }

    /// All pairs on one thread.
    fn collect<'py, V: Element + Copy>(
        &mut self,
        py: Python<'py>,
        sets: Sets,
        progress: Option<&Py<PyAny>>,
        convert: impl Fn(u32) -> V + Copy + Send + Sync,
    ) -> PyResult<Array<'py>> {
        let mut collected = Collected::new(take(&mut self.few), convert);
        let finder = &mut self.finder;
        let found = run(py, sets.boxes(), 1, progress, |progress| {
            finder.stream(sets.a, sets.b, progress, &mut |found| collected.take(found))
        });
        match found {
            Ok(Ok(_)) if collected.has_memory() => collected.into_array(py, &mut self.few),
            Ok(Ok(_)) => Err(raise_for(py, Error::OutOfMemory, sets)),
            Ok(Err(error)) => Err(raise_for(py, error, sets)),
            Err(error) => Err(self.fail(error)),
        }
    }

    /// Uses several threads for what takes long enough.
    fn choose_threads(&mut self, sets: Sets) {
        let boxes = sets.boxes();
        let pay = self.most_threads > 1
            && boxes >= MIN_FOR_THREADS
            && (boxes >= SURE_FOR_THREADS
                || self.finder.expected_ns(sets.a, sets.b) >= MIN_NS_FOR_THREADS);
        let threads = if pay { self.most_threads } else { 1 };
        if threads != self.threads {
            self.finder.use_threads(threads);
            self.threads = threads;
        }
    }

    /// After a signal or a panic, which may have left the finder's buffers half written.
    fn fail(&mut self, error: PyErr) -> PyErr {
        self.finder.reset();
        error
    }
}

/// More threads than can run at once do not help.
fn at_most(threads: usize) -> usize {
    if threads > 1 { threads.min(processors()) } else { 1 }
}

/// Threads store pairs in small chunks, which the allocator of glibc keeps when they are freed.
fn return_freed_memory() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    #[allow(unsafe_code)]
    {
        // SAFETY: this is the declaration of glibc. It may be called at any time, from any thread.
        unsafe extern "C" {
            safe fn malloc_trim(pad: usize) -> std::ffi::c_int;
        }
        malloc_trim(0);
    }
}
