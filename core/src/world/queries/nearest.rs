//! What is nearest to a point.

use alloc::collections::BinaryHeap;
use alloc::vec::Vec;

use core::ops::ControlFlow;

use super::lists::Lists;
use super::math::{check_each, fault_in, gap, is_finite};
use super::region::Queries;
use crate::world::bodies::ProxyId;
use crate::world::tree::Search;
use crate::{Aabb, Error, Scalar};

/// A body near a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbor {
    /// The body.
    pub id: ProxyId,
    /// The square of the distance from the point to the body's box; 0 if the point is in it.
    pub distance_squared: f64,
}

impl<const D: usize, T: Scalar> Queries<'_, D, T> {
    /// The `k` bodies nearest to a point, or all if there are fewer, sorted by distance and then
    /// by id.
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] if the point is not finite.
    pub fn nearest(&self, point: [T; D], k: usize) -> Result<Vec<Neighbor>, Error> {
        self.list(&point, |queries, points| queries.nearest_many(points, k))
    }

    /// [`nearest`](Self::nearest) for each of many points.
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] with the index of the first bad one.
    pub fn nearest_many(&self, points: &[[T; D]], k: usize) -> Result<Lists<Neighbor>, Error> {
        check_each(points, |point| fault_in("point", point, is_finite))?;
        let mut lists = Lists::new();
        let mut search =
            Nearest { queries: self, point: [T::default(); D], k, nearest: BinaryHeap::new() };
        let mut sorted = Vec::new();
        for &point in points {
            search.point = point;
            if k > 0 {
                let _ = self.tree.search(&mut search);
            }
            sorted.extend(search.nearest.drain());
            sorted.sort_unstable();
            let neighbors: Vec<_> = sorted
                .drain(..)
                .map(|(bits, slot)| Neighbor {
                    id: self.bodies.slots.id_of_slot(slot),
                    distance_squared: f64::from_bits(bits),
                })
                .collect();
            lists.push(&neighbors);
        }
        Ok(lists)
    }
}

/// The k nearest so far, the farthest on top, as bits of the squared distance (which order as the
/// numbers do, none being negative) and slot.
struct Nearest<'q, const D: usize, T: Scalar> {
    queries: &'q Queries<'q, D, T>,
    point: [T; D],
    k: usize,
    nearest: BinaryHeap<(u64, u32)>,
}

impl<const D: usize, T: Scalar> Search<D, T> for Nearest<'_, D, T> {
    fn bound(&self, bounds: &Aabb<D, T>) -> Option<f64> {
        let distance = distance_squared(&self.point, bounds);
        let is_full = self.nearest.len() == self.k;
        let farthest = self.nearest.peek().filter(|_| is_full);
        farthest.is_none_or(|&(bits, _)| distance.to_bits() <= bits).then_some(distance)
    }

    fn visit(&mut self, index: u32) -> ControlFlow<()> {
        if self.queries.sees(index) {
            let aabb = self.queries.bodies.shape(index);
            let slot = self.queries.bodies.slots.slot_of[index as usize];
            self.nearest.push((distance_squared(&self.point, aabb).to_bits(), slot));
            if self.nearest.len() > self.k {
                self.nearest.pop();
            }
        }
        ControlFlow::Continue(())
    }
}

fn distance_squared<const D: usize, T: Scalar>(point: &[T; D], aabb: &Aabb<D, T>) -> f64 {
    (0..D).fold(0.0, |sum, axis| {
        let gap = gap(point, aabb, axis);
        sum + gap * gap
    })
}
