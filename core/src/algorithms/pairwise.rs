//! Global pairwise: every box against every other.
//!
//! ```text
//! for i in 0..n
//!     for j in i+1..n
//!         if overlaps(boxes[i], boxes[j]): pair (i, j)
//! ```
//!
//! Always n(n-1)/2 tests and no memory of its own. It is too slow beyond a few hundred boxes and
//! too simple to be wrong, which makes it the oracle that every other path is compared with.
//! Its pairs come sorted.

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
    let mut pairs = Vec::new();
    pairwise_observed(boxes, 0, &mut (), &mut pairs);
    Ok(pairs)
}

/// Global pairwise under observation, appending to `pairs`. `first_axis`, less than `D`, is the
/// one that the box test tries first. The boxes must be valid.
pub fn pairwise_observed<const D: usize, T: Scalar, O: Observer>(
    boxes: &[Aabb<D, T>],
    first_axis: usize,
    observer: &mut O,
    pairs: &mut Vec<[u32; 2]>,
) {
    let n = boxes.len() as u32;
    for a in 0..n {
        for b in a + 1..n {
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
