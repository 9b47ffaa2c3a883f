//! Builds a tree from the top, and fits it to boxes that moved.

use alloc::vec::Vec;

use super::edit::{Building, Entry, Tree};
use super::node::{FAN, FILL, NONE, Node, finite, size};
use crate::float::greatest;
use crate::{Aabb, Scalar};

/// Sample size for measuring how bodies spread. 64 instead takes 0.99 to 1.03 of the time.
const SAMPLE: usize = 16;
/// The leaf of a body that is to be put into one.
const AWAITED: u32 = NONE - 1;
/// So few are divided by sorting them.
const FEW: usize = 16;
/// Sample size for measuring how large they are, at least but for small trees.
const SAMPLE_OF_SIDES: usize = 512;

/// How deep a step cuts, the first one, which also lists the bodies, and any other.
const CUTS_A_STEP: [u32; 2] = [1, 3];

impl<const D: usize, T: Scalar> Tree<D, T> {
    /// Builds the tree of these bodies: from scratch, or if a build has begun, from where it is. O(n log n) time.
    pub fn build(&mut self, bodies: impl Iterator<Item = u32> + Clone, boxes: &[Aabb<D, T>]) {
        let Building { ends, depth, .. } = self.building.take().unwrap_or_else(|| {
            let ends = sort_by_class(bodies.clone(), boxes, &mut self.entries);
            Building { ends, ..Building::default() }
        });
        self.nodes.clear();
        self.free.clear();
        self.leaves.clear();
        self.leaves.resize(boxes.len(), NONE);
        // What left since the build began has no place.
        bodies.clone().for_each(|body| self.leaves[body as usize] = AWAITED);
        let mut entries = core::mem::take(&mut self.entries);
        // Spare capacity for what moving bodies add, so that steady motion does not allocate.
        let leaves = entries.len().div_ceil(FILL);
        let nodes = leaves + leaves.div_ceil(FAN / 2);
        self.nodes.reserve(nodes + nodes / 2);
        self.free.reserve(nodes / 2);
        self.count = 0;
        let mut roots = Node::new(false);
        let mut start = 0;
        for end in ends {
            let entries = &mut entries[start..end];
            let cuts = Cuts { sides: mean_sides(entries, boxes), done: depth, depth: u32::MAX };
            if let Some((root, bounds)) =
                self.build_node(entries, boxes, &cuts, leaves_of(entries), 0)
            {
                roots.push(root, &bounds);
            }
            start = end;
        }
        self.entries = entries;
        self.root = match roots.count {
            0 => NONE,
            1 => roots.items[0],
            _ => self.add_inner(roots),
        };
        self.built = (self.leaf_size(), self.count);
        // What came since the build began.
        for body in bodies {
            if self.leaves[body as usize] == AWAITED {
                self.insert(body, &boxes[body as usize]);
            }
        }
    }

    /// Begins a build or takes it further, but makes no node. Returns whether what is left to do is to make the nodes.
    /// Meanwhile there may be other bodies and other boxes. O(n) time.
    pub fn prepare(
        &mut self,
        bodies: impl Iterator<Item = u32> + Clone,
        boxes: &[Aabb<D, T>],
    ) -> bool {
        let Self { building, entries, .. } = self;
        let building = building.get_or_insert_with(|| Building {
            ends: sort_by_class(bodies, boxes, entries),
            ..Building::default()
        });
        if building.is_cut {
            return true;
        }
        let depth = building.depth + CUTS_A_STEP[usize::from(building.depth > 0)];
        let (mut start, mut is_cut) = (0, true);
        for &end in &building.ends {
            let entries = &mut entries[start..end];
            let cuts = Cuts { sides: mean_sides(entries, boxes), done: building.depth, depth };
            let leaves = leaves_of(entries);
            is_cut &= cuts.cut_all(entries, leaves, capacity_of(leaves), 0);
            start = end;
        }
        (building.depth, building.is_cut) = (depth, is_cut);
        false
    }

    /// Whether a build has begun that is not done.
    #[cfg(test)]
    pub fn is_being_built(&self) -> bool {
        self.building.is_some()
    }

    /// Forgets a build that has begun.
    pub fn forget_build(&mut self) {
        self.building = None;
    }

    /// A node over bodies that go into `leaves` leaves, and its bounds, if one of them is still there. These are the
    /// entries after `depth` cuts.
    fn build_node(
        &mut self,
        entries: &mut [Entry<D, T>],
        boxes: &[Aabb<D, T>],
        cuts: &Cuts<D>,
        leaves: usize,
        depth: u32,
    ) -> Option<(u32, Aabb<D, T>)> {
        if leaves <= 1 {
            let mut leaf = Node::new(true);
            for &Entry { body, .. } in entries.iter() {
                if self.leaves[body as usize] == AWAITED {
                    leaf.push(body, &boxes[body as usize]);
                    self.leaves[body as usize] = self.nodes.len() as u32;
                }
            }
            if leaf.count == 0 {
                return None;
            }
            self.count += leaf.count;
            self.nodes.push(leaf);
            return Some(((self.nodes.len() - 1) as u32, leaf.bounds()));
        }
        let capacity = capacity_of(leaves);
        let mut inner = Node::new(false);
        inner.has_leaves = capacity == 1;
        self.build_children(entries, boxes, cuts, [leaves, capacity], depth, &mut inner);
        (inner.count > 0).then(|| (self.add_inner(inner), inner.bounds()))
    }

    /// Cuts bodies in two until what is left goes into a child of `capacity` leaves.
    fn build_children(
        &mut self,
        entries: &mut [Entry<D, T>],
        boxes: &[Aabb<D, T>],
        cuts: &Cuts<D>,
        [leaves, capacity]: [usize; 2],
        depth: u32,
        inner: &mut Node<D, T>,
    ) {
        if leaves <= capacity {
            if let Some((child, bounds)) = self.build_node(entries, boxes, cuts, leaves, depth) {
                inner.push(child, &bounds);
            }
            return;
        }
        let (low, high, left) = cuts.cut(entries, leaves, capacity, depth);
        self.build_children(low, boxes, cuts, [left, capacity], depth + 1, inner);
        self.build_children(high, boxes, cuts, [leaves - left, capacity], depth + 1, inner);
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

/// How entries are cut in two again and again.
struct Cuts<const D: usize> {
    /// The mean side of the boxes on each axis.
    sides: [f64; D],
    /// How deep they are cut already, and how deep they are to be cut.
    done: u32,
    depth: u32,
}

impl<const D: usize> Cuts<D> {
    /// The two parts of entries that go into `leaves` leaves below children of `capacity` leaves, and how many leaves
    /// the first part takes.
    fn cut<'a, T: Scalar>(
        &self,
        entries: &'a mut [Entry<D, T>],
        leaves: usize,
        capacity: usize,
        depth: u32,
    ) -> (&'a mut [Entry<D, T>], &'a mut [Entry<D, T>], usize) {
        let count = leaves.div_ceil(capacity);
        let left = (leaves * (count / 2)).div_ceil(count);
        // The product of two counts, which 32 bits do not hold.
        let middle = (entries.len() as u64 * left as u64 / leaves as u64) as usize;
        if depth >= self.done {
            let axis = widest_axis(entries, &self.sides);
            divide(entries, middle, axis);
        }
        let (low, high) = entries.split_at_mut(middle);
        (low, high, left)
    }

    /// Cuts entries. Returns whether they are cut to the bottom.
    fn cut_all<T: Scalar>(
        &self,
        entries: &mut [Entry<D, T>],
        leaves: usize,
        mut capacity: usize,
        depth: u32,
    ) -> bool {
        if leaves <= 1 {
            return true;
        }
        if depth == self.depth {
            return false;
        }
        if leaves <= capacity {
            capacity = capacity_of(leaves);
        }
        let (low, high, left) = self.cut(entries, leaves, capacity, depth);
        let is_low_cut = self.cut_all(low, left, capacity, depth + 1);
        self.cut_all(high, leaves - left, capacity, depth + 1) && is_low_cut
    }
}

/// Reorders entries so that no center of the first `count` is greater on an axis than one of the others: parts are divided
/// at the mean of a sample (quickselect). A selection of the standard library takes four times the code. O(n) time where centers are
/// spread; in the worst case, centers of all magnitudes, for each magnitude.
#[inline(never)]
fn divide<const D: usize, T: Scalar>(
    mut entries: &mut [Entry<D, T>],
    mut count: usize,
    axis: usize,
) {
    while count > 0 && count < entries.len() {
        if entries.len() <= FEW {
            for end in 1..entries.len() {
                let entry = entries[end];
                let mut at = end;
                while at > 0 && entry.center[axis] < entries[at - 1].center[axis] {
                    entries[at] = entries[at - 1];
                    at -= 1;
                }
                entries[at] = entry;
            }
            return;
        }
        let mut pivot = sample_mean(entries, axis);
        let low = loop {
            let mut low = 0;
            // Without a branch: which entries are low is unpredictable.
            for at in 0..entries.len() {
                let is_low = entries[at].center[axis] < pivot;
                entries.swap(low, at);
                low += usize::from(is_low);
            }
            if low > 0 && low < entries.len() {
                break low;
            }
            // The sample misleads: between the least and the greatest there is something on both sides.
            let (mut least, mut greatest) = (T::INFINITY, T::NEG_INFINITY);
            for entry in &*entries {
                let center = entry.center[axis];
                least = if center < least { center } else { least };
                greatest = if center > greatest { center } else { greatest };
            }
            pivot = T::from_f64(least.to_f64() / 2.0 + greatest.to_f64() / 2.0);
            // Rounded, the middle may be the least; that of infinities is NaN.
            let is_between = least < pivot && pivot <= greatest;
            if !is_between {
                pivot = greatest;
            }
            if pivot <= least {
                return;
            }
        };
        if count < low {
            entries = &mut entries[..low];
        } else {
            entries = &mut entries[low..];
            count -= low;
        }
    }
}

/// The mean center of a sample.
fn sample_mean<const D: usize, T: Scalar>(entries: &[Entry<D, T>], axis: usize) -> T {
    let size = if entries.len() < 4 * SAMPLE { SAMPLE / 4 } else { SAMPLE };
    let sample = entries.iter().step_by(entries.len().div_ceil(size));
    let (sum, count) = sample
        .fold((0.0, 0.0), |(sum, count), entry| (sum + entry.center[axis].to_f64(), count + 1.0));
    T::from_f64(sum / count)
}

/// How many leaves entries go into.
fn leaves_of<E>(entries: &[E]) -> usize {
    entries.len().div_ceil(FILL)
}

/// How many leaves each child of a node over `leaves` of them holds: as many as make it full to the bottom, so that
/// there are as few children as can be.
#[inline(never)]
fn capacity_of(leaves: usize) -> usize {
    let mut capacity = 1;
    while capacity * FAN < leaves {
        capacity *= FAN;
    }
    capacity
}

/// How many size classes there are.
const CLASSES: usize = 2048 / 3 + 1;

/// Lists bodies by size class, and within a class in the order given. Returns where each class that there is ends; where
/// there are more than a node can hold, the last one holds the others, and where there are fewer, the last ones are empty.
fn sort_by_class<const D: usize, T: Scalar>(
    bodies: impl Iterator<Item = u32> + Clone,
    boxes: &[Aabb<D, T>],
    entries: &mut Vec<Entry<D, T>>,
) -> [usize; FAN] {
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
    let (mut parts, mut last, mut found) = ([entries.len(); FAN], 0, 0);
    for end in ends {
        if end > last && found < FAN - 1 {
            parts[found] = end as usize;
            found += 1;
        }
        last = end;
    }
    parts
}

/// Sizes that differ by less than a factor of 8 on the longest axis are of one class, or of two
/// neighboring ones.
fn size_class<const D: usize, T: Scalar>(aabb: &Aabb<D, T>) -> usize {
    let longest = greatest((0..D).map(|axis| finite(aabb.max[axis]) - finite(aabb.min[axis])));
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
    let mut count = 0.0;
    for entry in entries.iter().step_by(entries.len() / SAMPLE_OF_SIDES + 1) {
        let aabb = &boxes[entry.body as usize];
        count += 1.0;
        for (axis, side) in sides.iter_mut().enumerate() {
            *side += finite(aabb.max[axis]) - finite(aabb.min[axis]);
        }
    }
    sides.map(|side| side / count)
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
