//! The boxes that a point or a line reaches, nearest first.
//!
//! A heap has the nodes and boxes that were reached, the nearest on top. A node is replaced by what is in it,
//! and a box is a result: nothing that is left can be nearer. At the same distance nodes are before boxes,
//! and boxes are in the order of their indices.

use alloc::collections::{BinaryHeap, TryReserveError};
use alloc::vec::Vec;
use core::cmp::Reverse;
use core::ops::ControlFlow;

use super::format::{INDEX_BYTES, Layout, indices, node_bytes};
use crate::geometry::contact_time;
use crate::pairs::{LANES, Lanes, Work, coordinate};
use crate::{Aabb, Scalar};

/// The bits of a distance (which order as distances do, none being negative), and what is there: a box, or a
/// node, whose bits are less than those of any box.
pub type Reached = BinaryHeap<Reverse<(u64, u64)>>;

/// In the second number of [`Reached`]: it is a box, and its index is in the low 32 bits. Otherwise it is a
/// node, and its level is in the high 32 bits.
const IS_BOX: u64 = 1 << 63;

/// How far boxes are away, in a measure in which no box is nearer than what contains it.
pub trait Reach<const D: usize, T> {
    /// The distance of each of the boxes of a node, or NaN if it is not reached.
    fn measure(&self, node: &[u8], distances: &mut [f64; LANES]);
}

/// The square of the distance from a point.
pub struct FromPoint<const D: usize> {
    pub point: [f64; D],
    /// The greatest square.
    pub limit: f64,
}

impl<const D: usize, T: Scalar> Reach<D, T> for FromPoint<D> {
    /// As [`distance_squared`](crate::geometry::distance_squared).
    #[inline(always)]
    fn measure(&self, node: &[u8], distances: &mut [f64; LANES]) {
        *distances = [0.0; LANES];
        for axis in 0..D {
            let at = self.point[axis];
            for lane in 0..LANES {
                let min = coordinate::<T>(node, 2 * axis, lane).to_f64();
                let max = coordinate::<T>(node, 2 * axis + 1, lane).to_f64();
                let gap = (min - at).max(at - max).max(0.0);
                distances[lane] += gap * gap;
            }
        }
        for distance in distances {
            if *distance > self.limit {
                *distance = f64::NAN;
            }
        }
    }
}

/// The time at which a box at `from + t * speed` touches others.
pub struct Moving<const D: usize, T> {
    pub from: Aabb<D, T>,
    pub speed: [f64; D],
    /// The last time.
    pub limit: f64,
}

impl<const D: usize, T: Scalar> Reach<D, T> for Moving<D, T> {
    #[inline(always)]
    fn measure(&self, node: &[u8], distances: &mut [f64; LANES]) {
        for lane in 0..LANES {
            let mut aabb = self.from;
            for axis in 0..D {
                aabb.min[axis] = coordinate(node, 2 * axis, lane);
                aabb.max[axis] = coordinate(node, 2 * axis + 1, lane);
            }
            let time = contact_time(&self.from, &self.speed, self.limit, &aabb);
            distances[lane] = time.unwrap_or(f64::NAN);
        }
    }
}

/// Shows boxes and their distances to a visitor, the nearest first, until it stops.
pub struct NearestFirst<'a, const D: usize, T, R, V> {
    pub layout: &'a Layout,
    /// As long as the layout says.
    pub bytes: &'a [u8],
    pub reach: R,
    pub reached: &'a mut Reached,
    pub visit: V,
    /// The type of the coordinates.
    pub scalar: core::marker::PhantomData<T>,
}

impl<const D: usize, T, R, V, B> Work for NearestFirst<'_, D, T, R, V>
where
    T: Scalar,
    R: Reach<D, T>,
    V: FnMut(u32, f64) -> ControlFlow<B>,
{
    type Output = Result<ControlFlow<B>, TryReserveError>;

    #[inline(always)]
    fn run(self, _: impl Lanes) -> Self::Output {
        let Self { layout, bytes, reach, reached, mut visit, .. } = self;
        let mut empty = Vec::from(core::mem::take(reached));
        empty.clear();
        *reached = BinaryHeap::from(empty);
        let mut distances = [0.0; LANES];
        let mut next = layout.depth.checked_sub(1).map(|top| (0, (top as u64) << 32));
        while let Some((bits, what)) = next {
            if what & IS_BOX != 0 {
                if let ControlFlow::Break(with) = visit(what as u32, f64::from_bits(bits)) {
                    return Ok(ControlFlow::Break(with));
                }
            } else {
                let (level, node) = ((what >> 32) as usize, what as u32 as usize);
                let at = layout.level(level).start + node * layout.stride::<D, T>(level);
                let own = at + node_bytes::<D, T>();
                if let Some(node_boxes) = bytes.get(at..own) {
                    reach.measure(node_boxes, &mut distances);
                    let mut below = [0; LANES];
                    if level == 0 {
                        let own = bytes.get(own..own + INDEX_BYTES);
                        if let Some(own) = own.and_then(|own| own.first_chunk()) {
                            let own = indices(own, layout.count as u32 - 1);
                            for lane in 0..LANES {
                                below[lane] = IS_BOX | u64::from(own[lane]);
                            }
                        }
                    } else {
                        for lane in 0..LANES {
                            below[lane] = (level as u64 - 1) << 32 | (node * LANES + lane) as u64;
                        }
                    }
                    reached.try_reserve(LANES)?;
                    // Lanes without a box have no distance.
                    for lane in 0..layout.lanes(level, node).min(LANES) {
                        let distance = distances[lane];
                        if distance >= 0.0 {
                            // Not -0.0.
                            reached.push(Reverse(((distance + 0.0).to_bits(), below[lane])));
                        }
                    }
                }
            }
            next = reached.pop().map(|Reverse(nearest)| nearest);
        }
        Ok(ControlFlow::Continue(()))
    }
}
