//! Global pairwise: every box against every other.
//!
//! ```text
//! for i in 0..n
//!     for j in i+1..n
//!         if overlaps(boxes[i], boxes[j]): pair (i, j)
//! ```
//!
//! Always n(n-1)/2 tests, in the best case and the worst, and no memory of its own. It is too slow
//! beyond a few hundred boxes and too simple to be wrong. Its pairs come sorted.
//!
//! Unlike the article's listing it tests closed intervals (touching boxes overlap), and it collects the
//! pairs instead of bouncing boxes during the loop.

use alloc::vec::Vec;

use crate::observer::{Observer, Separation};
use sweep_and_prune::{Aabb, Scalar};

/// Appends all overlapping pairs of the boxes `ids` (ascending) to `pairs`, sorted by (a, b). O(n²) time.
/// `first_axis`, less than `D`, is the one that the box test tries first.
pub(crate) fn pairwise<const D: usize, T: Scalar, O: Observer>(
    boxes: &[Aabb<D, T>],
    ids: &[u32],
    first_axis: usize,
    observer: &mut O,
    pairs: &mut Vec<[u32; 2]>,
) {
    for (i, &a) in ids.iter().enumerate() {
        for &b in &ids[i + 1..] {
            let separation = Separation::find(boxes, a, b, first_axis);
            observer.test(a, b, separation);
            if separation.is_none_or(|found| found.axis != first_axis) {
                observer.axis_overlap(first_axis, a, b);
            }
            if separation.is_none() {
                observer.overlap(a, b);
                pairs.push([a, b]);
            }
        }
    }
}
