//! What was done to bodies since the last update.

use alloc::vec::Vec;

use super::slots::{Slots, flag};
use crate::cloning::clone_fields;

/// The bodies that changed or left since the last update.
#[derive(Debug, Default)]
pub struct Edits {
    changed: Vec<u32>,
    leaving: Vec<u32>,
    any_new: bool,
    any_unlisted: bool,
}

clone_fields! {
    [] Edits { changed, leaving, any_new, any_unlisted }
}

impl Edits {
    /// The bodies of [`flag::CHANGED`], at least once each, and some that were removed since.
    #[inline]
    pub fn changed(&self) -> &[u32] {
        &self.changed
    }

    /// The bodies of [`flag::LEAVING`].
    #[inline]
    pub fn leaving(&self) -> &[u32] {
        &self.leaving
    }

    /// Whether there is a body of [`flag::NEW`].
    pub fn any_new(&self) -> bool {
        self.any_new
    }

    /// Whether boxes may have changed of bodies that are not listed.
    pub fn any_unlisted(&self) -> bool {
        self.any_unlisted
    }

    /// Has the next update look at a body, and the next query too.
    #[inline]
    pub fn touch(&mut self, slots: &mut Slots, index: u32) {
        let flags = &mut slots.flags[index as usize];
        if *flags & (flag::CHANGED | flag::IN_TREE) != flag::CHANGED {
            self.changed.push(index);
            *flags = (*flags | flag::CHANGED) & !flag::IN_TREE;
        }
    }

    /// Has the next update and the next query compare all boxes.
    pub fn touch_all(&mut self) {
        self.any_unlisted = true;
    }

    /// Reserves memory for as many more bodies to touch.
    pub fn reserve(&mut self, count: usize) {
        self.changed.reserve(count);
    }

    /// Notes that a body is new.
    pub fn note_new(&mut self, slots: &mut Slots, index: u32) {
        slots.raise(index, flag::NEW);
        self.any_new = true;
    }

    /// Lists a body of [`flag::LEAVING`].
    pub fn note_leaving(&mut self, index: u32) {
        self.leaving.push(index);
    }

    /// Whether all boxes are to be compared; the caller lists those that changed.
    pub fn take_unlisted(&mut self) -> bool {
        core::mem::take(&mut self.any_unlisted)
    }

    /// The list of bodies that changed, for a caller that finds out itself which these are.
    pub fn changed_mut(&mut self) -> &mut Vec<u32> {
        &mut self.changed
    }

    /// Lists each body of [`flag::CHANGED`] once.
    pub fn list_once(&mut self, slots: &Slots) {
        let all = 0..slots.len() as u32;
        self.changed.clear();
        self.changed.extend(all.filter(|&index| slots.has(index, flag::CHANGED)));
    }

    /// All lists, for other indices.
    pub fn lists(&mut self) -> [&mut Vec<u32>; 2] {
        [&mut self.changed, &mut self.leaving]
    }

    /// Forgets which bodies changed, and that some are new.
    pub fn forget_changed(&mut self) {
        self.changed.clear();
        self.any_new = false;
    }

    /// Frees the slots of the bodies that left.
    pub fn release_leaving(&mut self, slots: &mut Slots) {
        for index in self.leaving.drain(..) {
            slots.release(index, 0);
        }
    }
}
