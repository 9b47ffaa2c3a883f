//! What can be wrong with an input. Errors are values; after one, nothing has changed.

use core::fmt;

/// Why an input was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// A box is not `min <= max` on this axis: it is inverted, or holds a NaN.
    InvalidBox {
        /// The position of the box in the slice that was passed.
        index: usize,
        /// The first axis on which it is invalid.
        axis: usize,
    },
    /// More boxes than a `u32` can index.
    TooManyBoxes {
        /// How many were passed.
        count: usize,
    },
    /// An axis that the boxes do not have.
    InvalidAxis {
        /// The axis asked for.
        axis: usize,
        /// How many there are.
        dimensions: usize,
    },
}

impl Error {
    /// The greatest number of boxes in one set, 2^32 - 1: pairs hold `u32` indices.
    pub const BOX_LIMIT: usize = u32::MAX as usize;
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::InvalidBox { index, axis } => {
                write!(f, "box {index} is inverted or NaN on axis {axis}: min <= max must hold")
            }
            Error::TooManyBoxes { count } => {
                write!(f, "{count} boxes are more than the limit of {}", Error::BOX_LIMIT)
            }
            Error::InvalidAxis { axis, dimensions } => {
                write!(f, "axis {axis} does not exist in {dimensions} dimensions")
            }
        }
    }
}

impl core::error::Error for Error {}
