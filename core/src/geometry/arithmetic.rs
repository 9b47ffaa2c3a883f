//! The arithmetic on coordinates that placing and sorting boxes needs. It never decides overlap: that
//! takes comparisons of the coordinates as given.

use core::fmt::Debug;

/// Arithmetic on coordinates of type `T`. Its functions are not methods of `T`, so that users of
/// [`Scalar`](super::Scalar) do not see them.
pub trait Arithmetic<T> {
    /// A coordinate in the high bits and a position in the low ones: sorts by coordinate (`-0.0`
    /// equal to `0.0`), then by position.
    type Key: Copy + Ord + Default + Debug + Send + Sync;

    /// Grids reach from minus this to this; the outermost columns hold what lies beyond. Far enough
    /// from the greatest number for a few additions.
    const LIMIT: f64;

    /// A power of two: coordinates of at most this magnitude, multiplied by it, can be subtracted
    /// and have reciprocals without overflow. 1 for all but the very great and the very small.
    fn unit(magnitude: f64) -> T;

    /// See [`Key`](Self::Key).
    fn key(coordinate: T, position: u32) -> Self::Key;

    /// The position in a key.
    fn position(key: Self::Key) -> u32;

    /// `(coordinate * unit - origin) * scale`, rounded to a whole number and clamped to `0 ..= last`.
    /// Monotone: a greater coordinate never has a lesser cell. Takes infinities, overflow, and NaN
    /// (also from `0 * inf`), which counts as 0.
    fn cell(coordinate: T, quantizer: &Quantizer<T>) -> u32;
}

/// Cuts an axis into equal cells, numbered from 0. The outermost reach to infinity.
#[derive(Clone, Copy, Debug)]
pub struct Quantizer<T> {
    /// What coordinates are multiplied by first: see [`Arithmetic::unit`].
    pub unit: T,
    /// The middle of the first cell, in that unit.
    pub origin: T,
    /// Cells per unit.
    pub scale: T,
    /// The last cell, a whole number below 2^22.
    pub last: T,
}

/// The [`Arithmetic`] of `f32` and `f64`.
#[derive(Debug)]
pub struct Ieee754;

macro_rules! arithmetic {
    ($scalar:ident, $bits:ident, $signed:ident, $key:ident, $limit:literal, $tiny:literal, $up:literal) => {
        impl Arithmetic<$scalar> for Ieee754 {
            type Key = $key;
            const LIMIT: f64 = $limit;

            fn unit(magnitude: f64) -> $scalar {
                const UP: $scalar = (1u128 << $up) as $scalar;
                match magnitude {
                    ..$tiny => UP,
                    ..=$limit => 1.0,
                    _ => 1.0 / UP,
                }
            }

            #[inline(always)]
            fn key(coordinate: $scalar, position: u32) -> $key {
                let bits = (coordinate + 0.0).to_bits(); // -0.0 becomes 0.0
                // Negative numbers fall as their bits rise: flip all bits. Otherwise flip the sign.
                let negative = ((bits as $signed) >> ($bits::BITS - 1)) as $bits;
                let ordered = bits ^ (negative | 1 << ($bits::BITS - 1));
                $key::from(ordered) << 32 | $key::from(position)
            }

            #[inline(always)]
            fn position(key: $key) -> u32 {
                key as u32
            }

            #[inline(always)]
            fn cell(coordinate: $scalar, quantizer: &Quantizer<$scalar>) -> u32 {
                // Added to this number, a small one is rounded to a whole and stands in the low bits.
                const ANCHOR: $scalar = (1u64 << ($scalar::MANTISSA_DIGITS - 1)) as $scalar;
                let at = (coordinate * quantizer.unit - quantizer.origin) * quantizer.scale;
                // Not `clamp`: the first comparison also turns a NaN into 0.
                let at = if at > 0.0 { at } else { 0.0 };
                let at = if at < quantizer.last { at } else { quantizer.last };
                ((at + ANCHOR).to_bits() ^ ANCHOR.to_bits()) as u32
            }
        }
    };
}

arithmetic!(f32, u32, i32, u64, 1e37, 1e-20, 64);
arithmetic!(f64, u64, i64, u128, 1e300, 1e-280, 120);

#[cfg(test)]
mod tests;
