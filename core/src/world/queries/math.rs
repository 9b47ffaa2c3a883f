//! Distances, and which queries make sense.
//!
//! Formulas are in `f64` and made of operations that round monotonically, so what contains a body is
//! never farther than the body.

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

/// The square of the distance from a point to a box; 0 if the point is in it.
#[inline]
pub fn distance_squared<const D: usize, T: Scalar>(point: &[T; D], aabb: &Aabb<D, T>) -> f64 {
    (0..D).fold(0.0, |sum, axis| {
        let gap = gap(point, aabb, axis);
        sum + gap * gap
    })
}
