//! Finds pairs: a pair finder whose dimensions and precision are chosen at run time.

use std::mem::take;
use std::ops::ControlFlow;
use std::sync::Mutex;

use numpy::Element;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use sweep_and_prune::Error;
use sweep_and_prune_bindings::Kind;

use crate::arrays::{Array, Index, MANY, many_pairs, numbers, pairs};
use crate::collected::Collected;
use crate::errors::busy;
use crate::run::{attach, call_back, run};
use crate::search::{Arrays, Search, Sets, at_most, raise_for};

/// A pair finder, which one call uses at a time.
#[pyclass(frozen, module = "sweep_and_prune._native")]
pub struct Finder(Mutex<Search>);

/// From this many boxes on, one thread's pairs are collected as they are found.
const MIN_TO_COLLECT: usize = 4096;
/// From this many pairs of a search on threads on, freed memory returns to the system: at most 64 MB stay. To look for it
/// takes as long as a search of a million boxes where the rest of the process has freed much, too.
const MANY_TO_TRIM: usize = 1 << 23;

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
            let streamed = run(py, sets.boxes(), 1, None, |progress| {
                let mut buffer: Vec<[u32; 2]> = Vec::new();
                let mut end = Ok(true);
                let mut hand_over = |chunk: &[[u32; 2]]| {
                    end = attach(|py| wants_more(each.bind(py), index.pairs(py, chunk)?));
                    match end {
                        Ok(true) => ControlFlow::Continue(()),
                        _ => ControlFlow::Break(()),
                    }
                };
                let streamed = finder.stream(sets.a, sets.b, progress, &mut |mut found| {
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
                if streamed == Some(ControlFlow::Continue(())) && !buffer.is_empty() {
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
