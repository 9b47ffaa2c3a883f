//! What a broad phase keeps from update to update besides the bodies. It follows from them, so it only
//! changes how long an update takes.

use alloc::vec::Vec;

use super::bodies::{Bodies, flag};
use super::candidates::{Candidates, PairSorter};
use super::policy::{Motion, Policy, Sleep};
use super::tree::Tree;
use crate::pairs::PairFinder;
use crate::{Aabb, Scalar};

/// Fat AABBs, their pairs, and a tree of them.
#[derive(Debug)]
pub struct Tracking<const D: usize, T: Scalar> {
    /// By index. Meaningless for bodies of `flag::NEW`.
    pub fat: Vec<Aabb<D, T>>,
    /// Whether the fat AABBs should be the boxes of the last update, and are not yet.
    pub is_fat_stale: bool,
    pub candidates: Candidates,
    pub tree: Tree<D, T>,
    pub tree_state: TreeState,
    /// About how often the tree was searched since it was built.
    pub tree_uses: usize,
    pub motion: Motion,
    pub policy: Policy,
    pub sleep: Sleep,
    /// How much the locality of the storage order decayed by motion.
    pub locality_decay: usize,
    threads: usize,
    pub scratch: Scratch<D, T>,
}

/// What the tree holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TreeState {
    /// All fat AABBs, and the boxes of this many of the changed bodies, the first ones.
    Fresh { known: usize },
    /// The right bodies with old boxes.
    Old,
    /// Nothing of use.
    Unbuilt,
}

/// Buffers, kept so that steady motion does not allocate.
#[derive(Debug)]
pub struct Scratch<const D: usize, T: Scalar> {
    pub finder: PairFinder<D, T>,
    pub sorter: PairSorter,
    /// The bodies that need a new fat AABB.
    pub escaped: Vec<u32>,
    /// Boxes for the finder, and their indices.
    pub boxes: Vec<Aabb<D, T>>,
    pub indices: Vec<u32>,
    /// The live pairs of the last update, sorted.
    pub before: Vec<[u32; 2]>,
    /// By index: bodies that escaped or left, and bodies that changed.
    pub is_escaped: Vec<bool>,
    pub is_changed: Vec<bool>,
    /// Positions of candidates to test, and of dropped ones.
    pub positions: Vec<usize>,
    pub dropped: Vec<usize>,
    /// Boxes to look up, by index, and what the tree finds.
    pub queries: Vec<(u32, Aabb<D, T>)>,
    pub leaves: Vec<[u32; 2]>,
    pub found: Vec<[u32; 2]>,
    /// For reordering storage.
    pub renamed: Vec<u32>,
    pub words: Vec<u32>,
    pub filters: Vec<crate::Filter>,
    pub flags: Vec<u16>,
}

impl<const D: usize, T: Scalar> Tracking<D, T> {
    pub fn new() -> Self {
        Self {
            fat: Vec::new(),
            is_fat_stale: false,
            candidates: Candidates::default(),
            tree: Tree::new(),
            tree_state: TreeState::Unbuilt,
            tree_uses: 0,
            motion: Motion::default(),
            policy: Policy::default(),
            sleep: Sleep::default(),
            locality_decay: 0,
            threads: 1,
            scratch: Scratch::new(1),
        }
    }

    #[cfg(feature = "parallel")]
    pub fn set_threads(&mut self, threads: usize) {
        self.threads = threads;
        self.scratch = Scratch::new(threads);
    }

    /// Makes the fat AABBs as many as the bodies.
    pub fn grow(&mut self, bodies: &Bodies<D, T>) {
        self.fat.extend_from_slice(&bodies.boxes[self.fat.len()..]);
    }

    /// Writes the fat AABBs if they are stale.
    pub fn refresh_fat(&mut self, bodies: &Bodies<D, T>) {
        if core::mem::take(&mut self.is_fat_stale) {
            self.fat.copy_from_slice(&bodies.previous);
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

impl<const D: usize, T: Scalar> Clone for Tracking<D, T> {
    fn clone(&self) -> Self {
        Self {
            fat: self.fat.clone(),
            is_fat_stale: self.is_fat_stale,
            candidates: self.candidates.clone(),
            tree: self.tree.clone(),
            tree_state: self.tree_state,
            tree_uses: self.tree_uses,
            motion: self.motion.clone(),
            policy: self.policy.clone(),
            sleep: self.sleep.clone(),
            locality_decay: self.locality_decay,
            threads: self.threads,
            scratch: Scratch::new(self.threads),
        }
    }
}

impl<const D: usize, T: Scalar> Scratch<D, T> {
    #[cfg_attr(not(feature = "parallel"), expect(unused_variables))]
    fn new(threads: usize) -> Self {
        // It is called where most bodies got new boxes.
        let finder = PairFinder::new();
        #[cfg(feature = "parallel")]
        let finder = finder.threads(threads);
        Self {
            finder,
            sorter: PairSorter::default(),
            escaped: Vec::new(),
            boxes: Vec::new(),
            indices: Vec::new(),
            before: Vec::new(),
            is_escaped: Vec::new(),
            is_changed: Vec::new(),
            positions: Vec::new(),
            dropped: Vec::new(),
            queries: Vec::new(),
            leaves: Vec::new(),
            found: Vec::new(),
            renamed: Vec::new(),
            words: Vec::new(),
            filters: Vec::new(),
            flags: Vec::new(),
        }
    }
}
