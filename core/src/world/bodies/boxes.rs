//! The boxes whose overlaps are reported, now and at the last update.
//!
//! Where all bodies are given new boxes in each frame, the boxes of now become those of the last update without being
//! copied: the two tables change places.

use alloc::vec::Vec;

use super::rows::put_row;
use crate::cloning::clone_fields;
use crate::{Aabb, Scalar};

/// Whether all boxes are replaced at once. Not in WebAssembly, where code is to be small: there, those of each update are copied
/// when it ends.
pub const REPLACES_ALL: bool = cfg!(not(target_arch = "wasm32"));

/// Two tables, by index.
#[derive(Debug, Default)]
pub struct Boxes<const D: usize, T: Scalar> {
    now: Vec<Aabb<D, T>>,
    /// The boxes at the last update, meaningless for new bodies; empty if those are the boxes of now.
    previous: Vec<Aabb<D, T>>,
}

clone_fields! {
    [const D: usize, T: Scalar] Boxes<D, T> { now, previous }
}

impl<const D: usize, T: Scalar> Boxes<D, T> {
    /// How many there are.
    #[inline]
    pub fn len(&self) -> usize {
        self.now.len()
    }

    /// The boxes of now.
    #[inline]
    pub fn now(&self) -> &[Aabb<D, T>] {
        &self.now
    }

    /// The boxes at the last update. Meaningless for bodies of `flag::NEW`.
    #[inline]
    pub fn previous(&self) -> &[Aabb<D, T>] {
        if REPLACES_ALL && self.previous.is_empty() { &self.now } else { &self.previous }
    }

    /// The boxes of now, to be changed: those of the last update are kept.
    #[inline]
    pub fn now_mut(&mut self) -> &mut [Aabb<D, T>] {
        self.keep_previous();
        &mut self.now
    }

    /// Writes the box of a body whose index is that of an existing row or the next.
    pub fn put(&mut self, index: u32, boxed: Aabb<D, T>) {
        self.keep_previous();
        put_row(&mut self.now, index, boxed);
        if self.previous.len() < self.now.len() {
            self.previous.push(boxed);
        }
    }

    /// Writes the box that a body had at the last update.
    pub fn put_previous(&mut self, index: u32, boxed: Aabb<D, T>) {
        self.keep_previous();
        self.previous[index as usize] = boxed;
    }

    /// Replaces all boxes. Given is a box for each slot, and where storage was reordered, the slots by index.
    pub fn replace(&mut self, by_slot: &[Aabb<D, T>], slot_of: Option<&[u32]>) {
        if self.previous.is_empty() {
            core::mem::swap(&mut self.now, &mut self.previous);
        }
        self.now.clear();
        match slot_of {
            None => self.now.extend_from_slice(by_slot),
            Some(slots) => self.now.extend(slots.iter().map(|&slot| by_slot[slot as usize])),
        }
    }

    /// Ends an update: the boxes of now are those of the last update from then on. Given is how many rows are better copied in
    /// order, and which others may have changed.
    pub fn end_update(&mut self, read: usize, changed: &[u32]) {
        let Self { now, previous } = self;
        if REPLACES_ALL && (read == now.len() || previous.is_empty()) {
            previous.clear();
            return;
        }
        previous[..read].copy_from_slice(&now[..read]);
        if read < now.len() {
            for row in changed.iter().map(|&index| index as usize).filter(|&row| row >= read) {
                previous[row] = now[row];
            }
        }
    }

    /// What follows the storage order.
    pub fn stored(&mut self) -> [&mut Vec<Aabb<D, T>>; 2] {
        [&mut self.now, &mut self.previous]
    }

    /// Copies the boxes of the last update before one of now changes.
    #[inline]
    fn keep_previous(&mut self) {
        if REPLACES_ALL && self.previous.is_empty() {
            self.copy_previous();
        }
    }

    #[inline(never)]
    fn copy_previous(&mut self) {
        self.previous.extend_from_slice(&self.now);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(place: usize) -> Aabb<1> {
        Aabb::new([place as f32], [place as f32 + 1.0])
    }

    fn all(from: usize) -> Vec<Aabb<1>> {
        (from..from + 4).map(at).collect()
    }

    /// Four boxes, of which the last update knew all.
    fn four() -> Boxes<1, f32> {
        let mut boxes = Boxes::default();
        (0..4).for_each(|index| boxes.put(index, at(index as usize)));
        boxes.end_update(4, &[]);
        assert_eq!([boxes.now(), boxes.previous()], [&all(0); 2]);
        boxes
    }

    #[test]
    fn each_way_to_change_a_box_keeps_that_of_the_last_update() {
        let changes: [fn(&mut Boxes<1, f32>); 4] = [
            |boxes| boxes.now_mut()[2] = at(9),
            |boxes| boxes.put(2, at(9)),
            |boxes| boxes.put(4, at(9)),
            |boxes| boxes.replace(&all(5), None),
        ];
        for (first, change) in changes.iter().enumerate() {
            for second in &changes {
                let mut boxes = four();
                change(&mut boxes);
                second(&mut boxes);
                assert_ne!(boxes.now(), all(0), "{first}");
                assert_eq!(boxes.previous()[..4], all(0), "{first}");
            }
        }
    }

    #[test]
    fn boxes_by_slot_are_stored_by_index() {
        let mut boxes = four();
        boxes.replace(&all(5), Some(&[2, 0, 3, 1]));
        assert_eq!(boxes.now(), [7, 5, 8, 6].map(at));
        assert_eq!(boxes.previous(), all(0));
    }

    #[test]
    fn an_update_that_read_few_boxes_copies_those_that_changed() {
        let mut boxes = four();
        boxes.now_mut()[3] = at(9);
        boxes.end_update(1, &[3]);
        assert_eq!(boxes.previous(), [0, 1, 2, 9].map(at));
        // Then nothing changes, and the boxes of the last update are still those.
        boxes.end_update(4, &[]);
        boxes.end_update(0, &[]);
        boxes.end_update(1, &[3]);
        boxes.now_mut()[0] = at(7);
        assert_eq!(boxes.previous(), [0, 1, 2, 9].map(at));
    }

    #[test]
    fn the_box_of_the_last_update_can_be_another() {
        let mut boxes = four();
        boxes.put_previous(1, at(8));
        assert_eq!(boxes.now(), all(0));
        assert_eq!(boxes.previous(), [0, 8, 2, 3].map(at));
    }
}
