//! The tree that a broad phase keeps, and how much of the world it holds: for updates, which look up bodies, and for queries.

use alloc::vec::Vec;

use super::bodies::{Bodies, flag};
use super::policy::{LOOK_UP, Motion, refit_pays};
use super::tree::Tree;
use crate::cloning::clone_fields;
use crate::{Aabb, Scalar};

/// Where all fat AABBs are new, a tree is given up if more than one of this many bodies jumped: moving that in the tree takes as
/// long as finding all pairs. Second if there were queries since the last update: they would have it built, which takes several
/// times as long.
const MOVED: [usize; 2] = [LOOK_UP, LOOK_UP / 8];

/// A tree of fat AABBs.
#[derive(Debug, Default)]
pub struct SearchTree<const D: usize, T: Scalar> {
    tree: Tree<D, T>,
    state: TreeState,
    /// About how often the tree was searched since it was built.
    uses: usize,
}

clone_fields! {
    [const D: usize, T: Scalar] SearchTree<D, T> { tree, state, uses }
}

/// What the tree holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TreeState {
    /// All fat AABBs of bodies that are not new and do not fly, and the boxes of this many of the changed bodies, the first ones.
    Fresh { known: usize },
    /// The right bodies with old boxes.
    Old,
    /// Nothing of use.
    #[default]
    Unbuilt,
}

impl<const D: usize, T: Scalar> SearchTree<D, T> {
    pub fn tree(&self) -> &Tree<D, T> {
        &self.tree
    }

    pub fn tree_mut(&mut self) -> &mut Tree<D, T> {
        &mut self.tree
    }

    /// Whether it holds the right bodies, with their fat AABBs or old ones.
    pub fn is_built(&self) -> bool {
        self.state != TreeState::Unbuilt
    }

    /// Whether it holds the fat AABBs of all bodies that are not new and do not fly.
    pub fn is_fresh(&self) -> bool {
        matches!(self.state, TreeState::Fresh { .. })
    }

    /// Whether it also holds the boxes of all bodies that changed.
    pub fn knows_changes(&self, bodies: &Bodies<D, T>) -> bool {
        self.state == TreeState::Fresh { known: bodies.edits.changed().len() }
            && !bodies.edits.any_unlisted()
    }

    /// Notes that it does not hold the right bodies any more, or will not be needed.
    pub fn abandon(&mut self) {
        self.state = TreeState::Unbuilt;
    }

    /// Notes that an update ended: from now on no body has changed.
    pub fn forget_changes(&mut self) {
        if let TreeState::Fresh { known } = &mut self.state {
            *known = 0;
        }
    }

    /// Notes that it will be searched about so often.
    pub fn note_uses(&mut self, count: usize) {
        self.uses = self.uses.saturating_add(count);
    }

    /// Brings it closer to holding the fat AABBs of all bodies that are not new and do not fly, by about as much work as finding
    /// all pairs from scratch is. Returns whether it holds them.
    #[inline(never)]
    pub fn advance(&mut self, bodies: &Bodies<D, T>, fat: &[Aabb<D, T>]) -> bool {
        let Self { tree, state, uses } = self;
        match *state {
            TreeState::Fresh { .. } => return true,
            TreeState::Old if refit_pays(tree.refit(fat), *uses, tree.count) => {}
            _ => {
                *state = TreeState::Unbuilt;
                let is_known = |&index: &u32| {
                    bodies.slots.has(index, flag::LIVE | flag::LEAVING)
                        && !bodies.slots.has(index, flag::NEW)
                };
                let known = (0..bodies.slots.len() as u32).filter(is_known);
                if !tree.prepare(known.clone(), fat) {
                    return false;
                }
                *uses = 0;
                tree.build(known, fat);
            }
        }
        *state = TreeState::Fresh { known: 0 };
        true
    }

    /// Gives each body that changed since a box that contains its own. Only while it is fresh.
    pub fn add_changes(&mut self, bodies: &mut Bodies<D, T>, fat: &[Aabb<D, T>]) {
        let TreeState::Fresh { known } = &mut self.state else { return };
        while let Some(&index) = bodies.edits.changed().get(*known) {
            *known += 1;
            let row = index as usize;
            // Also for a free slot: a body that takes it has to be listed again.
            bodies.slots.raise(index, flag::IN_TREE);
            if !bodies.slots.has(index, flag::LIVE) {
                continue;
            }
            let aabb = &bodies.boxes.now()[row];
            if bodies.slots.has(index, flag::NEW) {
                self.tree.set(index, aabb);
            } else if !fat[row].contains(aabb) {
                self.tree.set(index, &fat[row].union(aabb));
            }
        }
        // A body that changes between queries is listed each time: without updates the list would grow.
        if bodies.edits.changed().len() > 2 * bodies.slots.len() {
            bodies.edits.list_once(&bodies.slots);
            *known = bodies.edits.changed().len();
        }
    }

    /// Notes that all fat AABBs are new. A body that is far from where it was must not enlarge the leaf
    /// where it was. `moved` is a buffer.
    #[inline(never)]
    pub fn note_new_fat(
        &mut self,
        bodies: &Bodies<D, T>,
        fat: &[Aabb<D, T>],
        motion: &Motion,
        is_queried: bool,
        moved: &mut Vec<u32>,
    ) {
        if !self.is_built() {
            return;
        }
        for &index in bodies.edits.leaving() {
            self.tree.remove(index);
        }
        let (boxes, previous) = (bodies.boxes.now(), bodies.boxes.previous());
        moved.clear();
        moved.extend(bodies.edits.changed().iter().copied().filter(|&index| {
            let row = index as usize;
            bodies.slots.has(index, flag::LIVE)
                && (bodies.slots.has(index, flag::NEW)
                    || motion.is_jump(&previous[row], &boxes[row]))
        }));
        if moved.len() * MOVED[usize::from(is_queried)] > self.tree.count {
            self.abandon();
            return;
        }
        for &index in &*moved {
            self.tree.set(index, &fat[index as usize]);
        }
        self.state = TreeState::Old;
    }

    /// What it holds, and how often it was searched.
    #[cfg(test)]
    pub fn state(&self) -> (TreeState, usize) {
        (self.state, self.uses)
    }
}
