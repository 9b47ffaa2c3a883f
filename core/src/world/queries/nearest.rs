//! What is nearest to a point.

use alloc::vec::Vec;
use core::cell::Cell;
use core::ops::ControlFlow;

use super::heap::{Ranked, rise, sink, sort};
use super::lists::Lists;
use super::math::{check_each, distance_squared, fault_in, is_finite, is_length};
use super::region::Queries;
use crate::memory::push;
use crate::world::bodies::ProxyId;
use crate::{Aabb, Error, Scalar};

/// A body near a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbor {
    /// The body.
    pub id: ProxyId,
    /// The square of the distance from the point to the body's box; 0 if the point is in it.
    pub distance_squared: f64,
}

impl Ranked for Neighbor {
    fn rank(&self) -> (u64, u32) {
        (self.distance_squared.to_bits(), self.id.slot())
    }
}

impl<const D: usize, T: Scalar> Queries<'_, D, T> {
    /// The `k` bodies nearest to a point that are at most `max_distance` away, or all of those if there are
    /// fewer; sorted by distance and then by id. Only the parts of the world that are near enough are searched.
    ///
    /// Distances are compared as squares in `f64`: they overflow beyond 1e154 and vanish below 1e-162, which coordinates of
    /// type `f32` cannot reach.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase};
    ///
    /// let mut world = BroadPhase::<2>::new();
    /// let near = world.insert(Aabb::new([3.0, 0.0], [4.0, 1.0]))?;
    /// let far = world.insert(Aabb::new([0.0, 5.0], [1.0, 6.0]))?;
    ///
    /// let queries = world.queries();
    /// let found = queries.nearest([0.0, 0.0], 2, 100.0)?;
    /// assert_eq!([found[0].id, found[1].id], [near, far]);
    /// assert_eq!([found[0].distance_squared, found[1].distance_squared], [9.0, 25.0]);
    /// assert_eq!(queries.nearest([0.0, 0.0], 2, 4.0)?.len(), 1);
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] if the point is not finite, or the distance is negative or NaN.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn nearest(
        &self,
        point: [T; D],
        k: usize,
        max_distance: f64,
    ) -> Result<Vec<Neighbor>, Error> {
        self.list(&point, |queries, points, lists| {
            queries.nearest_many(points, k, max_distance, lists)
        })
    }

    /// [`nearest`](Self::nearest) for each of many points, in lists that are replaced and keep their memory.
    ///
    /// # Errors
    /// As [`nearest`](Self::nearest), with the index of the first bad point.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn nearest_many(
        &self,
        points: &[[T; D]],
        k: usize,
        max_distance: f64,
        lists: &mut Lists<Neighbor>,
    ) -> Result<(), Error> {
        check_each(&[max_distance], |limit| fault_in("max_distance", &[*limit], is_length))?;
        check_each(points, |point| fault_in("point", point, is_finite))?;
        Ok(lists.replace(points, |point, nearest| {
            let start = nearest.len();
            self.collect_nearest(point, k, max_distance * max_distance, nearest)?;
            sort(&mut nearest[start..]);
            ControlFlow::Continue(())
        })?)
    }

    /// Adds to a list a heap of the `k` nearest bodies whose squared distances are at most `limit`, the farthest on top.
    /// Goes on with how many bodies it looked at, unless there is too little memory.
    fn collect_nearest(
        &self,
        point: &[T; D],
        k: usize,
        limit: f64,
        nearest: &mut Vec<Neighbor>,
    ) -> ControlFlow<(), usize> {
        if k == 0 {
            return ControlFlow::Continue(0);
        }
        let start = nearest.len();
        // What is farther away than this does not matter: it is lowered once there are k.
        let farthest = Cell::new(limit);
        let mut seen = 0;
        let bound = |bounds: &Aabb<D, T>| {
            let distance = distance_squared(point, bounds);
            (distance <= farthest.get()).then_some(distance)
        };
        self.tree.search(bound, |index| {
            seen += 1;
            let distance_squared = distance_squared(point, self.bodies.shape(index));
            if distance_squared <= farthest.get() && self.sees(index) {
                let found = Neighbor { id: self.bodies.slots.id(index), distance_squared };
                if nearest.len() - start < k {
                    push(nearest, found)?;
                    rise(&mut nearest[start..]);
                } else if found.rank() < nearest[start].rank() {
                    nearest[start] = found;
                    sink(&mut nearest[start..]);
                }
                if nearest.len() - start == k {
                    farthest.set(nearest[start].distance_squared);
                }
            }
            ControlFlow::Continue(())
        })?;
        ControlFlow::Continue(seen)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BroadPhase;

    #[test]
    fn only_what_is_near_enough_is_searched() {
        let mut world = BroadPhase::<1>::new();
        let boxes: Vec<_> = (0..10_000).map(|at| Aabb::new([at as f32], [at as f32])).collect();
        world.insert_many(&boxes, crate::Filter::default()).unwrap();
        let queries = world.queries();
        let seen = |k, max_distance: f64| {
            let mut nearest = Vec::new();
            let limit = max_distance * max_distance;
            let seen = queries.collect_nearest(&[5000.0], k, limit, &mut nearest);
            (nearest.len(), seen.continue_value().unwrap())
        };
        assert_eq!(seen(20_000, f64::INFINITY), (10_000, 10_000));
        let (found, looked_at) = seen(20_000, 50.0);
        assert!(found == 101 && looked_at < 300, "{found} found among {looked_at}");
        let (found, looked_at) = seen(3, f64::INFINITY);
        assert!(found == 3 && looked_at < 100, "{found} found among {looked_at}");
    }
}
