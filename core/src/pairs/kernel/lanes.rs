//! Instructions on the sixteen boxes of a node of the index. What is written with [`Lanes`] is safe code,
//! and [`Kernel::run`](super::Kernel::run) compiles it for each instruction set.

// Where there are no vectors, the definition is all that is used.
#![cfg_attr(
    not(any(
        target_arch = "x86_64",
        target_arch = "aarch64",
        all(target_arch = "wasm32", target_feature = "simd128")
    )),
    allow(dead_code)
)]

use core::marker::PhantomData;

use super::vector::{Vector, compress};
use crate::{Aabb, Scalar};

/// Boxes of a node.
pub const LANES: usize = 16;

/// Work that is compiled for each instruction set. What `run` calls must be inlined into it.
pub trait Work {
    type Output;
    fn run(self, lanes: impl Lanes) -> Self::Output;
}

/// Which relation of boxes to an area is tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// They share a point.
    Overlaps,
    /// They lie in the area.
    Inside,
}

/// Instructions on sixteen lanes. A value of this type is proof that the processor has them.
///
/// A node is the coordinates of sixteen boxes, little-endian: for each axis sixteen min, sixteen max.
pub trait Lanes: Copy {
    /// One bit for each box in this relation to `area`, the first lowest. A box with a NaN is in none.
    fn test<const D: usize, T: Scalar>(
        self,
        node: &[u8],
        area: &Aabb<D, T>,
        relation: Relation,
    ) -> u32;

    /// Moves the values of the lanes in `bits` to the front of `to`; the rest of `to` is not defined.
    fn compress(self, values: &[u32; LANES], bits: u32, to: &mut [u32; LANES]);
}

/// One coordinate of a node: those of an axis begin with column `2 * axis`, min, and the next is max.
#[inline(always)]
pub fn coordinate<T: Scalar>(node: &[u8], column: usize, lane: usize) -> T {
    let at = (column * LANES + lane) * T::BYTES;
    let mut word = [0; 8];
    word[..T::BYTES].copy_from_slice(&node[at..at + T::BYTES]);
    T::from_raw(u64::from_le_bytes(word))
}

/// The definition: one lane at a time.
#[derive(Clone, Copy)]
pub struct OneByOne;

impl Lanes for OneByOne {
    #[inline(always)]
    fn test<const D: usize, T: Scalar>(
        self,
        node: &[u8],
        area: &Aabb<D, T>,
        relation: Relation,
    ) -> u32 {
        (0..LANES).fold(0, |bits, lane| {
            let min = core::array::from_fn(|axis| coordinate(node, 2 * axis, lane));
            let max = core::array::from_fn(|axis| coordinate(node, 2 * axis + 1, lane));
            let aabb = Aabb::new(min, max);
            let hit = match relation {
                Relation::Overlaps => aabb.overlaps_branch_free(area),
                Relation::Inside => area.contains(&aabb),
            };
            bits | u32::from(hit) << lane
        })
    }

    #[inline(always)]
    fn compress(self, values: &[u32; LANES], bits: u32, to: &mut [u32; LANES]) {
        compress(values, bits, to);
    }
}

/// The lanes of [`Vector`]s of `f32` and `f64`.
#[derive(Clone, Copy)]
pub(super) struct Vectors<S, L>(PhantomData<(S, L)>);

impl<S, L> Vectors<S, L> {
    /// # Safety
    /// The processor has the instructions of these vectors, as long as the value is used, and is
    /// little-endian.
    pub unsafe fn new() -> Self {
        Self(PhantomData)
    }
}

impl<S: Vector<f32>, L: Vector<f64>> Lanes for Vectors<S, L> {
    #[inline(always)]
    fn test<const D: usize, T: Scalar>(
        self,
        node: &[u8],
        area: &Aabb<D, T>,
        relation: Relation,
    ) -> u32 {
        // SAFETY: the value is proof of the instructions.
        unsafe {
            if T::BYTES == 4 {
                test::<D, T, f32, S>(node, area, relation)
            } else {
                test::<D, T, f64, L>(node, area, relation)
            }
        }
    }

    #[inline(always)]
    fn compress(self, values: &[u32; LANES], bits: u32, to: &mut [u32; LANES]) {
        // SAFETY: the value is proof of the instructions.
        unsafe { S::compress(values, bits, to) }
    }
}

/// # Safety
/// The instructions of `V` are present, and little-endian.
#[inline(always)]
unsafe fn test<const D: usize, T: Scalar, U: Scalar, V: Vector<U>>(
    node: &[u8],
    area: &Aabb<D, T>,
    relation: Relation,
) -> u32 {
    assert!(node.len() == 2 * D * LANES * size_of::<U>() && T::BYTES == size_of::<U>());
    let (low, high) = match relation {
        Relation::Overlaps => (1, 0),
        Relation::Inside => (0, 1),
    };
    let mut bits = 0;
    for first in (0..LANES).step_by(V::LANES) {
        // SAFETY: the node has 2 * D columns of LANES coordinates, a multiple of those of a vector. Loads
        // need no alignment. The instructions are the caller's promise.
        unsafe {
            let splat = |limit: T| V::splat(U::from_raw(limit.to_raw()));
            let load =
                |column: usize| V::load(node.as_ptr().cast::<U>().add(column * LANES + first));
            let mut hits = V::le(splat(area.min[0]), load(low));
            hits = V::and_le(hits, load(high), splat(area.max[0]));
            for axis in 1..D {
                hits = V::and_le(hits, splat(area.min[axis]), load(2 * axis + low));
                hits = V::and_le(hits, load(2 * axis + high), splat(area.max[axis]));
            }
            bits |= V::bits(hits) << first;
        }
    }
    bits
}
