//! Who watches an algorithm at work, and the simplest watcher, which counts.

use super::endpoint::Edge;
use crate::{Aabb, Scalar};

/// Sees every step of an algorithm. Each method does nothing unless it is overridden, and `()`
/// watches nothing and costs nothing.
///
/// The words mean the same for every algorithm:
/// a *comparison* and a *swap* are the sort's; a *test* is one pair of boxes handed to the box
/// test; an *axis overlap* is a pair found to overlap on an axis that is swept; an *overlap* is a
/// pair that overlaps on every axis.
pub trait Observer {
    /// Whether anyone is watching. Algorithms skip work that only an observer would see.
    const ACTIVE: bool = true;

    /// The sort compared two endpoints.
    #[inline]
    fn compare(&mut self, _a: Edge, _b: Edge) {}

    /// The sort exchanged the endpoints at two positions of its array: `a`, which stood at
    /// `positions[0]`, is now at `positions[1]`, and `b` the other way round.
    #[inline]
    fn swap(&mut self, _positions: [usize; 2], _a: Edge, _b: Edge) {}

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

    /// Two boxes overlap on a swept axis.
    #[inline]
    fn axis_overlap(&mut self, _axis: usize, _a: u32, _b: u32) {}

    /// Two boxes overlap on every axis: a pair, the smaller index first.
    #[inline]
    fn overlap(&mut self, _a: u32, _b: u32) {}
}

impl Observer for () {
    const ACTIVE: bool = false;
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
    pub fn find<const D: usize, T: Scalar>(
        boxes: &[Aabb<D, T>],
        a: u32,
        b: u32,
        first_axis: usize,
    ) -> Option<Self> {
        (first_axis..D).chain(0..first_axis).find_map(|axis| Self::on_axis(boxes, a, b, axis))
    }

    /// How one axis separates two of `boxes`, if it does.
    #[inline]
    pub fn on_axis<const D: usize, T: Scalar>(
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

/// An observer that counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Comparisons of the sort.
    pub comparisons: u64,
    /// Swaps of the sort.
    pub swaps: u64,
    /// Pairs of boxes handed to the box test.
    pub tests: u64,
    /// Pairs found to overlap on a swept axis.
    pub axis_overlaps: u64,
    /// Pairs that overlap on every axis.
    pub pairs: u64,
}

impl Observer for Counts {
    #[inline]
    fn compare(&mut self, _: Edge, _: Edge) {
        self.comparisons += 1;
    }

    #[inline]
    fn swap(&mut self, _: [usize; 2], _: Edge, _: Edge) {
        self.swaps += 1;
    }

    #[inline]
    fn test(&mut self, _: u32, _: u32, _: Option<Separation>) {
        self.tests += 1;
    }

    #[inline]
    fn axis_overlap(&mut self, _: usize, _: u32, _: u32) {
        self.axis_overlaps += 1;
    }

    #[inline]
    fn overlap(&mut self, _: u32, _: u32) {
        self.pairs += 1;
    }
}
