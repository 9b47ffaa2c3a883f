//! The boxes that the sweep line touches.

use alloc::vec::Vec;

/// A set of box ids with O(1) `add` and `remove`, listed in an order that depends only on the
/// calls made.
#[derive(Clone, Debug, Default)]
pub struct Touching {
    ids: Vec<u32>,
    /// Where in `ids` a box stands, by its id; meaningless for those that are not in it.
    places: Vec<u32>,
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
        if self.places.len() <= id as usize {
            self.places.resize(id as usize + 1, 0);
        }
        self.places[id as usize] = self.ids.len() as u32;
        self.ids.push(id);
    }

    /// Removes a box that is in it; the last one takes its place.
    #[inline]
    pub fn remove(&mut self, id: u32) {
        let place = self.places[id as usize];
        self.ids.swap_remove(place as usize);
        if let Some(&moved) = self.ids.get(place as usize) {
            self.places[moved as usize] = place;
        }
    }

    /// The memory it holds.
    pub fn bytes(&self) -> usize {
        (self.ids.capacity() + self.places.capacity()) * size_of::<u32>()
    }
}
