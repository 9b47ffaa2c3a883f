//! A pair finder and what one search with it needs: the arrays that are copied to its rows, threads, errors.

use pyo3::prelude::*;
use sweep_and_prune::Error;
use sweep_and_prune_bindings::{ArrayPairFinder, Kind};

use crate::arrays::{Array, convert_boxes, copy_boxes};
use crate::errors::raise;
use crate::run::processors;

/// A pair finder whose dimensions and precision are chosen at run time.
pub struct Search {
    pub finder: Box<dyn ArrayPairFinder>,
    pub kind: Kind,
    /// The pairs of the last search on one thread, unless they were many.
    pub few: Vec<[u32; 2]>,
    /// How many may be used, and how many the last search used.
    pub most_threads: usize,
    pub threads: usize,
}

/// With fewer boxes than this the core uses one thread.
const MIN_FOR_THREADS: usize = 4096;
/// From this many boxes on, threads pay however few of them overlap.
const SURE_FOR_THREADS: usize = 1 << 17;
/// With less work threads do not pay: it takes 0.05 to 0.1 ms until another thread has begun and this one has heard that
/// it is done. (By the model of the plan, for one thread.)
const MIN_NS_FOR_THREADS: f64 = 1.0e6;

/// The arrays of one or two sets. With `take_ends`, they are of integers, which are converted as `whole.rs` says.
#[derive(Clone, Copy)]
pub struct Arrays<'a, 'py> {
    pub a: &'a Array<'py>,
    pub b: Option<&'a Array<'py>>,
    pub take_ends: Option<bool>,
}

/// How many boxes one or two sets have.
#[derive(Clone, Copy)]
pub struct Sets {
    pub a: usize,
    pub b: Option<usize>,
}

impl Sets {
    pub fn boxes(self) -> usize {
        self.a + self.b.unwrap_or(0)
    }
}

impl Search {
    /// Copies the boxes to the finder's rows. `None` if integers cannot be converted.
    pub fn copy(&mut self, Arrays { a, b, take_ends }: Arrays<'_, '_>) -> PyResult<Option<Sets>> {
        let Some(a) = self.copy_set(0, a, take_ends)? else { return Ok(None) };
        let Some(b) = b else { return Ok(Some(Sets { a, b: None })) };
        Ok(self.copy_set(1, b, take_ends)?.map(|b| Sets { a, b: Some(b) }))
    }

    /// Copies the boxes of a set to its rows, and returns how many there are. `None` if integers cannot be converted.
    pub fn copy_set(
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

    /// Uses several threads for what takes long enough.
    pub fn choose_threads(&mut self, sets: Sets) {
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
    pub fn fail(&mut self, error: PyErr) -> PyErr {
        self.finder.reset();
        error
    }
}

/// The error names the argument: `boxes`, or `a` or `b` where there are two.
pub fn raise_for(py: Python<'_>, error: Error, sets: Sets) -> PyErr {
    let argument = match error {
        Error::InvalidBox { set: 1, .. } => "b",
        _ if sets.b.is_some() => "a",
        _ => "boxes",
    };
    raise(py, error, argument, &[])
}

/// More threads than can run at once do not help.
pub fn at_most(threads: usize) -> usize {
    if threads > 1 { threads.min(processors()) } else { 1 }
}
