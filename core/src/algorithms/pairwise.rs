//! Global pairwise: every box against every other.
//!
//! ```text
//! for i in 0..n
//!     for j in i+1..n
//!         if overlaps(boxes[i], boxes[j]): pair (i, j)
//! ```
//!
//! Always n(n-1)/2 tests, in the best case and the worst, and no memory of its own. It is too slow
//! beyond a few hundred boxes and too simple to be wrong, which makes it the oracle that every
//! other path is compared with. Its pairs come sorted.
//!
//! Unlike the article's listing it tests closed intervals (touching boxes overlap), and hands the
//! pairs over instead of bouncing the boxes while it still goes through them.

use alloc::vec::Vec;

use super::observer::{Observer, Separation};
use crate::{Aabb, Error, Scalar, validate};

/// All overlapping pairs by global pairwise, sorted by (a, b): the oracle. O(n²) time.
///
/// # Errors
/// [`Error::InvalidBox`] or [`Error::TooManyBoxes`].
///
/// ```
/// use sweep_and_prune::{Aabb, algorithms::pairwise};
///
/// let boxes = [Aabb::new([0.0], [1.0]), Aabb::new([1.0], [2.0]), Aabb::new([3.0], [4.0])];
/// assert_eq!(pairwise(&boxes)?, [[0, 1]]);
/// # Ok::<(), sweep_and_prune::Error>(())
/// ```
pub fn pairwise<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>]) -> Result<Vec<[u32; 2]>, Error> {
    validate(boxes)?;
    let ids: Vec<u32> = (0..boxes.len() as u32).collect();
    let mut pairs = Vec::new();
    pairwise_observed(boxes, &ids, 0, &mut (), &mut pairs);
    Ok(pairs)
}

/// Global pairwise under observation over the boxes `ids` (ascending), appending to `pairs`.
/// `first_axis`, less than `D`, is the one that the box test tries first.
pub(super) fn pairwise_observed<const D: usize, T: Scalar, O: Observer>(
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
