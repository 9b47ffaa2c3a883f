//! A new order of the bodies in memory, and what brings their tables into it.

use alloc::vec::Vec;
use core::mem::swap;

use super::bodies::Filter;
use crate::memory::reserve;
use crate::{Aabb, Scalar};

/// No index yet.
const NONE: u32 = u32::MAX;

/// The old index of each new one, the new index of each old one, and spare tables.
#[derive(Debug, Default)]
pub struct Permutation<const D: usize, T: Scalar> {
    old: Vec<u32>,
    new: Vec<u32>,
    boxes: Vec<Aabb<D, T>>,
    words: Vec<u32>,
    filters: Vec<Filter>,
    flags: Vec<u16>,
}

impl<const D: usize, T: Scalar> Permutation<D, T> {
    /// Begins an order of this many bodies, which are added one by one.
    pub fn begin(&mut self, count: usize) {
        self.old.clear();
        self.new.clear();
        self.new.resize(count, NONE);
    }

    /// Gives a body the next index, unless it has one.
    #[cfg_attr(target_arch = "wasm32", inline(never))]
    pub fn add(&mut self, old: u32) {
        let new = &mut self.new[old as usize];
        if *new == NONE {
            *new = self.old.len() as u32;
            self.old.push(old);
        }
    }

    /// Becomes the order of these old and new indices, which are inverse to each other.
    pub fn copy(&mut self, old: &[u32], new: &[u32]) {
        for (to, from) in [(&mut self.old, old), (&mut self.new, new)] {
            to.clear();
            to.extend_from_slice(from);
        }
    }

    /// The new index of each old one.
    pub fn new_indices(&self) -> &[u32] {
        &self.new
    }

    /// Renames the bodies of a list.
    pub fn rename(&self, list: &mut [u32]) {
        for index in list {
            *index = self.new[*index as usize];
        }
    }

    /// Moves the rows of a table to their new indices.
    pub fn move_boxes(&mut self, table: &mut Vec<Aabb<D, T>>) {
        move_rows(table, &self.old, &mut self.boxes);
    }

    /// Moves the rows of a table to their new indices.
    pub fn move_filters(&mut self, table: &mut Vec<Filter>) {
        move_rows(table, &self.old, &mut self.filters);
    }

    /// Moves the rows of a table to their new indices.
    pub fn move_flags(&mut self, table: &mut Vec<u16>) {
        move_rows(table, &self.old, &mut self.flags);
    }

    /// Moves the rows of a table to their new indices.
    pub fn move_words(&mut self, table: &mut Vec<u32>) {
        move_rows(table, &self.old, &mut self.words);
    }
}

/// Puts a table into a new order; an empty one stays empty. What a table does not reach to is not needed.
#[inline(never)]
fn move_rows<V: Copy>(table: &mut Vec<V>, old: &[u32], spare: &mut Vec<V>) {
    if let Some(&any) = table.first() {
        table.resize(old.len(), any);
        spare.clear();
        reserve(spare, old.len());
        spare.extend(old.iter().map(|&old| table[old as usize]));
        swap(table, spare);
    }
}
