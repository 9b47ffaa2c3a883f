//! What a world keeps from update to update.

use alloc::vec::Vec;

use super::candidates::Candidates;
use super::effort::Effort;
use super::filter::Filter;
use super::loners::Loners;
use super::predict::Prediction;
use super::sleep::Sleep;
use super::sort::PairSorter;
use super::tree::Tree;
use crate::memory::preload;
use crate::pairs::PairFinder;
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
    /// Whether the fat boxes should be those of the last update, and are not.
    pub are_fat_old: bool,
    pub candidates: Candidates,
    pub sleep: Sleep,
    pub tree: Tree<D, T>,
    pub tree_state: TreeState,
    /// How often the tree was searched since it was built, roughly.
    pub tree_uses: usize,
    pub prediction: Prediction,
    pub effort: Effort,
    /// Those who move of late have seats below this, but for some.
    pub front: usize,
    /// Whether there is a body of `flag::NEW`.
    pub any_new: bool,
    /// How much the order of the seats has suffered from motion.
    pub wear: usize,
    /// How many the finder works on.
    threads: usize,
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

/// To look at a body out of order takes as long as to pass over so many in order.
pub(super) const SOME: usize = 16;

/// How much of a table by seat is better passed over in order than looked at here and there, if it
/// is `count` items that matter: all of it, the front, or nothing.
pub(super) fn in_order(count: usize, front: usize, all: usize) -> usize {
    let worth = count.saturating_mul(SOME);
    if front > all / 2 && worth > all {
        all
    } else if worth > front {
        front
    } else {
        0
    }
}

/// A set of seats.
#[derive(Debug, Default)]
pub(super) struct Marks(Vec<bool>);

impl Marks {
    /// Makes room for so many seats.
    pub fn resize(&mut self, seats: usize) {
        self.0.resize(seats, false);
    }

    #[inline]
    pub fn set(&mut self, seat: u32) {
        self.0[seat as usize] = true;
    }

    #[inline]
    pub fn clear(&mut self, seat: u32) {
        self.0[seat as usize] = false;
    }

    #[inline]
    pub fn has(&self, seat: u32) -> bool {
        self.0[seat as usize]
    }
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
    /// The live pairs of the last update, sorted.
    pub before: Vec<[u32; 2]>,
    pub marks: Marks,
    pub moved: Marks,
    pub places: Vec<usize>,
    pub dropped: Vec<usize>,
    pub queries: Vec<(u32, Aabb<D, T>)>,
    pub leaves: Vec<[u32; 2]>,
    pub names: Vec<u32>,
    pub loners: Loners,
    pub filters: Vec<Filter>,
    pub flags: Vec<u16>,
}

impl<const D: usize, T: Scalar> Updater<D, T> {
    pub fn new() -> Self {
        Self {
            previous: Vec::new(),
            old_filters: Vec::new(),
            any_refiltered: false,
            fat: Vec::new(),
            are_fat_old: false,
            candidates: Candidates::default(),
            sleep: Sleep::default(),
            tree: Tree::new(),
            tree_state: TreeState::Unbuilt,
            tree_uses: 0,
            prediction: Prediction::default(),
            effort: Effort::default(),
            front: 0,
            any_new: false,
            wear: 0,
            threads: 1,
            scratch: Scratch::new(1),
            begun: Vec::new(),
            ended: Vec::new(),
        }
    }

    #[cfg(feature = "parallel")]
    pub fn set_threads(&mut self, threads: usize) {
        self.threads = threads;
        self.scratch = Scratch::new(threads);
    }

    /// Makes room for a new seat.
    pub fn add_seat(&mut self, aabb: Aabb<D, T>) {
        self.front += usize::from(self.front == self.fat.len());
        self.previous.push(aabb);
        self.fat.push(aabb);
    }

    /// Writes the fat boxes, if they are not.
    pub fn refresh_fat(&mut self) {
        if core::mem::take(&mut self.are_fat_old) {
            self.fat.copy_from_slice(&self.previous);
        }
    }

    /// Reads the part of a table by seat through of which `count` items will be looked at.
    pub fn warm_for<V: Copy>(&self, count: usize, table: &[V]) {
        preload(&table[..in_order(count, self.front, table.len())]);
    }
}

impl<const D: usize, T: Scalar> Clone for Updater<D, T> {
    fn clone(&self) -> Self {
        Self {
            previous: self.previous.clone(),
            old_filters: self.old_filters.clone(),
            any_refiltered: self.any_refiltered,
            fat: self.fat.clone(),
            are_fat_old: self.are_fat_old,
            candidates: self.candidates.clone(),
            sleep: self.sleep.clone(),
            tree: self.tree.clone(),
            tree_state: self.tree_state,
            tree_uses: self.tree_uses,
            prediction: self.prediction.clone(),
            effort: self.effort.clone(),
            front: self.front,
            any_new: self.any_new,
            wear: self.wear,
            threads: self.threads,
            scratch: Scratch::new(self.threads),
            begun: Vec::new(),
            ended: Vec::new(),
        }
    }
}

impl<const D: usize, T: Scalar> Scratch<D, T> {
    #[cfg_attr(not(feature = "parallel"), expect(unused_variables))]
    fn new(threads: usize) -> Self {
        // It is asked where most bodies got new boxes.
        let finder = PairFinder::new();
        #[cfg(feature = "parallel")]
        let finder = finder.threads(threads);
        Self {
            finder,
            sorter: PairSorter::default(),
            boxes: Vec::new(),
            seats: Vec::new(),
            escaped: Vec::new(),
            found: Vec::new(),
            pairs: Vec::new(),
            before: Vec::new(),
            marks: Marks::default(),
            moved: Marks::default(),
            places: Vec::new(),
            dropped: Vec::new(),
            queries: Vec::new(),
            leaves: Vec::new(),
            names: Vec::new(),
            loners: Loners::default(),
            filters: Vec::new(),
            flags: Vec::new(),
        }
    }
}
