//! What is told to the world between two updates: bodies that come, get new boxes or filters, and go.
//! The next update looks at those that are *touched*.

use alloc::vec::Vec;

use super::BroadPhase;
use super::filter::Filter;
use super::options::{Report, contains, displacement, hull};
use super::proxy::{ProxyId, flag};
use super::update::MOST;
use super::updater::Updater;
use crate::memory::{prefetch_item, prefetch_pays};
use crate::{Aabb, Error, Scalar};

/// The boxes of so many bodies that are set are called from memory before they are written.
const AHEAD: usize = 32;

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
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
        let calls = ids.iter().zip(boxes);
        let is_sound = |(&id, aabb): (&ProxyId, &_)| self.slots.is_living(id) & is_valid(aabb);
        if !calls.clone().map(is_sound).fold(true, |all, each| all & each) {
            for (index, (&id, aabb)) in calls.enumerate() {
                self.slots.check(id, index)?;
                check_box(aabb, index)?;
            }
        }
        if !self.swept.is_empty() {
            for id in ids {
                self.slots.lower(self.slots.seats[id.slot() as usize], flag::SWEPT);
            }
        }
        let are_many = ids.len() * MOST > self.slots.len();
        if are_many && self.options.report == Report::Exact {
            self.place_unlisted(ids, boxes);
            return Ok(());
        }
        self.updater.warm_for(ids.len(), &self.boxes);
        self.changed.reserve(ids.len());
        let is_far = prefetch_pays(&self.boxes);
        for (index, (id, aabb)) in ids.iter().zip(boxes).enumerate() {
            // Seats are dealt by place, ids are not: what is looked at is all over the tables.
            if is_far && let Some(later) = ids.get(index + AHEAD) {
                let seat = self.slots.seats[later.slot() as usize] as usize;
                prefetch_item(&self.boxes, seat);
                prefetch_item(&self.slots.flags, seat);
            }
            self.place(self.slots.seats[id.slot() as usize], aabb);
        }
        Ok(())
    }

    /// Puts boxes, which are valid, where they are told: the update will see which differ from those of
    /// the last.
    #[inline(never)]
    fn place_unlisted(&mut self, ids: &[ProxyId], boxes: &[Aabb<D, T>]) {
        self.unlisted = true;
        let is_far = self.slots.are_dealt && prefetch_pays(&self.boxes);
        let seat = |id: &ProxyId| self.slots.seats[id.slot() as usize] as usize;
        for (index, (id, aabb)) in ids.iter().zip(boxes).enumerate() {
            if is_far && let Some(later) = ids.get(index + AHEAD) {
                prefetch_item(&self.boxes, seat(later));
            }
            self.boxes[seat(id)] = *aabb;
        }
    }

    /// Lists the bodies whose boxes were set many at a time and are not listed yet, and some that are.
    pub(super) fn list_changed(&mut self) {
        if core::mem::take(&mut self.unlisted) {
            for seat in 0..self.slots.len() {
                let flags = self.slots.flags[seat];
                // What the last update knew of the slot of a new body was another body's box.
                if flags & flag::LIVE != 0
                    && (flags & flag::NEW != 0
                        || differ(&self.boxes[seat], &self.updater.previous[seat]))
                {
                    self.touch(seat as u32);
                }
            }
        }
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
        self.set(id, hull(&from, &to))?;
        self.sweep_to(seat, to);
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
                    return Err(Error::StaleProxy { index, id: id.to_bits() });
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
    #[inline]
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
    pub(super) fn touch(&mut self, seat: u32) {
        let flags = &mut self.slots.flags[seat as usize];
        if *flags & (flag::CHANGED | flag::KNOWN) != flag::CHANGED {
            self.changed.push(seat);
            *flags = (*flags | flag::CHANGED) & !flag::KNOWN;
        }
    }

    /// Keeps the filter that the last update knew a body with.
    pub(super) fn note_old_filter(&mut self, seat: u32, filter: Filter) {
        let Updater { old_filters, any_refiltered, .. } = &mut self.updater;
        self.slots.raise(seat, flag::REFILTERED);
        *any_refiltered = true;
        self.any_filter |= filter != Filter::default();
        if old_filters.len() <= seat as usize {
            old_filters.resize(self.slots.len(), filter);
        }
        old_filters[seat as usize] = filter;
    }

    /// Notes where a sweep ends.
    pub(super) fn sweep_to(&mut self, seat: u32, to: Aabb<D, T>) {
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
    pub(super) fn settle(&mut self) {
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

pub(super) fn check_box<const D: usize, T: Scalar>(
    aabb: &Aabb<D, T>,
    index: usize,
) -> Result<(), Error> {
    aabb.check(index)
}

/// Whether a box is valid, without a branch.
#[inline]
fn is_valid<const D: usize, T: Scalar>(aabb: &Aabb<D, T>) -> bool {
    (0..D).fold(true, |all, axis| all & (aabb.min[axis] <= aabb.max[axis]))
}

/// Whether the bits of two boxes differ: without a branch, and in the order of the bits in memory, so
/// that compilers compare several at once.
#[inline]
pub(super) fn differ<const D: usize, T: Scalar>(a: &Aabb<D, T>, b: &Aabb<D, T>) -> bool {
    let corners = |a: &[T; D], b: &[T; D]| {
        (0..D).fold(0, |bits, axis| bits | (a[axis].to_raw() ^ b[axis].to_raw()))
    };
    corners(&a.min, &b.min) | corners(&a.max, &b.max) != 0
}

/// Writes to a table by seat, which grows by one where the seat is new.
fn put<V>(table: &mut Vec<V>, seat: u32, value: V) {
    match table.get_mut(seat as usize) {
        Some(place) => *place = value,
        None => table.push(value),
    }
}
