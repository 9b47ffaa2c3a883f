//! The persistent broad phase, whose dimensions and precision are chosen at run time. Every call is
//! for many bodies at once.

use std::collections::HashSet;
use std::sync::Mutex;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use sweep_and_prune::{Error, Filter, ProxyId, Report, SnapshotInfo};
use sweep_and_prune_bindings::{Answer, ArrayBroadPhase, Coordinates, Id, Kind, Query, filter};

use crate::arrays::{Array, copy_boxes, copy_numbers, numbers, pairs};
use crate::errors::{busy, raise};
use crate::run::run;

/// Category, mask, group, static.
type Words = (u32, u32, i32, bool);

fn filter_of((category, mask, group, is_static): Words) -> Filter {
    filter(category, mask, group, is_static)
}

fn words_of(filter: Filter) -> Words {
    (filter.category, filter.mask, filter.group, filter.is_static)
}

/// An id in Python: slot and generation in one number, as [`ProxyId::to_bits`], but counted from
/// the first generation. So the ids of a world from which nothing was removed are 0, 1, 2, and so
/// on, which are rows of the user's arrays. -1 is no id.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
struct PythonId(i64);

const FIRST_GENERATION: u64 = 1 << 32;

impl Id for PythonId {
    fn from_proxy(id: ProxyId) -> Self {
        Self(id.to_bits().wrapping_sub(FIRST_GENERATION) as i64)
    }
}

fn proxy(id: i64) -> ProxyId {
    ProxyId::from_bits((id as u64).wrapping_add(FIRST_GENERATION))
}

fn proxies(ids: &[i64]) -> Vec<ProxyId> {
    ids.iter().map(|&id| proxy(id)).collect()
}

/// A broad phase, which one call uses at a time.
#[pyclass(frozen, module = "sweep_and_prune._native")]
pub struct World(Mutex<Space>);

struct Space {
    world: Box<dyn ArrayBroadPhase<PythonId>>,
    kind: Kind,
    /// What updates found that did not reach Python, because a signal came, say.
    missed: Option<Found>,
    /// Whether the last update ended with an error, perhaps after it had found what changed: then the next one reports that.
    is_due: bool,
}

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
        let report = if fat { Report::Fat { margin, prediction } } else { Report::Exact };
        let kind = Kind { dimensions, is_double: double };
        Space::new(py, kind, report).map(Self::of)
    }

    /// The world of a snapshot, with the dimensions and the precision that it names.
    #[staticmethod]
    fn restore(py: Python<'_>, bytes: &[u8]) -> PyResult<(Self, usize, bool)> {
        let info = SnapshotInfo::read(bytes).map_err(|error| raise(py, error, "", &[]))?;
        // A damaged header may name other types: any type reports what is wrong then.
        let dimensions = if matches!(info.dimensions, 1..=3) { info.dimensions } else { 1 };
        let kind = Kind { dimensions, is_double: info.scalar_bytes == 8 };
        let mut space = Space::new(py, kind, Report::Exact)?;
        let restored = run(py, bytes.len(), 1, None, |_| space.world.restore(bytes))?;
        restored.map_err(|error| raise(py, error, "", &[]))?;
        Ok((Self::of(space), kind.dimensions, kind.is_double))
    }

    fn insert<'py>(
        &self,
        boxes: Array<'py>,
        filter: Words,
        argument: &str,
    ) -> PyResult<Array<'py>> {
        let py = boxes.py();
        self.with(|space| {
            let count = space.copy(&boxes)?;
            let done = space.run(py, count, |world| world.insert_many(count, filter_of(filter)))?;
            let ids = done.map_err(|error| raise(py, error, argument, &[]))?;
            // An error, or a signal that came meanwhile, would leave bodies whose ids are lost.
            let numbers = numbers(py, ids.iter().map(|&id| PythonId::from_proxy(id).0))
                .and_then(|numbers| py.check_signals().map(|()| numbers));
            if numbers.is_err() {
                space.run(py, count, |world| world.remove_many(&ids))?.ok();
            }
            numbers
        })
    }

    fn set(&self, ids: Array<'_>, boxes: Array<'_>, argument: &str) -> PyResult<()> {
        let (py, ids) = (ids.py(), copy_numbers(&ids)?);
        let ids = ids.as_slice()?;
        self.with(|space| {
            if space.copy(&boxes)? != ids.len() {
                return Err(different_lengths());
            }
            let proxies = proxies(ids);
            let done = space.run(py, proxies.len(), |world| world.set_many(&proxies))?;
            done.map_err(|error| raise(py, error, argument, ids))
        })
    }

    fn set_swept(
        &self,
        ids: Array<'_>,
        starts: Array<'_>,
        ends: Array<'_>,
        arguments: (String, String),
    ) -> PyResult<()> {
        let (py, ids) = (ids.py(), copy_numbers(&ids)?);
        let (starts, ends) = (copy_numbers::<f64>(&starts)?, copy_numbers::<f64>(&ends)?);
        let (ids, starts, ends) = (ids.as_slice()?, starts.as_slice()?, ends.as_slice()?);
        self.with(|space| {
            let width = 2 * space.kind.dimensions;
            if starts.len() != width * ids.len() || ends.len() != width * ids.len() {
                return Err(different_lengths());
            }
            // Everything that can be refused is checked before anything changes.
            space.check_ids(py, ids)?;
            for (boxes, argument) in [(starts, &arguments.0), (ends, &arguments.1)] {
                let valid = space.world.write_rows(Coordinates::Double(boxes));
                let valid = valid.and_then(|count| space.world.validate(count));
                valid.map_err(|error| raise(py, error, argument, ids))?;
            }
            let proxies = proxies(ids);
            let done = space.run(py, proxies.len(), |world| {
                let ways = starts.chunks_exact(width).zip(ends.chunks_exact(width));
                let mut bodies = proxies.iter().zip(ways);
                bodies.try_for_each(|(&id, (start, end))| world.set_swept(id, start, end))
            })?;
            done.map_err(|error| raise(py, error, &arguments.0, ids))
        })
    }

    fn teleport(&self, ids: Array<'_>, boxes: Array<'_>, argument: &str) -> PyResult<()> {
        let (py, ids) = (ids.py(), copy_numbers(&ids)?);
        let boxes = copy_numbers::<f64>(&boxes)?;
        let (ids, boxes) = (ids.as_slice()?, boxes.as_slice()?);
        self.with(|space| {
            let width = 2 * space.kind.dimensions;
            if boxes.len() != width * ids.len() {
                return Err(different_lengths());
            }
            // Everything that can be refused is checked before anything changes.
            space.check_ids(py, ids)?;
            let valid = space.world.write_rows(Coordinates::Double(boxes));
            let valid = valid.and_then(|count| space.world.validate(count));
            valid.map_err(|error| raise(py, error, argument, ids))?;
            let proxies = proxies(ids);
            let done = space.run(py, proxies.len(), |world| {
                let mut bodies = proxies.iter().zip(boxes.chunks_exact(width));
                bodies.try_for_each(|(&id, corners)| world.teleport(id, corners))
            })?;
            done.map_err(|error| raise(py, error, argument, ids))
        })
    }

    fn shift(&self, py: Python<'_>, offset: Vec<f64>) -> PyResult<()> {
        self.with(|space| {
            let count = space.world.len();
            let done = space.run(py, count, |world| world.shift(&offset))?;
            done.map_err(|error| raise(py, error, "offset", &[]))
        })
    }

    fn set_filter(&self, ids: Array<'_>, filter: Words) -> PyResult<()> {
        let filter = filter_of(filter);
        self.edit(ids, |world, ids| ids.iter().try_for_each(|&id| world.set_filter(id, filter)))
    }

    fn set_enabled(&self, ids: Array<'_>, enabled: bool) -> PyResult<()> {
        self.edit(ids, |world, ids| ids.iter().try_for_each(|&id| world.set_enabled(id, enabled)))
    }

    fn are_enabled(&self, ids: Array<'_>) -> PyResult<Vec<bool>> {
        self.look_up(ids, |world, ids| ids.iter().map(|&id| Ok(world.filter(id)?.1)).collect())
    }

    /// Excludes or includes the pair of two ids.
    fn set_excluded(&self, ids: Array<'_>, excluded: bool) -> PyResult<()> {
        self.edit(ids, |world, ids| {
            ids.as_chunks().0.iter().try_for_each(|&pair| world.set_excluded(pair, excluded))
        })
    }

    /// Whether the pair of two ids is excluded.
    fn is_excluded(&self, ids: Array<'_>) -> PyResult<bool> {
        let excluded = self.look_up(ids, |world, ids| {
            ids.as_chunks().0.iter().map(|&pair| world.is_excluded(pair)).collect()
        });
        Ok(excluded? == [true])
    }

    fn filters(&self, ids: Array<'_>) -> PyResult<Vec<Words>> {
        self.look_up(ids, |world, ids| {
            let filters = ids.iter().map(|&id| Ok(world.filter(id)?.0));
            filters.map(|filter| filter.map(words_of)).collect()
        })
    }

    /// Coordinates, box by box, in double precision, which holds those in single precision: of the boxes as set, or of those
    /// whose overlaps are reported.
    fn boxes<'py>(&self, ids: Array<'py>, reported: bool) -> PyResult<Array<'py>> {
        let (py, ids) = (ids.py(), copy_numbers(&ids)?);
        let ids = ids.as_slice()?;
        self.with(|space| {
            space.check_ids(py, ids)?;
            let width = 2 * space.kind.dimensions;
            let mut coordinates = vec![0.0; width * ids.len()];
            let mut bodies = ids.iter().zip(coordinates.chunks_exact_mut(width));
            let corners =
                |(&id, row): (&i64, &mut [f64])| space.world.corners(proxy(id), reported, row);
            let done = bodies.try_for_each(corners);
            done.map_err(|error| raise(py, error, "", ids))?;
            numbers(py, coordinates.into_iter())
        })
    }

    fn contains<'py>(&self, ids: Array<'py>) -> PyResult<Array<'py>> {
        let (py, ids) = (ids.py(), copy_numbers(&ids)?);
        let ids = ids.as_slice()?;
        self.with(|space| numbers(py, ids.iter().map(|&id| space.world.contains(proxy(id)))))
    }

    fn remove(&self, ids: Array<'_>) -> PyResult<()> {
        let (py, ids) = (ids.py(), copy_numbers(&ids)?);
        let ids = ids.as_slice()?;
        self.with(|space| {
            let proxies = proxies(ids);
            let done = space.run(py, proxies.len(), |world| world.remove_many(&proxies))?;
            done.map_err(|error| raise(py, error, "", ids))
        })
    }

    fn ids<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        self.with(|space| {
            let mut ids = Vec::with_capacity(space.world.len());
            space.world.for_each_id(&mut |id| ids.push(PythonId::from_proxy(id)));
            numbers(py, ids.into_iter().map(|id| id.0))
        })
    }

    fn __len__(&self) -> PyResult<usize> {
        self.with(|space| Ok(space.world.len()))
    }

    fn update<'py>(&self, py: Python<'py>) -> PyResult<(Array<'py>, Array<'py>)> {
        self.with(|space| {
            let missed = space.missed.take();
            let mut ids = Vec::new();
            let is_due = core::mem::replace(&mut space.is_due, true);
            let found = space.run(py, space.world.len(), |world| world.update(is_due, &mut ids))?;
            let begun = match found {
                Ok(begun) => begun,
                Err(error) => {
                    space.missed = missed;
                    return Err(raise(py, error, "", &[]));
                }
            };
            space.is_due = false;
            let mut found = Found { ids, begun };
            if let Some(missed) = missed {
                found = missed.then(&found);
            }
            let [begun, ended] = found.parts();
            let arrays = id_pairs(py, begun)
                .and_then(|begun| Ok((begun, id_pairs(py, ended)?)))
                // A signal that came meanwhile is raised here, where the changes are not lost.
                .and_then(|arrays| py.check_signals().map(|()| arrays));
            if arrays.is_err() {
                space.missed = Some(found);
            }
            arrays
        })
    }

    fn pairs<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        self.with(|space| {
            let mut ids = Vec::new();
            space.run(py, space.world.len(), |world| world.pairs(&mut ids))?;
            id_pairs(py, &ids)
        })
    }

    fn pairs_of<'py>(&self, py: Python<'py>, id: i64) -> PyResult<Array<'py>> {
        self.with(|space| {
            let mut ids = Vec::new();
            let done =
                space.run(py, space.world.len(), |world| world.pairs_of(proxy(id), &mut ids))?;
            done.map_err(|error| raise(py, error, "", &[id]))?;
            numbers(py, ids.into_iter().map(|id| id.0))
        })
    }

    /// Ids, their values, the faces that casts hit, and where the ids of each query end. `kind` names a [`Query`];
    /// `queries` holds its numbers, a row for each query. `excluded` are ids that no query finds.
    #[pyo3(signature = (kind, queries, filter, excluded, argument, k=0, max_distance=0.0, sorted=true))]
    #[allow(clippy::too_many_arguments)] // Python passes them by name
    fn query<'py>(
        &self,
        kind: &str,
        queries: Array<'py>,
        filter: Option<Words>,
        excluded: Array<'py>,
        argument: &str,
        k: usize,
        max_distance: f64,
        sorted: bool,
    ) -> PyResult<[Array<'py>; 4]> {
        let query = Query::named(kind, k, max_distance)
            .ok_or_else(|| PyValueError::new_err("there is no such query"))?;
        let (py, queries) = (queries.py(), copy_numbers::<f64>(&queries)?);
        let queries = queries.as_slice()?;
        let excluded = proxies(copy_numbers(&excluded)?.as_slice()?);
        self.with(|space| {
            let (mut answer, filter) = (Answer::default(), filter.map(filter_of));
            let count = space.world.len() + queries.len();
            let done = space.run(py, count, |world| {
                world.query(query, queries, filter, &excluded, sorted, &mut answer)
            })?;
            done.map_err(|error| raise(py, error, argument, &[]))?;
            Ok([
                numbers(py, answer.ids.iter().map(|id| id.0))?,
                numbers(py, answer.values.into_iter())?,
                numbers(py, answer.faces.iter().map(|&face| i64::from(face)))?,
                numbers(py, answer.ends.iter().map(|&end| end as i64))?,
            ])
        })
    }

    fn snapshot<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        self.with(|space| {
            let bytes = space.run(py, space.world.len(), |world| world.snapshot())?;
            PyBytes::new_with(py, bytes.len(), |into| {
                into.copy_from_slice(&bytes);
                Ok(())
            })
        })
    }

    fn shrink_to_fit(&self, py: Python<'_>) -> PyResult<()> {
        self.with(|space| space.run(py, space.world.len(), |world| world.shrink_to_fit()))
    }

    fn state_hash(&self, py: Python<'_>) -> PyResult<u64> {
        self.with(|space| space.run(py, space.world.len(), |world| world.state_hash()))
    }
}

impl World {
    fn of(space: Space) -> Self {
        Self(Mutex::new(space))
    }

    /// Refuses a second call while one is running. The second cannot wait, since the first may be waiting for it.
    fn with<R>(&self, call: impl FnOnce(&mut Space) -> PyResult<R>) -> PyResult<R> {
        let mut space = self.0.try_lock().map_err(|_| busy("BroadPhase"))?;
        call(&mut space)
    }

    /// Changes bodies by their ids. Nothing has changed if one of those is stale.
    fn edit(
        &self,
        ids: Array<'_>,
        change: impl FnOnce(&mut dyn ArrayBroadPhase<PythonId>, &[ProxyId]) -> Result<(), Error> + Send,
    ) -> PyResult<()> {
        let (py, ids) = (ids.py(), copy_numbers(&ids)?);
        let ids = ids.as_slice()?;
        self.with(|space| {
            space.check_ids(py, ids)?;
            let proxies = proxies(ids);
            let done = space.run(py, proxies.len(), |world| change(world, &proxies))?;
            done.map_err(|error| raise(py, error, "", ids))
        })
    }

    /// What is known of bodies, by their ids.
    fn look_up<V>(
        &self,
        ids: Array<'_>,
        read: impl FnOnce(&dyn ArrayBroadPhase<PythonId>, &[ProxyId]) -> Result<Vec<V>, Error>,
    ) -> PyResult<Vec<V>> {
        let (py, ids) = (ids.py(), copy_numbers(&ids)?);
        let ids = ids.as_slice()?;
        self.with(|space| {
            space.check_ids(py, ids)?;
            read(&*space.world, &proxies(ids)).map_err(|error| raise(py, error, "", ids))
        })
    }
}

impl Space {
    fn new(py: Python<'_>, kind: Kind, report: Report<f64>) -> PyResult<Self> {
        let world = kind.broad_phase(report);
        let world = world.ok_or_else(|| PyValueError::new_err("dimensions must be 1, 2 or 3"))?;
        let world = world.map_err(|error| raise(py, error, "", &[]))?;
        Ok(Self { world, kind, missed: None, is_due: false })
    }

    fn copy(&mut self, boxes: &Array<'_>) -> PyResult<usize> {
        copy_boxes(boxes, self.kind, |count| self.world.rows(count))
    }

    /// Runs a call that looks at about `count` boxes. It cannot be cancelled; if it panics, the
    /// world is emptied, since it may be half changed.
    fn run<R: Send>(
        &mut self,
        py: Python<'_>,
        count: usize,
        call: impl FnOnce(&mut dyn ArrayBroadPhase<PythonId>) -> R + Send,
    ) -> PyResult<R> {
        let world = &mut *self.world;
        run(py, count, 1, None, |_| call(world)).inspect_err(|_| self.world.reset())
    }

    fn check_ids(&mut self, py: Python<'_>, ids: &[i64]) -> PyResult<()> {
        match ids.iter().position(|&id| !self.world.contains(proxy(id))) {
            Some(index) => {
                let id = proxy(ids[index]).to_bits();
                Err(raise(py, Error::StaleProxy { index, id }, "", ids))
            }
            None => Ok(()),
        }
    }
}

/// What changed: the ids of the pairs that began and then of those that ended, each sorted by slot.
struct Found {
    ids: Vec<PythonId>,
    /// How many of the ids are of pairs that began.
    begun: usize,
}

impl Found {
    fn parts(&self) -> [&[PythonId]; 2] {
        self.ids.split_at(self.begun).into()
    }

    /// What changed in all, if this changed first and then that.
    fn then(&self, then: &Self) -> Self {
        let ([begun, ended], [begun_then, ended_then]) = (self.parts(), then.parts());
        let mut ids = net(begun, ended_then, begun_then, ended);
        let begun_in_all = ids.len();
        ids.append(&mut net(ended, begun_then, ended_then, begun));
        Self { ids, begun: begun_in_all }
    }
}

/// The pairs of `first` that are not undone, and those of `then` that undo nothing, sorted by slot.
fn net(
    first: &[PythonId],
    undone: &[PythonId],
    then: &[PythonId],
    undoes: &[PythonId],
) -> Vec<PythonId> {
    let left = |pairs: &[PythonId], others: &[PythonId]| -> Vec<[PythonId; 2]> {
        let others: HashSet<_> = others.as_chunks::<2>().0.iter().collect();
        pairs.as_chunks().0.iter().filter(|pair| !others.contains(pair)).copied().collect()
    };
    let mut pairs = left(first, undone);
    pairs.append(&mut left(then, undoes));
    pairs.sort_unstable_by_key(|&[a, b]| (a.0 as u32, b.0 as u32, a.0, b.0));
    pairs.into_flattened()
}

fn id_pairs<'py>(py: Python<'py>, ids: &[PythonId]) -> PyResult<Array<'py>> {
    pairs(py, ids.as_chunks().0.iter().map(|&[a, b]| [a.0, b.0]))
}

fn different_lengths() -> PyErr {
    PyValueError::new_err("the arguments have different lengths")
}
