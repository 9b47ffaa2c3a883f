//! Distances, and which queries make sense.
//!
//! Formulas are in `f64` and made of operations that round monotonically, so what contains a body is
//! never farther than the body.

use core::array;

use crate::float::greater;
use crate::{Aabb, Error, Scalar};

pub fn is_finite<T: Scalar>(value: T) -> bool {
    value > T::NEG_INFINITY && value < T::INFINITY
}

pub fn is_length<T: Scalar>(value: T) -> bool {
    value >= T::default()
}

/// The name of an argument of a query and its first value that is not valid.
pub type Fault = Option<(&'static str, f64)>;

pub fn fault_in<T: Scalar>(
    argument: &'static str,
    values: &[T],
    is_valid: impl Fn(T) -> bool,
) -> Fault {
    let value = values.iter().find(|&&value| !is_valid(value))?;
    Some((argument, value.to_f64()))
}

/// Refuses the first query with a fault.
pub fn check_each<Q>(queries: &[Q], fault: impl Fn(&Q) -> Fault) -> Result<(), Error> {
    for (index, query) in queries.iter().enumerate() {
        if let Some((argument, value)) = fault(query) {
            return Err(Error::InvalidQuery { index, argument, value: value.into() });
        }
    }
    Ok(())
}

/// From a point to a box on one axis.
#[inline]
fn gap<const D: usize, T: Scalar>(point: &[T; D], aabb: &Aabb<D, T>, axis: usize) -> f64 {
    let at = point[axis].to_f64();
    greater(at - aabb.max[axis].to_f64(), greater(aabb.min[axis].to_f64() - at, 0.0))
}

/// Whether a box is at most `radius` away. Scaled by a power of two where squares of an `f64`
/// would overflow or vanish.
pub fn is_within<const D: usize, T: Scalar>(
    center: &[T; D],
    radius: f64,
    aabb: &Aabb<D, T>,
) -> bool {
    const LARGE: f64 = 1e150;
    let scale = match radius {
        _ if radius > LARGE => f64::from_bits(0x1A70_0000_0000_0000), // 2^-600
        _ if radius < 1.0 / LARGE => f64::from_bits(0x6570_0000_0000_0000), // 2^600
        _ => 1.0,
    };
    let sum = (0..D).fold(0.0, |sum, axis| {
        let gap = gap(center, aabb, axis) * scale;
        sum + gap * gap
    });
    sum <= (radius * scale) * (radius * scale)
}

/// A box that overlaps every box that [`is_within`] the radius.
pub fn around<const D: usize, T: Scalar>(center: &[T; D], radius: f64) -> Aabb<D, T> {
    // More than all roundings, of distances too, can take off.
    let unit = if T::BYTES == 4 { f64::from(f32::EPSILON) } else { f64::EPSILON };
    let reach = center.map(|at| radius + 4.0 * unit * (at.to_f64().abs() + radius));
    Aabb {
        min: array::from_fn(|axis| T::from_f64(center[axis].to_f64() - reach[axis])),
        max: array::from_fn(|axis| T::from_f64(center[axis].to_f64() + reach[axis])),
    }
}

/// The square of the distance from a point to a box; 0 if the point is in it.
#[inline]
pub fn distance_squared<const D: usize, T: Scalar>(point: &[T; D], aabb: &Aabb<D, T>) -> f64 {
    (0..D).fold(0.0, |sum, axis| {
        let gap = gap(point, aabb, axis);
        sum + gap * gap
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Boxes whose near sides are the few coordinates around where the radius ends, for centers and radii of all magnitudes.
    fn check<T: Scalar>(magnitudes: &[i32], step: fn(T, bool) -> T) {
        let (mut within, mut apart) = (0, 0);
        for (at, &center_exponent) in magnitudes.iter().enumerate() {
            for &radius_exponent in magnitudes {
                let digits = 1.0 + (at as f64 * 0.618_033_988_749) % 1.0;
                let center = T::from_f64(digits * 2.0_f64.powi(center_exponent));
                let radius = T::from_f64((3.0 - digits) * 2.0_f64.powi(radius_exponent)).to_f64();
                let mut side = T::from_f64(center.to_f64() + radius);
                for _ in 0..6 {
                    side = step(side, false);
                }
                for _ in 0..12 {
                    side = step(side, true);
                    for (center, min, max) in [
                        (center, side, T::INFINITY),
                        (negative(center), T::NEG_INFINITY, negative(side)),
                    ] {
                        let aabb = Aabb::new([min], [max]);
                        let is_near = is_within(&[center], radius, &aabb);
                        let is_found = around(&[center], radius).overlaps(&aabb);
                        assert!(is_found || !is_near, "{center:?} {radius:e} {side:?}");
                        within += usize::from(is_near);
                        apart += usize::from(!is_near);
                    }
                }
            }
        }
        assert!(within > 1000 && apart > 1000, "{within} {apart}");
    }

    fn negative<T: Scalar>(at: T) -> T {
        T::default() - at
    }

    #[test]
    fn the_box_around_a_center_overlaps_what_is_within_the_radius() {
        check::<f32>(
            &[-149, -130, -126, -60, -24, -3, -1, 0, 1, 2, 23, 24, 60, 126],
            |at, is_up| if is_up { at.next_up() } else { at.next_down() },
        );
        check::<f64>(
            &[-1074, -1030, -1022, -600, -300, -53, -3, -1, 0, 1, 2, 52, 53, 300, 600, 1020],
            |at, is_up| if is_up { at.next_up() } else { at.next_down() },
        );
    }
}
