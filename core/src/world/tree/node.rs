//! A node: a few boxes, axis by axis.

use core::hint::black_box;

use crate::{Aabb, Scalar};

// The constants of the tree and of `bodies/table.rs` were measured in pairs on the motions of `scenes/` in 2D
// and 3D at 1,000 and 10,000 bodies (one core of an Intel Xeon at 2.6 GHz, November 2026).

/// No node, no body.
pub const NONE: u32 = u32::MAX;
/// Boxes a node holds at most.
pub const FAN: usize = 16;
/// Bodies a leaf is built with, which leaves spare capacity. With 8 or 16, drift takes 1.02 to 1.05.
pub const FILL: usize = 12;
/// A leaf with fewer is given up. 6 instead takes 0.98 to 1.01 of the time.
pub const LEAST: usize = 3;

/// Up to 16 boxes, each of a child node or of a body.
#[derive(Copy, Debug)]
#[repr(align(64))]
pub struct Node<const D: usize, T> {
    /// By axis and lane; a lane without a box has what changes no bounds.
    pub min: [[T; FAN]; D],
    pub max: [[T; FAN]; D],
    /// Bodies in a leaf, else nodes.
    pub items: [u32; FAN],
    pub count: usize,
    pub parent: u32,
    pub is_leaf: bool,
    /// Whether the items are leaves.
    pub has_leaves: bool,
}

// Not derived, as that of boxes.
impl<const D: usize, T: Copy> Clone for Node<D, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<const D: usize, T: Scalar> Node<D, T> {
    pub fn new(is_leaf: bool) -> Self {
        Self {
            min: [[T::INFINITY; FAN]; D],
            max: [[T::NEG_INFINITY; FAN]; D],
            items: [NONE; FAN],
            count: 0,
            parent: NONE,
            is_leaf,
            has_leaves: false,
        }
    }

    #[inline]
    pub fn aabb(&self, lane: usize) -> Aabb<D, T> {
        Aabb::new(
            core::array::from_fn(|axis| self.min[axis][lane]),
            core::array::from_fn(|axis| self.max[axis][lane]),
        )
    }

    #[inline]
    pub fn set_aabb(&mut self, lane: usize, aabb: &Aabb<D, T>) {
        for axis in 0..D {
            self.min[axis][lane] = aabb.min[axis];
            self.max[axis][lane] = aabb.max[axis];
        }
    }

    pub fn push(&mut self, item: u32, aabb: &Aabb<D, T>) {
        self.items[self.count] = item;
        self.set_aabb(self.count, aabb);
        self.count += 1;
    }

    pub fn swap_remove(&mut self, lane: usize) {
        self.count -= 1;
        let last = self.aabb(self.count);
        self.set_aabb(lane, &last);
        self.items[lane] = self.items[self.count];
        let nothing = Aabb::new([T::INFINITY; D], [T::NEG_INFINITY; D]);
        self.set_aabb(self.count, &nothing);
    }

    /// Where an item is that is there.
    #[inline]
    pub fn lane_of(&self, item: u32) -> usize {
        let is_at = |lane: usize| u32::from(self.items[lane] == item).wrapping_neg();
        let bits = (0..FAN).fold(0, |bits, lane| bits | is_at(lane) & BITS[lane]);
        (bits & ((1 << self.count) - 1)).trailing_zeros() as usize % FAN
    }

    /// Prefetches it.
    #[inline]
    pub fn prefetch(&self) {
        for axis in 0..D {
            black_box(self.min[axis][0]);
            black_box(self.max[axis][0]);
        }
        black_box(self.items[0]);
        black_box(self.count);
    }

    /// The smallest box that holds all.
    #[inline(never)]
    pub fn bounds(&self) -> Aabb<D, T> {
        Aabb::new(
            core::array::from_fn(|axis| best(self.min[axis], |a, b| if b < a { b } else { a })),
            core::array::from_fn(|axis| best(self.max[axis], |a, b| if b > a { b } else { a })),
        )
    }

    /// The box that has to grow least to take in another; of several the smallest.
    pub fn cheapest(&self, aabb: &Aabb<D, T>) -> usize {
        let (mut growth, mut before) = ([T::default(); FAN], [T::default(); FAN]);
        for axis in 0..D {
            let (min, max) = (aabb.min[axis], aabb.max[axis]);
            for lane in 0..FAN {
                let (low, high) = (self.min[axis][lane], self.max[axis][lane]);
                let (down, up) = (low - min, max - high);
                let zero = T::default();
                let grown = if down > zero { down } else { zero };
                growth[lane] = growth[lane] + grown + if up > zero { up } else { zero };
                before[lane] = before[lane] + (high - low);
            }
        }
        // With infinite boxes some of these are NaN, which is never less.
        (1..self.count).fold(0, |best, lane| {
            let is_less = growth[lane] < growth[best]
                || growth[lane] == growth[best] && before[lane] < before[best];
            if is_less { lane } else { best }
        })
    }

    /// The items of which the bits are set.
    #[inline]
    pub fn items_of(&self, bits: u32) -> Items<'_> {
        Items { items: &self.items, bits }
    }

    /// A bit for each box that overlaps `area`. Written so that compilers test several at once.
    #[inline(never)]
    pub fn overlapping(&self, area: &Aabb<D, T>) -> u32 {
        let mut apart = [0u32; FAN];
        for axis in 0..D {
            let (min, max) = (&self.min[axis], &self.max[axis]);
            for lane in 0..FAN {
                let is_apart = (min[lane] > area.max[axis]) | (area.min[axis] > max[lane]);
                apart[lane] |= u32::from(is_apart).wrapping_neg();
            }
        }
        let bits = (0..FAN).fold(0, |bits, lane| bits | apart[lane] & BITS[lane]);
        !bits & ((1 << self.count) - 1)
    }
}

/// Some items of a node, by their bits.
pub struct Items<'a> {
    items: &'a [u32; FAN],
    bits: u32,
}

impl Iterator for Items<'_> {
    type Item = u32;

    #[inline]
    fn next(&mut self) -> Option<u32> {
        if self.bits == 0 {
            return None;
        }
        let lane = self.bits.trailing_zeros() as usize;
        self.bits &= self.bits - 1;
        Some(self.items[lane])
    }
}

/// The best of all lanes, by halves, so that compilers compare several at once.
#[inline]
fn best<T: Copy>(mut lanes: [T; FAN], better: impl Fn(T, T) -> T) -> T {
    let mut half = FAN;
    while half > 1 {
        half /= 2;
        for lane in 0..half {
            lanes[lane] = better(lanes[lane], lanes[lane + half]);
        }
    }
    lanes[0]
}

/// By lane, its bit.
const BITS: [u32; FAN] = {
    let mut bits = [0; FAN];
    let mut lane = 0;
    while lane < FAN {
        bits[lane] = 1 << lane;
        lane += 1;
    }
    bits
};

impl<const D: usize, T: Scalar> Aabb<D, T> {
    /// The center on an axis, doubled and kept finite: to sort by.
    pub fn doubled_center(&self, axis: usize) -> f64 {
        finite(self.min[axis]) + finite(self.max[axis])
    }
}

pub fn finite<T: Scalar>(at: T) -> f64 {
    at.to_f64().clamp(-1e300, 1e300)
}

/// Half the perimeter, in proportion to which a box is met by chance. Finite.
pub fn size<const D: usize, T: Scalar>(aabb: &Aabb<D, T>) -> f64 {
    (0..D).map(|axis| finite(aabb.max[axis]) - finite(aabb.min[axis])).sum()
}

/// Sorts by keys that are not NaN, and then by number, by insertion: few, as a node has boxes. Each type that the standard
/// library sorts takes a kilobyte of a WebAssembly file.
#[inline(never)]
pub fn sort_few(parts: &mut [(f64, usize)]) {
    for end in 1..parts.len() {
        let part = parts[end];
        let mut at = end;
        while at > 0 && part < parts[at - 1] {
            parts[at] = parts[at - 1];
            at -= 1;
        }
        parts[at] = part;
    }
}

/// Divides a full node's boxes and one more in two halves: in the order of an axis or of size,
/// whichever makes the smallest halves.
pub fn split<const D: usize, T: Scalar>(
    node: &Node<D, T>,
    item: u32,
    aabb: &Aabb<D, T>,
) -> (Node<D, T>, Node<D, T>) {
    let mut entries = [(item, *aabb); FAN + 1];
    for (lane, entry) in entries[..FAN].iter_mut().enumerate() {
        *entry = (node.items[lane], node.aabb(lane));
    }
    let halves = |order: usize| {
        let key =
            |aabb: &Aabb<D, T>| if order < D { aabb.doubled_center(order) } else { size(aabb) };
        let mut sorted: [_; FAN + 1] = core::array::from_fn(|at| (key(&entries[at].1), at));
        sort_few(&mut sorted);
        let half = Node { has_leaves: node.has_leaves, ..Node::new(node.is_leaf) };
        let mut halves = (half, half);
        for (index, &(_, at)) in sorted.iter().enumerate() {
            let half = if index < FAN.div_ceil(2) { &mut halves.0 } else { &mut halves.1 };
            half.push(entries[at].0, &entries[at].1);
        }
        halves
    };
    let cost =
        |halves: &(Node<D, T>, Node<D, T>)| size(&halves.0.bounds()) + size(&halves.1.bounds());
    (1..=D).map(halves).fold(
        halves(0),
        |best, other| {
            if cost(&other) < cost(&best) { other } else { best }
        },
    )
}
