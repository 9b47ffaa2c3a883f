//! What a ray or a moving box hits.

use alloc::vec::Vec;
use core::cell::Cell;
use core::cmp::Ordering;
use core::ops::ControlFlow;

use super::math::{Fault, check_each, fault_in, is_finite, is_length};
use super::region::Queries;
use crate::world::bodies::ProxyId;
use crate::{Aabb, Error, Scalar};

/// A ray or a moving box, made by [`ray`](Self::ray) or [`aabb`](Self::aabb).
///
/// It is at `from + t * direction` for each t from 0 to `limit`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Cast<const D: usize, T = f32> {
    /// The box at t = 0; for a ray a point, its origin.
    pub from: Aabb<D, T>,
    /// How far it moves as t grows by 1: of any length, finite. If its length is 1, t is a distance.
    pub direction: [T; D],
    /// The largest t: 0 or more, may be infinite.
    pub limit: T,
}

impl<const D: usize, T: Scalar> Cast<D, T> {
    /// A ray.
    pub const fn ray(origin: [T; D], direction: [T; D], limit: T) -> Self {
        Self { from: Aabb::new(origin, origin), direction, limit }
    }

    /// A moving box.
    pub const fn aabb(from: Aabb<D, T>, direction: [T; D], limit: T) -> Self {
        Self { from, direction, limit }
    }

    fn fault(&self) -> Fault {
        let Self { from, direction, limit } = self;
        let inverted = from.invalid_axis().map(|axis| ("from", from.min[axis].to_f64()));
        fault_in("from", &from.min, is_finite)
            .or(fault_in("from", &from.max, is_finite))
            .or(inverted)
            .or(fault_in("direction", direction, is_finite))
            .or(fault_in("limit", &[*limit], is_length))
    }

    /// The t at which it first touches a box, if it does by `limit`.
    fn touches(&self, other: &Aabb<D, T>, limit: f64) -> Option<f64> {
        let (mut first, mut last) = (0.0f64, limit);
        for axis in 0..D {
            let speed = self.direction[axis].to_f64();
            let before = other.min[axis].to_f64() - self.from.max[axis].to_f64();
            let behind = other.max[axis].to_f64() - self.from.min[axis].to_f64();
            if speed == 0.0 {
                if before > 0.0 || behind < 0.0 {
                    return None;
                }
                continue;
            }
            let (enter, leave) = if speed > 0.0 { (before, behind) } else { (behind, before) };
            // Not by `max`: of 0.0 and -0.0 that may give either.
            let enter = enter / speed;
            first = if enter > first { enter } else { first };
            last = last.min(leave / speed);
        }
        (first <= last).then_some(first)
    }
}

/// A body that a cast hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The body.
    pub id: ProxyId,
    /// Where the hit is: at `from + t * direction`. 0 if they overlap at the start.
    pub t: f64,
}

impl<const D: usize, T: Scalar> Queries<'_, D, T> {
    /// The body that a ray or a moving box hits first; of several at once that with the smallest id.
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] if its box or direction is not finite, its box is inverted, or its
    /// limit is negative or NaN.
    #[doc(alias("ray_cast", "box_cast"))]
    pub fn cast(&self, cast: &Cast<D, T>) -> Result<Option<Hit>, Error> {
        Ok(self.cast_many(core::slice::from_ref(cast))?[0])
    }

    /// [`cast`](Self::cast) for each of many.
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] with the index of the first bad one.
    pub fn cast_many(&self, casts: &[Cast<D, T>]) -> Result<Vec<Option<Hit>>, Error> {
        check_each(casts, Cast::fault)?;
        let first_hit = |cast: &Cast<D, T>| {
            let mut best = None;
            self.run_cast(cast, |hit| {
                let is_better = |best: Hit| hit.t.total_cmp(&best.t).then(hit.id.cmp(&best.id));
                if best.is_none_or(|best| is_better(best) == Ordering::Less) {
                    best = Some(hit);
                }
                ControlFlow::Continue(hit.t)
            });
            best
        };
        Ok(casts.iter().map(first_hit).collect())
    }

    /// Everything that a ray or a moving box hits, sorted by t and then by id.
    ///
    /// # Errors
    /// As [`cast`](Self::cast).
    pub fn cast_all(&self, cast: &Cast<D, T>) -> Result<Vec<Hit>, Error> {
        let mut hits = Vec::new();
        self.cast_with(cast, |hit| {
            hits.push(hit);
            ControlFlow::Continue(f64::INFINITY)
        })?;
        hits.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.id.cmp(&b.id)));
        Ok(hits)
    }

    /// Calls `visit` with what a ray or a moving box hits, nearer parts of the world roughly first.
    /// It may stop the cast, or shorten it by continuing with a smaller limit.
    ///
    /// # Errors
    /// As [`cast`](Self::cast).
    pub fn cast_with(
        &self,
        cast: &Cast<D, T>,
        visit: impl FnMut(Hit) -> ControlFlow<(), f64>,
    ) -> Result<(), Error> {
        check_each(core::slice::from_ref(cast), Cast::fault)?;
        self.run_cast(cast, visit);
        Ok(())
    }

    fn run_cast(&self, cast: &Cast<D, T>, mut visit: impl FnMut(Hit) -> ControlFlow<(), f64>) {
        // The visitor lowers it.
        let limit = Cell::new(cast.limit.to_f64());
        let touches = |aabb: &Aabb<D, T>| cast.touches(aabb, limit.get());
        self.tree.search(touches, |index| {
            if let Some(t) = touches(self.bodies.shape(index))
                && self.sees(index)
            {
                match visit(Hit { id: self.bodies.slots.id(index), t }) {
                    ControlFlow::Continue(lower) => limit.set(limit.get().min(lower)),
                    ControlFlow::Break(()) => return ControlFlow::Break(()),
                }
            }
            ControlFlow::Continue(())
        });
    }
}
