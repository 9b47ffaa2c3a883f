//! What a broad phase keeps from update to update besides the bodies. It follows from them, so it only
//! changes how long an update takes.

use alloc::vec::Vec;

use super::bodies::{Bodies, flag};
use super::candidates::{Candidates, PairSorter};
use super::finder::Finder;
use super::permutation::Permutation;
use super::policy::{Motion, Policy, Sleep, Usage};
use super::queries::SortedBodies;
use super::search_tree::SearchTree;
use crate::cloning::clone_fields;
use crate::{Aabb, Scalar};

/// Fat AABBs, their pairs, and a tree of them.
#[derive(Debug, Default)]
pub struct Tracking<const D: usize, T: Scalar> {
    /// By index. Meaningless for bodies of `flag::NEW`.
    pub fat: Vec<Aabb<D, T>>,
    /// Whether the fat AABBs should be the boxes of the last update, and are not yet.
    pub is_fat_stale: bool,
    pub candidates: Candidates,
    pub tree: SearchTree<D, T>,
    /// The bodies of `flag::FLYING`, and some that left or, within an update, flew before. Only while the tree holds all others.
    pub flying: Vec<u32>,
    /// Whether there were queries since the last update.
    pub is_queried: bool,
    /// Within an update: whether to bring the tree closer to holding all bodies when it ends.
    pub is_tree_due: bool,
    pub motion: Motion,
    pub policy: Policy,
    pub sleep: Sleep,
    /// How much the locality of the storage order decayed by motion.
    pub locality_decay: usize,
    /// Whether to reorder storage at the end of the next update that finds few candidates.
    pub is_order_due: bool,
    pub finder: Finder<D, T>,
    pub usage: Usage,
    pub scratch: Scratch<D, T>,
    /// For many queries at once.
    pub sorted: SortedBodies<D, T>,
}

clone_fields! {
    [const D: usize, T: Scalar] Tracking<D, T> {
        fat, is_fat_stale, candidates, tree, flying, is_queried, is_tree_due, motion,
        policy, sleep, locality_decay, is_order_due, finder, usage, scratch, sorted,
    }
}

/// Buffers, kept so that steady motion does not allocate.
#[derive(Debug, Default)]
pub struct Scratch<const D: usize, T: Scalar> {
    pub sorter: PairSorter,
    /// The bodies that need a new fat AABB.
    pub escaped: Vec<u32>,
    /// The live pairs, sorted.
    pub sorted: Vec<[u32; 2]>,
    /// By index: bodies that escaped or left, and bodies that changed.
    pub is_escaped: Vec<bool>,
    pub is_changed: Vec<bool>,
    /// Positions of candidates that are dropped.
    pub dropped: Vec<usize>,
    /// The bodies that an update wakes.
    pub woken: Vec<u32>,
    /// New candidates, and whether each is live.
    pub added: Vec<([u32; 2], bool)>,
    /// Boxes to look up, by index, and what the tree finds.
    pub queries: Vec<(u32, Aabb<D, T>)>,
    pub sampled: Vec<(u32, Aabb<D, T>)>,
    pub leaves: Vec<[u32; 2]>,
    pub found: Vec<[u32; 2]>,
    pub permutation: Permutation<D, T>,
}

impl<const D: usize, T: Scalar> Tracking<D, T> {
    /// Makes the fat AABBs as many as the bodies, and writes them if they are stale.
    pub fn refresh_fat(&mut self, bodies: &Bodies<D, T>) {
        self.fat.extend_from_slice(&bodies.boxes.now()[self.fat.len()..]);
        if core::mem::take(&mut self.is_fat_stale) {
            self.fat.copy_from_slice(bodies.boxes.previous());
        }
    }

    /// Wakes all bodies.
    pub fn wake_all(&mut self, bodies: &mut Bodies<D, T>) {
        if self.sleep.wake_all() {
            bodies.slots.flags.iter_mut().for_each(|flags| *flags &= !flag::ASLEEP);
        }
        bodies.front = bodies.slots.len();
    }
}

impl<const D: usize, T: Scalar> Clone for Scratch<D, T> {
    /// Empty buffers: what they hold between updates is of no use.
    fn clone(&self) -> Self {
        Self::default()
    }

    /// Keeps its own buffers.
    fn clone_from(&mut self, _source: &Self) {}
}
