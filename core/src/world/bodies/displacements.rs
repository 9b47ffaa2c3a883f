//! From where displacements count, for fat AABBs that reach ahead of motion. Empty where boxes are reported as given.

use alloc::vec::Vec;

use super::rows::put_row;
use super::slots::{Slots, flag};
use crate::cloning::clone_fields;
use crate::{Aabb, Scalar};

/// The boxes as given, and where they were.
#[derive(Debug, Default)]
pub struct Displacements<const D: usize, T: Scalar> {
    /// By index: the boxes as given.
    shapes: Vec<Aabb<D, T>>,
    /// By index: the boxes as given at the last update, or where bodies were teleported to since. Meaningless for bodies
    /// of [`flag::NEW`].
    origins: Vec<Aabb<D, T>>,
    /// The bodies of [`flag::MOVED`], whose next displacement counts from another place.
    moved: Vec<u32>,
    /// The bodies whose fat AABB is replaced at the next update if they rest, and some that were removed since the last.
    too_wide: Vec<u32>,
    /// How far all bodies were shifted since the last update, if they were.
    shifted: Option<[T; D]>,
}

clone_fields! {
    [const D: usize, T: Scalar] Displacements<D, T> { shapes, origins, moved, too_wide, shifted }
}

impl<const D: usize, T: Scalar> Displacements<D, T> {
    /// The boxes as given.
    pub fn shapes(&self) -> &[Aabb<D, T>] {
        &self.shapes
    }

    /// From where displacements count.
    pub fn origins(&self) -> &[Aabb<D, T>] {
        &self.origins
    }

    /// The bodies whose displacements will count from another place.
    pub fn moved(&self) -> &[u32] {
        &self.moved
    }

    /// How far all bodies were shifted since the last update.
    pub fn shifted(&self) -> Option<[T; D]> {
        self.shifted
    }

    /// Writes the row of a new body, whose index is that of an existing row or the next.
    pub fn put(&mut self, index: u32, shape: Aabb<D, T>) {
        put_row(&mut self.shapes, index, shape);
        put_row(&mut self.origins, index, shape);
    }

    /// Gives a body another box.
    #[inline]
    pub fn move_to(&mut self, slots: &mut Slots, index: u32, shape: &Aabb<D, T>) {
        self.shapes[index as usize] = *shape;
        self.list_moved(slots, index);
    }

    /// Writes from where the displacements of a body count.
    pub fn put_origin(&mut self, slots: &mut Slots, index: u32, origin: Aabb<D, T>) {
        self.origins[index as usize] = origin;
        self.list_moved(slots, index);
    }

    /// Makes the displacements of a body count from where it will be.
    pub fn teleport(&mut self, index: u32, to: &Aabb<D, T>) {
        if let Some(origin) = self.origins.get_mut(index as usize) {
            *origin = *to;
        }
    }

    fn list_moved(&mut self, slots: &mut Slots, index: u32) {
        if !slots.has(index, flag::MOVED) {
            slots.raise(index, flag::MOVED);
            self.moved.push(index);
        }
    }

    /// Moves everything by an offset.
    pub fn shift(&mut self, offset: &[T; D]) {
        for aabb in self.shapes.iter_mut().chain(&mut self.origins) {
            *aabb = aabb.translate(*offset);
        }
        let before = self.shifted.unwrap_or([T::default(); D]);
        self.put_shift(core::array::from_fn(|axis| before[axis] + offset[axis]));
    }

    /// Notes how far all bodies were shifted since the last update.
    pub fn put_shift(&mut self, offset: [T; D]) {
        self.shifted = (offset != [T::default(); D]).then_some(offset);
    }

    /// Begins to count displacements from where the bodies are now: to be followed by calls of [`land`](Self::land).
    pub fn begin(&mut self) {
        self.shifted = None;
        self.too_wide.clear();
    }

    /// Makes the displacements of one of the bodies that moved count from where it is, and returns it.
    pub fn land(&mut self, slots: &mut Slots) -> Option<u32> {
        while let Some(index) = self.moved.pop() {
            slots.lower(index, flag::MOVED);
            if slots.has(index, flag::LIVE) {
                self.origins[index as usize] = self.shapes[index as usize];
                return Some(index);
            }
        }
        None
    }

    /// Notes a body whose fat AABB is too wide.
    pub fn note_too_wide(&mut self, index: u32) {
        self.too_wide.push(index);
    }

    /// The bodies whose fat AABBs are too wide, and some that were removed.
    pub fn too_wide(&self) -> &[u32] {
        &self.too_wide
    }

    /// What follows the storage order: rows, and lists of indices.
    pub fn stored(&mut self) -> ([&mut Vec<Aabb<D, T>>; 2], [&mut Vec<u32>; 2]) {
        ([&mut self.shapes, &mut self.origins], [&mut self.moved, &mut self.too_wide])
    }
}
