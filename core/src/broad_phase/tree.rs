//! A tree of boxes: what one body's box overlaps, and what a query looks for.
//!
//! An R-tree (Guttman 1984) of 16 boxes a node, held axis by axis so that the compiler tests
//! several at once. Built from the top by cutting in the middle, along the axis on which the
//! centres spread most for the size of the boxes; bodies that are far larger than others go into
//! trees of their own under one root, so that a giant does not widen the node of a dwarf.

use alloc::vec::Vec;
use core::ops::ControlFlow;

use super::options::{contains, hull};
use crate::{Aabb, Scalar};

const NONE: u32 = u32::MAX;
/// Boxes a node holds at most.
const FAN: usize = 16;
/// Bodies a leaf is built with, which leaves room for more.
const FILL: usize = 12;
/// A leaf with fewer is given up.
const LEAST: usize = 3;

/// What a query looks for.
pub(super) trait Search<const D: usize, T> {
    /// How near the nearest body in `bounds` may be; `None` if none in there can matter.
    fn bound(&self, bounds: &Aabb<D, T>) -> Option<f64>;

    /// Looks at the body in a seat.
    fn visit(&mut self, seat: u32) -> ControlFlow<()>;
}

/// Up to 16 boxes, each of a child node or of a body.
#[derive(Clone, Copy, Debug)]
struct Node<const D: usize, T> {
    min: [[T; FAN]; D],
    max: [[T; FAN]; D],
    /// Seats in a leaf, else nodes.
    items: [u32; FAN],
    count: usize,
    parent: u32,
    is_leaf: bool,
}

impl<const D: usize, T: Scalar> Node<D, T> {
    fn new(is_leaf: bool) -> Self {
        let nothing = [[T::default(); FAN]; D];
        Self { min: nothing, max: nothing, items: [NONE; FAN], count: 0, parent: NONE, is_leaf }
    }

    #[inline]
    fn aabb(&self, lane: usize) -> Aabb<D, T> {
        Aabb::new(
            core::array::from_fn(|axis| self.min[axis][lane]),
            core::array::from_fn(|axis| self.max[axis][lane]),
        )
    }

    #[inline]
    fn set_aabb(&mut self, lane: usize, aabb: &Aabb<D, T>) {
        for axis in 0..D {
            self.min[axis][lane] = aabb.min[axis];
            self.max[axis][lane] = aabb.max[axis];
        }
    }

    fn push(&mut self, item: u32, aabb: &Aabb<D, T>) {
        self.items[self.count] = item;
        self.set_aabb(self.count, aabb);
        self.count += 1;
    }

    fn swap_remove(&mut self, lane: usize) {
        self.count -= 1;
        let last = self.aabb(self.count);
        self.set_aabb(lane, &last);
        self.items[lane] = self.items[self.count];
    }

    #[inline]
    fn lane_of(&self, item: u32) -> usize {
        (0..self.count).find(|&lane| self.items[lane] == item).unwrap_or(0)
    }

    /// The smallest box that holds all.
    #[inline]
    fn bounds(&self) -> Aabb<D, T> {
        let mut bounds = self.aabb(0);
        for axis in 0..D {
            let (mut least, mut most) = (bounds.min[axis], bounds.max[axis]);
            for &min in &self.min[axis][..self.count] {
                least = if min < least { min } else { least };
            }
            for &max in &self.max[axis][..self.count] {
                most = if max > most { max } else { most };
            }
            (bounds.min[axis], bounds.max[axis]) = (least, most);
        }
        bounds
    }

    /// The box that has to grow least to take in another; of several the smallest.
    fn cheapest(&self, aabb: &Aabb<D, T>) -> usize {
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

    /// A bit for each box that overlaps `area`.
    #[inline]
    fn overlapping(&self, area: &Aabb<D, T>) -> u32 {
        let mut overlap = [true; FAN];
        for axis in 0..D {
            let (min, max) = (&self.min[axis], &self.max[axis]);
            for lane in 0..FAN {
                overlap[lane] &= (min[lane] <= area.max[axis]) & (area.min[axis] <= max[lane]);
            }
        }
        let bits = (0..FAN).fold(0, |bits, lane| bits | u32::from(overlap[lane]) << lane);
        bits & ((1 << self.count) - 1)
    }
}

/// The tree, by seats. Bodies' boxes may be larger than the bodies.
#[derive(Clone, Debug)]
pub(super) struct Tree<const D: usize, T> {
    nodes: Vec<Node<D, T>>,
    free: Vec<u32>,
    root: u32,
    /// By seat, its leaf.
    leaves: Vec<u32>,
    count: usize,
    /// The size of the leaves as built, and the number of bodies then.
    built: (f64, usize),
}

impl<const D: usize, T: Scalar> Tree<D, T> {
    pub fn new() -> Self {
        Self {
            nodes: Vec::new(),
            free: Vec::new(),
            root: NONE,
            leaves: Vec::new(),
            count: 0,
            built: (0.0, 0),
        }
    }

    /// How many bodies it holds.
    pub fn len(&self) -> usize {
        self.count
    }

    pub fn clear(&mut self) {
        self.nodes.clear();
        self.free.clear();
        self.leaves.clear();
        self.root = NONE;
        self.count = 0;
    }

    pub fn holds(&self, seat: u32) -> bool {
        self.leaves.get(seat as usize).is_some_and(|&leaf| leaf != NONE)
    }

    /// Builds the tree anew of these seats, which it puts into another order. O(n log n) time.
    pub fn build(&mut self, seats: &mut [u32], boxes: &[Aabb<D, T>]) {
        self.clear();
        self.leaves.resize(boxes.len(), NONE);
        self.count = seats.len();
        let class = |seat: u32| size_class(&boxes[seat as usize]);
        seats.sort_unstable_by_key(|&seat| (class(seat), seat));
        let mut roots = Node::new(false);
        let mut rest = &mut *seats;
        while let Some(&first) = rest.first() {
            // Where there are more classes than a node has room for, the last holds the others.
            let is_last = roots.count == FAN - 1;
            let end = rest.partition_point(|&seat| is_last || class(seat) == class(first));
            let (now, later) = rest.split_at_mut(end);
            let leaves = now.len().div_ceil(FILL);
            let (root, bounds) = self.build_node(now, boxes, leaves);
            roots.push(root, &bounds);
            rest = later;
        }
        self.root = match roots.count {
            0 => NONE,
            1 => roots.items[0],
            _ => self.add_inner(roots),
        };
        self.built = (self.leaf_size(), self.count);
        // Room for what moving bodies add and take away, so that it need not be found later.
        self.nodes.reserve(self.nodes.len() / 2);
        self.free.reserve(self.nodes.len() / 2);
    }

    /// A node over seats that go into `leaves` leaves, and its bounds.
    fn build_node(
        &mut self,
        seats: &mut [u32],
        boxes: &[Aabb<D, T>],
        leaves: usize,
    ) -> (u32, Aabb<D, T>) {
        if leaves <= 1 {
            let mut leaf = Node::new(true);
            for &seat in seats.iter() {
                leaf.push(seat, &boxes[seat as usize]);
                self.leaves[seat as usize] = self.nodes.len() as u32;
            }
            self.nodes.push(leaf);
            return ((self.nodes.len() - 1) as u32, leaf.bounds());
        }
        // As few children as hold the leaves when they are full to the bottom.
        let mut room = 1;
        while room * FAN < leaves {
            room *= FAN;
        }
        let mut inner = Node::new(false);
        self.build_children(seats, boxes, leaves, room, &mut inner);
        (self.add_inner(inner), inner.bounds())
    }

    /// Cuts seats in two until what is left goes into a child of `room` leaves.
    fn build_children(
        &mut self,
        seats: &mut [u32],
        boxes: &[Aabb<D, T>],
        leaves: usize,
        room: usize,
        inner: &mut Node<D, T>,
    ) {
        let count = leaves.div_ceil(room);
        if count <= 1 {
            let (child, bounds) = self.build_node(seats, boxes, leaves);
            inner.push(child, &bounds);
            return;
        }
        let left = (leaves * (count / 2)).div_ceil(count);
        // The product of two counts, which 32 bits do not hold.
        let middle = (seats.len() as u64 * left as u64 / leaves as u64) as usize;
        let axis = widest_axis(seats, boxes);
        let centre = |seat: &u32| boxes[*seat as usize].centre(axis);
        seats.select_nth_unstable_by(middle, |a, b| centre(a).total_cmp(&centre(b)).then(a.cmp(b)));
        let (low, high) = seats.split_at_mut(middle);
        self.build_children(low, boxes, left, room, inner);
        self.build_children(high, boxes, leaves - left, room, inner);
    }

    fn add_inner(&mut self, inner: Node<D, T>) -> u32 {
        let index = self.add_node(inner);
        for &child in &inner.items[..inner.count] {
            self.nodes[child as usize].parent = index;
        }
        index
    }

    fn add_node(&mut self, node: Node<D, T>) -> u32 {
        if let Some(index) = self.free.pop() {
            self.nodes[index as usize] = node;
            index
        } else {
            self.nodes.push(node);
            (self.nodes.len() - 1) as u32
        }
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

    /// Gives the bodies other seats. O(n) time.
    pub fn rename(&mut self, renamed: &[u32]) {
        self.leaves.clear();
        self.leaves.resize(renamed.len(), NONE);
        for (index, node) in self.nodes.iter_mut().enumerate().filter(|(_, node)| node.is_leaf) {
            for seat in &mut node.items[..node.count] {
                *seat = renamed[*seat as usize];
                self.leaves[*seat as usize] = index as u32;
            }
        }
    }

    /// Adds a body. O(log n) time.
    pub fn insert(&mut self, seat: u32, aabb: &Aabb<D, T>) {
        if self.leaves.len() <= seat as usize {
            self.leaves.resize(seat as usize + 1, NONE);
        }
        self.count += 1;
        if self.root == NONE {
            self.root = self.add_node(Node::new(true));
        }
        self.insert_below(self.root, seat, aabb);
    }

    /// Adds a body somewhere below a node whose own box need not grow for it.
    fn insert_below(&mut self, mut index: u32, seat: u32, aabb: &Aabb<D, T>) {
        loop {
            let node = &mut self.nodes[index as usize];
            if node.is_leaf {
                break;
            }
            let lane = node.cheapest(aabb);
            let grown = hull(&node.aabb(lane), aabb);
            node.set_aabb(lane, &grown);
            index = node.items[lane];
        }
        self.leaves[seat as usize] = index;
        self.push(index, seat, aabb);
    }

    /// Adds a box to a node; a full one splits.
    fn push(&mut self, index: u32, item: u32, aabb: &Aabb<D, T>) {
        let node = &mut self.nodes[index as usize];
        if node.count < FAN {
            node.push(item, aabb);
            return;
        }
        let (is_leaf, parent) = (node.is_leaf, node.parent);
        let (low, high) = split(node, item, aabb);
        *node = Node { parent, ..low };
        let (low_bounds, high_bounds) = (node.bounds(), high.bounds());
        let other = self.add_node(Node { parent, ..high });
        for lane in 0..high.count {
            let moved = high.items[lane] as usize;
            if is_leaf {
                self.leaves[moved] = other;
            } else {
                self.nodes[moved].parent = other;
            }
        }
        if parent == NONE {
            let mut root = Node::new(false);
            root.push(index, &low_bounds);
            root.push(other, &high_bounds);
            self.root = self.add_inner(root);
        } else {
            let above = &mut self.nodes[parent as usize];
            let lane = above.lane_of(index);
            above.set_aabb(lane, &low_bounds);
            self.push(parent, other, &high_bounds);
        }
    }

    /// Removes a body, if it is there. O(log n) time.
    pub fn remove(&mut self, seat: u32) {
        if !self.holds(seat) {
            return;
        }
        let index = core::mem::replace(&mut self.leaves[seat as usize], NONE);
        self.count -= 1;
        let leaf = &mut self.nodes[index as usize];
        leaf.swap_remove(leaf.lane_of(seat));
        if leaf.count >= LEAST || leaf.parent == NONE && leaf.count > 0 {
            self.tighten(index);
            return;
        }
        let few = *leaf;
        self.give_up(index);
        for lane in 0..few.count {
            self.count -= 1;
            self.insert(few.items[lane], &few.aabb(lane));
        }
    }

    /// Takes a node out of the tree, and those above it that it leaves empty.
    fn give_up(&mut self, index: u32) {
        self.free.push(index);
        let node = &mut self.nodes[index as usize];
        node.count = 0;
        if node.parent == NONE {
            self.root = NONE;
            return;
        }
        let parent = node.parent;
        let above = &mut self.nodes[parent as usize];
        above.swap_remove(above.lane_of(index));
        if above.count == 0 {
            self.give_up(parent);
        } else {
            self.tighten(parent);
        }
    }

    /// Fits the boxes above a node to it, as far up as that changes one.
    fn tighten(&mut self, mut index: u32) {
        loop {
            let node = &self.nodes[index as usize];
            if node.parent == NONE {
                return;
            }
            let (bounds, parent) = (node.bounds(), node.parent);
            let above = &mut self.nodes[parent as usize];
            let lane = above.lane_of(index);
            if above.aabb(lane) == bounds {
                return;
            }
            above.set_aabb(lane, &bounds);
            index = parent;
        }
    }

    /// Gives a body its new box; adds it if it is not there. O(log n) time.
    pub fn set(&mut self, seat: u32, aabb: &Aabb<D, T>) {
        if !self.holds(seat) {
            self.insert(seat, aabb);
            return;
        }
        let index = self.leaves[seat as usize];
        let fits = self.fits(index, aabb);
        let leaf = &mut self.nodes[index as usize];
        let lane = leaf.lane_of(seat);
        if fits {
            leaf.set_aabb(lane, aabb);
            self.tighten(index);
            return;
        }
        if leaf.count <= LEAST {
            self.remove(seat);
            self.insert(seat, aabb);
            return;
        }
        // It leaves for another leaf, which most often is near.
        leaf.swap_remove(lane);
        let mut above = leaf.parent;
        while !self.fits(above, aabb) {
            above = self.nodes[above as usize].parent;
        }
        self.insert_below(above, seat, aabb);
        self.tighten(index);
    }

    /// Whether a box does not reach beyond the box of a node. The root has none.
    fn fits(&self, index: u32, aabb: &Aabb<D, T>) -> bool {
        let parent = self.nodes[index as usize].parent;
        if parent == NONE {
            return true;
        }
        let above = &self.nodes[parent as usize];
        contains(&above.aabb(above.lane_of(index)), aabb)
    }

    /// Lists all bodies whose box overlaps `area`.
    pub fn overlapping(&self, area: &Aabb<D, T>, found: &mut Vec<u32>) {
        found.clear();
        if self.root != NONE {
            self.overlapping_in(self.root, area, found);
        }
    }

    fn overlapping_in(&self, index: u32, area: &Aabb<D, T>, found: &mut Vec<u32>) {
        let node = &self.nodes[index as usize];
        let mut bits = node.overlapping(area);
        while bits != 0 {
            let item = node.items[bits.trailing_zeros() as usize];
            if node.is_leaf {
                found.push(item);
            } else {
                self.overlapping_in(item, area, found);
            }
            bits &= bits - 1;
        }
    }

    /// Goes through what a search does not exclude, the nearer of a node's parts first.
    pub fn search(&self, search: &mut impl Search<D, T>) -> ControlFlow<()> {
        if self.root == NONE {
            ControlFlow::Continue(())
        } else {
            self.search_in(self.root, search)
        }
    }

    fn search_in(&self, index: u32, search: &mut impl Search<D, T>) -> ControlFlow<()> {
        let node = &self.nodes[index as usize];
        let mut parts = [(0.0, 0); FAN];
        let mut count = 0;
        for lane in 0..node.count {
            if let Some(bound) = search.bound(&node.aabb(lane)) {
                parts[count] = (bound, lane);
                count += 1;
            }
        }
        let parts = &mut parts[..count];
        parts.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for &mut (_, lane) in parts {
            // What was seen since may exclude it now.
            if search.bound(&node.aabb(lane)).is_none() {
                continue;
            }
            if node.is_leaf {
                search.visit(node.items[lane])?;
            } else {
                self.search_in(node.items[lane], search)?;
            }
        }
        ControlFlow::Continue(())
    }
}

impl<const D: usize, T: Scalar> Aabb<D, T> {
    /// The centre on an axis, doubled and kept finite: to sort by.
    fn centre(&self, axis: usize) -> f64 {
        finite(self.min[axis]) + finite(self.max[axis])
    }
}

fn finite<T: Scalar>(at: T) -> f64 {
    at.to_f64().clamp(-1e300, 1e300)
}

/// Half the perimeter, in proportion to which a box is met by chance. Finite.
fn size<const D: usize, T: Scalar>(aabb: &Aabb<D, T>) -> f64 {
    (0..D).map(|axis| finite(aabb.max[axis]) - finite(aabb.min[axis])).sum()
}

/// Sizes that differ by less than a factor of 8 on the longest axis are of one class, or of two
/// neighbouring ones.
fn size_class<const D: usize, T: Scalar>(aabb: &Aabb<D, T>) -> u32 {
    let longest =
        (0..D).map(|axis| finite(aabb.max[axis]) - finite(aabb.min[axis])).fold(0.0, f64::max);
    // The exponent, in threes; larger first, so that the many small classes are the ones to share.
    let exponent = (longest.to_bits() >> 52) as u32;
    2047 / 3 - exponent / 3
}

/// The axis on which the centres spread most for the size of the boxes.
fn widest_axis<const D: usize, T: Scalar>(seats: &[u32], boxes: &[Aabb<D, T>]) -> usize {
    let mut best = (0, -1.0, 0.0);
    for axis in 0..D {
        let (mut low, mut high, mut width) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
        for &seat in seats {
            let aabb = &boxes[seat as usize];
            let centre = aabb.centre(axis);
            low = low.min(centre);
            high = high.max(centre);
            width += finite(aabb.max[axis]) - finite(aabb.min[axis]);
        }
        let spread = high - low;
        let ratio = if spread > 0.0 { spread / width } else { 0.0 };
        if ratio > best.1 || ratio == best.1 && spread > best.2 {
            best = (axis, ratio, spread);
        }
    }
    best.0
}

/// Divides a full node's boxes and one more in two halves: in the order of an axis or of size,
/// whichever makes the smallest halves.
fn split<const D: usize, T: Scalar>(
    node: &Node<D, T>,
    item: u32,
    aabb: &Aabb<D, T>,
) -> (Node<D, T>, Node<D, T>) {
    let mut entries = [(item, *aabb); FAN + 1];
    for (lane, entry) in entries[..FAN].iter_mut().enumerate() {
        *entry = (node.items[lane], node.aabb(lane));
    }
    let halves = |order: usize| {
        let mut sorted = entries;
        let key = |aabb: &Aabb<D, T>| if order < D { aabb.centre(order) } else { size(aabb) };
        sorted.sort_unstable_by(|a, b| key(&a.1).total_cmp(&key(&b.1)).then(a.0.cmp(&b.0)));
        let mut halves = (Node::new(node.is_leaf), Node::new(node.is_leaf));
        for (index, (item, aabb)) in sorted.iter().enumerate() {
            let half = if index < FAN.div_ceil(2) { &mut halves.0 } else { &mut halves.1 };
            half.push(*item, aabb);
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
