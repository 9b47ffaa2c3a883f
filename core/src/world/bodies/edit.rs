//! Insert, set and remove: what is told to the broad phase between two updates.

use alloc::vec::Vec;

use super::filter::Filter;
use super::id::ProxyId;
use super::slots::flag;
use super::table::{Bodies, check_box, differ};
use crate::memory::{prefetch_item, prefetch_pays, preload};
use crate::world::options::{Report, displacement};
use crate::{Aabb, Error, Scalar};

/// How many bodies ahead boxes are prefetched.
const AHEAD: usize = 32;

impl<const D: usize, T: Scalar> Bodies<D, T> {
    pub fn insert(&mut self, aabb: Aabb<D, T>, filter: Filter) -> Result<ProxyId, Error> {
        check_box(&aabb, 0)?;
        self.slots.check_capacity(1)?;
        Ok(self.add(aabb, filter))
    }

    pub fn insert_many(
        &mut self,
        boxes: &[Aabb<D, T>],
        filter: Filter,
    ) -> Result<Vec<ProxyId>, Error> {
        for (position, aabb) in boxes.iter().enumerate() {
            check_box(aabb, position)?;
        }
        self.slots.check_capacity(boxes.len())?;
        Ok(boxes.iter().map(|&aabb| self.add(aabb, filter)).collect())
    }

    fn add(&mut self, aabb: Aabb<D, T>, filter: Filter) -> ProxyId {
        let index = self.slots.take();
        let boxed = match self.options.report {
            Report::Exact => aabb,
            Report::Fat => self.options.fatten(&aabb, [T::default(); D]),
        };
        self.put(index, aabb, boxed, filter);
        self.slots.raise(index, flag::NEW);
        self.any_new = true;
        self.touch(index);
        self.slots.id(index)
    }

    #[inline(never)]
    pub fn set_many(&mut self, ids: &[ProxyId], boxes: &[Aabb<D, T>]) -> Result<(), Error> {
        if ids.len() != boxes.len() {
            return Err(Error::LengthMismatch { ids: ids.len(), boxes: boxes.len() });
        }
        let rows = ids.iter().zip(boxes);
        let is_sound = |(&id, aabb): (&ProxyId, &_)| self.slots.is_living(id) & is_valid(aabb);
        if !rows.clone().map(is_sound).fold(true, |all, each| all & each) {
            for (position, (&id, aabb)) in rows.enumerate() {
                self.slots.check(id, position)?;
                check_box(aabb, position)?;
            }
        }
        if !self.swept.is_empty() {
            for id in ids {
                self.slots.lower(self.slots.index_of[id.slot() as usize], flag::SWEPT);
            }
        }
        if self.scans_all(ids.len()) && self.options.report == Report::Exact {
            self.place_unlisted(ids, boxes);
            return Ok(());
        }
        preload(&self.boxes[..self.rows_to_scan(ids.len())]);
        self.changed.reserve(ids.len());
        let is_far = prefetch_pays(&self.boxes);
        for (position, (id, aabb)) in ids.iter().zip(boxes).enumerate() {
            // Rows are in the order of space, ids are not: rows are read all over the tables.
            if is_far && let Some(later) = ids.get(position + AHEAD) {
                let index = self.slots.index_of[later.slot() as usize] as usize;
                prefetch_item(&self.boxes, index);
                prefetch_item(&self.slots.flags, index);
            }
            self.place(self.slots.index_of[id.slot() as usize], aabb);
        }
        Ok(())
    }

    /// Writes valid boxes; which of them differ from those of the last update is found out later.
    #[inline(never)]
    fn place_unlisted(&mut self, ids: &[ProxyId], boxes: &[Aabb<D, T>]) {
        self.any_unlisted = true;
        let is_far = self.slots.is_reordered && prefetch_pays(&self.boxes);
        let index = |id: &ProxyId| self.slots.index_of[id.slot() as usize] as usize;
        for (position, (id, aabb)) in ids.iter().zip(boxes).enumerate() {
            if is_far && let Some(later) = ids.get(position + AHEAD) {
                prefetch_item(&self.boxes, index(later));
            }
            self.boxes[index(id)] = *aabb;
        }
    }

    /// Gives a body its new box, which is valid.
    #[inline]
    fn place(&mut self, index: u32, aabb: &Aabb<D, T>) {
        let row = index as usize;
        match self.options.report {
            Report::Exact => {
                if differ(&self.boxes[row], aabb) {
                    self.boxes[row] = *aabb;
                    self.touch(index);
                }
            }
            Report::Fat => {
                let before = core::mem::replace(&mut self.shapes[row], *aabb);
                if !self.boxes[row].contains(aabb) {
                    self.boxes[row] = self.options.fatten(aabb, displacement(&before, aabb));
                    self.touch(index);
                }
            }
        }
    }

    pub fn set_swept(
        &mut self,
        id: ProxyId,
        from: Aabb<D, T>,
        to: Aabb<D, T>,
    ) -> Result<(), Error> {
        let index = self.slots.check(id, 0)?;
        check_box(&from, 0)?;
        check_box(&to, 1)?;
        self.set_many(&[id], &[from.union(&to)])?;
        self.sweep_to(index, to);
        Ok(())
    }

    /// Puts swept bodies where their sweeps ended.
    pub fn settle(&mut self) {
        while let Some(index) = self.swept.pop() {
            if self.slots.has(index, flag::SWEPT) {
                self.slots.lower(index, flag::SWEPT);
                let to = self.rests[index as usize];
                if self.options.report == Report::Fat {
                    self.shapes[index as usize] = to;
                    self.boxes[index as usize] = self.options.fatten(&to, [T::default(); D]);
                    self.touch(index);
                } else {
                    self.place(index, &to);
                }
            }
        }
    }

    pub fn set_filter(&mut self, id: ProxyId, filter: Filter) -> Result<(), Error> {
        let index = self.slots.check(id, 0)?;
        let before = core::mem::replace(&mut self.filters[index as usize], filter);
        self.any_filter |= filter != Filter::default();
        if before != filter {
            if !self.slots.has(index, flag::NEW | flag::REFILTERED) {
                self.keep_old_filter(index, before);
            }
            self.touch(index);
        }
        Ok(())
    }

    pub fn remove_many(&mut self, ids: &[ProxyId]) -> Result<(), Error> {
        for (position, &id) in ids.iter().enumerate() {
            match self.slots.find(id) {
                Some(index) if !self.slots.has(index, flag::MARKED) => {
                    self.slots.raise(index, flag::MARKED);
                }
                _ => {
                    for before in &ids[..position] {
                        let index = self.slots.index_of[before.slot() as usize];
                        self.slots.lower(index, flag::MARKED);
                    }
                    return Err(Error::StaleProxy { index: position, id: id.to_bits() });
                }
            }
        }
        for id in ids {
            let index = self.slots.index_of[id.slot() as usize];
            self.slots.lower(index, flag::MARKED);
            self.slots.retire(index);
            if !self.slots.has(index, flag::NEW) {
                self.leaving.push(index);
                continue;
            }
            // No update knew it, so none has to report its end, and its slot is free at once: a world
            // that is edited and never updated does not grow.
            if self.slots.has(index, flag::IN_TREE) {
                self.only_in_tree.push(index);
            }
            self.slots.release(index, flag::CHANGED | flag::IN_TREE);
        }
        Ok(())
    }
}

/// Whether a box is valid, without a branch.
#[inline]
fn is_valid<const D: usize, T: Scalar>(aabb: &Aabb<D, T>) -> bool {
    (0..D).fold(true, |all, axis| all & (aabb.min[axis] <= aabb.max[axis]))
}
