//! Queries for all bodies in a region: a box, a point or a sphere.

use alloc::vec::Vec;
use core::fmt;
use core::ops::ControlFlow;

use super::at_once;
use super::lists::Lists;
use super::math::{around, check_each, fault_in, is_finite, is_length, is_within};
use super::sorted_bodies::SortedBodies;
use crate::memory::{OutOfMemory, push, reserve_for};
use crate::world::bodies::{Bodies, Filter, ProxyId, flag, sort_ids};
use crate::world::tree::Tree;
use crate::{Aabb, Error, Scalar};

/// The queries of a world; see [`BroadPhase::queries`](crate::BroadPhase::queries).
///
/// They see the boxes as last set, updated or not, and all bodies unless they get a
/// [filter](Self::with_filter). Lists are sorted by id, unless they need [not](Self::unsorted) be; bodies that are
/// equally near are too.
///
/// Each query for a list returns a new one. The forms for many, as [`overlapping_many`](Self::overlapping_many), write to
/// [`Lists`] of yours instead, which keep their memory: with them, queries in each frame do not allocate once the lists are
/// large enough, unless there are thousands of them in a large world.
///
/// If an answer does not fit in memory, the query ends with [`Error::OutOfMemory`], and [`Lists`] of yours are empty.
#[derive(Clone, Copy)]
pub struct Queries<'w, const D: usize, T: Scalar = f32> {
    pub(in crate::world) bodies: &'w Bodies<D, T>,
    pub(in crate::world) tree: &'w Tree<D, T>,
    pub(in crate::world) sorted: &'w SortedBodies<D, T>,
    pub(in crate::world) filter: Option<Filter>,
    pub(in crate::world) predicate: Option<&'w (dyn Fn(ProxyId) -> bool + Sync)>,
    pub(in crate::world) is_sorted: bool,
}

impl<const D: usize, T: Scalar> fmt::Debug for Queries<'_, D, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Queries")
            .field("filter", &self.filter)
            .field("has_predicate", &self.predicate.is_some())
            .field("is_sorted", &self.is_sorted)
            .finish_non_exhaustive()
    }
}

impl<'w, const D: usize, T: Scalar> Queries<'w, D, T> {
    /// The same queries, which find only the bodies of which a function of yours is true: not the one that asks, or only
    /// those that your tables say are visible. It replaces an earlier one, and is called for no body that the filter hides.
    ///
    /// A query calls it for each body in reach, in no particular order, and perhaps for some that it does not find: for
    /// [`cast`](Self::cast) bodies behind the one that is hit, for [`nearest`](Self::nearest) some that are farther.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase, Cast, ProxyId};
    ///
    /// let mut world = BroadPhase::<1>::new();
    /// let hero = world.insert(Aabb::new([0.0], [1.0]))?;
    /// let glass = world.insert(Aabb::new([3.0], [4.0]))?;
    /// let wall = world.insert(Aabb::new([5.0], [6.0]))?;
    /// let is_opaque = [true, false, true]; // by slot
    ///
    /// let blocks_view = |id: ProxyId| id != hero && is_opaque[id.slot() as usize];
    /// let queries = world.queries().with_predicate(&blocks_view);
    /// let look = Cast::ray([0.5], [1.0], 100.0);
    /// assert_eq!(queries.cast(&look)?.unwrap().id, wall);
    /// assert_eq!(queries.nearest([0.5], 1, f64::INFINITY)?[0].id, wall);
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    pub fn with_predicate<'q>(
        self,
        predicate: &'q (dyn Fn(ProxyId) -> bool + Sync),
    ) -> Queries<'q, D, T>
    where
        'w: 'q,
    {
        Queries { predicate: Some(predicate), ..self }
    }

    /// The same queries with a filter: they find what a body with this filter may pair with. Without one
    /// they find every body; with [`Filter::ALL`] none whose category or mask is 0.
    pub fn with_filter(self, filter: Filter) -> Self {
        Self { filter: Some(filter), ..self }
    }

    /// The same queries, but what overlaps a box, contains a point or is within a sphere is in no particular order.
    /// Sorting takes a quarter of the time of a query that finds 100 bodies, and half if it finds 10,000. What is
    /// nearest, or hit, is sorted by distance all the same.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase};
    ///
    /// let mut world = BroadPhase::<1>::new();
    /// let ids = world.insert_many(&[Aabb::new([0.0], [1.0]); 100], Default::default())?;
    /// let mut found = world.queries().unsorted().containing([0.5])?;
    /// found.sort_unstable();
    /// assert_eq!(found, ids);
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    pub fn unsorted(self) -> Self {
        Self { is_sorted: false, ..self }
    }

    /// The bodies whose boxes overlap a box, sorted. Those that are completely inside are some of them:
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase};
    ///
    /// let mut world = BroadPhase::<1>::new();
    /// let ids = world.insert_many(&[Aabb::new([1.0], [2.0]), Aabb::new([4.0], [9.0])], Default::default())?;
    /// let area = Aabb::new([0.0], [5.0]);
    /// let mut found = world.queries().overlapping(&area)?;
    /// assert_eq!(found, ids);
    /// found.retain(|&id| world.aabb(id).is_ok_and(|inner| area.contains(&inner)));
    /// assert_eq!(found, [ids[0]]);
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidBox`].
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn overlapping(&self, area: &Aabb<D, T>) -> Result<Vec<ProxyId>, Error> {
        self.list(area, Self::overlapping_many)
    }

    /// [`overlapping`](Self::overlapping) for each of many boxes, in lists that are replaced and keep their memory.
    ///
    /// With at least a box for every fourth of 32,768 bodies or more, or for every twelfth of 131,072 or more, all are found at
    /// once, as by [`find_pairs_between`](crate::find_pairs_between), which allocates for the time of the call: 25,000 boxes
    /// among 200,000 bodies take 0.21 to 0.72 of the time that they take one by one (AMD EPYC, Zen 3, 2026-11-29).
    ///
    /// After two such calls the world sorts the boxes of its bodies, when it is next asked, and keeps them. While at most one
    /// body in 16 has another box, 12,500 boxes among 200,000 bodies take 0.13 to 0.65 of the time one by one, 50,000 take 0.12 to
    /// 0.28 (2026-11-30), and fewer boxes suffice: one for every 32nd of 131,072 bodies, every twelfth of 32,768, every fourth
    /// of 8,192. That takes about `5 * D * size_of::<T>() + 12` bytes for each body, until bodies that all move make it useless, or
    /// no call used it for 64 to 128 updates.
    ///
    /// # Errors
    /// [`Error::InvalidBox`] with the index of the first bad one.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn overlapping_many(
        &self,
        areas: &[Aabb<D, T>],
        lists: &mut Lists<ProxyId>,
    ) -> Result<(), Error> {
        crate::validate(areas)?;
        let is_visible = (!self.sees_all()).then_some(|index| self.sees(index));
        if at_once::may_pay(self.bodies, areas.len())
            && at_once::list(areas, self.bodies, self.sorted, is_visible, lists)
        {
            self.sort_each(lists);
            return Ok(());
        }
        Ok(self.collect(areas, lists, |area, found| self.list_box(area, found))?)
    }

    /// Calls `visit` with each body whose box overlaps a box, in no particular order, until it breaks. It
    /// makes no list, and stops as soon as the answer is known: is this place free?
    ///
    /// # Errors
    /// [`Error::InvalidBox`].
    ///
    /// # Example
    /// ```
    /// use core::ops::ControlFlow;
    /// use sweep_and_prune::{Aabb, BroadPhase};
    ///
    /// let mut world = BroadPhase::<2>::new();
    /// world.insert(Aabb::new([0.0, 0.0], [2.0, 2.0]))?;
    /// let mut is_free = true;
    /// world.queries().visit_overlapping(&Aabb::new([1.0, 1.0], [3.0, 3.0]), |_| {
    ///     is_free = false;
    ///     ControlFlow::Break(())
    /// })?;
    /// assert!(!is_free);
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    pub fn visit_overlapping(
        &self,
        area: &Aabb<D, T>,
        mut visit: impl FnMut(ProxyId) -> ControlFlow<()>,
    ) -> Result<(), Error> {
        area.check(0)?;
        // The visitor knows whether it stopped.
        let _ = self.visit_box(area, &mut visit);
        Ok(())
    }

    /// The bodies whose boxes hold a point, sorted.
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] for a NaN.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn containing(&self, point: [T; D]) -> Result<Vec<ProxyId>, Error> {
        self.list(&point, Self::containing_many)
    }

    /// [`containing`](Self::containing) for each of many points, in lists that are replaced and keep their memory. Very many
    /// are found at once, as in [`overlapping_many`](Self::overlapping_many).
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] with the index of the first bad one.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn containing_many(
        &self,
        points: &[[T; D]],
        lists: &mut Lists<ProxyId>,
    ) -> Result<(), Error> {
        let is_number = |at: T| at <= T::INFINITY && at >= T::NEG_INFINITY;
        check_each(points, |point| fault_in("point", point, is_number))?;
        if at_once::may_pay(self.bodies, points.len()) {
            let mut areas = Vec::new();
            reserve_for(&mut areas, points.len()).or_else(|_| lists.fail())?;
            areas.extend(points.iter().map(|&at| Aabb::new(at, at)));
            return self.overlapping_many(&areas, lists);
        }
        Ok(self.collect(points, lists, |&at, found| self.list_box(&Aabb::new(at, at), found))?)
    }

    /// The bodies whose boxes are at most `radius` away from `center`, sorted.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, BroadPhase};
    ///
    /// let mut world = BroadPhase::<2>::new();
    /// let crates = [Aabb::new([3.0, 0.0], [4.0, 1.0]), Aabb::new([4.0, 4.0], [5.0, 5.0])];
    /// let ids = world.insert_many(&crates, Default::default())?;
    /// // An explosion at the origin: the second crate's corner is 5.66 away.
    /// assert_eq!(world.queries().within([0.0, 0.0], 5.0)?, [ids[0]]);
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] if the center is not finite, or the radius negative or NaN.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn within(&self, center: [T; D], radius: T) -> Result<Vec<ProxyId>, Error> {
        self.list(&(center, radius), Self::within_many)
    }

    /// [`within`](Self::within) for each of many spheres, each a center and a radius, in lists that are replaced and keep
    /// their memory.
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] with the index of the first bad one.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn within_many(
        &self,
        spheres: &[([T; D], T)],
        lists: &mut Lists<ProxyId>,
    ) -> Result<(), Error> {
        check_each(spheres, |(center, radius)| {
            fault_in("center", center, is_finite).or(fault_in("radius", &[*radius], is_length))
        })?;
        Ok(self.collect(spheres, lists, |sphere, found| self.list_sphere(sphere, found))?)
    }

    /// One query by way of the form for many.
    pub(super) fn list<Q, V: Copy>(
        &self,
        query: &Q,
        many: impl Fn(&Self, &[Q], &mut Lists<V>) -> Result<(), Error>,
    ) -> Result<Vec<V>, Error> {
        let mut lists = Lists::new();
        many(self, core::slice::from_ref(query), &mut lists)?;
        Ok(lists.values)
    }

    /// The bodies in each of many regions, which `list` appends.
    fn collect<Q>(
        &self,
        regions: &[Q],
        lists: &mut Lists<ProxyId>,
        list: impl Fn(&Q, &mut Vec<ProxyId>) -> ControlFlow<()>,
    ) -> Result<(), OutOfMemory> {
        lists.replace(regions, list)?;
        self.sort_each(lists);
        Ok(())
    }

    /// Sorts each list, unless it need not be.
    fn sort_each(&self, lists: &mut Lists<ProxyId>) {
        if !self.is_sorted {
            return;
        }
        let mut start = 0;
        for &end in &lists.ends {
            sort_ids(&mut lists.values[start..end]);
            start = end;
        }
    }

    /// Appends the bodies whose boxes overlap a box, as far as there is memory.
    fn list_box(&self, area: &Aabb<D, T>, found: &mut Vec<ProxyId>) -> ControlFlow<()> {
        let sees_all = self.sees_all();
        self.tree.visit_overlapping(area, &mut |bodies| {
            for index in bodies {
                if self.bodies.shape(index).overlaps(area) && (sees_all || self.sees(index)) {
                    push(found, self.bodies.slots.id(index))?;
                }
            }
            ControlFlow::Continue(())
        })
    }

    /// Shows the bodies whose boxes overlap a box.
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    fn visit_box(
        &self,
        area: &Aabb<D, T>,
        visit: &mut dyn FnMut(ProxyId) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.tree.visit_overlapping(area, &mut |mut bodies| {
            bodies.try_for_each(|index| {
                if self.bodies.shape(index).overlaps(area) && self.sees(index) {
                    return visit(self.bodies.slots.id(index));
                }
                ControlFlow::Continue(())
            })
        })
    }

    /// Appends the bodies near a point, as far as there is memory.
    fn list_sphere(
        &self,
        (center, radius): &([T; D], T),
        found: &mut Vec<ProxyId>,
    ) -> ControlFlow<()> {
        let (radius, sees_all) = (radius.to_f64(), self.sees_all());
        self.tree.visit_overlapping(&around(center, radius), &mut |bodies| {
            for index in bodies {
                let is_near = is_within(center, radius, self.bodies.shape(index));
                if is_near && (sees_all || self.sees(index)) {
                    push(found, self.bodies.slots.id(index))?;
                }
            }
            ControlFlow::Continue(())
        })
    }

    /// Whether a body is there, which the tree alone does not say, and not filtered out.
    pub(super) fn sees(&self, index: u32) -> bool {
        self.bodies.slots.has(index, flag::LIVE)
            && (self.bodies.rules.allow_all() && self.filter.is_none() || self.filter_sees(index))
            && self.predicate.is_none_or(|is_wanted| is_wanted(self.bodies.slots.id(index)))
    }

    /// Whether [`sees`](Self::sees) is true of every index, as it is where all bodies have the filter of the first and are there.
    fn sees_all(&self) -> bool {
        let Bodies { slots, rules, .. } = self.bodies;
        slots.live == slots.len()
            && slots.live > 0
            && rules.allow_all()
            && self.predicate.is_none()
            && self.filter_sees(0)
    }

    /// Whether a body is enabled, and the filter of the queries allows its own.
    #[inline]
    fn filter_sees(&self, index: u32) -> bool {
        let own = self.bodies.rules.filter_now(index);
        own.is_enabled && self.filter.is_none_or(|filter| filter.allows(own))
    }
}
