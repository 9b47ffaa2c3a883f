//! Options: which boxes are reported, and how much larger than bodies fat AABBs are.

use crate::setters::setters;
use crate::{Aabb, Error, Scalar};

/// Which boxes the reported pairs are those of.
///
/// The pairs of *fat AABBs* begin and end less often than those of the boxes themselves. Which fat AABB a body has
/// depends on its boxes at updates alone, not on what it was in between. At an update it keeps the one that it has,
/// if its box is within, and if that is on no axis more than twice as wide as a new one. Otherwise it gets a new one:
/// its box, grown by `margin` on every side, and on each axis by `prediction` times the displacement since
/// the last update in its direction, but by no more than 4 times the longest side of the box and the margin
/// together. A body that moved further than that has jumped: where it goes next is unknown, and its fat AABB
/// reaches ahead on no axis.
///
/// ```
/// use sweep_and_prune::{Aabb, BroadPhase, Options, Report};
///
/// let report = Report::Fat { margin: 0.1, prediction: 2.0 };
/// let mut world = BroadPhase::<1>::with_options(Options::default().report(report))?;
/// let id = world.insert(Aabb::new([0.0], [1.0]))?;
/// world.update();
/// assert_eq!(world.reported_aabb(id)?, Aabb::new([-0.1], [1.1]));
/// world.set(id, Aabb::new([0.5], [1.5]))?;
/// assert_eq!(world.reported_aabb(id)?, Aabb::new([0.4], [2.6]));
/// # Ok::<(), sweep_and_prune::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Report<T = f32> {
    /// The boxes as they were given.
    #[default]
    Exact,
    /// Fat AABBs.
    Fat {
        /// How far a fat AABB reaches beyond the body on every side, in units of length. Finite, 0 or more.
        margin: T,
        /// How many displacements it reaches ahead. Finite, 0 or more.
        prediction: T,
    },
}

/// How a [`BroadPhase`](crate::BroadPhase) treats its boxes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Options<T = f32> {
    /// Which pairs are reported.
    pub report: Report<T>,
}

/// How far a fat AABB reaches ahead at most, as a multiple of the longest side of the body and the margin together. What
/// moves further in one update is not within its fat AABB at the next one anyway.
const FARTHEST: f64 = 4.0;

impl<T: Scalar> Options<T> {
    setters! { report: Report<T> }

    pub(crate) fn check(&self) -> Result<(), Error> {
        if let Report::Fat { margin, prediction } = self.report {
            for (option, value) in [("margin", margin), ("prediction", prediction)] {
                if !(value >= T::default() && value < T::INFINITY) {
                    return Err(Error::InvalidOption { option, value: value.to_f64().into() });
                }
            }
        }
        Ok(())
    }
}

impl<T: Scalar> Report<T> {
    /// Whether fat AABBs are reported.
    pub(crate) fn is_fat(&self) -> bool {
        matches!(self, Self::Fat { .. })
    }

    /// The box that is reported of a body that was at `from` at the last update and is at `to`, given the one that it
    /// had, if it had one.
    pub(crate) fn boxed<const D: usize>(
        &self,
        had: Option<Aabb<D, T>>,
        from: &Aabb<D, T>,
        to: &Aabb<D, T>,
    ) -> Aabb<D, T> {
        let Self::Fat { margin, prediction } = *self else { return *to };
        let new = fatten(margin, prediction, from, to);
        had.filter(|had| had.contains(to) && !is_far_wider(had, &new)).unwrap_or(new)
    }
}

/// A new fat AABB. It contains the body whatever the rounding, since adding what is not negative never makes a number
/// less.
fn fatten<const D: usize, T: Scalar>(
    margin: T,
    prediction: T,
    from: &Aabb<D, T>,
    to: &Aabb<D, T>,
) -> Aabb<D, T> {
    let zero = T::default();
    let mut longest = zero;
    for axis in 0..D {
        // NaN where both corners are at the same infinity.
        let side = to.max[axis] - to.min[axis];
        if side > longest {
            longest = side;
        }
    }
    let limit = (longest + margin) * T::from_f64(FARTHEST);
    let limited = |way: T| -> T {
        if way > limit {
            limit
        } else if way < zero - limit {
            zero - limit
        } else {
            way
        }
    };
    let displacement = displacement(from, to);
    let jumps = displacement.iter().any(|&way| way != limited(way));
    let mut fat = *to;
    for (axis, &way) in displacement.iter().enumerate() {
        let ahead = if jumps { zero } else { limited(way * prediction) };
        let (back, front) = if ahead < zero { (ahead, zero) } else { (zero, ahead) };
        fat.min[axis] = to.min[axis] - margin + back;
        fat.max[axis] = to.max[axis] + margin + front;
    }
    fat
}

/// Whether a box is on any axis more than twice as wide as another.
fn is_far_wider<const D: usize, T: Scalar>(a: &Aabb<D, T>, b: &Aabb<D, T>) -> bool {
    (0..D).any(|axis| {
        let width = b.max[axis] - b.min[axis];
        a.max[axis] - a.min[axis] > width + width
    })
}

/// How far a box moved on each axis: 0 where that is not a finite number.
fn displacement<const D: usize, T: Scalar>(from: &Aabb<D, T>, to: &Aabb<D, T>) -> [T; D] {
    core::array::from_fn(|axis| {
        let way = to.min[axis] - from.min[axis];
        if way < T::INFINITY && way > T::NEG_INFINITY { way } else { T::default() }
    })
}
