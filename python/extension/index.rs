//! The static index. It never changes, so any number of threads may search it at once.

use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::PyBytes;
use sweep_and_prune::{Error, Hit, IndexFault, Neighbor};
use sweep_and_prune_bindings::{AnyIndex, Coordinates, Found, Kind};

use crate::arrays::{Array, copy_boxes, copy_numbers, numbers, results};
use crate::errors::raise;
use crate::run::{FEW, processors, run};

/// A static index of boxes.
#[pyclass(frozen, module = "sweep_and_prune._native")]
pub struct Index {
    index: Box<dyn AnyIndex>,
    kind: Kind,
}

/// With fewer queries than this the index uses one thread.
const MIN_FOR_THREADS: usize = 4096;

#[pymethods]
impl Index {
    #[new]
    fn new(boxes: Array<'_>, dimensions: usize, double: bool) -> PyResult<Self> {
        let (py, kind) = (boxes.py(), Kind { dimensions, is_double: double });
        let builder = kind.index_builder();
        let mut builder =
            builder.ok_or_else(|| PyValueError::new_err("dimensions must be 1, 2 or 3"))?;
        let count = copy_boxes(&boxes, kind, |count| builder.rows(count))?;
        let built = run(py, count, 1, None, |_| builder.build(count))?;
        let index = built.map_err(|error| raise(py, error, "boxes", &[]))?;
        Ok(Self { index, kind })
    }

    /// The bytes are not copied: they cannot change, and live as long as the index.
    #[staticmethod]
    fn from_bytes(py: Python<'_>, bytes: PyBackedBytes) -> PyResult<Self> {
        let made = Kind::of_index(&bytes).and_then(|kind| {
            let foreign = Error::InvalidIndex(IndexFault::Foreign);
            Ok(Self { index: kind.index(bytes).ok_or(foreign)??, kind })
        });
        made.map_err(|error| raise(py, error, "data", &[]))
    }

    fn __len__(&self) -> usize {
        self.index.len()
    }

    /// The dimensions, and whether coordinates are in double precision.
    fn kind(&self) -> (usize, bool) {
        (self.kind.dimensions, self.kind.is_double)
    }

    fn data<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = self.index.bytes();
        PyBytes::new_with(py, bytes.len(), |into| {
            into.copy_from_slice(bytes);
            Ok(())
        })
    }

    fn search<'py>(&self, area: Array<'py>, limit: Option<usize>) -> PyResult<Array<'py>> {
        let (py, area) = (area.py(), self.row(&area, 2)?);
        let (area, mut found) = (area.as_slice()?, Found::default());
        let limit = limit.unwrap_or(usize::MAX);
        let found = self.index.search(area, limit, &mut found);
        let found = found.map_err(|error| raise(py, error, "box", &[]))?;
        numbers(py, found.iter().map(|&index| i64::from(index)))
    }

    fn search_many<'py>(&self, areas: Array<'py>, threads: usize) -> PyResult<Array<'py>> {
        let py = areas.py();
        if self.kind.is_double {
            let areas = copy_numbers::<f64>(&areas)?;
            self.answer_many(py, Coordinates::Double(areas.as_slice()?), threads)
        } else {
            let areas = copy_numbers::<f32>(&areas)?;
            self.answer_many(py, Coordinates::Single(areas.as_slice()?), threads)
        }
    }

    /// The indices of the nearest boxes, and the squares of their distances.
    fn neighbors<'py>(
        &self,
        point: Array<'py>,
        k: usize,
        max_distance: f64,
    ) -> PyResult<(Array<'py>, Array<'py>)> {
        let (py, point) = (point.py(), self.row(&point, 1)?);
        let point = point.as_slice()?;
        let index = &self.index;
        let near =
            run(py, index.len().min(k), 1, None, |_| index.neighbors(point, k, max_distance))?;
        let near = near.map_err(|error| raise(py, error, "point", &[]))?;
        let near: &[Neighbor<u32>] = near.values();
        Ok((
            numbers(py, near.iter().map(|neighbor| i64::from(neighbor.id)))?,
            numbers(py, near.iter().map(|neighbor| neighbor.distance_squared))?,
        ))
    }

    /// What a ray hits (an origin and a direction), or without a limit a segment (two ends): the indices of the
    /// boxes, and the times.
    fn cast<'py>(
        &self,
        line: Array<'py>,
        limit: Option<f64>,
        all: bool,
    ) -> PyResult<(Array<'py>, Array<'py>)> {
        let (py, line) = (line.py(), self.row(&line, 2)?);
        let (line, index) = (line.as_slice()?, &self.index);
        let hits = run(py, FEW - 1, 1, None, |_| match limit {
            Some(limit) => index.ray(line, limit, all),
            None => index.segment(line),
        })?;
        let hits: Vec<Hit<u32>> = hits.map_err(|error| raise(py, error, "ray", &[]))?;
        Ok((
            numbers(py, hits.iter().map(|hit| i64::from(hit.id)))?,
            numbers(py, hits.iter().map(|hit| hit.t))?,
        ))
    }
}

impl Index {
    /// The numbers of so many points.
    fn row<'py>(&self, row: &Array<'py>, points: usize) -> PyResult<PyReadonlyArray1<'py, f64>> {
        let numbers = copy_numbers::<f64>(row)?;
        if numbers.as_slice()?.len() != points * self.kind.dimensions {
            return Err(PyValueError::new_err("a row of the right width is expected"));
        }
        Ok(numbers)
    }

    fn answer_many<'py>(
        &self,
        py: Python<'py>,
        areas: Coordinates<'_>,
        threads: usize,
    ) -> PyResult<Array<'py>> {
        let numbers = match areas {
            Coordinates::Single(numbers) => numbers.len(),
            Coordinates::Double(numbers) => numbers.len(),
        };
        let queries = numbers / (2 * self.kind.dimensions);
        let threads = if queries < MIN_FOR_THREADS { 1 } else { threads.min(processors()) };
        let index = &self.index;
        let found = run(py, queries, threads, None, |_| index.search_many(areas, threads))?;
        results(py, &found.map_err(|error| raise(py, error, "boxes", &[]))?)
    }
}
