//! The endpoint array: two endpoints for each box, updated as the boxes change.
//!
//! The article leaves out how this works ("an implementation detail"). Each endpoint knows its box and
//! its side, so its coordinate can be refreshed in place, in any order of the array. The endpoints of
//! removed boxes are dropped, and those of added boxes are appended. So the array keeps the order of
//! the last sort, and only what moved is out of place: the input on which insertion sort is fast.

use alloc::vec::Vec;

use crate::endpoint::{Edge, Endpoint, Side};
use crate::observer::Observer;
use crate::sorts::Sort;
use sweep_and_prune::{Aabb, Scalar};

/// Endpoints on one axis, in the order of the last sort.
#[derive(Clone, Debug, Default)]
pub struct EndpointArray<T> {
    /// The endpoints. A sort may reorder them.
    pub endpoints: Vec<Endpoint<T>>,
}

impl<T: Scalar> EndpointArray<T> {
    /// Appends the endpoints of each box on these sides, without coordinates.
    pub fn append(&mut self, ids: &[u32], sides: &[Side]) {
        let edges = ids.iter().flat_map(|&id| sides.iter().map(move |&side| Edge { side, id }));
        self.endpoints.extend(edges.map(|edge| Endpoint { at: T::default(), edge }));
    }

    /// Drops the endpoints of these boxes, `ids` ascending. O(n log k), the rest stays in order.
    pub fn remove(&mut self, ids: &[u32]) {
        if !ids.is_empty() {
            self.endpoints.retain(|endpoint| ids.binary_search(&endpoint.edge.id).is_err());
        }
    }

    /// Refreshes every coordinate from the boxes, and sorts.
    pub fn sort<const D: usize, O: Observer>(
        &mut self,
        boxes: &[Aabb<D, T>],
        axis: usize,
        sort: Sort,
        observer: &mut O,
    ) {
        self.refresh(0, boxes, axis);
        observer.array(axis, &self.endpoints);
        sort.sort(&mut self.endpoints, observer);
    }

    /// Refreshes the coordinates of `endpoints[from..]` from the boxes.
    pub fn refresh<const D: usize>(&mut self, from: usize, boxes: &[Aabb<D, T>], axis: usize) {
        for endpoint in &mut self.endpoints[from..] {
            let aabb = &boxes[endpoint.edge.id as usize];
            endpoint.at = match endpoint.edge.side {
                Side::Left => aabb.min[axis],
                Side::Right => aabb.max[axis],
            };
        }
    }

    /// The memory it holds.
    pub fn bytes(&self) -> usize {
        self.endpoints.capacity() * size_of::<Endpoint<T>>()
    }
}
