//! Functions of `f64` that `core` lacks, or that are calls in WebAssembly.

/// The greatest whole number up to a value.
pub fn floor(value: f64) -> f64 {
    const ALL_WHOLE: f64 = (1u64 << 52) as f64;
    if value.abs() >= ALL_WHOLE {
        return value;
    }
    let whole = value as i64 as f64;
    if whole > value { whole - 1.0 } else { whole }
}

/// The whole part of a value from 0 to 2^32 - 1.
pub fn whole(value: f64) -> f64 {
    value as u32 as f64
}

/// The lesser; the limit if the value is NaN.
pub fn lesser(value: f64, limit: f64) -> f64 {
    if value < limit { value } else { limit }
}

/// The greater; the limit if the value is NaN.
pub fn greater(value: f64, limit: f64) -> f64 {
    if value > limit { value } else { limit }
}

/// The greatest; at least 0.
pub fn greatest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most, value| greater(value, most))
}
