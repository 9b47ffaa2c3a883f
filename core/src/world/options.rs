//! Margins: how much larger than its body a box is, and which box is reported.

use crate::{Aabb, Error, Scalar};

/// Which boxes the reported pairs are those of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Report {
    /// The boxes as they were given.
    #[default]
    Exact,
    /// The fat boxes of [`Options::margin`] and [`Options::prediction`].
    Fat,
}

/// How a [`BroadPhase`](super::BroadPhase) treats its boxes.
///
/// The world fattens boxes for itself, by what it sees of their motion, and never lets it show:
/// with [`Report::Exact`], the default, margin and prediction are not needed for speed and change
/// no result. With [`Report::Fat`] the pairs are those of the *fat boxes*, and begin and end less
/// often: a fat box stays where it is until the body's own box leaves it. Then it is made anew:
/// the box, grown by `margin` on every side, and on each axis by `prediction` times the last
/// displacement in its direction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options<T = f32> {
    /// What a fat box has around the body's own, in units of length. Finite, not negative.
    pub margin: T,
    /// How many displacements a fat box reaches ahead. Finite, not negative.
    pub prediction: T,
    /// Which pairs are reported.
    pub report: Report,
}

impl<T: Scalar> Options<T> {
    pub(super) fn check(&self) -> Result<(), Error> {
        for (option, value) in [("margin", self.margin), ("prediction", self.prediction)] {
            if !(value >= T::default() && value < T::INFINITY) {
                return Err(Error::InvalidOption { option, value: value.to_f64().into() });
            }
        }
        Ok(())
    }

    /// The fat box of a body that came here by `displacement`.
    pub(super) fn fatten<const D: usize>(
        &self,
        aabb: &Aabb<D, T>,
        displacement: [T; D],
    ) -> Aabb<D, T> {
        fatten(aabb, displacement, self.prediction, [self.margin; D])
    }
}

/// A box grown by a margin on each axis, and `steps` displacements ahead. It contains the box
/// whatever the rounding, since adding what is not negative never makes a number less.
pub(super) fn fatten<const D: usize, T: Scalar>(
    aabb: &Aabb<D, T>,
    displacement: [T; D],
    steps: T,
    margin: [T; D],
) -> Aabb<D, T> {
    let mut fat = *aabb;
    let zero = T::default();
    for axis in 0..D {
        let ahead = displacement[axis] * steps;
        let (back, front) = if ahead < zero { (ahead, zero) } else { (zero, ahead) };
        fat.min[axis] = aabb.min[axis] - margin[axis] + back;
        fat.max[axis] = aabb.max[axis] + margin[axis] + front;
    }
    fat
}

/// How far a box moved on each axis: 0 where that is not a finite number.
pub(super) fn displacement<const D: usize, T: Scalar>(
    from: &Aabb<D, T>,
    to: &Aabb<D, T>,
) -> [T; D] {
    core::array::from_fn(|axis| {
        let way = to.min[axis] - from.min[axis];
        if way < T::INFINITY && way > T::NEG_INFINITY { way } else { T::default() }
    })
}

/// Whether a box holds another.
#[inline]
pub(super) fn contains<const D: usize, T: Scalar>(outer: &Aabb<D, T>, inner: &Aabb<D, T>) -> bool {
    outer.contains(inner)
}

/// The smallest box that holds two.
#[inline]
pub(super) fn hull<const D: usize, T: Scalar>(a: &Aabb<D, T>, b: &Aabb<D, T>) -> Aabb<D, T> {
    a.union(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fat_box_reaches_ahead_and_holds_its_body_at_the_edge_of_the_range() {
        let options = Options { margin: 1.0f32, prediction: 2.0, report: Report::Fat };
        let body = Aabb::new([0.0, 0.0], [1.0, 1.0]);
        let fat = options.fatten(&body, [3.0, -3.0]);
        assert_eq!(fat, Aabb::new([-1.0, -7.0], [8.0, 2.0]));

        let inf = f32::INFINITY;
        let far = Aabb::new([f32::MIN, inf], [f32::MAX, inf]);
        let from = Aabb::new([f32::MAX, -inf], [f32::MAX, inf]);
        let fat = options.fatten(&far, displacement(&from, &far));
        assert!(fat.is_valid() && contains(&fat, &far));
    }
}
