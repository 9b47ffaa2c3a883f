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
    /// By slot, the box at the last update. Means nothing for bodies of `flag::NEW`.
    pub previous: Vec<Aabb<D, T>>,
    /// By slot, the filter at the last update, for bodies of `flag::REFILTERED`; as long as the
    /// greatest slot of one ever needed.
    pub old_filters: Vec<Filter>,
    /// Whether there is such a body.
    pub any_refiltered: bool,
    /// By slot, the fat box. Means nothing for bodies of `flag::NEW`.
    pub fat: Vec<Aabb<D, T>>,
    pub candidates: Candidates,
    pub tree: Tree<D, T>,
    pub tree_state: TreeState,
    pub prediction: Prediction,
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
    pub slots: Vec<u32>,
    /// The bodies that need a new fat box.
    pub escaped: Vec<u32>,
    pub found: Vec<u32>,
    /// By slot, the number of the search that last came upon it.
    pub seen: Vec<u32>,
    pub searches: u32,
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
            prediction: Prediction::default(),
            scratch: Scratch::new(),
            begun: Vec::new(),
            ended: Vec::new(),
        }
    }

    /// Makes room for a new slot.
    pub fn add_slot(&mut self, aabb: Aabb<D, T>) {
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
            prediction: self.prediction.clone(),
            scratch: Scratch::new(),
            begun: Vec::new(),
            ended: Vec::new(),
        }
    }
}

impl<const D: usize, T: Scalar> Scratch<D, T> {
    fn new() -> Self {
        Self {
            finder: PairFinder::new(),
            sorter: PairSorter::default(),
            boxes: Vec::new(),
            slots: Vec::new(),
            escaped: Vec::new(),
            found: Vec::new(),
            seen: Vec::new(),
            searches: 0,
        }
    }

    /// The number of a new search among so many slots.
    pub fn begin_search(&mut self, slots: usize) -> u32 {
        self.searches = self.searches.wrapping_add(1);
        if self.searches == 0 {
            self.seen.fill(0);
            self.searches = 1;
        }
        self.seen.resize(slots, 0);
        self.searches
    }
}
