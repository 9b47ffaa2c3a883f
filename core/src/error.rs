//! What can be wrong with an input. Errors are values; after one, nothing has changed.

use core::fmt;

/// Why a call was rejected. Nothing has changed after an error.
///
/// Each message names the argument, its value, the limit that the value broke, and what to do:
///
/// ```
/// use sweep_and_prune::{Aabb, find_pairs};
///
/// let boxes = [Aabb::new([0.0, 0.0], [1.0, 1.0]), Aabb::new([3.5, 0.0], [2.0, 1.0])];
/// let error = find_pairs(&boxes).unwrap_err();
/// assert_eq!(
///     error.to_string(),
///     "box 1 is invalid on axis 0: min is 3.5 and max is 2, but min <= max must hold and neither \
///      may be NaN"
/// );
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// A box is inverted or NaN on an axis: `min <= max` does not hold.
    InvalidBox {
        /// The set of the box: 0, or 1 for the second of two sets.
        set: usize,
        /// The index of the first invalid box in its set, 0 for a single box.
        index: usize,
        /// The first axis on which it is invalid.
        axis: usize,
        /// Its min on that axis.
        min: Value,
        /// Its max on that axis.
        max: Value,
    },
    /// An id that names no body here: its body was removed, or it never had one. (An id of another
    /// world is refused only if no body here has the same slot and generation.)
    StaleProxy {
        /// The index of the id in the slice that was passed, 0 for a single id.
        index: usize,
        /// The id, as [`ProxyId::to_bits`](crate::ProxyId::to_bits) gives it.
        id: u64,
    },
    /// Not one box for each id.
    LengthMismatch {
        /// How many ids were passed.
        ids: usize,
        /// How many boxes were passed.
        boxes: usize,
    },
    /// An option of a world is negative, infinite or NaN.
    InvalidOption {
        /// The name of the option.
        option: &'static str,
        /// Its value.
        value: Value,
    },
    /// The offset of a shift is not finite.
    InvalidOffset {
        /// The first axis on which it is not.
        axis: usize,
        /// Its coordinate there.
        value: Value,
    },
    /// An argument of a query is NaN, or infinite or negative where it must not be.
    InvalidQuery {
        /// The index of the first invalid query in the slice that was passed, 0 for a single query.
        index: usize,
        /// The name of the argument: `point`, `center`, `radius`, `from`, `direction`, `limit` or `max_distance`.
        argument: &'static str,
        /// Its value, or the coordinate of it that is at fault.
        value: Value,
    },
    /// The bytes are not a snapshot that this world can read.
    InvalidSnapshot(SnapshotFault),
    /// More boxes than a `u32` can index.
    TooManyBoxes {
        /// How many boxes were passed.
        count: usize,
    },
    /// The pairs, the memory for finding them, or the answer to queries do not fit. A finder keeps none of the pairs, a world is
    /// as before, and both can be used again. Counting or streaming pairs, or fewer queries at a time, need less memory.
    OutOfMemory,
    /// The progress callback ended the search: see [`Search::progress`](crate::Search::progress).
    Cancelled,
}

/// A number that an error reports: a coordinate, a length or an option, as `f64`.
///
/// Unlike numbers, two NaN values are equal, so that errors can be compared.
#[derive(Clone, Copy)]
pub struct Value(f64);

impl Value {
    /// The number.
    pub const fn get(self) -> f64 {
        self.0
    }
}

impl From<f64> for Value {
    fn from(value: f64) -> Self {
        Self(value)
    }
}

impl PartialEq for Value {
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0 || (self.0.is_nan() && other.0.is_nan())
    }
}

impl Eq for Value {}

impl fmt::Debug for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The shortest form of the `f32` that it was: 0.1, not 0.10000000149011612.
        let single = self.0 as f32;
        if f64::from(single) == self.0 { write!(f, "{single}") } else { write!(f, "{}", self.0) }
    }
}

/// What is wrong with the bytes of a snapshot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SnapshotFault {
    /// They do not begin as a snapshot does.
    Foreign,
    /// They were written by a version that this one cannot read.
    Version {
        /// The version that wrote them.
        found: u8,
    },
    /// They hold a world of other dimensions or of the other coordinate type.
    OtherWorld {
        /// Its dimensions.
        dimensions: usize,
        /// The size of its coordinates in bytes: 4 for `f32`, 8 for `f64`.
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

/// The arguments of queries that may be infinite.
const LENGTHS: [&str; 3] = ["radius", "max_distance", "limit"];

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::InvalidBox { set, index, axis, min, max } => write!(
                f,
                "box {index}{} is invalid on axis {axis}: min is {min} and max is {max}, but \
                 min <= max must hold and neither may be NaN",
                if *set == 0 { "" } else { " of the second set" },
            ),
            Error::TooManyBoxes { count } => {
                let limit = Error::BOX_LIMIT;
                write!(f, "{count} boxes are too many: one set can hold {limit}, so split it")
            }
            Error::OutOfMemory => f.write_str(
                "out of memory: the pairs, or the answer to these queries, do not fit; count or stream the \
                 pairs, or pass fewer boxes",
            ),
            Error::Cancelled => f.write_str("cancelled: the progress callback ended the search"),
            Error::StaleProxy { index, id } => write!(
                f,
                "the id at index {index} ({id}) is stale: its body was removed, or it never had one \
                 in this world; use the ids of bodies that are in it"
            ),
            Error::LengthMismatch { ids, boxes } => {
                write!(f, "there are {ids} ids but {boxes} boxes: pass one box for each id")
            }
            Error::InvalidOption { option, value } => {
                write!(f, "the option `{option}` is {value}, but it must be finite and 0 or more")
            }
            Error::InvalidOffset { axis, value } => {
                write!(f, "the offset on axis {axis} is {value}, but it must be finite")
            }
            Error::InvalidQuery { index, argument, value } => {
                let limit = match value.get() {
                    number if number.is_nan() => "may not be NaN",
                    number if number.is_infinite() && !LENGTHS.contains(argument) => {
                        "must be finite"
                    }
                    _ if *argument == "from" => "must be a box with min <= max",
                    _ => "must be 0 or more",
                };
                write!(f, "`{argument}` of query {index} is {value}, but it {limit}")
            }
            Error::InvalidSnapshot(fault) => fault.fmt(f),
        }
    }
}

impl fmt::Display for SnapshotFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SnapshotFault::Foreign => f.write_str("these bytes are not a snapshot"),
            SnapshotFault::Version { found } => write!(
                f,
                "the snapshot is of version {found}, which this version of the library cannot read: \
                 use the version that wrote it"
            ),
            SnapshotFault::OtherWorld { dimensions, scalar_bytes } => {
                let bits = 8 * scalar_bytes;
                write!(
                    f,
                    "the snapshot holds a world of {dimensions} dimensions and f{bits} coordinates: \
                     read it as `BroadPhase<{dimensions}, f{bits}>`"
                )
            }
            SnapshotFault::Truncated => {
                f.write_str("the snapshot ends too early: some of its bytes are missing")
            }
            SnapshotFault::Corrupt => f.write_str(
                "the snapshot is corrupt: its parts or its checksum contradict each other",
            ),
        }
    }
}

impl core::error::Error for Error {}
