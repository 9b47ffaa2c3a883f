//! Queries: what overlaps a box, a point or a sphere, what a ray or a moving box hits, what is
//! nearest.
//!
//! Each query is a [`Search`] of the tree: a lower bound for all bodies in a box, by which whole
//! parts of the world are passed over, and the same formula for one body. Formulas are in `f64` and made of
//! operations that round monotonically, so what holds a body is never farther than the body.

use alloc::collections::BinaryHeap;
use alloc::vec::Vec;
use core::cmp::Ordering;
use core::ops::{ControlFlow, Index};

use super::BroadPhase;
use super::filter::Filter;
use super::proxy::{ProxyId, flag};
use super::tree::Search;
use crate::{Aabb, Error, Scalar};

/// A box or a point on its way: from where, in which direction, how far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cast<const D: usize, T = f32> {
    /// The box at its start; for a ray a point.
    pub from: Aabb<D, T>,
    /// The way it goes for each unit of [`limit`](Self::limit), of any length. Finite.
    pub direction: [T; D],
    /// How many directions far: not negative, may be infinite.
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

    fn is_valid(&self) -> bool {
        let finite = |at: &T| *at > T::NEG_INFINITY && *at < T::INFINITY;
        self.from.is_valid()
            && self.from.min.iter().chain(&self.from.max).chain(&self.direction).all(finite)
            && self.limit >= T::default()
    }

    /// When it first touches a box, in directions, if it does by `limit`.
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
            first = first.max(enter / speed);
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
    /// How many directions from the start; 0 if they overlap there.
    pub at: f64,
}

/// A body near a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbour {
    /// The body.
    pub id: ProxyId,
    /// The square of the distance from the point to the body's box; 0 if the point is in it.
    pub distance_squared: f64,
}

/// The results of many queries, a list for each.
#[derive(Clone, Debug, PartialEq)]
pub struct Lists<V> {
    ends: Vec<usize>,
    values: Vec<V>,
}

impl<V> Lists<V> {
    fn new() -> Self {
        Self { ends: Vec::new(), values: Vec::new() }
    }

    fn push(&mut self, values: &[V])
    where
        V: Copy,
    {
        self.values.extend_from_slice(values);
        self.ends.push(self.values.len());
    }

    /// How many lists there are: one a query.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether no query was asked.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The lists in the order of the queries.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[V]> {
        (0..self.len()).map(|query| &self[query])
    }

    /// All lists one after another.
    pub fn values(&self) -> &[V] {
        &self.values
    }

    /// Where each list ends in [`values`](Self::values); it begins where the one before ends.
    pub fn ends(&self) -> &[usize] {
        &self.ends
    }
}

impl<V> Index<usize> for Lists<V> {
    type Output = [V];

    fn index(&self, query: usize) -> &[V] {
        let start = if query == 0 { 0 } else { self.ends[query - 1] };
        &self.values[start..self.ends[query]]
    }
}

/// The questions that a world answers; see [`BroadPhase::queries`].
///
/// They see the boxes as last given, updated or not, and the filter of each body against the one
/// that the query stands for: at first [`Filter::ALL`]. Lists are sorted by id, and equally near
/// bodies too, so every answer follows from the state alone.
#[derive(Clone, Copy, Debug)]
pub struct Queries<'w, const D: usize, T: Scalar = f32> {
    world: &'w BroadPhase<D, T>,
    filter: Filter,
}

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// Gets ready to answer queries, which takes time if bodies changed since it last did.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase, Cast};
    ///
    /// let mut world = BroadPhase::<2>::new();
    /// let wall = world.insert(Aabb::new([5.0, 0.0], [6.0, 9.0]))?;
    /// let tree = world.insert(Aabb::new([8.0, 0.0], [9.0, 9.0]))?;
    ///
    /// let queries = world.queries();
    /// assert_eq!(queries.overlapping(&Aabb::new([0.0, 0.0], [5.0, 1.0]))?, [wall]);
    /// let hit = queries.cast(&Cast::ray([1.0, 1.0], [1.0, 0.0], 100.0))?.unwrap();
    /// assert_eq!((hit.id, hit.at), (wall, 4.0));
    /// assert_eq!(queries.nearest([10.0, 1.0], 1)?[0].id, tree);
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    pub fn queries(&mut self) -> Queries<'_, D, T> {
        self.refresh_tree();
        Queries { world: self, filter: Filter::ALL }
    }
}

impl<const D: usize, T: Scalar> Queries<'_, D, T> {
    /// The same queries by a body of this filter: they find what it may pair with.
    pub fn with_filter(self, filter: Filter) -> Self {
        Self { filter, ..self }
    }

    /// The bodies whose boxes overlap a box, sorted.
    ///
    /// # Errors
    /// [`Error::InvalidBox`].
    pub fn overlapping(&self, area: &Aabb<D, T>) -> Result<Vec<ProxyId>, Error> {
        self.list(area, Self::overlapping_many)
    }

    /// [`overlapping`](Self::overlapping) for each of many boxes.
    ///
    /// # Errors
    /// [`Error::InvalidBox`] with the index of the first bad one.
    pub fn overlapping_many(&self, areas: &[Aabb<D, T>]) -> Result<Lists<ProxyId>, Error> {
        crate::validate(areas)?;
        let bound = |area: &Aabb<D, T>, bounds: &Aabb<D, T>| bounds.overlaps(area);
        Ok(self.collect(areas, bound))
    }

    /// Shows the bodies whose boxes overlap a box to `visit`, which may break off; in no
    /// particular order.
    ///
    /// # Errors
    /// [`Error::InvalidBox`].
    pub fn visit_overlapping(
        &self,
        area: &Aabb<D, T>,
        mut visit: impl FnMut(ProxyId) -> ControlFlow<()>,
    ) -> Result<(), Error> {
        crate::validate(core::slice::from_ref(area))?;
        let is_near = |bounds: &Aabb<D, T>| bounds.overlaps(area);
        // Whoever broke off knows it.
        let _ = self.visit_region(is_near, &mut visit);
        Ok(())
    }

    /// The bodies whose boxes hold a point, sorted.
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] for a NaN.
    pub fn containing(&self, point: [T; D]) -> Result<Vec<ProxyId>, Error> {
        self.list(&point, Self::containing_many)
    }

    /// [`containing`](Self::containing) for each of many points.
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] with the index of the first bad one.
    pub fn containing_many(&self, points: &[[T; D]]) -> Result<Lists<ProxyId>, Error> {
        check_each(points, |&point| Aabb::new(point, point).is_valid())?;
        let bound =
            |&point: &[T; D], bounds: &Aabb<D, T>| bounds.overlaps(&Aabb::new(point, point));
        Ok(self.collect(points, bound))
    }

    /// The bodies whose boxes are at most `radius` away from `centre`, sorted.
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] if the centre is not finite, or the radius negative or NaN.
    pub fn within(&self, centre: [T; D], radius: T) -> Result<Vec<ProxyId>, Error> {
        self.list(&(centre, radius), Self::within_many)
    }

    /// [`within`](Self::within) for each of many spheres, of centre and radius.
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] with the index of the first bad one.
    pub fn within_many(&self, spheres: &[([T; D], T)]) -> Result<Lists<ProxyId>, Error> {
        check_each(spheres, |(centre, radius)| is_finite(centre) && *radius >= T::default())?;
        let bound = |sphere: &([T; D], T), bounds: &Aabb<D, T>| {
            is_within(&sphere.0, sphere.1.to_f64(), bounds)
        };
        Ok(self.collect(spheres, bound))
    }

    /// The body that a ray or a moving box hits first; of several at once the least id.
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
        check_each(casts, Cast::is_valid)?;
        let first_hit = |cast: &Cast<D, T>| {
            let mut best = None;
            self.run_cast(cast, |hit| {
                let is_better = |best: Hit| hit.at.total_cmp(&best.at).then(hit.id.cmp(&best.id));
                if best.is_none_or(|best| is_better(best) == Ordering::Less) {
                    best = Some(hit);
                }
                ControlFlow::Continue(hit.at)
            });
            best
        };
        Ok(casts.iter().map(first_hit).collect())
    }

    /// Everything that a ray or a moving box hits, sorted by where and then by id.
    ///
    /// # Errors
    /// As [`cast`](Self::cast).
    pub fn cast_all(&self, cast: &Cast<D, T>) -> Result<Vec<Hit>, Error> {
        let mut hits = Vec::new();
        self.cast_with(cast, |hit| {
            hits.push(hit);
            ControlFlow::Continue(f64::INFINITY)
        })?;
        hits.sort_unstable_by(|a, b| a.at.total_cmp(&b.at).then(a.id.cmp(&b.id)));
        Ok(hits)
    }

    /// Shows what a ray or a moving box hits to `visit`, nearer parts of the world roughly first.
    /// It may break off, or shorten the cast by continuing with a lower limit, in directions.
    ///
    /// # Errors
    /// As [`cast`](Self::cast).
    pub fn cast_with(
        &self,
        cast: &Cast<D, T>,
        visit: impl FnMut(Hit) -> ControlFlow<(), f64>,
    ) -> Result<(), Error> {
        check_each(core::slice::from_ref(cast), Cast::is_valid)?;
        self.run_cast(cast, visit);
        Ok(())
    }

    /// The `k` bodies nearest to a point, or all if there are fewer, sorted by distance and then
    /// by id.
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] if the point is not finite.
    pub fn nearest(&self, point: [T; D], k: usize) -> Result<Vec<Neighbour>, Error> {
        self.list(&point, |queries, points| queries.nearest_many(points, k))
    }

    /// [`nearest`](Self::nearest) for each of many points.
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] with the index of the first bad one.
    pub fn nearest_many(&self, points: &[[T; D]], k: usize) -> Result<Lists<Neighbour>, Error> {
        check_each(points, is_finite)?;
        let mut lists = Lists::new();
        let mut search =
            Nearest { queries: self, point: [T::default(); D], k, nearest: BinaryHeap::new() };
        let mut sorted = Vec::new();
        for &point in points {
            search.point = point;
            if k > 0 {
                let _ = self.world.updater.tree.search(&mut search);
            }
            sorted.extend(search.nearest.drain());
            sorted.sort_unstable();
            let neighbours: Vec<_> = sorted
                .drain(..)
                .map(|(bits, slot)| Neighbour {
                    id: self.world.slots.id_of_slot(slot),
                    distance_squared: f64::from_bits(bits),
                })
                .collect();
            lists.push(&neighbours);
        }
        Ok(lists)
    }

    /// One query by way of the form for many.
    fn list<Q, V: Copy>(
        &self,
        query: &Q,
        many: impl Fn(&Self, &[Q]) -> Result<Lists<V>, Error>,
    ) -> Result<Vec<V>, Error> {
        Ok(many(self, core::slice::from_ref(query))?.values)
    }

    /// The bodies in each of many regions.
    fn collect<Q>(
        &self,
        regions: &[Q],
        is_near: impl Fn(&Q, &Aabb<D, T>) -> bool,
    ) -> Lists<ProxyId> {
        let mut lists = Lists::new();
        for region in regions {
            let start = lists.values.len();
            let _ = self.visit_region(
                |bounds| is_near(region, bounds),
                |id| {
                    lists.values.push(id);
                    ControlFlow::Continue(())
                },
            );
            lists.values[start..].sort_unstable();
            lists.ends.push(lists.values.len());
        }
        lists
    }

    fn visit_region(
        &self,
        is_near: impl Fn(&Aabb<D, T>) -> bool,
        visit: impl FnMut(ProxyId) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.world.updater.tree.search(&mut Region { queries: self, is_near, visit })
    }

    fn run_cast(&self, cast: &Cast<D, T>, visit: impl FnMut(Hit) -> ControlFlow<(), f64>) {
        let limit = cast.limit.to_f64();
        // Whoever broke off knows it.
        let _ = self.world.updater.tree.search(&mut Casting { queries: self, cast, limit, visit });
    }

    /// Whether a body is there, which the tree alone does not say, and not filtered out.
    fn sees(&self, seat: u32) -> bool {
        self.world.slots.has(seat, flag::LIVE)
            && self.filter.allows(&self.world.filters[seat as usize])
    }
}

/// All bodies in a region.
struct Region<'q, const D: usize, T: Scalar, N, V> {
    queries: &'q Queries<'q, D, T>,
    is_near: N,
    visit: V,
}

impl<const D: usize, T, N, V> Search<D, T> for Region<'_, D, T, N, V>
where
    T: Scalar,
    N: Fn(&Aabb<D, T>) -> bool,
    V: FnMut(ProxyId) -> ControlFlow<()>,
{
    #[inline]
    fn bound(&self, bounds: &Aabb<D, T>) -> Option<f64> {
        (self.is_near)(bounds).then_some(0.0)
    }

    fn visit(&mut self, seat: u32) -> ControlFlow<()> {
        if (self.is_near)(self.queries.world.shape(seat)) && self.queries.sees(seat) {
            (self.visit)(self.queries.world.slots.id(seat))?;
        }
        ControlFlow::Continue(())
    }
}

/// What a cast hits up to a limit that the visitor lowers.
struct Casting<'q, const D: usize, T: Scalar, V> {
    queries: &'q Queries<'q, D, T>,
    cast: &'q Cast<D, T>,
    limit: f64,
    visit: V,
}

impl<const D: usize, T, V> Search<D, T> for Casting<'_, D, T, V>
where
    T: Scalar,
    V: FnMut(Hit) -> ControlFlow<(), f64>,
{
    #[inline]
    fn bound(&self, bounds: &Aabb<D, T>) -> Option<f64> {
        self.cast.touches(bounds, self.limit)
    }

    fn visit(&mut self, seat: u32) -> ControlFlow<()> {
        if let Some(at) = self.cast.touches(self.queries.world.shape(seat), self.limit)
            && self.queries.sees(seat)
        {
            let limit = (self.visit)(Hit { id: self.queries.world.slots.id(seat), at });
            self.limit = self.limit.min(match limit {
                ControlFlow::Continue(limit) => limit,
                ControlFlow::Break(()) => return ControlFlow::Break(()),
            });
        }
        ControlFlow::Continue(())
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

    fn visit(&mut self, seat: u32) -> ControlFlow<()> {
        if self.queries.sees(seat) {
            let aabb = self.queries.world.shape(seat);
            let slot = self.queries.world.slots.slots[seat as usize];
            self.nearest.push((distance_squared(&self.point, aabb).to_bits(), slot));
            if self.nearest.len() > self.k {
                self.nearest.pop();
            }
        }
        ControlFlow::Continue(())
    }
}

fn is_finite<const D: usize, T: Scalar>(point: &[T; D]) -> bool {
    point.iter().all(|&at| at > T::NEG_INFINITY && at < T::INFINITY)
}

fn check_each<Q>(queries: &[Q], is_valid: impl Fn(&Q) -> bool) -> Result<(), Error> {
    match queries.iter().position(|query| !is_valid(query)) {
        None => Ok(()),
        Some(index) => Err(Error::InvalidQuery { index }),
    }
}

/// From a point to a box on one axis.
#[inline]
fn gap<const D: usize, T: Scalar>(point: &[T; D], aabb: &Aabb<D, T>, axis: usize) -> f64 {
    let at = point[axis].to_f64();
    (aabb.min[axis].to_f64() - at).max(at - aabb.max[axis].to_f64()).max(0.0)
}

fn distance_squared<const D: usize, T: Scalar>(point: &[T; D], aabb: &Aabb<D, T>) -> f64 {
    (0..D).fold(0.0, |sum, axis| {
        let gap = gap(point, aabb, axis);
        sum + gap * gap
    })
}

/// Whether a box is at most `radius` away. Scaled by a power of two where squares of an `f64`
/// would overflow or vanish.
fn is_within<const D: usize, T: Scalar>(centre: &[T; D], radius: f64, aabb: &Aabb<D, T>) -> bool {
    const LARGE: f64 = 1e150;
    let scale = match radius {
        _ if radius > LARGE => f64::from_bits(0x1A70_0000_0000_0000), // 2^-600
        _ if radius < 1.0 / LARGE => f64::from_bits(0x6570_0000_0000_0000), // 2^600
        _ => 1.0,
    };
    let sum = (0..D).fold(0.0, |sum, axis| {
        let gap = gap(centre, aabb, axis) * scale;
        sum + gap * gap
    });
    sum <= (radius * scale) * (radius * scale)
}
