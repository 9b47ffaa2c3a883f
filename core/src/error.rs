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
    /// There is not enough memory for the pairs, or for the work on them. The finder keeps none of
    /// the pairs and can be used again; it may be enough to count pairs or to stream them.
    OutOfMemory,
    /// An axis that the boxes do not have.
    InvalidAxis {
        /// The axis asked for.
        axis: usize,
        /// How many there are.
        dimensions: usize,
    },
    /// An id that names no body here: its body was removed, or it never had one. (An id of another
    /// world is refused only if no body here has the same slot and generation.)
    StaleProxy {
        /// The position of the id in the slice that was passed, 0 for a single one.
        index: usize,
    },
    /// Two slices that go together differ in length.
    LengthMismatch {
        /// How many ids.
        ids: usize,
        /// How many boxes.
        boxes: usize,
    },
    /// A margin or a prediction that is negative, infinite or NaN.
    InvalidMargin,
    /// A query with a centre, direction, length or radius that is NaN, infinite where it has to be
    /// finite, or negative where that means nothing.
    InvalidQuery {
        /// The position of the query in the slice that was passed, 0 for a single one.
        index: usize,
    },
    /// Bytes that are no snapshot of such a world.
    InvalidSnapshot(SnapshotFault),
}

/// What is wrong with the bytes of a snapshot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SnapshotFault {
    /// They do not begin as a snapshot does.
    Foreign,
    /// They were written by a version that this one cannot read.
    Version {
        /// The version that they name.
        found: u8,
    },
    /// They hold a world of other dimensions or of the other coordinate type.
    OtherWorld {
        /// Its dimensions.
        dimensions: usize,
        /// The size of its coordinates, 4 or 8.
        scalar_bytes: usize,
    },
    /// They end too early.
    Truncated,
    /// Their parts contradict each other or their checksum.
    Corrupt,
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
            Error::OutOfMemory => write!(f, "not enough memory for the pairs of these boxes"),
            Error::InvalidAxis { axis, dimensions } => {
                write!(f, "axis {axis} does not exist in {dimensions} dimensions")
            }
            Error::StaleProxy { index } => {
                write!(
                    f,
                    "proxy id {index} is stale: its body was removed, or it never had one here"
                )
            }
            Error::LengthMismatch { ids, boxes } => {
                write!(f, "{ids} ids do not go with {boxes} boxes")
            }
            Error::InvalidMargin => {
                write!(f, "a margin and a prediction must be finite and not negative")
            }
            Error::InvalidQuery { index } => {
                write!(f, "query {index} has a part that is NaN, infinite or negative")
            }
            Error::InvalidSnapshot(fault) => match fault {
                SnapshotFault::Foreign => write!(f, "these bytes are not a snapshot"),
                SnapshotFault::Version { found } => {
                    write!(f, "the snapshot is of version {found}, which cannot be read here")
                }
                SnapshotFault::OtherWorld { dimensions, scalar_bytes } => write!(
                    f,
                    "the snapshot holds a world of {dimensions} dimensions and {scalar_bytes}-byte \
                     coordinates"
                ),
                SnapshotFault::Truncated => write!(f, "the snapshot ends too early"),
                SnapshotFault::Corrupt => write!(f, "the snapshot is corrupt"),
            },
        }
    }
}

impl core::error::Error for Error {}
