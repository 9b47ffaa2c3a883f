//! The tree, brought up to date: for updates, which look up bodies, and for queries.

use crate::Scalar;
use crate::world::bodies::{Bodies, flag};
use crate::world::policy::refit_pays;
use crate::world::tracking::{Tracking, TreeState};

impl<const D: usize, T: Scalar> Tracking<D, T> {
    /// Makes the tree hold the fat AABBs of all bodies that are not new and do not fly.
    pub fn ready_tree(&mut self, bodies: &Bodies<D, T>) {
        while !self.advance_tree(bodies) {}
    }

    /// Whether the tree holds the fat AABBs of all bodies that are not new and do not fly.
    pub fn has_tree(&self) -> bool {
        matches!(self.tree_state, TreeState::Fresh { .. })
    }

    /// Brings the tree closer to holding the fat AABBs of all bodies that are not new and do not fly, by about as much work as finding
    /// all pairs from scratch is. Returns whether it holds them.
    #[inline(never)]
    pub fn advance_tree(&mut self, bodies: &Bodies<D, T>) -> bool {
        self.refresh_fat(bodies);
        let Self { tree, tree_state, tree_uses, fat, .. } = self;
        match *tree_state {
            TreeState::Fresh { .. } => return true,
            TreeState::Old if refit_pays(tree.refit(fat), *tree_uses, tree.count) => {}
            _ => {
                *tree_state = TreeState::Unbuilt;
                let is_known = |&index: &u32| {
                    bodies.slots.has(index, flag::LIVE | flag::LEAVING)
                        && !bodies.slots.has(index, flag::NEW)
                };
                let known = (0..bodies.slots.len() as u32).filter(is_known);
                if !tree.prepare(known.clone(), fat) {
                    return false;
                }
                *tree_uses = 0;
                tree.build(known, fat);
            }
        }
        *tree_state = TreeState::Fresh { known: 0 };
        true
    }

    /// Whether the tree holds every body, with a box that contains its own, and nothing changed that it does not know of.
    pub fn is_ready_for_queries(&self, bodies: &Bodies<D, T>) -> bool {
        self.tree_state == TreeState::Fresh { known: bodies.edits.changed().len() }
            && self.flying.is_empty()
            && !self.is_fat_stale
            && !bodies.edits.any_unlisted()
    }

    /// Makes the tree hold every body, with a box that contains its own.
    pub fn ready_for_queries(&mut self, bodies: &mut Bodies<D, T>) {
        bodies.list_changed();
        // Where one query is asked, more may follow.
        self.tree_uses += bodies.slots.live / 4;
        self.is_queried = true;
        self.ready_tree(bodies);
        self.land_in_tree(bodies);
        let Self { tree, tree_state, fat, .. } = self;
        let TreeState::Fresh { known } = tree_state else { return };
        while let Some(&index) = bodies.edits.changed().get(*known) {
            *known += 1;
            let row = index as usize;
            // Also for a free slot: a body that takes it has to be listed again.
            bodies.slots.raise(index, flag::IN_TREE);
            if !bodies.slots.has(index, flag::LIVE) {
                continue;
            }
            if bodies.slots.has(index, flag::NEW) {
                tree.set(index, &bodies.boxes[row]);
            } else if !fat[row].contains(&bodies.boxes[row]) {
                tree.set(index, &fat[row].union(&bodies.boxes[row]));
            }
        }
        // A body that changes between queries is listed each time: without updates the list would grow.
        if bodies.edits.changed().len() > 2 * bodies.slots.len() {
            let all = 0..bodies.slots.len() as u32;
            let changed = bodies.edits.changed_mut();
            changed.clear();
            changed.extend(all.filter(|&index| bodies.slots.has(index, flag::CHANGED)));
            *known = bodies.edits.changed().len();
        }
    }

    /// Notes that all fat AABBs are new. A body that is far from where it was must not enlarge the leaf
    /// where it was.
    #[inline(never)]
    pub fn note_new_fat(&mut self, bodies: &Bodies<D, T>) {
        let Self { tree, tree_state, scratch, fat, motion, .. } = self;
        if *tree_state == TreeState::Unbuilt {
            return;
        }
        for &index in bodies.edits.leaving() {
            tree.remove(index);
        }
        let moved = &mut scratch.escaped;
        moved.clear();
        moved.extend(bodies.edits.changed().iter().copied().filter(|&index| {
            let row = index as usize;
            bodies.slots.has(index, flag::LIVE)
                && (bodies.slots.has(index, flag::NEW)
                    || motion.is_jump(&bodies.previous[row], &bodies.boxes[row]))
        }));
        if moved.len() * 2 > tree.count {
            *tree_state = TreeState::Unbuilt;
            return;
        }
        for &index in &*moved {
            tree.set(index, &fat[index as usize]);
        }
        *tree_state = TreeState::Old;
    }
}
