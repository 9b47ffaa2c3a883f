//! Queries: what overlaps a box, a point or a sphere, what a ray or a moving box hits, what is
//! nearest.
//!
//! Each query is a [`Search`] of the tree: a lower bound for all bodies in a box, by which whole
//! parts of the world are passed over, and the same formula for one body. Formulas are in `f64` and made of
//! operations that round monotonically, so what holds a body is never farther than the body.

mod cast;
mod lists;
mod nearest;

use alloc::vec::Vec;
use core::ops::ControlFlow;

use super::BroadPhase;
use super::filter::Filter;
use super::proxy::{ProxyId, flag};
use super::tree::Search;
use crate::{Aabb, Error, Scalar};
pub use cast::{Cast, Hit};
pub use lists::Lists;
pub use nearest::Neighbour;

/// The questions that a world answers; see [`BroadPhase::queries`].
///
/// They see the boxes as last given, updated or not, and all bodies unless they get a
/// [filter](Self::with_filter). Lists are sorted by id, and equally near
/// bodies too, so every answer follows from the state alone.
#[derive(Clone, Copy, Debug)]
pub struct Queries<'w, const D: usize, T: Scalar = f32> {
    world: &'w BroadPhase<D, T>,
    filter: Option<Filter>,
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
        Queries { world: self, filter: None }
    }
}

impl<const D: usize, T: Scalar> Queries<'_, D, T> {
    /// The same queries by a body of this filter: they find what it may pair with.
    pub fn with_filter(self, filter: Filter) -> Self {
        Self { filter: Some(filter), ..self }
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
        let is_number = |at: T| at <= T::INFINITY && at >= T::NEG_INFINITY;
        check_each(points, |point| fault_in("point", point, is_number))?;
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
        check_each(spheres, |(center, radius)| {
            fault_in("center", center, is_finite).or(fault_in("radius", &[*radius], is_length))
        })?;
        let bound = |sphere: &([T; D], T), bounds: &Aabb<D, T>| {
            is_within(&sphere.0, sphere.1.to_f64(), bounds)
        };
        Ok(self.collect(spheres, bound))
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

    /// Whether a body is there, which the tree alone does not say, and not filtered out.
    fn sees(&self, seat: u32) -> bool {
        self.world.slots.has(seat, flag::LIVE)
            && self.filter.is_none_or(|filter| filter.allows(&self.world.filters[seat as usize]))
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

fn is_finite<T: Scalar>(value: T) -> bool {
    value > T::NEG_INFINITY && value < T::INFINITY
}

fn is_length<T: Scalar>(value: T) -> bool {
    value >= T::default()
}

/// The name of an argument of a query and its first value that is not valid.
type Fault = Option<(&'static str, f64)>;

fn fault_in<T: Scalar>(
    argument: &'static str,
    values: &[T],
    is_valid: impl Fn(T) -> bool,
) -> Fault {
    let value = values.iter().find(|&&value| !is_valid(value))?;
    Some((argument, value.to_f64()))
}

/// Refuses the first query with a fault.
fn check_each<Q>(queries: &[Q], fault: impl Fn(&Q) -> Fault) -> Result<(), Error> {
    for (index, query) in queries.iter().enumerate() {
        if let Some((argument, value)) = fault(query) {
            return Err(Error::InvalidQuery { index, argument, value: value.into() });
        }
    }
    Ok(())
}

/// From a point to a box on one axis.
#[inline]
fn gap<const D: usize, T: Scalar>(point: &[T; D], aabb: &Aabb<D, T>, axis: usize) -> f64 {
    let at = point[axis].to_f64();
    (aabb.min[axis].to_f64() - at).max(at - aabb.max[axis].to_f64()).max(0.0)
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
