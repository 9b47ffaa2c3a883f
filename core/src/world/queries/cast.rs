//! What a ray or a moving box hits.

use alloc::vec::Vec;
use core::cell::Cell;
use core::ops::ControlFlow;

use super::heap::{Ranked, rise, sort};
use super::lists::Lists;
use super::math::{Fault, check_each, fault_in, is_finite, is_length};
use super::region::Queries;
use crate::float::{greater, lesser};
use crate::memory::{push, reserve_for};
use crate::world::bodies::ProxyId;
use crate::{Aabb, Error, Scalar};

/// A ray or a moving box, made by [`ray`](Self::ray) or [`aabb`](Self::aabb).
///
/// It is at `from + t * direction` for each t from 0 to `limit`.
#[derive(Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Cast<const D: usize, T = f32> {
    /// The box at t = 0; for a ray a point, its origin.
    pub from: Aabb<D, T>,
    /// How far it moves as t grows by 1: of any length, finite. If its length is 1, t is a distance.
    pub direction: [T; D],
    /// The largest t: 0 or more, may be infinite.
    pub limit: T,
    /// Whether it passes what it only touches: see [`ignore_touching`](Self::ignore_touching).
    pub ignores_touching: bool,
}

// Not derived, as that of boxes.
impl<const D: usize, T: Copy> Clone for Cast<D, T> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}

impl<const D: usize, T: Scalar> Cast<D, T> {
    /// A ray.
    pub const fn ray(origin: [T; D], direction: [T; D], limit: T) -> Self {
        Self::aabb(Aabb::new(origin, origin), direction, limit)
    }

    /// A moving box.
    pub const fn aabb(from: Aabb<D, T>, direction: [T; D], limit: T) -> Self {
        Self { from, direction, limit, ignores_touching: false }
    }

    /// The same cast, which hits only what it enters. A body that it touches at its start and moves away from, or
    /// slides along, is not hit: a character walks over a floor of many tiles, and jumps off it.
    ///
    /// A body is entered if the insides of both boxes meet by `limit`. On an axis where both are flat, as a ray and a thin
    /// wall are, it is enough that they meet.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase, Cast};
    ///
    /// let mut world = BroadPhase::<2>::new();
    /// world.insert(Aabb::new([0.0, -1.0], [9.0, 0.0]))?; // a floor
    /// let wall = world.insert(Aabb::new([5.0, 0.0], [6.0, 9.0]))?;
    /// let hero = Aabb::new([1.0, 0.0], [2.0, 2.0]); // stands on the floor
    ///
    /// let walk = Cast::aabb(hero, [1.0, 0.0], 100.0);
    /// let queries = world.queries();
    /// assert_eq!(queries.cast(&walk)?.unwrap().t, 0.0); // touches the floor
    /// let hit = queries.cast(&walk.ignore_touching())?.unwrap();
    /// assert_eq!((hit.id, hit.t, hit.normal), (wall, 3.0, [-1.0, 0.0]));
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    #[must_use]
    pub const fn ignore_touching(self) -> Self {
        Self { ignores_touching: true, ..self }
    }

    fn fault(&self) -> Fault {
        let Self { from, direction, limit, .. } = self;
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
            let (enter, leave) = self.meets(other, axis).when()?;
            first = greater(enter, first);
            last = lesser(leave, last);
        }
        (first <= last).then_some(first)
    }

    /// Whether it enters a box that it touches: see [`ignore_touching`](Self::ignore_touching).
    fn enters(&self, other: &Aabb<D, T>) -> bool {
        let limit = self.limit.to_f64();
        // Its inside is entered after `first` and left before `last`; flat boxes meet at one t.
        let (mut first, mut last, mut at) = (f64::NEG_INFINITY, f64::INFINITY, None);
        for axis in 0..D {
            let meets = self.meets(other, axis);
            let Some((enter, leave)) = meets.when() else { return false };
            if meets.before == meets.behind {
                if meets.speed != 0.0 && *at.get_or_insert(enter) != enter {
                    return false;
                }
                continue;
            }
            if meets.speed == 0.0 && !(meets.before < 0.0 && meets.behind > 0.0) {
                return false;
            }
            first = greater(enter, first);
            last = lesser(leave, last);
        }
        match at {
            Some(at) => first < at && at < last && (0.0..=limit).contains(&at),
            None => first < last && last > 0.0 && first < limit,
        }
    }

    /// The face of a box that it touches first: the axis, and whether that is the face at the box's max corner. None
    /// if it starts inside the box. Of several faces, as at an edge, that of the first axis; one that it moves towards
    /// is preferred.
    fn face(&self, other: &Aabb<D, T>) -> Option<(usize, bool)> {
        let (mut face, mut latest) = (None, f64::NEG_INFINITY);
        for axis in 0..D {
            let meets = self.meets(other, axis);
            let (enter, _) = meets.when()?;
            if enter >= 0.0 && enter > latest && meets.speed != 0.0 {
                (face, latest) = (Some((axis, meets.speed < 0.0)), enter);
            }
        }
        face.or_else(|| {
            (0..D).find_map(|axis| {
                let Meeting { before, behind, .. } = self.meets(other, axis);
                (before == 0.0 || behind == 0.0).then_some((axis, before != 0.0))
            })
        })
    }

    /// How it meets a box on an axis.
    fn meets(&self, other: &Aabb<D, T>, axis: usize) -> Meeting {
        Meeting {
            speed: self.direction[axis].to_f64(),
            before: other.min[axis].to_f64() - self.from.max[axis].to_f64(),
            behind: other.max[axis].to_f64() - self.from.min[axis].to_f64(),
        }
    }
}

/// How a cast meets a box on one axis.
struct Meeting {
    /// How far the cast moves as t grows by 1.
    speed: f64,
    /// How far it has to move up until it touches the box,
    before: f64,
    /// and until it is past the box.
    behind: f64,
}

impl Meeting {
    /// From which t to which they overlap, if they ever do.
    fn when(&self) -> Option<(f64, f64)> {
        let Self { speed, before, behind } = *self;
        if speed == 0.0 {
            let always = (f64::NEG_INFINITY, f64::INFINITY);
            return (before <= 0.0 && behind >= 0.0).then_some(always);
        }
        let (enter, leave) = if speed > 0.0 { (before, behind) } else { (behind, before) };
        Some((enter / speed, leave / speed))
    }
}

/// A body that a cast hits.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Hit<const D: usize, T = f32> {
    /// The body.
    pub id: ProxyId,
    /// Where the hit is: at `from + t * direction`. 0 if they overlap at the start.
    pub t: f64,
    /// Which way the face that is hit looks: of length 1 along an axis, away from the body. All 0 if the cast starts
    /// inside the body. At an edge or a corner, the face of the first axis.
    pub normal: [T; D],
    /// Whether the insides of the boxes overlap at the start. A box that touches at the start does not start inside.
    pub starts_inside: bool,
}

impl<const D: usize, T> Ranked for Hit<D, T> {
    fn rank(&self) -> (u64, u32) {
        (self.t.to_bits(), self.id.slot())
    }
}

impl<const D: usize, T: Scalar> Queries<'_, D, T> {
    /// The body that a ray or a moving box hits first; of several at once that with the smallest id.
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] if its box or direction is not finite, its box is inverted, or its
    /// limit is negative or NaN.
    #[doc(alias("ray_cast", "box_cast"))]
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn cast(&self, cast: &Cast<D, T>) -> Result<Option<Hit<D, T>>, Error> {
        check_each(core::slice::from_ref(cast), Cast::fault)?;
        Ok(self.first_hit(cast))
    }

    /// [`cast`](Self::cast) for each of many, in a list that is replaced and keeps its memory.
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] with the index of the first bad one.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn cast_many(
        &self,
        casts: &[Cast<D, T>],
        hits: &mut Vec<Option<Hit<D, T>>>,
    ) -> Result<(), Error> {
        check_each(casts, Cast::fault)?;
        hits.clear();
        reserve_for(hits, casts.len())?;
        hits.extend(casts.iter().map(|cast| self.first_hit(cast)));
        Ok(())
    }

    fn first_hit(&self, cast: &Cast<D, T>) -> Option<Hit<D, T>> {
        let mut best: Option<Hit<D, T>> = None;
        let _ = self.run_cast(cast, |hit| {
            if best.is_none_or(|best| hit.rank() < best.rank()) {
                best = Some(hit);
            }
            ControlFlow::Continue(hit.t)
        });
        best
    }

    /// Everything that a ray or a moving box hits, sorted by t and then by id.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase, Cast};
    ///
    /// let mut world = BroadPhase::<2>::new();
    /// let targets = [Aabb::new([6.0, 0.0], [7.0, 1.0]), Aabb::new([2.0, 0.0], [3.0, 1.0])];
    /// let ids = world.insert_many(&targets, Default::default())?;
    /// // A shot that goes through: both targets, the nearer one first.
    /// let hits = world.queries().cast_all(&Cast::ray([0.0, 0.5], [1.0, 0.0], 100.0))?;
    /// let hits: Vec<_> = hits.iter().map(|hit| (hit.id, hit.t)).collect();
    /// assert_eq!(hits, [(ids[1], 2.0), (ids[0], 6.0)]);
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`cast`](Self::cast).
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn cast_all(&self, cast: &Cast<D, T>) -> Result<Vec<Hit<D, T>>, Error> {
        self.list(cast, Self::cast_all_many)
    }

    /// [`cast_all`](Self::cast_all) for each of many, in lists that are replaced and keep their memory.
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] with the index of the first bad one.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn cast_all_many(
        &self,
        casts: &[Cast<D, T>],
        lists: &mut Lists<Hit<D, T>>,
    ) -> Result<(), Error> {
        check_each(casts, Cast::fault)?;
        Ok(lists.replace(casts, |cast, hits| {
            let start = hits.len();
            self.run_cast(cast, |hit| {
                if push(hits, hit).is_break() {
                    return ControlFlow::Break(());
                }
                rise(&mut hits[start..]);
                ControlFlow::Continue(f64::INFINITY)
            })?;
            sort(&mut hits[start..]);
            ControlFlow::Continue(())
        })?)
    }

    /// Calls `visit` with what a ray or a moving box hits, nearer parts of the world roughly first.
    /// It may stop the cast, or shorten it by continuing with a smaller limit.
    ///
    /// # Errors
    /// As [`cast`](Self::cast).
    pub fn cast_with(
        &self,
        cast: &Cast<D, T>,
        mut visit: impl FnMut(Hit<D, T>) -> ControlFlow<(), f64>,
    ) -> Result<(), Error> {
        check_each(core::slice::from_ref(cast), Cast::fault)?;
        // The visitor knows whether it stopped.
        let _ = self.run_cast(cast, &mut visit as &mut dyn FnMut(_) -> _);
        Ok(())
    }

    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    fn run_cast(
        &self,
        cast: &Cast<D, T>,
        mut visit: impl FnMut(Hit<D, T>) -> ControlFlow<(), f64>,
    ) -> ControlFlow<()> {
        // The visitor lowers it.
        let limit = Cell::new(cast.limit.to_f64());
        let touches = |aabb: &Aabb<D, T>| cast.touches(aabb, limit.get());
        self.tree.search(touches, |index| {
            let aabb = self.bodies.shape(index);
            if let Some(t) = touches(aabb)
                && self.sees(index)
                && (!cast.ignores_touching || cast.enters(aabb))
            {
                match visit(self.hit(cast, index, t)) {
                    ControlFlow::Continue(lower) => limit.set(lesser(lower, limit.get())),
                    ControlFlow::Break(()) => return ControlFlow::Break(()),
                }
            }
            ControlFlow::Continue(())
        })
    }

    fn hit(&self, cast: &Cast<D, T>, index: u32, t: f64) -> Hit<D, T> {
        let face = cast.face(self.bodies.shape(index));
        let mut normal = [T::default(); D];
        if let Some((axis, is_max)) = face {
            normal[axis] = T::from_f64(if is_max { 1.0 } else { -1.0 });
        }
        Hit { id: self.bodies.slots.id(index), t, normal, starts_inside: face.is_none() }
    }
}
