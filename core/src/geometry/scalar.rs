//! The two coordinate types, `f32` and `f64`.

use core::cmp::Ordering;
use core::fmt::Debug;
use core::ops::{Add, Mul, Sub};

use super::arithmetic::{Arithmetic, Ieee754};

mod sealed {
    use super::{Arithmetic, Ieee754};

    /// Keeps others from implementing [`Scalar`](super::Scalar).
    pub trait Sealed: Sized {
        /// What the crate computes with coordinates, beside what users may.
        type Arithmetic: Arithmetic<Self>;
    }

    impl Sealed for f32 {
        type Arithmetic = Ieee754;
    }

    impl Sealed for f64 {
        type Arithmetic = Ieee754;
    }
}

/// The sort key of a coordinate: see [`Arithmetic::Key`].
pub(crate) type Key<T> = <<T as sealed::Sealed>::Arithmetic as Arithmetic<T>>::Key;

/// A coordinate: `f32` or `f64`, and nothing else (the trait is sealed).
///
/// Coordinates are compared exactly as given: no rounding, no epsilon. Public functions refuse NaN,
/// so inside the crate `<` and `<=` order coordinates totally, with `-0.0` equal to `0.0`.
///
/// What the crate itself computes with coordinates is not part of the trait:
///
/// ```compile_fail,E0599
/// fn key<T: sweep_and_prune::Scalar>(coordinate: T) {
///     coordinate.key(0);
/// }
/// ```
pub trait Scalar:
    sealed::Sealed
    + Copy
    + Debug
    + Default
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Send
    + Sync
    + 'static
{
    /// The size in memory, 4 or 8.
    const BYTES: usize;
    /// Positive infinity.
    const INFINITY: Self;
    /// Negative infinity.
    const NEG_INFINITY: Self;

    /// The coordinate as `f64`, which holds every `f32` exactly.
    fn to_f64(self) -> f64;

    /// The coordinate nearest to an `f64`, ties to even. Values beyond the range of `f32` become
    /// infinite.
    fn from_f64(value: f64) -> Self;

    /// The IEEE 754 bits, in the low [`BYTES`](Self::BYTES) bytes.
    fn to_raw(self) -> u64;

    /// The coordinate with these bits. Bits beyond the low [`BYTES`](Self::BYTES) bytes are ignored.
    fn from_raw(bits: u64) -> Self;

    /// Compares two coordinates that are not NaN. A NaN compares as equal to everything.
    #[inline]
    fn order(self, other: Self) -> Ordering {
        if self < other {
            Ordering::Less
        } else if other < self {
            Ordering::Greater
        } else {
            Ordering::Equal
        }
    }
}

macro_rules! scalar {
    ($scalar:ident, $bits:ident) => {
        impl Scalar for $scalar {
            const BYTES: usize = size_of::<$scalar>();
            const INFINITY: Self = $scalar::INFINITY;
            const NEG_INFINITY: Self = $scalar::NEG_INFINITY;

            #[inline]
            fn to_f64(self) -> f64 {
                self.into()
            }

            #[inline]
            fn from_f64(value: f64) -> Self {
                value as $scalar
            }

            #[inline]
            fn to_raw(self) -> u64 {
                self.to_bits().into()
            }

            #[inline]
            fn from_raw(bits: u64) -> Self {
                $scalar::from_bits(bits as $bits)
            }
        }
    };
}

scalar!(f32, u32);
scalar!(f64, u64);
