//! The arithmetic on coordinates that placing and sorting boxes needs. Overlap is never decided
//! by it: that takes comparisons of the coordinates as given, and nothing else.

use core::fmt::Debug;

use super::kernel::Coordinate;

/// Arithmetic of `f32` and `f64`.
pub trait Number: Coordinate {
    /// A coordinate and, beneath it, a place: sorts by coordinate (`-0.0` equal to `0.0`), then
    /// by place.
    type Key: Copy + Ord + Default + Debug + Send + Sync;

    /// Plans reach from minus this to this; what lies beyond is in the outermost columns. Far
    /// enough from the greatest number for a few additions.
    const LIMIT: f64;

    /// A power of two: coordinates of at most this magnitude, multiplied by it, can be subtracted
    /// and have reciprocals without overflow. 1 for all but the very great and the very small.
    fn unit(magnitude: f64) -> Self;

    /// See [`Key`](Self::Key).
    fn key(self, place: u32) -> Self::Key;

    /// The place in a key.
    fn place(key: Self::Key) -> u32;

    /// `(self * unit - origin) * scale`, rounded to a whole number and held in `0 ..= last`. What
    /// rounds how does not matter, but it is monotone: a greater coordinate never has a lesser cell.
    /// It takes infinities, overflow, and a NaN (as of `0 * inf`), which counts as 0.
    fn cell(self, ruler: &Ruler<Self>) -> u32;

    /// Adds `step` times the first cell of each interval to a bin, and tells how many more cells it
    /// touches. False if an interval is inverted or NaN; it touches no more.
    fn spans(
        [low, high]: [&[Self; BLOCK]; 2],
        ruler: &Ruler<Self>,
        step: u32,
        bin: &mut [u32; BLOCK],
        more: &mut [u32; BLOCK],
    ) -> bool {
        let mut valid = true;
        for i in 0..BLOCK {
            valid &= low[i] <= high[i];
            let first = low[i].cell(ruler);
            bin[i] += first * step;
            more[i] = high[i].cell(ruler).saturating_sub(first);
        }
        valid
    }
}

/// Equal cells on an axis, numbered from 0; the outermost reach to infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ruler<T> {
    /// What coordinates are multiplied by first: see [`Number::unit`].
    pub unit: T,
    /// The middle of the first cell, in that unit.
    pub origin: T,
    /// Cells a unit.
    pub scale: T,
    /// The last cell, a whole number below 2^22.
    pub last: T,
}

/// Intervals that are placed at a time.
pub const BLOCK: usize = 64;

macro_rules! number {
    ($scalar:ident, $bits:ident, $signed:ident, $key:ident, $limit:literal, $tiny:literal, $up:literal $(, $spans:ident)?) => {
        impl Number for $scalar {
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
            fn key(self, place: u32) -> $key {
                let bits = (self + 0.0).to_bits(); // -0.0 becomes 0.0
                // Negative numbers fall as their bits rise: turn all of them; of the others, the sign.
                let negative = ((bits as $signed) >> ($bits::BITS - 1)) as $bits;
                let ordered = bits ^ (negative | 1 << ($bits::BITS - 1));
                $key::from(ordered) << 32 | $key::from(place)
            }

            #[inline(always)]
            fn place(key: $key) -> u32 {
                key as u32
            }

            #[inline(always)]
            fn cell(self, ruler: &Ruler<Self>) -> u32 {
                // Added to this number, a small one is rounded to a whole and stands in the low bits.
                const ANCHOR: $scalar = (1u64 << ($scalar::MANTISSA_DIGITS - 1)) as $scalar;
                let place = (self * ruler.unit - ruler.origin) * ruler.scale;
                // Not `clamp`: the first comparison also turns a NaN into 0.
                let place = if place > 0.0 { place } else { 0.0 };
                let place = if place < ruler.last { place } else { ruler.last };
                ((place + ANCHOR).to_bits() ^ ANCHOR.to_bits()) as u32
            }

            $(
                #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
                fn spans(
                    intervals: [&[Self; BLOCK]; 2],
                    ruler: &Ruler<Self>,
                    step: u32,
                    bin: &mut [u32; BLOCK],
                    more: &mut [u32; BLOCK],
                ) -> bool {
                    super::kernel::$spans(intervals, ruler, step, bin, more)
                }
            )?
        }
    };
}

number!(f32, u32, i32, u64, 1e37, 1e-20, 64, spans_by_four);
number!(f64, u64, i64, u128, 1e300, 1e-280, 120);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_order_as_coordinates_do() {
        let ascending =
            [f32::NEG_INFINITY, -1e30, -1.0, -1e-40, 0.0, 1e-40, 1.0, 1e30, f32::INFINITY];
        for pair in ascending.windows(2) {
            assert!(pair[0].key(9) < pair[1].key(0));
            assert!(f64::from(pair[0]).key(9) < f64::from(pair[1]).key(0));
        }
        assert_eq!((-0.0f32).key(3), 0.0f32.key(3));
        assert_eq!(f64::place((-7.0f64).key(u32::MAX)), u32::MAX);
    }

    #[test]
    fn cells_are_monotone_whatever_the_coordinates() {
        let ascending = [
            f64::NEG_INFINITY,
            f64::MIN,
            -1e30,
            -1.0,
            -1e-320,
            0.0,
            0.3,
            1.0,
            1e30,
            f64::MAX,
            f64::INFINITY,
        ];
        for origin in [-1e300, -1.0, 0.0, 1e-320, 1e300] {
            for scale in [0.0, 1e-300, 1.0, 1e300, f64::INFINITY] {
                let ruler = Ruler { unit: 1.0, origin, scale, last: 100.0 };
                let cells = ascending.map(|x| x.cell(&ruler));
                assert!(cells.is_sorted() && cells[10] <= 100, "{origin} {scale} {cells:?}");
            }
        }
        let ruler = Ruler { unit: 1.0, origin: 0.0, scale: 1.0, last: 7.0 };
        assert_eq!([0.4f32, 0.6, 4.6, 9.0].map(|x| x.cell(&ruler)), [0, 1, 5, 7]);
    }
}
