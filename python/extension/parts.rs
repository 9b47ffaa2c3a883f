//! Pairs between two sets of intervals of which the larger one is converted a part at a time: new memory for all of it would
//! take as long as the search.

use std::mem::take;
use std::ops::ControlFlow;

use numpy::{Element, IntoPyArray, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PySlice;
use sweep_and_prune::{Error, InParts};

use crate::arrays::Array;
use crate::collected::Collected;
use crate::run::run;
use crate::search::{Arrays, Search, Sets, raise_for};

/// With fewer boxes in the larger set, all are one part.
const MIN_BOXES: usize = 1 << 21;
/// More threads than this share a search of all boxes at once. A search in parts is that of one thread. (On two cores, ten
/// million intervals against a million take as long on two threads as in parts.)
const MOST_THREADS: usize = 2;

impl Search {
    /// All pairs between two sets of intervals. None if they have to be searched at once: that tells what is wrong with them, if
    /// something is.
    pub fn find_in_parts<'py, V: Element + Copy>(
        &mut self,
        Arrays { a, b, take_ends }: Arrays<'_, 'py>,
        progress: Option<&Py<PyAny>>,
        convert: impl Fn(u32) -> V + Copy + Send + Sync,
    ) -> PyResult<Option<Array<'py>>> {
        let (py, Some(b)) = (a.py(), b) else { return Ok(None) };
        let sets = Sets { a: length(a)?, b: Some(length(b)?) };
        let (first, second) = (sets.a, sets.boxes() - sets.a);
        let larger = InParts { boxes: first.max(second), is_first: first > second };
        let are_for_parts = self.kind.dimensions == 1
            && self.most_threads <= MOST_THREADS
            && larger.boxes >= MIN_BOXES
            && larger.suit(sets.boxes() - larger.boxes);
        if !are_for_parts {
            return Ok(None);
        }
        let [in_parts, others] = if larger.is_first { [0, 1] } else { [1, 0] };
        let (whole, smaller) = if larger.is_first { (a, b) } else { (b, a) };
        let places = larger.sample().map(|at| at as i64).collect::<Vec<_>>();
        let sample = whole.get_item(places.into_pyarray(py))?;
        let copied = [
            self.copy_set(others, smaller, take_ends)?,
            self.copy_set(in_parts, &sample, take_ends)?,
        ];
        let [Some(count), Some(_)] = copied else { return Ok(None) };
        let finder = &mut self.finder;
        let ready = run(py, count, 1, None, |_| finder.prepare_parts(count, larger));
        let at_a_time = match ready {
            Ok(Ok(Some(at_a_time))) => at_a_time,
            Ok(Ok(None)) => return Ok(None),
            Ok(Err(error)) => return Err(raise_for(py, error, sets)),
            Err(error) => return Err(self.fail(error)),
        };
        let mut collected = Collected::new(take(&mut self.few), convert);
        for start in (0..larger.boxes).step_by(at_a_time) {
            let end = larger.boxes.min(start + at_a_time);
            let part = whole.get_item(PySlice::new(py, start as isize, end as isize, 1))?;
            let Some(count) = self.copy_set(in_parts, &part, take_ends)? else { return Ok(None) };
            let share = |done: f64| (start as f64 + done * count as f64) / larger.boxes as f64;
            let finder = &mut self.finder;
            let found = run(py, count, 1, progress, |progress| {
                let progress = |done| progress(share(done));
                let mut take = |found: &[[u32; 2]]| collected.take(found);
                finder.stream_part(larger, count, start, &progress, &mut take)
            });
            match found {
                Ok(Ok(Some(ControlFlow::Continue(())))) => {}
                Ok(Ok(Some(ControlFlow::Break(())))) => {
                    return Err(raise_for(py, Error::OutOfMemory, sets));
                }
                Ok(Ok(None)) => return Ok(None),
                Ok(Err(error)) => return Err(raise_for(py, error, sets)),
                Err(error) => return Err(self.fail(error)),
            }
        }
        collected.into_array(py, &mut self.few).map(Some)
    }
}

/// How many boxes an array has.
fn length(array: &Array<'_>) -> PyResult<usize> {
    Ok(array.cast::<PyUntypedArray>()?.shape().first().copied().unwrap_or(0))
}
