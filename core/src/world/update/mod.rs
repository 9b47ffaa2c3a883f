//! The update: from boxes that changed to the pairs that begin and end.
//!
//! Every body has a fat AABB around its box, and the pairs of fat AABBs are kept as candidates. While
//! bodies stay within their fat AABBs only candidates can begin or end, and an update tests the list of
//! them, without those of sleeping bodies. A body that leaves its fat AABB gets a new one, which reaches
//! ahead in the direction of its motion, and a tree finds what that overlaps (`incremental`), or the finder
//! while there is no tree: one is built at the end of several updates, since at once it would take several times as
//! long as finding all pairs where few boxes overlap. Only where most bodies are new and static, since a level was loaded,
//! the update puts these to sleep and builds it at once. When many leave theirs, the finder finds all candidates
//! (`rebuild`). Where that happens again and again, fat AABBs do not pay, and for some updates all pairs of the
//! boxes themselves are found and compared with those of the last update (`from_scratch`); so it is where updates keep reading
//! more of the tree than that takes, in heaps. A few fast bodies
//! among many that rest are kept out of the tree, and searched among themselves (`flights`).
//!
//! Neither fat AABBs nor the strategy can be seen in the results. A pair is live if the last update knew
//! both bodies, their boxes overlapped and their filters allowed it: a fact about boxes and filters only.
//!
//! The steps are compiled as separate functions: inlined into one they are larger and no faster.

mod collect;
mod finish;
mod flights;
mod from_scratch;
mod give_back;
mod incremental;
mod rebuild;
mod search_tree;
mod take_back;
#[cfg(test)]
mod tests;

pub use rebuild::restore;

use super::bodies::Bodies;
use super::changes::Events;
use super::layout::Reorder;
use super::tracking::Tracking;
use crate::Scalar;
use crate::memory::OutOfMemory;

/// Finds the pairs that begin and end, and makes the world of now that of the last update.
///
/// # Errors
/// [`OutOfMemory`]: then nothing has changed but that there are no events.
pub fn update<const D: usize, T: Scalar>(
    bodies: &mut Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
    events: &mut Events,
) -> Result<(), OutOfMemory> {
    give_back::note_usage(bodies, tracking, events);
    events.begun.clear();
    events.ended.clear();
    bodies.refatten_too_wide();
    let found = find_events(bodies, tracking, events);
    let is_tree_due = core::mem::take(&mut tracking.is_tree_due);
    tracking.is_queried = false;
    if let Ok(mut order) = found {
        let is_level_new = bodies.is_level_new();
        if finish::finish(bodies, tracking, events, is_level_new) && order == Reorder::No {
            order = Reorder::BySpace;
        }
        tracking.reorder(bodies, order);
        // Loading takes long anyhow; each of the next frames would be late.
        if is_level_new && order != Reorder::Later {
            tracking.ready_tree(bodies);
        }
        if is_tree_due {
            tracking.advance_tree(bodies);
        }
    } else {
        take_back::take_back(bodies, tracking, events);
    }
    found.map(|_| ())
}

/// Finds the pairs that begin and end, by the way that is expected to be the fastest. Returns how to reorder storage.
fn find_events<const D: usize, T: Scalar>(
    bodies: &mut Bodies<D, T>,
    tracking: &mut Tracking<D, T>,
    events: &mut Events,
) -> Result<Reorder, OutOfMemory> {
    let mut order = Reorder::No;
    let changed = bodies.count_changes();
    let live = bodies.slots.live;
    let may_fly = changed > 0 && tracking.policy.may_fly(changed, live) && !tracking.is_queried;
    // Bodies fly where there is a tree already: building one is work for updates that have little else to do.
    let is_tree_advanced = may_fly && tracking.tree.is_built();
    let has_tree = is_tree_advanced && tracking.advance_tree(bodies);
    if changed > 0 && !has_tree && tracking.policy.skips_tracking(changed, live) {
        from_scratch::from_scratch(bodies, tracking, events, may_fly)?;
        tracking.is_tree_due = may_fly;
    } else if changed > 0 {
        tracking.candidates.list()?;
        collect::collect_escaped(bodies, tracking);
        let flights = tracking.choose_flying(bodies, has_tree);
        let escaped = tracking.scratch.escaped.len() - flights;
        let moves = escaped + bodies.edits.leaving().len();
        let too_many_fly = tracking.policy.too_many_fly(flights, moves, live);
        let rebuilds = too_many_fly || tracking.policy.rebuild_pays(moves, changed, live);
        if rebuilds && flights == 0 {
            tracking.policy.note_no_flights();
        }
        if rebuilds
            || !incremental::incremental(bodies, tracking, events, flights, is_tree_advanced)
        {
            order = rebuild::rebuild(bodies, tracking, events)?;
        } else if tracking.policy.reads_too_much(changed, live) {
            order = Reorder::Later;
        } else if tracking.is_order_due {
            order = Reorder::BySpace;
        }
        for pairs in [&mut events.begun, &mut events.ended] {
            bodies.slots.to_slots(pairs);
            tracking.scratch.sorter.sort(pairs, bodies.slots.len());
        }
    }
    Ok(order)
}
