//! The living world: bodies that are inserted, moved and removed, and what begins and ends.

mod candidates;
mod changes;
mod filter;
mod follow;
mod hash;
mod options;
mod predict;
mod proxy;
mod queries;
mod rebuild;
mod seating;
#[cfg(feature = "serde")]
mod serde;
mod sleep;
mod snapshot;
mod sort;
mod tree;
mod update;
mod updater;
mod warm;

use alloc::vec::Vec;

pub use changes::{Changes, Pairs};
pub use filter::Filter;
pub use options::{Options, Report};
pub use proxy::ProxyId;
pub use queries::{Cast, Hit, Lists, Neighbour, Queries};

use crate::{Aabb, Error, Scalar};
use options::{contains, displacement, hull};
use proxy::{Slots, flag};
use updater::Updater;
use warm::{call, make_room};

/// The boxes of so many bodies that are set are called from memory before they are written.
const AHEAD: usize = 32;

/// A world of boxes that tells which overlaps began and which ended.
///
/// Bodies are [inserted](Self::insert), [set](Self::set) and [removed](Self::remove) as often as
/// one likes; [`update`](Self::update) then reports the pairs that began and those that ended
/// since the last update, each once, sorted by id. Touching boxes overlap; which bodies may pair
/// at all is their [`Filter`]'s to say. What a body that rests costs is its memory.
///
/// [`queries`](Self::queries) answers what overlaps a box, a point or a sphere, what a ray or a
/// moving box hits, and which bodies are nearest.
///
/// Same calls, same results: bit for bit, on every platform. A refused call changes nothing.
///
/// ```
/// use sweep_and_prune::{Aabb, BroadPhase};
///
/// let mut world = BroadPhase::<2>::new();
/// let hero = world.insert(Aabb::new([0.0, 0.0], [1.0, 2.0]))?;
/// let door = world.insert(Aabb::new([3.0, 0.0], [4.0, 2.0]))?;
/// assert_eq!(world.update().begun().len(), 0);
///
/// world.set(hero, Aabb::new([2.5, 0.0], [3.5, 2.0]))?;
/// for pair in world.update().begun() {
///     assert_eq!(pair, [hero, door]);
/// }
/// assert_eq!(world.pairs(), [[hero, door]]);
///
/// world.remove(door)?;
/// assert_eq!(world.update().ended().next(), Some([hero, door]));
/// # Ok::<(), sweep_and_prune::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct BroadPhase<const D: usize, T: Scalar = f32> {
    options: Options<T>,
    slots: Slots,
    /// By seat, the boxes whose overlaps are reported.
    boxes: Vec<Aabb<D, T>>,
    /// By seat, the boxes as given, where these are not the ones reported; else empty.
    shapes: Vec<Aabb<D, T>>,
    /// By seat.
    filters: Vec<Filter>,
    /// Whether a body ever had another filter than the default: if not, every pair is allowed.
    any_filter: bool,
    /// The seats of [`flag::CHANGED`], at least once each, and those of bodies that left since.
    changed: Vec<u32>,
    /// The seats of [`flag::LEAVING`].
    leaving: Vec<u32>,
    /// By seat, where the bodies of [`flag::SWEPT`] are after the next update; as long as the
    /// last seat of one ever needed.
    rests: Vec<Aabb<D, T>>,
    /// The seats of [`flag::SWEPT`], and others, some twice.
    swept: Vec<u32>,
    updater: Updater<D, T>,
}

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// An empty world that reports the pairs of the exact boxes.
    pub fn new() -> Self {
        Self::from_options(Options::default())
    }

    /// An empty world with margins.
    ///
    /// # Errors
    /// [`Error::InvalidMargin`] if the margin or the prediction is negative, infinite or NaN.
    pub fn with_options(options: Options<T>) -> Result<Self, Error> {
        options.check()?;
        Ok(Self::from_options(options))
    }

    fn from_options(options: Options<T>) -> Self {
        Self {
            options,
            slots: Slots::default(),
            boxes: Vec::new(),
            shapes: Vec::new(),
            filters: Vec::new(),
            any_filter: false,
            changed: Vec::new(),
            leaving: Vec::new(),
            rests: Vec::new(),
            swept: Vec::new(),
            updater: Updater::new(),
        }
    }

    /// The same world, which finds candidates on so many threads of rayon's current pool where most
    /// bodies move at once; one if 0 is given. Nothing but the time depends on it. Clones keep it,
    /// snapshots do not.
    #[cfg(feature = "parallel")]
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.updater.set_threads(threads);
        self
    }

    /// The options it was made with.
    pub fn options(&self) -> Options<T> {
        self.options
    }

    /// How many bodies there are.
    pub fn len(&self) -> usize {
        self.slots.live
    }

    /// Whether there is no body.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The ids of all bodies, sorted.
    pub fn ids(&self) -> impl Iterator<Item = ProxyId> + '_ {
        let seats = self.slots.seats.iter();
        seats.filter(|&&seat| self.slots.has(seat, flag::LIVE)).map(|&seat| self.slots.id(seat))
    }

    /// Whether an id names a body that was inserted here and not removed.
    pub fn contains(&self, id: ProxyId) -> bool {
        self.slots.find(id).is_some()
    }

    /// The box of a body as last given: for a swept one, until the next update, the whole way.
    ///
    /// # Errors
    /// [`Error::StaleProxy`].
    pub fn aabb(&self, id: ProxyId) -> Result<Aabb<D, T>, Error> {
        Ok(*self.shape(self.slots.check(id, 0)?))
    }

    /// The box of a body whose overlaps are reported: its [`aabb`](Self::aabb), or with
    /// [`Report::Fat`] its fat box.
    ///
    /// # Errors
    /// [`Error::StaleProxy`].
    pub fn reported_aabb(&self, id: ProxyId) -> Result<Aabb<D, T>, Error> {
        Ok(self.boxes[self.slots.check(id, 0)? as usize])
    }

    /// The filter of a body.
    ///
    /// # Errors
    /// [`Error::StaleProxy`].
    pub fn filter(&self, id: ProxyId) -> Result<Filter, Error> {
        Ok(self.filters[self.slots.check(id, 0)? as usize])
    }

    /// Adds a body with the default filter.
    ///
    /// # Errors
    /// [`Error::InvalidBox`]; [`Error::TooManyBoxes`] if no slot is left.
    pub fn insert(&mut self, aabb: Aabb<D, T>) -> Result<ProxyId, Error> {
        self.insert_with(aabb, Filter::default())
    }

    /// Adds a body.
    ///
    /// # Errors
    /// As [`insert`](Self::insert).
    pub fn insert_with(&mut self, aabb: Aabb<D, T>, filter: Filter) -> Result<ProxyId, Error> {
        check_box(&aabb, 0)?;
        self.slots.check_room(1)?;
        Ok(self.add(aabb, filter))
    }

    /// Adds bodies with one filter. Their ids are in the order of their boxes.
    ///
    /// # Errors
    /// As [`insert`](Self::insert), with the index of the first bad box; then none was added.
    pub fn insert_many(
        &mut self,
        boxes: &[Aabb<D, T>],
        filter: Filter,
    ) -> Result<Vec<ProxyId>, Error> {
        for (index, aabb) in boxes.iter().enumerate() {
            check_box(aabb, index)?;
        }
        self.slots.check_room(boxes.len())?;
        Ok(boxes.iter().map(|&aabb| self.add(aabb, filter)).collect())
    }

    /// Gives a body its new box.
    ///
    /// # Errors
    /// [`Error::StaleProxy`], [`Error::InvalidBox`].
    pub fn set(&mut self, id: ProxyId, aabb: Aabb<D, T>) -> Result<(), Error> {
        self.set_many(&[id], &[aabb])
    }

    /// Gives each of many bodies its new box; of an id that comes twice the last box counts.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`]; [`Error::StaleProxy`] or [`Error::InvalidBox`] with the index
    /// of the first that is bad. Then no box has changed.
    #[inline(never)]
    pub fn set_many(&mut self, ids: &[ProxyId], boxes: &[Aabb<D, T>]) -> Result<(), Error> {
        if ids.len() != boxes.len() {
            return Err(Error::LengthMismatch { ids: ids.len(), boxes: boxes.len() });
        }
        if !self.slots.are_living(ids) | !are_valid(boxes) {
            for (index, (&id, aabb)) in ids.iter().zip(boxes).enumerate() {
                self.slots.check(id, index)?;
                check_box(aabb, index)?;
            }
        }
        if !self.swept.is_empty() {
            for id in ids {
                self.slots.lower(self.slots.seats[id.slot() as usize], flag::SWEPT);
            }
        }
        self.updater.warm_for(ids.len(), &self.boxes);
        self.changed.reserve(ids.len());
        for (ids, boxes) in ids.chunks(AHEAD).zip(boxes.chunks(AHEAD)) {
            // Seats are dealt by place, ids are not: what is looked at is all over the tables.
            for id in ids {
                let seat = self.slots.seats[id.slot() as usize] as usize;
                call(&self.boxes, seat);
                call(&self.slots.flags, seat);
            }
            for (id, aabb) in ids.iter().zip(boxes) {
                self.place(self.slots.seats[id.slot() as usize], aabb);
            }
        }
        Ok(())
    }

    /// Moves a fast body all the way from one box to another: until the next update its box is
    /// the smallest that holds both, and from then on `to`. So it pairs with what it would have
    /// jumped over (and, on a diagonal way, with what lies beside it).
    ///
    /// # Errors
    /// [`Error::StaleProxy`]; [`Error::InvalidBox`] with index 0 for `from` and 1 for `to`.
    pub fn set_swept(
        &mut self,
        id: ProxyId,
        from: Aabb<D, T>,
        to: Aabb<D, T>,
    ) -> Result<(), Error> {
        let seat = self.slots.check(id, 0)?;
        check_box(&from, 0)?;
        check_box(&to, 1)?;
        self.sweep_to(seat, to);
        self.place(seat, &hull(&from, &to));
        Ok(())
    }

    /// Changes which others a body may pair with; pairs begin or end by it at the next update.
    ///
    /// # Errors
    /// [`Error::StaleProxy`].
    pub fn set_filter(&mut self, id: ProxyId, filter: Filter) -> Result<(), Error> {
        let seat = self.slots.check(id, 0)?;
        let before = core::mem::replace(&mut self.filters[seat as usize], filter);
        self.any_filter |= filter != Filter::default();
        if before != filter {
            if !self.slots.has(seat, flag::NEW | flag::REFILTERED) {
                self.note_old_filter(seat, before);
            }
            self.touch(seat);
        }
        Ok(())
    }

    /// Removes a body. Its id is stale from now on; the next update reports its ended pairs.
    ///
    /// # Errors
    /// [`Error::StaleProxy`].
    pub fn remove(&mut self, id: ProxyId) -> Result<(), Error> {
        self.remove_many(&[id])
    }

    /// Removes many bodies.
    ///
    /// # Errors
    /// [`Error::StaleProxy`] with the index of the first id that is stale, or that came before.
    /// Then none was removed.
    pub fn remove_many(&mut self, ids: &[ProxyId]) -> Result<(), Error> {
        for (index, &id) in ids.iter().enumerate() {
            match self.slots.find(id) {
                Some(seat) if !self.slots.has(seat, flag::MARKED) => {
                    self.slots.raise(seat, flag::MARKED);
                }
                _ => {
                    for before in &ids[..index] {
                        self.slots.lower(self.slots.seats[before.slot() as usize], flag::MARKED);
                    }
                    return Err(Error::StaleProxy { index });
                }
            }
        }
        for id in ids {
            let seat = self.slots.seats[id.slot() as usize];
            self.slots.lower(seat, flag::MARKED);
            self.slots.retire(seat);
            self.leaving.push(seat);
        }
        Ok(())
    }

    /// The box of a body as given.
    fn shape(&self, seat: u32) -> &Aabb<D, T> {
        match self.options.report {
            Report::Exact => &self.boxes[seat as usize],
            Report::Fat => &self.shapes[seat as usize],
        }
    }

    fn add(&mut self, aabb: Aabb<D, T>, filter: Filter) -> ProxyId {
        let seat = self.slots.take();
        let boxed = match self.options.report {
            Report::Exact => aabb,
            Report::Fat => {
                put(&mut self.shapes, seat, aabb);
                self.options.fatten(&aabb, [T::default(); D])
            }
        };
        put(&mut self.boxes, seat, boxed);
        put(&mut self.filters, seat, filter);
        self.any_filter |= filter != Filter::default();
        if self.updater.fat.len() < self.boxes.len() {
            self.updater.add_seat(boxed);
        }
        self.slots.raise(seat, flag::NEW);
        self.updater.any_new = true;
        self.touch(seat);
        self.slots.id(seat)
    }

    /// Puts a body's box, which is valid, where it is told.
    #[inline(always)]
    fn place(&mut self, seat: u32, aabb: &Aabb<D, T>) {
        let at = seat as usize;
        match self.options.report {
            Report::Exact => {
                let place = &mut self.boxes[at];
                if differ(place, aabb) {
                    *place = *aabb;
                    self.touch(seat);
                }
            }
            Report::Fat => {
                let before = core::mem::replace(&mut self.shapes[at], *aabb);
                if !contains(&self.boxes[at], aabb) {
                    self.boxes[at] = self.options.fatten(aabb, displacement(&before, aabb));
                    self.touch(seat);
                }
            }
        }
    }

    /// Has the next update look at a body, and the next query too.
    #[inline]
    fn touch(&mut self, seat: u32) {
        let flags = &mut self.slots.flags[seat as usize];
        if *flags & (flag::CHANGED | flag::KNOWN) != flag::CHANGED {
            self.changed.push(seat);
            *flags = (*flags | flag::CHANGED) & !flag::KNOWN;
        }
    }

    /// Keeps the filter that the last update knew a body with.
    fn note_old_filter(&mut self, seat: u32, filter: Filter) {
        let Updater { old_filters, any_refiltered, .. } = &mut self.updater;
        self.slots.raise(seat, flag::REFILTERED);
        *any_refiltered = true;
        if old_filters.len() <= seat as usize {
            old_filters.resize(self.slots.len(), filter);
        }
        old_filters[seat as usize] = filter;
    }

    /// Notes where a sweep ends.
    fn sweep_to(&mut self, seat: u32, to: Aabb<D, T>) {
        if !self.slots.has(seat, flag::SWEPT) {
            self.slots.raise(seat, flag::SWEPT);
            self.swept.push(seat);
        }
        if self.rests.len() <= seat as usize {
            self.rests.resize(self.slots.len(), to);
        }
        self.rests[seat as usize] = to;
    }

    /// Puts swept bodies where their way ended.
    fn settle(&mut self) {
        while let Some(seat) = self.swept.pop() {
            if self.slots.has(seat, flag::SWEPT) {
                self.slots.lower(seat, flag::SWEPT);
                let to = self.rests[seat as usize];
                if self.options.report == Report::Fat {
                    self.shapes[seat as usize] = to;
                    self.boxes[seat as usize] = self.options.fatten(&to, [T::default(); D]);
                    self.touch(seat);
                } else {
                    self.place(seat, &to);
                }
            }
        }
    }
}

impl<const D: usize, T: Scalar> Default for BroadPhase<D, T> {
    fn default() -> Self {
        Self::new()
    }
}

fn check_box<const D: usize, T: Scalar>(aabb: &Aabb<D, T>, index: usize) -> Result<(), Error> {
    match aabb.invalid_axis() {
        None => Ok(()),
        Some(axis) => Err(Error::InvalidBox { index, axis }),
    }
}

/// Whether boxes are all valid, without a branch for each.
fn are_valid<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>]) -> bool {
    let is_valid =
        |aabb: &Aabb<D, T>| (0..D).fold(true, |all, axis| all & (aabb.min[axis] <= aabb.max[axis]));
    boxes.iter().fold(true, |all, aabb| all & is_valid(aabb))
}

/// Whether the bits of two boxes differ, without a branch.
#[inline]
fn differ<const D: usize, T: Scalar>(a: &Aabb<D, T>, b: &Aabb<D, T>) -> bool {
    let differing = |a: T, b: T| a.to_raw() ^ b.to_raw();
    let sides = |bits, axis| {
        bits | differing(a.min[axis], b.min[axis]) | differing(a.max[axis], b.max[axis])
    };
    (0..D).fold(0, sides) != 0
}

/// Writes to a table by seat, which grows by one where the seat is new.
fn put<V>(table: &mut Vec<V>, seat: u32, value: V) {
    match table.get_mut(seat as usize) {
        Some(place) => *place = value,
        None => {
            make_room(table, 1);
            table.push(value);
        }
    }
}
