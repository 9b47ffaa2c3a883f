//! Why a step is refused. After an error nothing has changed.

use core::fmt;

/// Why a call was rejected. Nothing has changed after an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// A box is invalid, or there are too many.
    Boxes(sweep_and_prune::Error),
    /// The boxes do not have this axis.
    InvalidAxis {
        /// The axis that was passed.
        axis: usize,
        /// How many axes the boxes have.
        dimensions: usize,
    },
}

impl From<sweep_and_prune::Error> for Error {
    fn from(error: sweep_and_prune::Error) -> Self {
        Self::Boxes(error)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Boxes(error) => error.fmt(f),
            Error::InvalidAxis { axis, dimensions } => write!(
                f,
                "axis {axis} does not exist: the boxes have {dimensions} dimensions, and the axis \
                 must be less"
            ),
        }
    }
}

impl core::error::Error for Error {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Error::Boxes(error) => Some(error),
            Error::InvalidAxis { .. } => None,
        }
    }
}
