//! The tables of bodies: what the next update compares, the world now and at the last update.

use super::boxes::Boxes;
use super::displacements::Displacements;
use super::edits::Edits;
use super::filter::Filter;
use super::id::ProxyId;
use super::rules::{Rules, When};
use super::slots::{Slots, flag};
use super::sweeps::Sweeps;
use crate::cloning::clone_fields;
use crate::world::options::{Options, Report};
use crate::{Aabb, Scalar};

/// Reading a row at random takes as long as reading this many rows in order (see `crate::memory`).
pub const RANDOM_READ: usize = 16;
/// If more than one body in this many changed, all bodies are scanned in storage order.
/// 2 instead takes 0.97 to 1.02 of the time; with 16 mostly-still takes 1.20 to 1.54.
const SCAN_ALL: usize = 4;

/// All bodies, by storage index, and what changed since the last update.
#[derive(Debug, Default)]
pub struct Bodies<const D: usize, T: Scalar> {
    pub options: Options<T>,
    pub slots: Slots,
    /// The boxes whose overlaps are reported, now and at the last update.
    pub boxes: Boxes<D, T>,
    /// The boxes as given, where these are not the ones reported.
    pub displacements: Displacements<D, T>,
    pub sweeps: Sweeps<D, T>,
    /// Which bodies may pair.
    pub rules: Rules,
    /// What was done since the last update.
    pub edits: Edits,
    /// Bodies that moved recently have smaller indices than this, with few exceptions.
    pub front: usize,
}

clone_fields! {
    [const D: usize, T: Scalar] Bodies<D, T> {
        options, slots, boxes, displacements, sweeps, rules, edits, front,
    }
}

impl<const D: usize, T: Scalar> Bodies<D, T> {
    /// Whether this many changes are found faster by scanning all bodies than one by one.
    pub fn scans_all(&self, changes: usize) -> bool {
        changes * SCAN_ALL > self.slots.len()
    }

    /// How many rows of a table are better read in order, if `count` rows are needed: all, those of
    /// the bodies that move, or none.
    pub fn rows_to_scan(&self, count: usize) -> usize {
        let (worth, front, all) = (count.saturating_mul(RANDOM_READ), self.front, self.slots.len());
        if front > all / 2 && worth > all {
            all
        } else if worth > front {
            front
        } else {
            0
        }
    }

    /// The boxes as given, by slot, of free slots those of their last bodies.
    pub fn shapes(&self) -> &[Aabb<D, T>] {
        match self.options.report {
            Report::Exact => self.boxes.now(),
            Report::Fat { .. } => self.displacements.shapes(),
        }
    }

    /// The box of a body as given.
    pub fn shape(&self, index: u32) -> &Aabb<D, T> {
        &self.shapes()[index as usize]
    }

    /// Writes all that is known of a body whose index is that of an existing row or the next.
    pub fn put(&mut self, index: u32, shape: Aabb<D, T>, boxed: Aabb<D, T>, filter: Filter) {
        if self.options.report.is_fat() {
            self.displacements.put(index, shape);
        }
        let rows = self.boxes.len();
        self.front += usize::from(index as usize == rows && self.front == rows);
        self.boxes.put(index, boxed);
        self.rules.put(index, filter);
    }

    /// Adds a body, for which there is a slot.
    pub fn add(&mut self, aabb: Aabb<D, T>, filter: Filter) -> ProxyId {
        let index = self.slots.take();
        let boxed = self.options.report.boxed(None, &aabb, &aabb);
        self.put(index, aabb, boxed, filter);
        self.edits.note_new(&mut self.slots, index);
        self.touch(index);
        self.slots.id(index)
    }

    /// Gives a body its new box, which is valid.
    #[inline]
    pub fn place(&mut self, index: u32, aabb: &Aabb<D, T>) {
        let row = index as usize;
        match self.options.report {
            Report::Exact => {
                if differ(&self.boxes.now()[row], aabb) {
                    self.boxes.now_mut()[row] = *aabb;
                    self.touch(index);
                }
            }
            Report::Fat { .. } => {
                self.displacements.move_to(&mut self.slots, index, aabb);
                self.refatten(index);
            }
        }
    }

    /// The fat AABB of a body: a fact about the last update, where the body is now, and teleports and shifts in between.
    #[inline(never)]
    fn fat(&self, index: u32) -> Aabb<D, T> {
        let row = index as usize;
        let shape = &self.displacements.shapes()[row];
        let is_new = self.slots.has(index, flag::NEW);
        // The union of a sweep is no place where the body was.
        let rests = is_new || self.slots.has(index, flag::SWEPT);
        let had = || match self.displacements.shifted() {
            Some(offset) => self.boxes.previous()[row].translate(offset),
            None => self.boxes.previous()[row],
        };
        let from = if rests { shape } else { &self.displacements.origins()[row] };
        self.options.report.boxed((!is_new).then(had), from, shape)
    }

    /// Gives a body the fat AABB that follows from its box.
    #[inline(never)]
    fn refatten(&mut self, index: u32) {
        let fat = self.fat(index);
        if differ(&self.boxes.now()[index as usize], &fat) {
            self.boxes.now_mut()[index as usize] = fat;
            self.touch(index);
        }
    }

    /// Whether the fat AABB of a body is another one than follows from its box: then it is replaced at the next update,
    /// if the body rests.
    pub fn is_too_wide(&self, index: u32) -> bool {
        differ(&self.boxes.now()[index as usize], &self.fat(index))
    }

    /// Replaces the fat AABBs that are too wide for bodies that rest since the last update.
    pub fn refatten_too_wide(&mut self) {
        for at in 0..self.displacements.too_wide().len() {
            let index = self.displacements.too_wide()[at];
            if self.slots.has(index, flag::LIVE) {
                self.refatten(index);
            }
        }
    }

    /// Makes displacements count from where the bodies are now. To be called when the last update is this one.
    pub fn reset_origins(&mut self) {
        self.displacements.begin();
        while let Some(index) = self.displacements.land(&mut self.slots) {
            if self.is_too_wide(index) {
                self.displacements.note_too_wide(index);
            }
        }
    }

    /// Gives a body its new box, as if it had been there at the last update already.
    pub fn teleport(&mut self, index: u32, aabb: &Aabb<D, T>) {
        self.displacements.teleport(index, aabb);
        self.place(index, aabb);
    }

    /// Moves everything by a finite offset.
    pub fn shift(&mut self, offset: &[T; D]) {
        self.boxes.now_mut().iter_mut().for_each(|aabb| *aabb = aabb.translate(*offset));
        self.sweeps.shift(offset);
        self.edits.touch_all();
        if self.options.report.is_fat() {
            self.displacements.shift(offset);
            for index in 0..self.slots.len() as u32 {
                if self.slots.has(index, flag::LIVE) {
                    self.refatten(index);
                }
            }
        }
    }

    /// Has the next update look at a body, and the next query too.
    #[inline]
    pub fn touch(&mut self, index: u32) {
        self.edits.touch(&mut self.slots, index);
    }

    /// About how many bodies changed or were removed.
    pub fn count_changes(&self) -> usize {
        let listed = self.edits.changed().len() + self.edits.leaving().len();
        if self.edits.any_unlisted() { listed.max(self.slots.live) } else { listed }
    }

    /// Whether most bodies are new and static: a level was loaded.
    #[inline(never)]
    pub fn is_level_new(&self) -> bool {
        let is_new = |&&index: &&u32| self.is_static(index) && self.slots.has(index, flag::NEW);
        let changed = self.edits.changed();
        self.edits.any_new()
            && changed.len() * 2 > self.slots.live
            && changed.iter().filter(is_new).count() * 2 > self.slots.live
    }

    /// Whether there is a body, and it is static.
    pub fn is_static(&self, index: u32) -> bool {
        self.slots.has(index, flag::LIVE) && self.rules.filter_now(index).is_static
    }

    /// Lists the bodies whose boxes changed and are not listed yet, and some that are.
    pub fn list_changed(&mut self) {
        if self.edits.take_unlisted() {
            for index in 0..self.slots.len() {
                let flags = self.slots.flags[index];
                // The previous box of a new body is that of the body that had the slot before.
                let (now, before) = (&self.boxes.now()[index], &self.boxes.previous()[index]);
                let is_changed = flags & flag::NEW != 0 || differ(now, before);
                if flags & flag::LIVE != 0 && is_changed {
                    self.touch(index as u32);
                }
            }
        }
    }

    /// Whether two bodies are there, overlap, and may pair.
    pub fn is_live(&self, [a, b]: [u32; 2]) -> bool {
        let boxes = self.boxes.now();
        self.slots.has(a, flag::LIVE)
            && self.slots.has(b, flag::LIVE)
            && boxes[a as usize].overlaps_branch_free(&boxes[b as usize])
            && self.allows([a, b])
    }

    /// Whether a pair was live at the last update. Compiled once in WebAssembly, where files are to stay small.
    #[cfg_attr(target_arch = "wasm32", inline(never))]
    pub fn was_live(&self, [a, b]: [u32; 2]) -> bool {
        let boxes = self.boxes.previous();
        boxes[a as usize].overlaps_branch_free(&boxes[b as usize]) && self.was_allowed([a, b])
    }

    /// Whether the last update knew two bodies, and their filters allowed them to pair then.
    pub fn was_allowed(&self, [a, b]: [u32; 2]) -> bool {
        !self.slots.has(a, flag::NEW)
            && !self.slots.has(b, flag::NEW)
            && (self.rules.allow_all() || self.rules.allow(&self.slots, [a, b], When::LastUpdate))
    }

    /// Whether two bodies may pair.
    #[inline]
    pub fn allows(&self, pair: [u32; 2]) -> bool {
        self.rules.allow_all() || self.rules.allow(&self.slots, pair, When::Now)
    }

    /// Gives a body another filter.
    pub fn refilter(&mut self, index: u32, filter: Filter) {
        if *self.rules.filter_now(index) != filter {
            self.rules.refilter(&mut self.slots, index, filter);
            self.touch(index);
        }
    }

    /// Excludes a pair of two bodies, or includes it again.
    pub fn exclude(&mut self, pair: [u32; 2], is_excluded: bool) {
        if self.rules.exclude(&mut self.slots, pair, is_excluded) {
            pair.iter().for_each(|&index| self.touch(index));
        }
    }

    /// Forgets that a body is swept, if it is.
    pub fn cancel_sweep(&mut self, index: u32) {
        self.slots.lower(index, flag::SWEPT);
    }

    /// Puts swept bodies where their sweeps ended.
    pub fn settle(&mut self) {
        while let Some((index, end)) = self.sweeps.pop(&mut self.slots) {
            self.teleport(index, &end);
        }
    }
}

/// Whether the bits of two boxes differ: without a branch, and in the order of the bits in memory, so
/// that compilers vectorize it.
#[inline]
pub fn differ<const D: usize, T: Scalar>(a: &Aabb<D, T>, b: &Aabb<D, T>) -> bool {
    let corners = |a: &[T; D], b: &[T; D]| {
        (0..D).fold(0, |bits, axis| bits | (a[axis].to_raw() ^ b[axis].to_raw()))
    };
    corners(&a.min, &b.min) | corners(&a.max, &b.max) != 0
}
