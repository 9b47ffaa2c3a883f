//! The one-to-n scan: which boxes overlap this one? Flawed, and kept to show how.
//!
//! ```text
//! sort the endpoints
//! for each endpoint between the left and the right endpoint of the focus
//!     its box overlaps the focus on the axis
//! ```
//!
//! Time: the sort, plus O(n) to find the focus, plus the endpoints in between. Memory: O(n).
//!
//! The flaw: a box that encloses the focus on the axis has no endpoint in between, and is missed.
//! The article says that the scan is flawed and hides it by focusing the largest ball. Scanning
//! from *every* box would fix it, because one of two overlapping intervals has an endpoint within the
//! other; but then most overlaps are found twice. The sweep is the better fix: see
//! `endpoint_sweep.rs`.
//!
//! Unlike the article's demo, the endpoints at the focus's own coordinates are in between or not
//! by the total order, left before right, so boxes that only touch the focus are found.

use alloc::vec::Vec;

use crate::endpoint::{Edge, Endpoint, Side};
use crate::endpoint_array::EndpointArray;
use crate::observer::{Observer, test_beside};
use sweep_and_prune::{Aabb, Scalar};

/// Appends the pairs of box `focus` that the scan of `array`, which is sorted, finds. Without such a box
/// in it there are none.
pub(crate) fn one_to_n<const D: usize, T: Scalar, O: Observer>(
    boxes: &[Aabb<D, T>],
    array: &EndpointArray<T>,
    focus: u32,
    axis: usize,
    observer: &mut O,
    pairs: &mut Vec<[u32; 2]>,
) {
    let begin = Edge { side: Side::Left, id: focus };
    let Some(first) = array.endpoints.iter().position(|endpoint| endpoint.edge == begin) else {
        return;
    };
    let left = array.endpoints[first];
    observer.visit(first, begin);
    observer.enter(focus);
    for (position, endpoint) in array.endpoints.iter().enumerate().skip(first + 1) {
        let Edge { side, id } = endpoint.edge;
        observer.visit(position, endpoint.edge);
        if id == focus {
            break;
        }
        // A box with both endpoints in between is met at its left one.
        let began_before = || Endpoint::left(boxes[id as usize].min[axis], id).precedes(&left);
        if side == Side::Left || began_before() {
            test_beside(boxes, [focus, id], axis, observer, pairs);
        }
    }
    observer.leave(focus);
}
