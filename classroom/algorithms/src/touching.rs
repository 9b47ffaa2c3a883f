//! The boxes that the sweep line touches.

use alloc::vec::Vec;

/// A set of box ids with O(1) `add` and `remove`, listed in an order that depends only on the
/// calls made.
#[derive(Clone, Debug, Default)]
pub struct Touching {
    ids: Vec<u32>,
    /// By id, the position of the box in `ids`; meaningless for boxes that are not in it.
    positions: Vec<u32>,
}

impl Touching {
    /// The boxes in it.
    #[inline]
    pub fn ids(&self) -> &[u32] {
        &self.ids
    }

    /// Adds a box that is not in it.
    #[inline]
    pub fn add(&mut self, id: u32) {
        if self.positions.len() <= id as usize {
            self.positions.resize(id as usize + 1, 0);
        }
        self.positions[id as usize] = self.ids.len() as u32;
        self.ids.push(id);
    }

    /// Removes a box that is in it; the last one moves to its position.
    #[inline]
    pub fn remove(&mut self, id: u32) {
        let position = self.positions[id as usize];
        self.ids.swap_remove(position as usize);
        if let Some(&moved) = self.ids.get(position as usize) {
            self.positions[moved as usize] = position;
        }
    }

    /// The memory it holds.
    pub fn bytes(&self) -> usize {
        (self.ids.capacity() + self.positions.capacity()) * size_of::<u32>()
    }
}
