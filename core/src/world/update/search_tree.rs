//! The tree, brought up to date: for updates, which look up bodies, and for queries.

use crate::Scalar;
use crate::world::bodies::Bodies;
use crate::world::tracking::Tracking;

impl<const D: usize, T: Scalar> Tracking<D, T> {
    /// Makes the tree hold the fat AABBs of all bodies that are not new and do not fly.
    pub fn ready_tree(&mut self, bodies: &Bodies<D, T>) {
        while !self.advance_tree(bodies) {}
    }

    /// Brings the tree closer to that. Returns whether it holds them.
    #[inline(never)]
    pub fn advance_tree(&mut self, bodies: &Bodies<D, T>) -> bool {
        self.refresh_fat(bodies);
        self.tree.advance(bodies, &self.fat)
    }

    /// Whether the tree holds every body, with a box that contains its own, and nothing changed that it does not know of.
    pub fn is_ready_for_queries(&self, bodies: &Bodies<D, T>) -> bool {
        self.tree.knows_changes(bodies) && self.flying.is_empty() && !self.is_fat_stale
    }

    /// Makes the tree hold every body, with a box that contains its own.
    pub fn ready_for_queries(&mut self, bodies: &mut Bodies<D, T>) {
        bodies.list_changed();
        // Where one query is asked, more may follow.
        self.tree.note_uses(bodies.slots.live / 4);
        self.is_queried = true;
        self.ready_tree(bodies);
        self.land_in_tree(bodies);
        self.tree.add_changes(bodies, &self.fat);
        self.sorted.prepare(bodies.shapes());
    }

    /// Notes that all fat AABBs are new.
    pub fn note_new_fat(&mut self, bodies: &Bodies<D, T>) {
        let Self { tree, fat, motion, is_queried, scratch, .. } = self;
        tree.note_new_fat(bodies, fat, motion, *is_queried, &mut scratch.escaped);
    }
}
