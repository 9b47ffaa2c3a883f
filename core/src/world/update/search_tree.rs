//! The tree, brought up to date: for updates, which look up bodies, and for queries.

use crate::Scalar;
use crate::world::bodies::{Bodies, flag};
use crate::world::policy::refit_pays;
use crate::world::tracking::{Tracking, TreeState};

/// Removes from the tree the bodies that no update knew.
pub fn forget_removed<const D: usize, T: Scalar>(
    bodies: &mut Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
) {
    for index in bodies.only_in_tree.drain(..) {
        tracking.tree.remove(index);
    }
}

/// Makes the tree hold the fat AABBs of all bodies that are not new.
#[inline(never)]
pub fn ready<const D: usize, T: Scalar>(bodies: &Bodies<D, T>, tracking: &mut Tracking<D, T>) {
    tracking.refresh_fat(bodies);
    let Tracking { tree, tree_state, tree_uses, fat, .. } = tracking;
    match *tree_state {
        TreeState::Fresh { .. } => return,
        TreeState::Old if refit_pays(tree.refit(fat), *tree_uses, tree.len()) => {}
        _ => {
            *tree_uses = 0;
            let is_known = |&index: &u32| {
                bodies.slots.has(index, flag::LIVE | flag::LEAVING)
                    && !bodies.slots.has(index, flag::NEW)
            };
            tree.build((0..bodies.slots.len() as u32).filter(is_known), fat);
        }
    }
    *tree_state = TreeState::Fresh { known: 0 };
}

/// Makes the tree hold every body, with a box that contains its own.
pub fn ready_for_queries<const D: usize, T: Scalar>(
    bodies: &mut Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
) {
    tracking.grow(bodies);
    bodies.list_changed();
    // Where one query is asked, more may follow.
    tracking.tree_uses += bodies.live() / 4;
    forget_removed(bodies, tracking);
    ready(bodies, tracking);
    let Tracking { tree, tree_state, fat, .. } = tracking;
    let TreeState::Fresh { known } = tree_state else { return };
    while let Some(&index) = bodies.changed.get(*known) {
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
    if bodies.changed.len() > 2 * bodies.slots.len() {
        let all = 0..bodies.slots.len() as u32;
        bodies.changed.clear();
        bodies.changed.extend(all.filter(|&index| bodies.slots.has(index, flag::CHANGED)));
        *known = bodies.changed.len();
    }
}

/// Notes that all fat AABBs are new, and which bodies need a new one.
#[inline(never)]
pub fn note_new_fat<const D: usize, T: Scalar>(
    bodies: &Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
) {
    let Tracking { tree, tree_state, scratch, fat, motion, .. } = tracking;
    if *tree_state == TreeState::Unbuilt {
        return;
    }
    for &index in &bodies.leaving {
        tree.remove(index);
    }
    // A body that is far from where it was must not enlarge the leaf where it was.
    let is_elsewhere = |index: u32| {
        let row = index as usize;
        bodies.slots.has(index, flag::NEW)
            || motion.is_jump(&bodies.previous[row], &bodies.boxes[row])
    };
    let (escaped, moved) = (&scratch.escaped, &mut scratch.indices);
    moved.clear();
    moved.extend(escaped.iter().copied().filter(|&index| is_elsewhere(index)));
    if moved.len() * 2 > tree.len() {
        *tree_state = TreeState::Unbuilt;
        return;
    }
    for &index in moved.iter() {
        tree.set(index, &fat[index as usize]);
    }
    *tree_state = TreeState::Old;
}
