//! The oracle: every box against every other. Too simple to be wrong.

use sweep_and_prune::{Aabb, Error, Scalar, validate};

/// All overlapping pairs, sorted by (a, b), by n(n - 1)/2 tests. Every other way to find pairs is compared with it.
///
/// # Errors
/// [`Error::InvalidBox`] or [`Error::TooManyBoxes`].
///
/// ```
/// use sweep_and_prune::Aabb;
/// use sweep_and_prune_scenes::brute_force;
///
/// let boxes = [Aabb::new([0.0], [1.0]), Aabb::new([1.0], [2.0]), Aabb::new([3.0], [4.0])];
/// assert_eq!(brute_force(&boxes)?, [[0, 1]]);
/// # Ok::<(), sweep_and_prune::Error>(())
/// ```
pub fn brute_force<const D: usize, T: Scalar>(
    boxes: &[Aabb<D, T>],
) -> Result<Vec<[u32; 2]>, Error> {
    validate(boxes)?;
    let mut pairs = Vec::new();
    for (a, first) in boxes.iter().enumerate() {
        for (b, second) in boxes.iter().enumerate().skip(a + 1) {
            if first.overlaps(second) {
                pairs.push([a as u32, b as u32]);
            }
        }
    }
    Ok(pairs)
}
