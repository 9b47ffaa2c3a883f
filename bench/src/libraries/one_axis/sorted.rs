//! The sorted boxes as the sweep reads them.

use sweep_and_prune::Aabb;

use super::order::key;

/// How many sentinels end each array: one vector of the widest kind, and one more.
pub const SENTINELS: usize = 32;
/// Above every key of a coordinate, infinity included.
pub const SENTINEL: i32 = i32::MAX;

/// The sorted boxes: one array for each coordinate, with the axis of the sweep first.
pub struct Sorted<const D: usize> {
    pub min: [Vec<i32>; D],
    pub max: [Vec<i32>; D],
    pub ids: Vec<u32>,
}

impl<const D: usize> Sorted<D> {
    /// No boxes.
    pub fn new() -> Self {
        let empty = || std::array::from_fn(|_| Vec::new());
        Self { min: empty(), max: empty(), ids: Vec::new() }
    }

    /// Takes the boxes in an order, whose items have the indices in their lower halves.
    pub fn fill(&mut self, boxes: &[Aabb<D>], order: &[u64], axis: usize) {
        let len = boxes.len() + SENTINELS;
        if self.ids.len() != len {
            self.ids.resize(len, 0);
            for array in self.min.iter_mut().chain(&mut self.max) {
                array.resize(len, SENTINEL);
            }
        }
        let axes: [usize; D] = std::array::from_fn(|at| (axis + at) % D);
        let min = self.min.each_mut().map(|array| &mut array[..len]);
        let max = self.max.each_mut().map(|array| &mut array[..len]);
        for (at, &item) in order.iter().enumerate().take(boxes.len()) {
            let id = item as u32;
            let aabb = &boxes[id as usize];
            for (to, axis) in axes.into_iter().enumerate() {
                min[to][at] = key(aabb.min[axis]);
                // Only a coordinate that is not a number has the key of a sentinel.
                max[to][at] = key(aabb.max[axis]).min(SENTINEL - 1);
            }
            self.ids[at] = id;
        }
        for array in min.into_iter().chain(max) {
            array[boxes.len()..].fill(SENTINEL);
        }
    }
}
