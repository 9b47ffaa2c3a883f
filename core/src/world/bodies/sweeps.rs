//! The boxes that are swept until the next update.

use alloc::vec::Vec;

use super::slots::{Slots, flag};
use crate::cloning::clone_fields;
use crate::{Aabb, Scalar};

/// The bodies of [`flag::SWEPT`], and where each is after the next update.
#[derive(Debug, Default)]
pub struct Sweeps<const D: usize, T: Scalar> {
    /// The swept bodies, and others, some twice.
    listed: Vec<u32>,
    /// By index, only as long as needed. Meaningless for bodies that are not swept.
    ends: Vec<Aabb<D, T>>,
}

clone_fields! {
    [const D: usize, T: Scalar] Sweeps<D, T> { listed, ends }
}

impl<const D: usize, T: Scalar> Sweeps<D, T> {
    /// Whether surely no body is swept.
    pub fn is_empty(&self) -> bool {
        self.listed.is_empty()
    }

    /// The bodies that are swept, and others.
    pub fn listed(&self) -> &[u32] {
        &self.listed
    }

    /// Where the sweep of a body ends, if it is swept.
    pub fn end(&self, index: u32) -> Option<&Aabb<D, T>> {
        self.ends.get(index as usize)
    }

    /// Keeps where a sweep ends.
    pub fn add(&mut self, slots: &mut Slots, index: u32, end: Aabb<D, T>) {
        if !slots.has(index, flag::SWEPT) {
            if self.listed.len() > slots.len() {
                // Bodies that were set after they were swept are still listed: drop them.
                let all = 0..slots.len() as u32;
                self.listed.clear();
                self.listed.extend(all.filter(|&index| slots.has(index, flag::SWEPT)));
            }
            slots.raise(index, flag::SWEPT);
            self.listed.push(index);
        }
        if self.ends.len() <= index as usize {
            self.ends.resize(slots.len(), end);
        }
        self.ends[index as usize] = end;
    }

    /// A body that is swept, and where its sweep ends; then it is swept no more.
    pub fn pop(&mut self, slots: &mut Slots) -> Option<(u32, Aabb<D, T>)> {
        while let Some(index) = self.listed.pop() {
            if slots.has(index, flag::SWEPT) {
                slots.lower(index, flag::SWEPT);
                return Some((index, self.ends[index as usize]));
            }
        }
        None
    }

    /// Moves all ends.
    pub fn shift(&mut self, offset: &[T; D]) {
        self.ends.iter_mut().for_each(|end| *end = end.translate(*offset));
    }

    /// What follows the storage order: rows, and a list of indices.
    pub fn stored(&mut self) -> (&mut Vec<Aabb<D, T>>, &mut Vec<u32>) {
        (&mut self.ends, &mut self.listed)
    }
}
