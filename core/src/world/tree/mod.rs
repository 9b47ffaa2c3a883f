//! A tree of boxes: what one body's box overlaps, and what a query looks for.
//!
//! An R-tree (Guttman 1984) of 16 boxes a node, held axis by axis so that the compiler tests
//! several at once. Built from the top by cutting in the middle, along the axis on which the
//! centres spread most for the size of the boxes; bodies that are far larger than others go into
//! trees of their own under one root, so that a giant does not widen the node of a dwarf.

mod build;
mod node;
mod search;

use alloc::vec::Vec;

use super::options::{contains, hull};
use crate::{Aabb, Scalar};
use build::Entry;
use node::{FAN, LEAST, Node, split};
pub(super) use search::{BATCH, Search, TOGETHER};

const NONE: u32 = u32::MAX;

/// The tree, by seats. Bodies' boxes may be larger than the bodies.
#[derive(Clone, Debug)]
pub(super) struct Tree<const D: usize, T> {
    nodes: Vec<Node<D, T>>,
    free: Vec<u32>,
    root: u32,
    /// By seat, its leaf.
    leaves: Vec<u32>,
    count: usize,
    /// A buffer for building.
    entries: Vec<Entry<D>>,
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
            entries: Vec::new(),
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
            root.has_leaves = is_leaf;
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
}
