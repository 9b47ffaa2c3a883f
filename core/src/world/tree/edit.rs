//! The tree, and how bodies are added, moved and removed one by one.

use alloc::vec::Vec;

use super::node::{FAN, LEAST, NONE, Node, split};
use crate::cloning::clone_fields;
use crate::{Aabb, Scalar};

/// A body that is to be put into a leaf. What is read again and again is kept here, in few bytes.
#[derive(Clone, Copy, Debug)]
pub struct Entry<const D: usize, T> {
    pub center: [T; D],
    pub body: u32,
}

/// A build that takes several steps.
#[derive(Clone, Debug, Default)]
pub struct Building {
    /// Where the entries of each size class end, of those that there are; behind the last one empty ones.
    pub ends: [usize; FAN],
    /// How deep the entries are cut.
    pub depth: u32,
    /// Whether they are cut to the bottom.
    pub is_cut: bool,
}

/// The tree. Bodies are storage indices, and their boxes in it may be larger than they are.
#[derive(Debug)]
pub struct Tree<const D: usize, T> {
    pub(super) nodes: Vec<Node<D, T>>,
    pub(super) free: Vec<u32>,
    pub(super) root: u32,
    /// By body, its leaf.
    pub(super) leaves: Vec<u32>,
    /// How many bodies it holds.
    pub count: usize,
    /// The bodies of a build that has begun, else a buffer.
    pub(super) entries: Vec<Entry<D, T>>,
    pub(super) building: Option<Building>,
    /// The size of the leaves as built, and the number of bodies then.
    pub(super) built: (f64, usize),
}

clone_fields! {
    [const D: usize, T: Scalar] Tree<D, T> {
        nodes, free, root, leaves, count, entries, building, built,
    }
}

impl<const D: usize, T: Scalar> Default for Tree<D, T> {
    fn default() -> Self {
        Self {
            nodes: Vec::new(),
            free: Vec::new(),
            root: NONE,
            leaves: Vec::new(),
            count: 0,
            entries: Vec::new(),
            building: None,
            built: (0.0, 0),
        }
    }
}

impl<const D: usize, T: Scalar> Tree<D, T> {
    pub fn holds(&self, body: u32) -> bool {
        self.leaves.get(body as usize).is_some_and(|&leaf| leaf != NONE)
    }

    pub(super) fn add_inner(&mut self, inner: Node<D, T>) -> u32 {
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

    /// Gives the bodies other bodies. O(n) time.
    pub fn rename(&mut self, renamed: &[u32]) {
        if self.building.is_some() {
            self.entries.iter_mut().for_each(|entry| entry.body = renamed[entry.body as usize]);
        }
        self.leaves.clear();
        self.leaves.resize(renamed.len(), NONE);
        for (index, node) in self.nodes.iter_mut().enumerate().filter(|(_, node)| node.is_leaf) {
            for body in &mut node.items[..node.count] {
                *body = renamed[*body as usize];
                self.leaves[*body as usize] = index as u32;
            }
        }
    }

    /// Adds a body. O(log n) time.
    pub fn insert(&mut self, body: u32, aabb: &Aabb<D, T>) {
        if self.leaves.len() <= body as usize {
            self.leaves.resize(body as usize + 1, NONE);
        }
        self.count += 1;
        if self.root == NONE {
            self.root = self.add_node(Node::new(true));
        }
        self.insert_below(self.root, body, aabb);
    }

    /// Adds a body somewhere below a node whose own box need not grow for it.
    fn insert_below(&mut self, mut index: u32, body: u32, aabb: &Aabb<D, T>) {
        loop {
            let node = &mut self.nodes[index as usize];
            if node.is_leaf {
                break;
            }
            let lane = node.cheapest(aabb);
            let grown = node.aabb(lane).union(aabb);
            node.set_aabb(lane, &grown);
            index = node.items[lane];
        }
        self.leaves[body as usize] = index;
        self.push(index, body, aabb);
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
    pub fn remove(&mut self, body: u32) {
        if !self.holds(body) {
            return;
        }
        let index = core::mem::replace(&mut self.leaves[body as usize], NONE);
        self.count -= 1;
        let leaf = &mut self.nodes[index as usize];
        leaf.swap_remove(leaf.lane_of(body));
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
    pub fn set(&mut self, body: u32, aabb: &Aabb<D, T>) {
        if !self.holds(body) {
            self.insert(body, aabb);
            return;
        }
        let index = self.leaves[body as usize];
        let fits = self.fits(index, aabb);
        let leaf = &mut self.nodes[index as usize];
        let lane = leaf.lane_of(body);
        if fits {
            leaf.set_aabb(lane, aabb);
            self.tighten(index);
            return;
        }
        if leaf.count <= LEAST {
            self.remove(body);
            self.insert(body, aabb);
            return;
        }
        // It leaves for another leaf, which most often is near.
        leaf.swap_remove(lane);
        let mut above = leaf.parent;
        while !self.fits(above, aabb) {
            above = self.nodes[above as usize].parent;
        }
        self.insert_below(above, body, aabb);
        self.tighten(index);
    }

    /// Whether a box does not reach beyond the box of a node. The root has none.
    fn fits(&self, index: u32, aabb: &Aabb<D, T>) -> bool {
        let parent = self.nodes[index as usize].parent;
        if parent == NONE {
            return true;
        }
        let above = &self.nodes[parent as usize];
        above.aabb(above.lane_of(index)).contains(aabb)
    }
}
