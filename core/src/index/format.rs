//! The format of an index: what each byte means. The number of boxes alone gives the place of all else.
//!
//! ```text
//! header     "SaPi"  version u8  dimensions u8  scalar bytes u8  0 u8  count of boxes u64  48 zero bytes
//! leaves     each: for each axis 16 min, 16 max; then 16 indices of boxes, u32
//! nodes      of level 1, then of level 2, ..: each for each axis 16 min, 16 max
//! ```
//! All numbers are little-endian. Leaf k has the boxes 16 k to 16 k + 15 in the order of the leaves; node k
//! of a level has the bounds of the nodes 16 k to 16 k + 15 of the level below. The last level has one node.
//! Coordinates of lanes without a box are the NaN with these bits: 0x7fc00000, or 0x7ff8000000000000. Their
//! indices are 0. The header and all nodes are multiples of 64 bytes, so that no cache line belongs to two,
//! if the first byte is at a multiple of 64.

use crate::pairs::LANES;
use crate::{Error, IndexFault, Scalar};

/// What the bytes of an index begin with.
const MAGIC: [u8; 4] = *b"SaPi";
const VERSION: u8 = 1;
/// Bytes of the header.
pub const HEADER: usize = 64;
/// Levels of an index of 2^32 boxes.
pub const MAX_LEVELS: usize = 8;
/// Bytes of the indices of a leaf.
pub const INDEX_BYTES: usize = LANES * size_of::<u32>();

/// What kind of index some bytes are: which [`Index`](crate::Index) can read them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct IndexInfo {
    /// The dimensions of its boxes: 1 to 3 in practice.
    pub dimensions: usize,
    /// The size of its coordinates in bytes: 4 for `f32`, 8 for `f64`.
    pub scalar_bytes: usize,
    /// How many boxes it says that it holds.
    pub len: u64,
}

impl IndexInfo {
    /// Reads the header, and nothing else: the rest may still be missing.
    ///
    /// # Errors
    /// [`Error::InvalidIndex`] if the bytes do not begin as those of an index do, end within the header, or
    /// are of another version.
    pub fn read(bytes: &[u8]) -> Result<Self, Error> {
        let fault = |fault| Err(Error::InvalidIndex(fault));
        let known = MAGIC.len().min(bytes.len());
        if bytes[..known] != MAGIC[..known] {
            return fault(IndexFault::Foreign);
        }
        let Some((&header, _)) = bytes.split_first_chunk::<HEADER>() else {
            return fault(IndexFault::Truncated);
        };
        let [_, _, _, _, version, dimensions, scalar_bytes, _, ..] = header;
        if version != VERSION {
            return fault(IndexFault::Version { found: version });
        }
        let mut len = [0; 8];
        len.copy_from_slice(&header[8..16]);
        Ok(Self {
            dimensions: dimensions.into(),
            scalar_bytes: scalar_bytes.into(),
            len: u64::from_le_bytes(len),
        })
    }
}

/// The header of an index.
pub fn header<const D: usize, T: Scalar>(count: usize) -> [u8; HEADER] {
    let mut header = [0; HEADER];
    header[..4].copy_from_slice(&MAGIC);
    header[4..8].copy_from_slice(&[VERSION, D as u8, T::BYTES as u8, 0]);
    header[8..16].copy_from_slice(&(count as u64).to_le_bytes());
    header
}

/// The NaN of lanes without a box: the same bits on every machine, which arithmetic does not promise.
pub fn nan<T: Scalar>() -> T {
    T::from_raw(if T::BYTES == 4 { 0x7fc0_0000 } else { 0x7ff8_0000_0000_0000 })
}

/// Bytes of the boxes of a node.
pub const fn node_bytes<const D: usize, T: Scalar>() -> usize {
    2 * D * LANES * T::BYTES
}

/// Where the nodes of each level are.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// How many boxes there are.
    pub count: usize,
    /// How many levels there are; 0 if there is no box.
    pub depth: usize,
    /// How many bytes there are.
    pub bytes: usize,
    levels: [Level; MAX_LEVELS],
}

/// The nodes of a level.
#[derive(Clone, Copy, Debug, Default)]
pub struct Level {
    /// Where the first one begins.
    pub start: usize,
    /// How many there are.
    pub nodes: usize,
}

impl Layout {
    /// The layout for so many boxes, if it fits in memory.
    pub fn new<const D: usize, T: Scalar>(count: usize) -> Option<Self> {
        u32::try_from(count).ok()?;
        let mut layout = Self { count, depth: 0, bytes: HEADER, levels: Default::default() };
        let mut nodes = count;
        while nodes > 1 || (nodes == 1 && layout.depth == 0) {
            nodes = nodes.div_ceil(LANES);
            let stride = layout.stride::<D, T>(layout.depth);
            layout.levels[layout.depth] = Level { start: layout.bytes, nodes };
            layout.bytes = layout.bytes.checked_add(nodes.checked_mul(stride)?)?;
            layout.depth += 1;
        }
        // Positions near the end may be computed before they are checked.
        (layout.bytes <= isize::MAX as usize).then_some(layout)
    }

    /// The nodes of a level; 0 are the leaves.
    pub fn level(&self, level: usize) -> Level {
        self.levels[level]
    }

    /// Bytes from one node of a level to the next.
    #[inline(always)]
    pub const fn stride<const D: usize, T: Scalar>(&self, level: usize) -> usize {
        node_bytes::<D, T>() + if level == 0 { INDEX_BYTES } else { 0 }
    }

    /// How many lanes of a node have a box.
    #[inline(always)]
    pub fn lanes(&self, level: usize, node: usize) -> usize {
        let below = if level == 0 { self.count } else { self.levels[level - 1].nodes };
        below.saturating_sub(node * LANES).min(LANES)
    }
}

/// The indices of a leaf, as bytes; each at most `last`.
#[inline(always)]
pub fn indices(bytes: &[u8; INDEX_BYTES], last: u32) -> [u32; LANES] {
    let mut indices = [0; LANES];
    for lane in 0..LANES {
        let at = 4 * lane;
        let index = [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
        indices[lane] = u32::from_le_bytes(index).min(last);
    }
    indices
}
