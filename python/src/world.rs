//! The living world: of any dimensions and type, chosen at run time. Every call is one for many.

use std::sync::Mutex;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use sweep_and_prune::{
    Aabb, BroadPhase, Cast, Error, Filter, Hit, Lists, Options, ProxyId, Queries, Report, SnapshotInfo,
    validate,
};

use crate::arrays::{Coordinate, Rows, numbers, pairs, proxies, read_ids, read_numbers};
use crate::errors::{busy, raise};
use crate::run::run;

type Array<'py> = Bound<'py, PyAny>;
/// Category, mask, group, static.
type Words = (u32, u32, i32, bool);

/// The queries of a world; all categories and all bits in the mask stand for no filter, with which all
/// bodies are found.
fn filtered<const D: usize, T: Coordinate>(
    world: &mut BroadPhase<D, T>,
    filter: Filter,
) -> Queries<'_, D, T> {
    let queries = world.queries();
    if filter == Filter::ALL { queries } else { queries.with_filter(filter) }
}

fn filter_of((category, mask, group, is_static): Words) -> Filter {
    Filter { category, mask, group, is_static }
}

/// Which bodies are asked for.
#[derive(Clone, Copy, PartialEq)]
enum Region {
    /// Those that overlap boxes.
    Overlapping,
    /// Those that hold points.
    Containing,
    /// Those that are as near to points as a number for each.
    Within,
}

/// A world of any type.
trait Space: Send {
    fn insert<'py>(&mut self, boxes: &Array<'py>, filter: Filter) -> PyResult<Array<'py>>;
    fn set(&mut self, ids: &[u64], boxes: &Array<'_>) -> PyResult<()>;
    fn set_swept(&mut self, ids: &[u64], start: &Array<'_>, end: &Array<'_>) -> PyResult<()>;
    fn set_filter(&mut self, py: Python<'_>, ids: &[u64], filter: Filter) -> PyResult<()>;
    fn filters(&mut self, py: Python<'_>, ids: &[u64]) -> PyResult<Vec<Words>>;
    /// Coordinates, box by box.
    fn boxes<'py>(&mut self, py: Python<'py>, ids: &[u64]) -> PyResult<Array<'py>>;
    fn contains(&self, ids: &[u64]) -> Vec<bool>;
    fn remove(&mut self, py: Python<'_>, ids: &[u64]) -> PyResult<()>;
    fn ids<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>>;
    fn len(&self) -> usize;
    fn update<'py>(&mut self, py: Python<'py>) -> PyResult<(Array<'py>, Array<'py>)>;
    fn pairs<'py>(&mut self, py: Python<'py>) -> PyResult<Array<'py>>;
    fn pairs_of<'py>(&mut self, py: Python<'py>, id: u64) -> PyResult<Array<'py>>;
    /// Ids, and where those of each query end.
    fn query<'py>(
        &mut self,
        region: Region,
        of: &Array<'py>,
        radii: Option<&Array<'py>>,
        filter: Filter,
    ) -> PyResult<(Array<'py>, Array<'py>)>;
    /// Ids and places: of the first hit of each cast, id 0 where there is none; or of all hits of
    /// the only cast.
    fn cast<'py>(
        &mut self,
        boxes: &Array<'py>,
        directions: &Array<'py>,
        limits: &Array<'py>,
        filter: Filter,
        all: bool,
    ) -> PyResult<(Array<'py>, Array<'py>)>;
    /// Ids and squared distances, as many for each point.
    fn nearest<'py>(
        &mut self,
        points: &Array<'py>,
        k: usize,
        filter: Filter,
    ) -> PyResult<(Array<'py>, Array<'py>)>;
    fn snapshot(&mut self, py: Python<'_>) -> PyResult<Vec<u8>>;
    fn state_hash(&mut self, py: Python<'_>) -> PyResult<u64>;
}

struct Typed<const D: usize, T: Coordinate>(BroadPhase<D, T>);

impl<const D: usize, T: Coordinate> Typed<D, T> {
    fn boxed(margin: f64, prediction: f64, report: Report) -> Result<Box<dyn Space>, Error> {
        let (margin, prediction) = (T::from_f64(margin), T::from_f64(prediction));
        let world = BroadPhase::with_options(Options { margin, prediction, report })?;
        Ok(Box::new(Self(world)))
    }

    fn restored(bytes: &[u8]) -> Result<Box<dyn Space>, Error> {
        Ok(Box::new(Self(BroadPhase::<D, T>::from_snapshot(bytes)?)))
    }

    /// Runs a call that looks at about `count` boxes. It cannot be broken off; if it panics, an
    /// empty world is left.
    fn run<R: Send>(
        &mut self,
        py: Python<'_>,
        count: usize,
        call: impl FnOnce(&mut BroadPhase<D, T>) -> R + Send,
    ) -> PyResult<R> {
        let options = self.0.options();
        let world = &mut self.0;
        run(py, count, 1, move |_| call(world))
            .inspect_err(|_| self.0 = BroadPhase::with_options(options).unwrap_or_default())
    }
}

/// A copy, since the world keeps one anyway: whatever writes to the array meanwhile, what is
/// validated is what is kept.
fn copy<const D: usize, T: Coordinate>(array: &Array<'_>) -> PyResult<Vec<Aabb<D, T>>> {
    Ok(Rows::<T>::of(array, 2 * D)?.boxes::<D>()?.to_vec())
}

impl<const D: usize, T: Coordinate> Space for Typed<D, T> {
    fn insert<'py>(&mut self, boxes: &Array<'py>, filter: Filter) -> PyResult<Array<'py>> {
        let py = boxes.py();
        let boxes = copy::<D, T>(boxes)?;
        let ids = self.run(py, boxes.len(), |world| world.insert_many(&boxes, filter))?;
        let ids = ids.map_err(|error| raise(py, error, "boxes", &[]))?;
        numbers(py, ids.into_iter().map(ProxyId::to_bits))
    }

    fn set(&mut self, ids: &[u64], boxes: &Array<'_>) -> PyResult<()> {
        let py = boxes.py();
        let (names, boxes) = (proxies(ids), copy::<D, T>(boxes)?);
        let done = self.run(py, boxes.len(), |world| world.set_many(&names, &boxes))?;
        done.map_err(|error| raise(py, error, "boxes", ids))
    }

    fn set_swept(&mut self, ids: &[u64], start: &Array<'_>, end: &Array<'_>) -> PyResult<()> {
        let py = start.py();
        let (starts, ends) = (copy::<D, T>(start)?, copy::<D, T>(end)?);
        if starts.len() != ids.len() || ends.len() != ids.len() {
            return Err(PyValueError::new_err("as many ids, starts and ends are expected"));
        }
        // First all that could be refused.
        if let Some(index) = self.contains(ids).iter().position(|is_here| !is_here) {
            return Err(raise(py, Error::StaleProxy { index, id: ids[index] }, "start", ids));
        }
        validate(&starts).map_err(|error| raise(py, error, "start", ids))?;
        validate(&ends).map_err(|error| raise(py, error, "end", ids))?;
        let names = proxies(ids);
        let done = self.run(py, names.len(), |world| {
            let ways = starts.iter().zip(&ends);
            names
                .iter()
                .zip(ways)
                .try_for_each(|(&id, (&start, &end))| world.set_swept(id, start, end))
        })?;
        done.map_err(|error| raise(py, error, "start", ids))
    }

    fn set_filter(&mut self, py: Python<'_>, ids: &[u64], filter: Filter) -> PyResult<()> {
        if let Some(index) = self.contains(ids).iter().position(|is_here| !is_here) {
            return Err(raise(py, Error::StaleProxy { index, id: ids[index] }, "boxes", ids));
        }
        let names = proxies(ids);
        let done = self.run(py, names.len(), |world| {
            names.iter().try_for_each(|&id| world.set_filter(id, filter))
        })?;
        done.map_err(|error| raise(py, error, "boxes", ids))
    }

    fn filters(&mut self, py: Python<'_>, ids: &[u64]) -> PyResult<Vec<Words>> {
        let of = |(index, id)| {
            let filter = self.0.filter(id).map_err(|_| stale(py, index, ids))?;
            Ok((filter.category, filter.mask, filter.group, filter.is_static))
        };
        proxies(ids).into_iter().enumerate().map(of).collect()
    }

    fn boxes<'py>(&mut self, py: Python<'py>, ids: &[u64]) -> PyResult<Array<'py>> {
        let of = |(index, id)| self.0.aabb(id).map_err(|_| stale(py, index, ids));
        let boxes: Vec<_> =
            proxies(ids).into_iter().enumerate().map(of).collect::<PyResult<_>>()?;
        let corners: Vec<_> = boxes.into_iter().flat_map(|aabb| [aabb.min, aabb.max]).collect();
        numbers(py, corners.into_flattened().into_iter())
    }

    fn contains(&self, ids: &[u64]) -> Vec<bool> {
        proxies(ids).into_iter().map(|id| self.0.contains(id)).collect()
    }

    fn remove(&mut self, py: Python<'_>, ids: &[u64]) -> PyResult<()> {
        let names = proxies(ids);
        let done = self.run(py, names.len(), |world| world.remove_many(&names))?;
        done.map_err(|error| raise(py, error, "boxes", ids))
    }

    fn ids<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        let ids: Vec<_> = self.0.ids().map(ProxyId::to_bits).collect();
        numbers(py, ids.into_iter())
    }

    fn len(&self) -> usize {
        self.0.len()
    }

    fn update<'py>(&mut self, py: Python<'py>) -> PyResult<(Array<'py>, Array<'py>)> {
        let (begun, ended) = self.run(py, self.len(), |world| {
            let changes = world.update();
            (
                changes.begun().map(bits).collect::<Vec<_>>(),
                changes.ended().map(bits).collect::<Vec<_>>(),
            )
        })?;
        Ok((pairs(py, begun.into_iter())?, pairs(py, ended.into_iter())?))
    }

    fn pairs<'py>(&mut self, py: Python<'py>) -> PyResult<Array<'py>> {
        let found = self.run(py, self.len(), |world| world.pairs())?;
        pairs(py, found.into_iter().map(bits))
    }

    fn pairs_of<'py>(&mut self, py: Python<'py>, id: u64) -> PyResult<Array<'py>> {
        let others = self.run(py, self.len(), |world| world.pairs_of(ProxyId::from_bits(id)))?;
        let others = others.map_err(|error| raise(py, error, "boxes", &[id]))?;
        numbers(py, others.into_iter().map(ProxyId::to_bits))
    }

    fn query<'py>(
        &mut self,
        region: Region,
        of: &Array<'py>,
        radii: Option<&Array<'py>>,
        filter: Filter,
    ) -> PyResult<(Array<'py>, Array<'py>)> {
        let py = of.py();
        let width = if region == Region::Overlapping { 2 * D } else { D };
        let rows = Rows::<T>::of(of, width)?;
        let count = self.len() + rows.numbers()?.len();
        let lists: Result<Lists<ProxyId>, Error> = match region {
            Region::Overlapping => {
                let boxes = rows.boxes::<D>()?.to_vec();
                self.run(py, count, move |world| {
                    filtered(world, filter).overlapping_many(&boxes)
                })?
            }
            Region::Containing => {
                let points = rows.points::<D>()?.to_vec();
                self.run(py, count, move |world| {
                    filtered(world, filter).containing_many(&points)
                })?
            }
            Region::Within => {
                let radii = radii.map(read_numbers::<T>).transpose()?;
                let radii = radii.as_ref().map(|radii| radii.as_slice()).transpose()?;
                let radii = radii.unwrap_or_default().iter().copied();
                let spheres: Vec<_> = rows.points::<D>()?.iter().copied().zip(radii).collect();
                self.run(py, count, move |world| {
                    filtered(world, filter).within_many(&spheres)
                })?
            }
        };
        let lists = lists.map_err(|error| raise(py, error, "boxes", &[]))?;
        let values = numbers(py, lists.values().iter().map(|id| id.to_bits()))?;
        Ok((values, numbers(py, lists.ends().iter().map(|&end| end as i64))?))
    }

    fn cast<'py>(
        &mut self,
        boxes: &Array<'py>,
        directions: &Array<'py>,
        limits: &Array<'py>,
        filter: Filter,
        all: bool,
    ) -> PyResult<(Array<'py>, Array<'py>)> {
        let py = boxes.py();
        let boxes = copy::<D, T>(boxes)?;
        let directions = Rows::<T>::of(directions, D)?;
        let limits = read_numbers::<T>(limits)?;
        let ways = directions.points::<D>()?.iter().zip(limits.as_slice()?);
        let cast_of = |(from, (&direction, &limit))| Cast { from, direction, limit };
        let casts: Vec<Cast<D, T>> = boxes.into_iter().zip(ways).map(cast_of).collect();
        let hits = self.run(py, self.len() + casts.len(), move |world| {
            let queries = filtered(world, filter);
            match (&casts[..], all) {
                ([cast], true) => {
                    queries.cast_all(cast).map(|hits| hits.into_iter().map(Some).collect())
                }
                (casts, _) => queries.cast_many(casts),
            }
        })?;
        let hits: Vec<Option<Hit>> = hits.map_err(|error| raise(py, error, "boxes", &[]))?;
        let ids = hits.iter().map(|hit| hit.map_or(0, |hit| hit.id.to_bits()));
        Ok((
            numbers(py, ids)?,
            numbers(py, hits.iter().map(|hit| hit.map_or(f64::INFINITY, |hit| hit.at)))?,
        ))
    }

    fn nearest<'py>(
        &mut self,
        points: &Array<'py>,
        k: usize,
        filter: Filter,
    ) -> PyResult<(Array<'py>, Array<'py>)> {
        let py = points.py();
        let points = Rows::<T>::of(points, D)?.points::<D>()?.to_vec();
        let found = self.run(py, self.len() + points.len(), move |world| {
            filtered(world, filter).nearest_many(&points, k)
        })?;
        let found = found.map_err(|error| raise(py, error, "boxes", &[]))?;
        let ids = numbers(py, found.values().iter().map(|near| near.id.to_bits()))?;
        Ok((ids, numbers(py, found.values().iter().map(|near| near.distance_squared))?))
    }

    fn snapshot(&mut self, py: Python<'_>) -> PyResult<Vec<u8>> {
        self.run(py, self.len(), |world| world.snapshot())
    }

    fn state_hash(&mut self, py: Python<'_>) -> PyResult<u64> {
        self.run(py, self.len(), |world| world.state_hash())
    }
}

fn bits(pair: [ProxyId; 2]) -> [u64; 2] {
    pair.map(ProxyId::to_bits)
}

fn stale(py: Python<'_>, index: usize, ids: &[u64]) -> PyErr {
    raise(py, Error::StaleProxy { index, id: ids[index] }, "boxes", ids)
}

/// A `BroadPhase` of so many dimensions, of doubles or of singles.
#[pyclass(frozen, module = "sweep_and_prune._native")]
pub struct World(Mutex<Box<dyn Space>>);

#[pymethods]
impl World {
    #[new]
    fn new(
        py: Python<'_>,
        dimensions: usize,
        double: bool,
        margin: f64,
        prediction: f64,
        fat: bool,
    ) -> PyResult<Self> {
        let report = if fat { Report::Fat } else { Report::Exact };
        let boxed = match (dimensions, double) {
            (1, false) => Typed::<1, f32>::boxed,
            (2, false) => Typed::<2, f32>::boxed,
            (3, false) => Typed::<3, f32>::boxed,
            (1, true) => Typed::<1, f64>::boxed,
            (2, true) => Typed::<2, f64>::boxed,
            (3, true) => Typed::<3, f64>::boxed,
            _ => return Err(PyValueError::new_err("dimensions must be 1, 2 or 3")),
        };
        let world = boxed(margin, prediction, report);
        Ok(Self(Mutex::new(world.map_err(|error| raise(py, error, "boxes", &[]))?)))
    }

    /// The world of a snapshot, which says of what dimensions and type it is; with these.
    #[staticmethod]
    fn restore(py: Python<'_>, bytes: &[u8]) -> PyResult<(Self, usize, bool)> {
        let info = SnapshotInfo::read(bytes).map_err(|error| raise(py, error, "boxes", &[]))?;
        let (dimensions, double) = (info.dimensions, info.scalar_bytes == 8);
        let restored = match (dimensions, double) {
            (1, false) => Typed::<1, f32>::restored,
            (2, false) => Typed::<2, f32>::restored,
            (3, false) => Typed::<3, f32>::restored,
            (1, true) => Typed::<1, f64>::restored,
            (2, true) => Typed::<2, f64>::restored,
            _ => Typed::<3, f64>::restored,
        };
        let world = run(py, bytes.len(), 1, |_| restored(bytes))?;
        let world = world.map_err(|error| raise(py, error, "boxes", &[]))?;
        Ok((Self(Mutex::new(world)), dimensions, double))
    }

    fn insert<'py>(&self, boxes: Array<'py>, filter: Words) -> PyResult<Array<'py>> {
        self.with(|world| world.insert(&boxes, filter_of(filter)))
    }

    fn set(&self, ids: Array<'_>, boxes: Array<'_>) -> PyResult<()> {
        self.with(|world| world.set(read_ids(&ids)?.as_slice()?, &boxes))
    }

    fn set_swept(&self, ids: Array<'_>, start: Array<'_>, end: Array<'_>) -> PyResult<()> {
        self.with(|world| world.set_swept(read_ids(&ids)?.as_slice()?, &start, &end))
    }

    fn set_filter(&self, py: Python<'_>, ids: Array<'_>, filter: Words) -> PyResult<()> {
        self.with(|world| world.set_filter(py, read_ids(&ids)?.as_slice()?, filter_of(filter)))
    }

    fn filters(&self, py: Python<'_>, ids: Array<'_>) -> PyResult<Vec<Words>> {
        self.with(|world| world.filters(py, read_ids(&ids)?.as_slice()?))
    }

    fn boxes<'py>(&self, py: Python<'py>, ids: Array<'_>) -> PyResult<Array<'py>> {
        self.with(|world| world.boxes(py, read_ids(&ids)?.as_slice()?))
    }

    fn contains<'py>(&self, py: Python<'py>, ids: Array<'_>) -> PyResult<Array<'py>> {
        self.with(|world| numbers(py, world.contains(read_ids(&ids)?.as_slice()?).into_iter()))
    }

    fn remove(&self, py: Python<'_>, ids: Array<'_>) -> PyResult<()> {
        self.with(|world| world.remove(py, read_ids(&ids)?.as_slice()?))
    }

    fn ids<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        self.with(|world| world.ids(py))
    }

    fn __len__(&self) -> PyResult<usize> {
        self.with(|world| Ok(world.len()))
    }

    fn update<'py>(&self, py: Python<'py>) -> PyResult<(Array<'py>, Array<'py>)> {
        self.with(|world| world.update(py))
    }

    fn pairs<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        self.with(|world| world.pairs(py))
    }

    fn pairs_of<'py>(&self, py: Python<'py>, id: u64) -> PyResult<Array<'py>> {
        self.with(|world| world.pairs_of(py, id))
    }

    fn overlapping<'py>(
        &self,
        boxes: Array<'py>,
        filter: Words,
    ) -> PyResult<(Array<'py>, Array<'py>)> {
        self.with(|world| world.query(Region::Overlapping, &boxes, None, filter_of(filter)))
    }

    fn containing<'py>(
        &self,
        points: Array<'py>,
        filter: Words,
    ) -> PyResult<(Array<'py>, Array<'py>)> {
        self.with(|world| world.query(Region::Containing, &points, None, filter_of(filter)))
    }

    fn within<'py>(
        &self,
        centres: Array<'py>,
        radii: Array<'py>,
        filter: Words,
    ) -> PyResult<(Array<'py>, Array<'py>)> {
        self.with(|world| world.query(Region::Within, &centres, Some(&radii), filter_of(filter)))
    }

    fn cast<'py>(
        &self,
        boxes: Array<'py>,
        directions: Array<'py>,
        limits: Array<'py>,
        filter: Words,
        all: bool,
    ) -> PyResult<(Array<'py>, Array<'py>)> {
        self.with(|world| world.cast(&boxes, &directions, &limits, filter_of(filter), all))
    }

    fn nearest<'py>(
        &self,
        points: Array<'py>,
        k: usize,
        filter: Words,
    ) -> PyResult<(Array<'py>, Array<'py>)> {
        self.with(|world| world.nearest(&points, k, filter_of(filter)))
    }

    fn snapshot<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        self.with(|world| {
            let bytes = world.snapshot(py)?;
            PyBytes::new_with(py, bytes.len(), |into| {
                into.copy_from_slice(&bytes);
                Ok(())
            })
        })
    }

    fn state_hash(&self, py: Python<'_>) -> PyResult<u64> {
        self.with(|world| world.state_hash(py))
    }
}

impl World {
    /// One call at a time: a second one is refused, not kept waiting for what may be itself.
    fn with<R>(&self, call: impl FnOnce(&mut dyn Space) -> PyResult<R>) -> PyResult<R> {
        let mut world = self.0.try_lock().map_err(|_| busy("BroadPhase"))?;
        call(&mut **world)
    }
}
