//! The observer of an algorithm at work, and why two boxes are apart.

use alloc::vec::Vec;

use crate::endpoint::{Edge, Endpoint};
use sweep_and_prune::{Aabb, Scalar};

/// Receives every operation of an algorithm. Each method does nothing unless it is overridden. `()`
/// observes nothing and costs nothing.
///
/// The words mean the same for every algorithm:
/// a *comparison* and a *swap* are the sort's; a *test* is one pair of boxes handed to the box
/// test; an *axis overlap* is a pair found to overlap on an axis that is swept; an *overlap* is a
/// pair that overlaps on every axis, which a narrow phase would receive. Every algorithm reports it
/// once a step for each pair. The two forms that sweep every axis need no box test.
///
/// The events are enough to draw an algorithm at work without knowing the algorithm:
/// [`Trace`](crate::Trace) records them, [`Player`](crate::Player) turns them back into a state.
/// A pair of observers is an observer: `&mut (counts, trace)`.
pub trait Observer {
    /// Whether the observer uses any event. If not, algorithms skip work that only it would see.
    const ACTIVE: bool = true;

    /// A step begins, along `axis`. If `keeps_axis_overlaps`, the axis overlaps of earlier steps are
    /// still valid, and only changes are reported (in the persistent swap-driven forms). Otherwise all
    /// of them are found and reported again.
    #[inline]
    fn step(&mut self, _axis: usize, _keeps_axis_overlaps: bool) {}

    /// This is now the array of endpoints on `axis`; the comparisons, swaps and visits that follow
    /// are of its positions, up to the next call.
    #[inline]
    fn array<T: Scalar>(&mut self, _axis: usize, _endpoints: &[Endpoint<T>]) {}

    /// The sort compared two endpoints.
    #[inline]
    fn compare(&mut self, _a: Edge, _b: Edge) {}

    /// The sort exchanged the endpoints at two positions of its array: `a`, which stood at
    /// `positions[0]`, is now at `positions[1]`, and `b` the other way round.
    #[inline]
    fn swap(&mut self, _positions: [usize; 2], _a: Edge, _b: Edge) {}

    /// The sweep line, or a scan, reached the endpoint at this position of the array.
    #[inline]
    fn visit(&mut self, _position: usize, _edge: Edge) {}

    /// The sweep reached a box.
    #[inline]
    fn enter(&mut self, _id: u32) {}

    /// The sweep left a box behind.
    #[inline]
    fn leave(&mut self, _id: u32) {}

    /// A scan ended early: these two are apart on the sweep axis, and so is every box that
    /// follows in the order, which is not tested.
    #[inline]
    fn prune(&mut self, _separation: Separation) {}

    /// A pair of boxes was tested; `separation` is the inequality that decided, if they are apart.
    #[inline]
    fn test(&mut self, _a: u32, _b: u32, _separation: Option<Separation>) {}

    /// Two boxes overlap on a swept axis, or begin to; the smaller index first.
    #[inline]
    fn axis_overlap(&mut self, _axis: usize, _a: u32, _b: u32) {}

    /// Two boxes that overlapped on a swept axis no longer do; the smaller index first.
    #[inline]
    fn axis_apart(&mut self, _axis: usize, _a: u32, _b: u32) {}

    /// Two boxes overlap on every axis: a pair, the smaller index first.
    #[inline]
    fn overlap(&mut self, _a: u32, _b: u32) {}

    /// A pair that did not overlap after the last step begins; the smaller index first.
    #[inline]
    fn begin(&mut self, _a: u32, _b: u32) {}

    /// A pair that overlapped after the last step ends; the smaller index first.
    #[inline]
    fn end(&mut self, _a: u32, _b: u32) {}
}

impl Observer for () {
    const ACTIVE: bool = false;
}

/// Methods that hand an event to both observers of a pair.
macro_rules! both {
    ($($method:ident($($argument:ident: $type:ty),*);)*) => {$(
        #[inline]
        fn $method(&mut self, $($argument: $type),*) {
            self.0.$method($($argument),*);
            self.1.$method($($argument),*);
        }
    )*};
}

/// Both observers receive every event, the first of the pair first.
impl<A: Observer, B: Observer> Observer for (A, B) {
    const ACTIVE: bool = A::ACTIVE || B::ACTIVE;

    #[inline]
    fn array<T: Scalar>(&mut self, axis: usize, endpoints: &[Endpoint<T>]) {
        self.0.array(axis, endpoints);
        self.1.array(axis, endpoints);
    }

    both! {
        step(axis: usize, keeps_axis_overlaps: bool);
        compare(a: Edge, b: Edge);
        swap(positions: [usize; 2], a: Edge, b: Edge);
        visit(position: usize, edge: Edge);
        enter(id: u32);
        leave(id: u32);
        prune(separation: Separation);
        test(a: u32, b: u32, separation: Option<Separation>);
        axis_overlap(axis: usize, a: u32, b: u32);
        axis_apart(axis: usize, a: u32, b: u32);
        overlap(a: u32, b: u32);
        begin(a: u32, b: u32);
        end(a: u32, b: u32);
    }
}

/// Why two boxes are apart: on `axis`, `left.max < right.min`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Separation {
    /// The axis that separates.
    pub axis: usize,
    /// The box that ends first.
    pub left: u32,
    /// The box that begins after that.
    pub right: u32,
}

impl Separation {
    /// The first axis that separates two of `boxes`, trying `first_axis`, then the ones after it,
    /// then those before; `None` if the two overlap.
    #[inline]
    pub(crate) fn find<const D: usize, T: Scalar>(
        boxes: &[Aabb<D, T>],
        a: u32,
        b: u32,
        first_axis: usize,
    ) -> Option<Self> {
        (first_axis..D).chain(0..first_axis).find_map(|axis| Self::on_axis(boxes, a, b, axis))
    }

    /// The first axis but `known_axis` that separates two of `boxes`, which are known to overlap on
    /// `known_axis`.
    #[inline]
    pub(crate) fn find_beside<const D: usize, T: Scalar>(
        boxes: &[Aabb<D, T>],
        a: u32,
        b: u32,
        known_axis: usize,
    ) -> Option<Self> {
        (known_axis + 1..D).chain(0..known_axis).find_map(|axis| Self::on_axis(boxes, a, b, axis))
    }

    /// How one axis separates two of `boxes`, if it does.
    #[inline]
    fn on_axis<const D: usize, T: Scalar>(
        boxes: &[Aabb<D, T>],
        a: u32,
        b: u32,
        axis: usize,
    ) -> Option<Self> {
        let (box_a, box_b) = (&boxes[a as usize], &boxes[b as usize]);
        if box_a.overlaps_on(axis, box_b) {
            None
        } else if box_a.max[axis] < box_b.min[axis] {
            Some(Self { axis, left: a, right: b })
        } else {
            Some(Self { axis, left: b, right: a })
        }
    }
}

/// Tests two boxes that overlap on `axis` on the other axes, and appends them if they are a pair.
pub(crate) fn test_beside<const D: usize, T: Scalar, O: Observer>(
    boxes: &[Aabb<D, T>],
    [a, b]: [u32; 2],
    axis: usize,
    observer: &mut O,
    pairs: &mut Vec<[u32; 2]>,
) {
    let [least, other] = pair(a, b);
    observer.axis_overlap(axis, least, other);
    let separation = Separation::find_beside(boxes, a, b, axis);
    observer.test(a, b, separation);
    if separation.is_none() {
        observer.overlap(least, other);
        pairs.push([least, other]);
    }
}

/// A pair as it is reported: the smaller index first.
#[inline]
pub(crate) fn pair(a: u32, b: u32) -> [u32; 2] {
    if a < b { [a, b] } else { [b, a] }
}
