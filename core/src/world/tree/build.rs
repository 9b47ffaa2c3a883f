//! Builds a tree from the top, and fits it to boxes that moved.

use alloc::vec::Vec;

use super::edit::{Entry, Tree};
use super::node::{FAN, FILL, NONE, Node, finite, size};
use crate::sampling::positions;
use crate::{Aabb, Scalar};

/// Sample size for measuring how bodies spread. 64 instead takes 0.99 to 1.03 of the time.
const SAMPLE: usize = 16;
/// Sample size for measuring how large they are.
const SAMPLE_OF_SIDES: usize = 512;

impl<const D: usize, T: Scalar> Tree<D, T> {
    /// Builds the tree from scratch of these bodies. O(n log n) time.
    pub fn build(&mut self, bodies: impl Iterator<Item = u32> + Clone, boxes: &[Aabb<D, T>]) {
        self.nodes.clear();
        self.free.clear();
        self.leaves.clear();
        self.leaves.resize(boxes.len(), NONE);
        let mut entries = core::mem::take(&mut self.entries);
        let ends = sort_by_class(bodies, boxes, &mut entries);
        self.count = entries.len();
        // Spare capacity for what moving bodies add, so that steady motion does not allocate.
        let leaves = self.count.div_ceil(FILL);
        let nodes = leaves + leaves.div_ceil(FAN / 2);
        self.nodes.reserve(nodes + nodes / 2);
        self.free.reserve(nodes / 2);
        let mut roots = Node::new(false);
        let mut start = 0;
        for end in ends {
            // Where there are more classes than a node can hold, the last holds the others.
            let end = if roots.count == FAN - 1 { entries.len() } else { end as usize };
            if end <= start {
                continue;
            }
            let leaves = (end - start).div_ceil(FILL);
            let entries = &mut entries[start..end];
            let sides = mean_sides(entries, boxes);
            let (root, bounds) = self.build_node(entries, boxes, &sides, leaves);
            roots.push(root, &bounds);
            start = end;
        }
        self.entries = entries;
        self.root = match roots.count {
            0 => NONE,
            1 => roots.items[0],
            _ => self.add_inner(roots),
        };
        self.built = (self.leaf_size(), self.count);
    }

    /// A node over bodies that go into `leaves` leaves, and its bounds.
    fn build_node(
        &mut self,
        entries: &mut [Entry<D, T>],
        boxes: &[Aabb<D, T>],
        sides: &[f64; D],
        leaves: usize,
    ) -> (u32, Aabb<D, T>) {
        if leaves <= 1 {
            let mut leaf = Node::new(true);
            for &Entry { body, .. } in entries.iter() {
                leaf.push(body, &boxes[body as usize]);
                self.leaves[body as usize] = self.nodes.len() as u32;
            }
            self.nodes.push(leaf);
            return ((self.nodes.len() - 1) as u32, leaf.bounds());
        }
        // As few children as hold the leaves when they are full to the bottom.
        let mut capacity = 1;
        while capacity * FAN < leaves {
            capacity *= FAN;
        }
        let mut inner = Node::new(false);
        inner.has_leaves = capacity == 1;
        self.build_children(entries, boxes, sides, leaves, capacity, &mut inner);
        (self.add_inner(inner), inner.bounds())
    }

    /// Cuts bodies in two until what is left goes into a child of `capacity` leaves.
    fn build_children(
        &mut self,
        entries: &mut [Entry<D, T>],
        boxes: &[Aabb<D, T>],
        sides: &[f64; D],
        leaves: usize,
        capacity: usize,
        inner: &mut Node<D, T>,
    ) {
        let count = leaves.div_ceil(capacity);
        if count <= 1 {
            let (child, bounds) = self.build_node(entries, boxes, sides, leaves);
            inner.push(child, &bounds);
            return;
        }
        let left = (leaves * (count / 2)).div_ceil(count);
        // The product of two counts, which 32 bits do not hold.
        let middle = (entries.len() as u64 * left as u64 / leaves as u64) as usize;
        let axis = widest_axis(entries, sides);
        entries.select_nth_unstable_by(middle, |a, b| a.center[axis].order(b.center[axis]));
        let (low, high) = entries.split_at_mut(middle);
        self.build_children(low, boxes, sides, left, capacity, inner);
        self.build_children(high, boxes, sides, leaves - left, capacity, inner);
    }

    /// Takes over new boxes of all bodies. Returns how many times as large as when built the
    /// leaves are in the mean. O(n) time.
    pub fn refit(&mut self, boxes: &[Aabb<D, T>]) -> f64 {
        if self.root != NONE {
            self.refit_node(self.root, boxes);
        }
        let (size, count) = self.built;
        let (size, now) = (size / count as f64, self.leaf_size() / self.count as f64);
        if now > size { now / size } else { 1.0 }
    }

    fn refit_node(&mut self, index: u32, boxes: &[Aabb<D, T>]) -> Aabb<D, T> {
        for lane in 0..self.nodes[index as usize].count {
            let node = &self.nodes[index as usize];
            let item = node.items[lane];
            let aabb =
                if node.is_leaf { boxes[item as usize] } else { self.refit_node(item, boxes) };
            self.nodes[index as usize].set_aabb(lane, &aabb);
        }
        self.nodes[index as usize].bounds()
    }

    /// The sum of the sizes of the leaves.
    fn leaf_size(&self) -> f64 {
        let leaves = self.nodes.iter().filter(|node| node.is_leaf && node.count > 0);
        leaves.map(|leaf| size(&leaf.bounds())).sum()
    }
}

/// How many size classes there are.
const CLASSES: usize = 2048 / 3 + 1;

/// Lists bodies by size class, and within a class in the order given. Returns by class where it ends.
fn sort_by_class<const D: usize, T: Scalar>(
    bodies: impl Iterator<Item = u32> + Clone,
    boxes: &[Aabb<D, T>],
    entries: &mut Vec<Entry<D, T>>,
) -> [u32; CLASSES] {
    let class = |body: u32| size_class(&boxes[body as usize]);
    let mut ends = [0; CLASSES];
    bodies.clone().for_each(|body| ends[class(body)] += 1);
    let mut count = 0;
    for end in &mut ends {
        // Where the class begins, until its bodies are listed.
        count += core::mem::replace(end, count);
    }
    entries.clear();
    entries.resize(count as usize, Entry { center: [T::default(); D], body: NONE });
    for body in bodies {
        let (aabb, at) = (&boxes[body as usize], &mut ends[class(body)]);
        let center = core::array::from_fn(|axis| T::from_f64(aabb.doubled_center(axis) / 2.0));
        entries[*at as usize] = Entry { center, body };
        *at += 1;
    }
    ends
}

/// Sizes that differ by less than a factor of 8 on the longest axis are of one class, or of two
/// neighboring ones.
fn size_class<const D: usize, T: Scalar>(aabb: &Aabb<D, T>) -> usize {
    let longest =
        (0..D).map(|axis| finite(aabb.max[axis]) - finite(aabb.min[axis])).fold(0.0, f64::max);
    // The exponent, in threes; larger first, so that the many small classes come last.
    let exponent = (longest.to_bits() >> 52) as usize;
    2047 / 3 - exponent / 3
}

/// The mean side on each axis, by a sample.
fn mean_sides<const D: usize, T: Scalar>(
    entries: &[Entry<D, T>],
    boxes: &[Aabb<D, T>],
) -> [f64; D] {
    let mut sides = [0.0; D];
    for at in positions(entries.len(), SAMPLE_OF_SIDES) {
        let aabb = &boxes[entries[at].body as usize];
        for (axis, side) in sides.iter_mut().enumerate() {
            *side += finite(aabb.max[axis]) - finite(aabb.min[axis]);
        }
    }
    sides.map(|side| side / entries.len().min(SAMPLE_OF_SIDES) as f64)
}

/// The axis on which the centers spread most for the size of the boxes, by a sample.
fn widest_axis<const D: usize, T: Scalar>(entries: &[Entry<D, T>], sides: &[f64; D]) -> usize {
    let (mut low, mut high) = ([T::INFINITY; D], [T::NEG_INFINITY; D]);
    for entry in entries.iter().step_by(entries.len().div_ceil(SAMPLE)) {
        for axis in 0..D {
            let center = entry.center[axis];
            low[axis] = if center < low[axis] { center } else { low[axis] };
            high[axis] = if center > high[axis] { center } else { high[axis] };
        }
    }
    let mut best = (0, -1.0, 0.0);
    for axis in 0..D {
        let spread = high[axis].to_f64() - low[axis].to_f64();
        let ratio = if spread > 0.0 { spread / sides[axis] } else { 0.0 };
        if ratio > best.1 || ratio == best.1 && spread > best.2 {
            best = (axis, ratio, spread);
        }
    }
    best.0
}
