//! What is nearest to a point.

use alloc::collections::BinaryHeap;
use alloc::vec::Vec;
use core::cell::RefCell;
use core::ops::ControlFlow;

use super::region::Queries;
use crate::geometry::{check_each, distance_squared, fault_in, is_finite};
use crate::lists::Lists;
use crate::world::bodies::ProxyId;
use crate::{Aabb, Error, Scalar};

/// A body near a point; or a box, whose id is its index, if it was found in an [`Index`](crate::Index).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbor<I = ProxyId> {
    /// The body.
    pub id: I,
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
        // The k nearest so far, the farthest on top, as bits of the squared distance (which order as the
        // numbers do, none being negative) and slot.
        let nearest = RefCell::new(BinaryHeap::new());
        for point in points {
            let bound = |bounds: &Aabb<D, T>| {
                let (distance, nearest) = (distance_squared(point, bounds), nearest.borrow());
                let farthest = nearest.peek().filter(|_| nearest.len() == k);
                farthest.is_none_or(|&(bits, _)| distance.to_bits() <= bits).then_some(distance)
            };
            let visit = |index: u32| {
                if self.sees(index) {
                    let distance = distance_squared(point, self.bodies.shape(index));
                    let mut nearest = nearest.borrow_mut();
                    nearest.push((distance.to_bits(), self.bodies.slots.slot_of[index as usize]));
                    if nearest.len() > k {
                        nearest.pop();
                    }
                }
                ControlFlow::Continue(())
            };
            if k > 0 {
                self.tree.search(bound, visit);
            }
            let start = lists.values.len();
            lists.values.extend(nearest.borrow_mut().drain().map(|(bits, slot)| Neighbor {
                id: self.bodies.slots.id_of_slot(slot),
                distance_squared: f64::from_bits(bits),
            }));
            lists.values[start..].sort_unstable_by(|a, b| {
                a.distance_squared.total_cmp(&b.distance_squared).then(a.id.cmp(&b.id))
            });
            lists.end();
        }
        Ok(lists)
    }
}
