//! Options: which boxes are reported, and how much larger than bodies fat AABBs are.

use crate::setters::setters;
use crate::{Aabb, Error, Scalar};

/// Which boxes the reported pairs are those of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Report {
    /// The boxes as they were given.
    #[default]
    Exact,
    /// The fat AABBs of [`Options::margin`] and [`Options::prediction`].
    Fat,
}

/// How a [`BroadPhase`](crate::BroadPhase) treats its boxes.
///
/// With [`Report::Exact`], the default, margin and prediction change no result and are not needed for
/// speed: the world chooses fat AABBs of its own by the motion it sees. With [`Report::Fat`] the pairs are
/// those of *fat AABBs*, and begin and end less often: a fat AABB stays where it is until the body's box
/// leaves it. Then it is replaced: by the box, grown by `margin` on every side, and on each axis by
/// `prediction` times the last displacement in its direction.
///
/// ```
/// use sweep_and_prune::{BroadPhase, Options, Report};
///
/// let options = Options::default().margin(0.1).prediction(2.0).report(Report::Fat);
/// let world = BroadPhase::<2>::with_options(options)?;
/// # Ok::<(), sweep_and_prune::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Options<T = f32> {
    /// How far a fat AABB reaches beyond the body on every side, in units of length. Finite, 0 or more.
    pub margin: T,
    /// How many displacements a fat AABB reaches ahead. Finite, 0 or more.
    pub prediction: T,
    /// Which pairs are reported.
    pub report: Report,
}

impl<T: Scalar> Options<T> {
    setters! { margin: T, prediction: T, report: Report }

    pub(crate) fn check(&self) -> Result<(), Error> {
        for (option, value) in [("margin", self.margin), ("prediction", self.prediction)] {
            if !(value >= T::default() && value < T::INFINITY) {
                return Err(Error::InvalidOption { option, value: value.to_f64().into() });
            }
        }
        Ok(())
    }

    /// The fat AABB of a body that moved by `displacement`. It contains the body whatever the rounding,
    /// since adding what is not negative never makes a number less.
    pub(crate) fn fatten<const D: usize>(
        &self,
        aabb: &Aabb<D, T>,
        displacement: [T; D],
    ) -> Aabb<D, T> {
        let mut fat = *aabb;
        let zero = T::default();
        for (axis, &step) in displacement.iter().enumerate() {
            let ahead = step * self.prediction;
            let (back, front) = if ahead < zero { (ahead, zero) } else { (zero, ahead) };
            fat.min[axis] = aabb.min[axis] - self.margin + back;
            fat.max[axis] = aabb.max[axis] + self.margin + front;
        }
        fat
    }
}

/// How far a box moved on each axis: 0 where that is not a finite number.
pub fn displacement<const D: usize, T: Scalar>(from: &Aabb<D, T>, to: &Aabb<D, T>) -> [T; D] {
    core::array::from_fn(|axis| {
        let way = to.min[axis] - from.min[axis];
        if way < T::INFINITY && way > T::NEG_INFINITY { way } else { T::default() }
    })
}
