//! What a world keeps from update to update.

use alloc::vec::Vec;

use super::candidates::Candidates;
use super::filter::Filter;
use super::predict::Prediction;
use super::sort::PairSorter;
use super::tree::Tree;
use crate::finder::PairFinder;
use crate::{Aabb, Scalar};

/// The world of the last update, and what follows from it.
#[derive(Debug)]
pub(super) struct Updater<const D: usize, T: Scalar> {
    /// By seat, the box at the last update. Means nothing for bodies of `flag::NEW`.
    pub previous: Vec<Aabb<D, T>>,
    /// By seat, the filter at the last update, for bodies of `flag::REFILTERED`; as long as the
    /// greatest seat of one ever needed.
    pub old_filters: Vec<Filter>,
    /// Whether there is such a body.
    pub any_refiltered: bool,
    /// By seat, the fat box. Means nothing for bodies of `flag::NEW`.
    pub fat: Vec<Aabb<D, T>>,
    pub candidates: Candidates,
    pub tree: Tree<D, T>,
    pub tree_state: TreeState,
    /// How often the tree was searched since it was built, roughly.
    pub tree_uses: usize,
    pub prediction: Prediction,
    /// How much the order of the seats has suffered from motion.
    pub wear: usize,
    pub scratch: Scratch<D, T>,
    pub begun: Vec<[u32; 2]>,
    pub ended: Vec<[u32; 2]>,
}

/// How far the tree is from what it should hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TreeState {
    /// It holds all fat boxes, and the boxes of so many of the changed bodies, the first.
    Fresh { known: usize },
    /// It holds the right bodies with old boxes.
    Old,
    /// It has to be built.
    Unbuilt,
}

/// Buffers, kept so that they need not be allocated again.
#[derive(Debug)]
pub(super) struct Scratch<const D: usize, T: Scalar> {
    pub finder: PairFinder<D, T>,
    pub sorter: PairSorter,
    /// Boxes for the finder, and whose they are.
    pub boxes: Vec<Aabb<D, T>>,
    pub seats: Vec<u32>,
    /// The bodies that need a new fat box.
    pub escaped: Vec<u32>,
    pub found: Vec<u32>,
    pub pairs: Vec<[u32; 2]>,
    pub is_old: Vec<bool>,
    pub names: Vec<u32>,
    pub filters: Vec<Filter>,
    pub flags: Vec<u8>,
}

impl<const D: usize, T: Scalar> Updater<D, T> {
    pub fn new() -> Self {
        Self {
            previous: Vec::new(),
            old_filters: Vec::new(),
            any_refiltered: false,
            fat: Vec::new(),
            candidates: Candidates::default(),
            tree: Tree::new(),
            tree_state: TreeState::Unbuilt,
            tree_uses: 0,
            prediction: Prediction::default(),
            wear: 0,
            scratch: Scratch::new(),
            begun: Vec::new(),
            ended: Vec::new(),
        }
    }

    /// Makes room for a new seat.
    pub fn add_seat(&mut self, aabb: Aabb<D, T>) {
        self.previous.push(aabb);
        self.fat.push(aabb);
    }
}

impl<const D: usize, T: Scalar> Clone for Updater<D, T> {
    fn clone(&self) -> Self {
        Self {
            previous: self.previous.clone(),
            old_filters: self.old_filters.clone(),
            any_refiltered: self.any_refiltered,
            fat: self.fat.clone(),
            candidates: self.candidates.clone(),
            tree: self.tree.clone(),
            tree_state: self.tree_state,
            tree_uses: self.tree_uses,
            prediction: self.prediction.clone(),
            wear: self.wear,
            scratch: Scratch::new(),
            begun: Vec::new(),
            ended: Vec::new(),
        }
    }
}

impl<const D: usize, T: Scalar> Scratch<D, T> {
    fn new() -> Self {
        Self {
            // It is asked where most bodies got new boxes.
            finder: PairFinder::forgetful(),
            sorter: PairSorter::default(),
            boxes: Vec::new(),
            seats: Vec::new(),
            escaped: Vec::new(),
            found: Vec::new(),
            pairs: Vec::new(),
            is_old: Vec::new(),
            names: Vec::new(),
            filters: Vec::new(),
            flags: Vec::new(),
        }
    }
}
