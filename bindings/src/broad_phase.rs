//! A broad phase of any dimensions and precision.

use alloc::vec::Vec;

use sweep_and_prune::{
    BroadPhase, Changes, Error, Filter, Options, ProxyId, Report, Scalar, validate,
};

use crate::id::Id;
use crate::kind::Kind;
use crate::queries::{Answer, Query, ask};
use crate::rows::{Coordinates, Rows, aabb};

/// A broad phase with the rows that it reads. What a method of the same name promises in
/// [`BroadPhase`] holds here, errors included; after an error nothing has changed.
#[allow(clippy::missing_errors_doc, clippy::len_without_is_empty)]
pub trait TrackBodies<I: Id>: Send {
    /// The type of its boxes.
    fn kind(&self) -> Kind;

    /// Where to write `count` rows, valid until the next call of this method; `None` if there is
    /// no memory.
    fn rows(&mut self, count: usize) -> Option<*mut u8>;

    /// Adds a body from the corners of its box.
    fn insert(&mut self, corners: &[f64]) -> Result<ProxyId, Error>;

    /// Adds a body for each of the first `count` rows.
    fn insert_many(&mut self, count: usize, filter: Filter) -> Result<Vec<ProxyId>, Error>;

    /// Gives a body the box of these corners.
    fn set(&mut self, id: ProxyId, corners: &[f64]) -> Result<(), Error>;

    /// Gives the bodies the boxes of the first rows, which are at least as many.
    fn set_many(&mut self, ids: &[ProxyId]) -> Result<(), Error>;

    /// Moves a body from the box of these corners to another.
    fn set_swept(&mut self, id: ProxyId, from: &[f64], to: &[f64]) -> Result<(), Error>;

    /// Gives a body the box of these corners, to which it did not move.
    fn teleport(&mut self, id: ProxyId, corners: &[f64]) -> Result<(), Error>;

    /// Adds an offset, given on each axis, to all boxes.
    fn shift(&mut self, offset: &[f64]) -> Result<(), Error>;

    /// Changes the filter of a body.
    fn set_filter(&mut self, id: ProxyId, filter: Filter) -> Result<(), Error>;

    /// The filter of a body, and whether it is enabled.
    fn filter(&self, id: ProxyId) -> Result<(Filter, bool), Error>;

    /// Disables a body, or enables it again.
    fn set_enabled(&mut self, id: ProxyId, is_enabled: bool) -> Result<(), Error>;

    /// Writes the corners of the box of a body, as set or as its overlaps are reported.
    fn corners(&self, id: ProxyId, is_reported: bool, corners: &mut [f64]) -> Result<(), Error>;

    /// Whether a body is here.
    fn contains(&self, id: ProxyId) -> bool;

    /// Removes bodies.
    fn remove_many(&mut self, ids: &[ProxyId]) -> Result<(), Error>;

    /// How many bodies there are.
    fn len(&self) -> usize;

    /// Calls `each` with the id of each body.
    fn for_each_id(&self, each: &mut dyn FnMut(ProxyId));

    /// Updates. Appends the ids of the pairs that began, then the ids of the pairs that ended, two for each pair. Returns how
    /// many ids belong to pairs that began.
    ///
    /// After an error, also of what the caller does with the ids, the next call gets `is_due`. Then changes of the last
    /// update that did not arrive come now, in place of an update.
    fn update(&mut self, is_due: bool, ids: &mut Vec<I>) -> Result<usize, Error>;
}

/// A broad phase that also answers queries, lists its pairs, and is saved and restored.
#[allow(clippy::missing_errors_doc)]
pub trait AnyBroadPhase<I: Id>: TrackBodies<I> {
    /// Excludes a pair, or includes it again.
    fn set_excluded(&mut self, pair: [ProxyId; 2], is_excluded: bool) -> Result<(), Error>;

    /// Whether a pair is excluded.
    fn is_excluded(&self, pair: [ProxyId; 2]) -> Result<bool, Error>;

    /// Appends the ids of the pairs of the last update, two a pair, sorted.
    fn pairs(&self, ids: &mut Vec<I>);

    /// Appends them in no particular order, which takes less time.
    fn pairs_unsorted(&self, ids: &mut Vec<I>);

    /// Appends the ids of the bodies that overlapped this one at the last update.
    fn pairs_of(&mut self, id: ProxyId, ids: &mut Vec<I>) -> Result<(), Error>;

    /// Answers queries of one kind, whose numbers follow each other: see [`Query`]. Without a filter they find every body.
    /// `is_sorted` is the opposite of [`Queries::unsorted`].
    ///
    /// [`Queries::unsorted`]: sweep_and_prune::Queries::unsorted
    fn query(
        &mut self,
        query: Query,
        numbers: &[f64],
        filter: Option<Filter>,
        excluded: &[ProxyId],
        is_sorted: bool,
        answer: &mut Answer<I>,
    ) -> Result<(), Error>;

    /// The whole state as bytes.
    fn snapshot(&self) -> Vec<u8>;

    /// Becomes the broad phase of a snapshot of the same type of boxes.
    fn restore(&mut self, bytes: &[u8]) -> Result<(), Error>;

    /// A hash of the whole state.
    fn state_hash(&self) -> u64;
}

/// A broad phase whose boxes are copied from arrays.
pub trait ArrayBroadPhase<I: Id>: AnyBroadPhase<I> {
    /// Copies boxes to the first rows, and returns how many there are.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    fn write_rows(&mut self, coordinates: Coordinates<'_>) -> Result<usize, Error>;

    /// Checks the first `count` rows.
    ///
    /// # Errors
    /// [`Error::InvalidBox`].
    fn validate(&self, count: usize) -> Result<(), Error>;

    /// Gives back memory that is not needed now.
    fn shrink_to_fit(&mut self);

    /// Removes all bodies: for after a call that panicked, which may have left anything half done.
    fn reset(&mut self);
}

/// The implementation for one type of box.
pub struct TypedBroadPhase<const D: usize, T: Scalar> {
    world: BroadPhase<D, T>,
    rows: Rows<D, T>,
}

impl<const D: usize, T: Scalar> TypedBroadPhase<D, T> {
    /// An empty broad phase.
    ///
    /// # Errors
    /// [`Error::InvalidOption`].
    pub fn new(report: Report<f64>) -> Result<Self, Error> {
        let report = match report {
            Report::Exact => Report::Exact,
            Report::Fat { margin, prediction } => {
                Report::Fat { margin: T::from_f64(margin), prediction: T::from_f64(prediction) }
            }
        };
        let world = BroadPhase::with_options(Options::default().report(report))?;
        Ok(Self { world, rows: Rows::new() })
    }
}

impl<const D: usize, T: Scalar, I: Id> TrackBodies<I> for TypedBroadPhase<D, T> {
    fn kind(&self) -> Kind {
        Kind { dimensions: D, is_double: size_of::<T>() == size_of::<f64>() }
    }

    fn rows(&mut self, count: usize) -> Option<*mut u8> {
        self.rows.reserve(count)
    }

    fn insert(&mut self, corners: &[f64]) -> Result<ProxyId, Error> {
        self.world.insert(aabb(corners))
    }

    fn insert_many(&mut self, count: usize, filter: Filter) -> Result<Vec<ProxyId>, Error> {
        self.world.insert_many(self.rows.first(count), filter)
    }

    fn set(&mut self, id: ProxyId, corners: &[f64]) -> Result<(), Error> {
        self.world.set(id, aabb(corners))
    }

    fn set_many(&mut self, ids: &[ProxyId]) -> Result<(), Error> {
        self.world.set_many(ids, self.rows.first(ids.len()))
    }

    fn set_swept(&mut self, id: ProxyId, from: &[f64], to: &[f64]) -> Result<(), Error> {
        self.world.set_swept(id, aabb(from), aabb(to))
    }

    fn teleport(&mut self, id: ProxyId, corners: &[f64]) -> Result<(), Error> {
        self.world.teleport(id, aabb(corners))
    }

    fn shift(&mut self, offset: &[f64]) -> Result<(), Error> {
        self.world.shift(core::array::from_fn(|axis| T::from_f64(offset[axis])))
    }

    fn set_filter(&mut self, id: ProxyId, filter: Filter) -> Result<(), Error> {
        self.world.set_filter(id, filter)
    }

    fn filter(&self, id: ProxyId) -> Result<(Filter, bool), Error> {
        Ok((self.world.filter(id)?, self.world.is_enabled(id)?))
    }

    fn set_enabled(&mut self, id: ProxyId, is_enabled: bool) -> Result<(), Error> {
        self.world.set_enabled(id, is_enabled)
    }

    fn corners(&self, id: ProxyId, is_reported: bool, corners: &mut [f64]) -> Result<(), Error> {
        let world = &self.world;
        let aabb = if is_reported { world.reported_aabb(id) } else { world.aabb(id) }?;
        for (number, at) in corners.iter_mut().zip(aabb.min.into_iter().chain(aabb.max)) {
            *number = at.to_f64();
        }
        Ok(())
    }

    fn contains(&self, id: ProxyId) -> bool {
        self.world.contains(id)
    }

    fn remove_many(&mut self, ids: &[ProxyId]) -> Result<(), Error> {
        self.world.remove_many(ids)
    }

    fn len(&self) -> usize {
        self.world.len()
    }

    fn for_each_id(&self, each: &mut dyn FnMut(ProxyId)) {
        self.world.ids().for_each(each);
    }

    fn update(&mut self, is_due: bool, ids: &mut Vec<I>) -> Result<usize, Error> {
        // There are none after an update that failed, nor in a restored world.
        if !is_due || self.world.changes().is_empty() {
            self.world.try_update()?;
        }
        append_changes(self.world.changes(), ids).ok_or(Error::OutOfMemory)
    }
}

impl<const D: usize, T: Scalar, I: Id> AnyBroadPhase<I> for TypedBroadPhase<D, T> {
    fn set_excluded(&mut self, [a, b]: [ProxyId; 2], is_excluded: bool) -> Result<(), Error> {
        if is_excluded { self.world.exclude_pair(a, b) } else { self.world.include_pair(a, b) }
    }

    fn is_excluded(&self, [a, b]: [ProxyId; 2]) -> Result<bool, Error> {
        self.world.is_excluded(a, b)
    }

    fn pairs(&self, ids: &mut Vec<I>) {
        ids.extend(self.world.pairs().flatten().map(I::from_proxy));
    }

    fn pairs_unsorted(&self, ids: &mut Vec<I>) {
        ids.extend(self.world.pairs_unsorted().flatten().map(I::from_proxy));
    }

    fn pairs_of(&mut self, id: ProxyId, ids: &mut Vec<I>) -> Result<(), Error> {
        self.world.queries(); // which makes the tree that `pairs_of` searches
        ids.extend(self.world.pairs_of(id)?.map(I::from_proxy));
        Ok(())
    }

    fn query(
        &mut self,
        query: Query,
        numbers: &[f64],
        filter: Option<Filter>,
        excluded: &[ProxyId],
        is_sorted: bool,
        answer: &mut Answer<I>,
    ) -> Result<(), Error> {
        let is_wanted = |id| !excluded.contains(&id);
        let queries = self.world.queries();
        let queries =
            if excluded.is_empty() { queries } else { queries.with_predicate(&is_wanted) };
        let queries = filter.map_or(queries, |filter| queries.with_filter(filter));
        ask(if is_sorted { queries } else { queries.unsorted() }, query, numbers, answer)
    }

    fn snapshot(&self) -> Vec<u8> {
        self.world.snapshot()
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), Error> {
        self.world = BroadPhase::from_snapshot(bytes)?;
        Ok(())
    }

    fn state_hash(&self) -> u64 {
        self.world.state_hash()
    }
}

impl<const D: usize, T: Scalar, I: Id> ArrayBroadPhase<I> for TypedBroadPhase<D, T> {
    fn write_rows(&mut self, coordinates: Coordinates<'_>) -> Result<usize, Error> {
        self.rows.write(coordinates)
    }

    fn validate(&self, count: usize) -> Result<(), Error> {
        validate(self.rows.first(count))
    }

    fn shrink_to_fit(&mut self) {
        self.world.shrink_to_fit();
    }

    fn reset(&mut self) {
        self.world = BroadPhase::with_options(self.world.options()).unwrap_or_default();
    }
}

/// Appends the pairs that began and those that ended, if there is memory for their ids. Returns how many ids belong to pairs that
/// began. One copy of it serves all dimensions.
#[inline(never)]
fn append_changes<I: Id>(changes: Changes<'_>, ids: &mut Vec<I>) -> Option<usize> {
    let (begun, ended) = (changes.begun(), changes.ended());
    let count = 2 * begun.len();
    ids.try_reserve(count + 2 * ended.len()).ok()?;
    for pairs in [begun, ended] {
        for pair in pairs {
            ids.extend(pair.map(I::from_proxy));
        }
    }
    Some(count)
}
