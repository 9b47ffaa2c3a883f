//! Sorted pairwise: the simplified sweep and prune, ten lines in Matthias Müller's *Ten Minute Physics*.
//!
//! ```text
//! sort by left edge
//! for i in 0..n
//!     for j in i+1..n
//!         if boxes[j].left > boxes[i].right: break      everything further right is apart too
//!         if overlaps(boxes[i], boxes[j]): pair (i, j)
//! ```
//!
//! Time: the sort, plus O(n + m) where m is the number of overlaps *on the sweep axis* (not of
//! pairs: a tall stack swept from the side has m near n²/2 and hardly a pair). Memory: O(n) for
//! the order. There is no set of active boxes: the scan forward from each box replaces it.
//!
//! Unlike the article's listing it sorts an array of its own, not the caller's; the order is
//! total, so ties stay where they are; the break and the box test share one closed rule; and the
//! order is kept from call to call, so that insertion sort finds it nearly sorted. A NaN would break
//! the sort and the early exit; the [`Runner`](crate::Runner) refuses it before this code runs.

use alloc::vec::Vec;

use crate::endpoint_array::EndpointArray;
use crate::observer::{Observer, Separation, test_beside};
use sweep_and_prune::{Aabb, Scalar};

/// Appends all overlapping pairs of the boxes in `lefts`, which holds their left endpoints, sorted, in
/// the order in which the sweep along `axis` finds them.
pub(crate) fn sorted_pairwise<const D: usize, T: Scalar, O: Observer>(
    boxes: &[Aabb<D, T>],
    lefts: &EndpointArray<T>,
    axis: usize,
    observer: &mut O,
    pairs: &mut Vec<[u32; 2]>,
) {
    for (i, left) in lefts.endpoints.iter().enumerate() {
        let a = left.edge.id;
        let right = boxes[a as usize].max[axis];
        observer.visit(i, left.edge);
        observer.enter(a);
        for next in &lefts.endpoints[i + 1..] {
            let b = next.edge.id;
            if next.at > right {
                observer.prune(Separation { axis, left: a, right: b });
                break;
            }
            test_beside(boxes, [a, b], axis, observer, pairs);
        }
        observer.leave(a);
    }
}
