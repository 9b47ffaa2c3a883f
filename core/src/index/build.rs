//! Writes the bytes of an index: leaves in their order, then level by level the bounds of what is below.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;
use core::fmt;

use super::format::{HEADER, Layout, header, nan};
use super::pack::pack;
use crate::geometry::validate;
use crate::memory::reserved;
use crate::pairs::LANES;
use crate::{Aabb, Error, Scalar};

/// The bytes of an index that was built here, at a multiple of 64 in memory: then no node shares a cache
/// line with another.
pub struct IndexBuffer {
    bytes: Vec<u8>,
    /// Where the index begins.
    start: usize,
}

impl IndexBuffer {
    /// An empty buffer with capacity for so many bytes.
    fn with_capacity(capacity: usize) -> Result<Self, TryReserveError> {
        let mut bytes: Vec<u8> = reserved(capacity.saturating_add(HEADER - 1))?;
        let start = bytes.as_ptr().addr().wrapping_neg() % HEADER;
        bytes.resize(start, 0);
        Ok(Self { bytes, start })
    }

    /// A copy of some bytes.
    pub(super) fn copy_of(bytes: &[u8]) -> Result<Self, TryReserveError> {
        let mut copy = Self::with_capacity(bytes.len())?;
        copy.bytes.extend_from_slice(bytes);
        Ok(copy)
    }
}

impl AsRef<[u8]> for IndexBuffer {
    #[inline]
    fn as_ref(&self) -> &[u8] {
        &self.bytes[self.start..]
    }
}

impl Clone for IndexBuffer {
    fn clone(&self) -> Self {
        // Unaligned is slower, but as right.
        let bytes = self.as_ref();
        Self::copy_of(bytes).unwrap_or_else(|_| Self { bytes: bytes.to_vec(), start: 0 })
    }
}

impl fmt::Debug for IndexBuffer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("IndexBuffer").field("len", &self.as_ref().len()).finish_non_exhaustive()
    }
}

/// Builds an index.
pub fn build<const D: usize, T: Scalar>(
    boxes: &[Aabb<D, T>],
) -> Result<(Layout, IndexBuffer), Error> {
    validate(boxes)?;
    let layout = Layout::new::<D, T>(boxes.len()).ok_or(Error::OutOfMemory)?;
    let buffer = write(boxes, &layout).map_err(|_| Error::OutOfMemory)?;
    Ok((layout, buffer))
}

fn write<const D: usize, T: Scalar>(
    boxes: &[Aabb<D, T>],
    layout: &Layout,
) -> Result<IndexBuffer, TryReserveError> {
    let mut buffer = IndexBuffer::with_capacity(layout.bytes)?;
    let bytes = &mut buffer.bytes;
    bytes.extend_from_slice(&header::<D, T>(boxes.len()));
    // The bounds of the nodes of the last level that was written.
    let mut bounds = reserved(layout.level(0).nodes)?;
    let mut own = [empty(); LANES];
    pack(boxes, |centers| {
        let mut indices = [0; LANES];
        for (lane, center) in centers.iter().enumerate() {
            own[lane] = boxes[center.index as usize];
            indices[lane] = center.index;
        }
        bounds.push(put_node(bytes, &own[..centers.len()]));
        for index in indices {
            bytes.extend_from_slice(&index.to_le_bytes());
        }
    })?;
    for level in 1..layout.depth {
        for node in 0..layout.level(level).nodes {
            let below = &bounds[node * LANES..];
            // Its place was read already: a node has at least one below it.
            bounds[node] = put_node(bytes, &below[..below.len().min(LANES)]);
        }
        bounds.truncate(layout.level(level).nodes);
    }
    debug_assert_eq!(buffer.as_ref().len(), layout.bytes);
    Ok(buffer)
}

/// Writes the boxes of a node, at most 16. Returns their bounds.
#[inline]
fn put_node<const D: usize, T: Scalar>(bytes: &mut Vec<u8>, boxes: &[Aabb<D, T>]) -> Aabb<D, T> {
    let mut bounds = empty::<D, T>();
    for axis in 0..D {
        let (mut min, mut max) = ([nan::<T>(); LANES], [nan::<T>(); LANES]);
        for (lane, aabb) in boxes.iter().enumerate().take(LANES) {
            (min[lane], max[lane]) = (aabb.min[axis], aabb.max[axis]);
            if aabb.min[axis] < bounds.min[axis] {
                bounds.min[axis] = aabb.min[axis];
            }
            if aabb.max[axis] > bounds.max[axis] {
                bounds.max[axis] = aabb.max[axis];
            }
        }
        put_column(bytes, &min);
        put_column(bytes, &max);
    }
    bounds
}

/// Bounds of nothing.
fn empty<const D: usize, T: Scalar>() -> Aabb<D, T> {
    Aabb::new([T::INFINITY; D], [T::NEG_INFINITY; D])
}

#[inline]
fn put_column<T: Scalar>(bytes: &mut Vec<u8>, column: &[T; LANES]) {
    if T::BYTES == 4 {
        let mut raw = [[0; 4]; LANES];
        for lane in 0..LANES {
            raw[lane] = (column[lane].to_raw() as u32).to_le_bytes();
        }
        bytes.extend_from_slice(raw.as_flattened());
    } else {
        let mut raw = [[0; 8]; LANES];
        for lane in 0..LANES {
            raw[lane] = column[lane].to_raw().to_le_bytes();
        }
        bytes.extend_from_slice(raw.as_flattened());
    }
}
