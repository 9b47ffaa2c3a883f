//! Which overlapping colliders become a contact pair, by Avian's rules.

use super::avian::collider_tree::{ColliderTreeProxy, ColliderTreeProxyFlags, ColliderTrees};
use super::avian::data_structures::pair_key::PairKey;
use super::avian::prelude::ContactGraph;
use super::joint_graph::JointGraph;
use super::tracked::{Tracked, proxy};

/// What becomes of an overlapping pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// A contact pair.
    Pair,
    /// A contact pair, unless the user's hook refuses it.
    AskHook,
    /// A contact pair already.
    Known,
    /// None now: the pair is examined again when one of its colliders moves.
    NotNow,
    /// None as long as both colliders belong to the same bodies.
    Never,
}

/// What to examine pairs by.
pub struct Rule<'a> {
    pub trees: &'a ColliderTrees,
    pub contacts: &'a ContactGraph,
    pub joints: &'a JointGraph,
    pub step: u64,
}

impl Rule<'_> {
    /// The verdict on an overlapping pair, and whether its second collider comes first in the contact pair.
    pub fn examine(&self, one: &Tracked, other: &Tracked) -> (Verdict, bool) {
        // Two colliders without a body count as colliders of the same one.
        if one.body == other.body {
            return (Verdict::Never, false);
        }
        let (Some(first), Some(second)) =
            (proxy(one.key, self.trees), proxy(other.key, self.trees))
        else {
            return (Verdict::NotNow, false);
        };
        if self.contacts.contains_key(&key(one, other)) {
            return (Verdict::Known, false);
        }
        // Of two that moved, the one that is first in Avian's order finds the other.
        let is_reversed = order(other) < order(one);
        let either = if is_reversed {
            [(other, second, one), (one, first, other)]
        } else {
            [(one, first, other), (other, second, one)]
        };
        let finds = |&(it, proxy, found): &(&Tracked, &ColliderTreeProxy, &Tracked)| {
            it.moved_at == self.step
                && (!it.key.is_static() || !found.key.is_static() || proxy.is_sensor())
        };
        let Some((finder, ..)) = either.iter().find(|it| finds(it)) else {
            return (Verdict::NotNow, false);
        };
        let is_reversed = finder.key != one.key;
        if !first.layers.interacts_with(second.layers) || self.is_jointed(one, other) {
            return (Verdict::NotNow, is_reversed);
        }
        let flags = first.flags.union(second.flags);
        let asks = flags.contains(ColliderTreeProxyFlags::CUSTOM_FILTER);
        (if asks { Verdict::AskHook } else { Verdict::Pair }, is_reversed)
    }

    /// Whether a joint between the bodies of two colliders disables their contacts.
    fn is_jointed(&self, one: &Tracked, other: &Tracked) -> bool {
        let (Some(body), Some(other)) = (one.body, other.body) else { return false };
        self.joints.joints_between(body, other).any(|edge| edge.collision_disabled)
    }
}

/// The key of a pair in the graph of contacts.
pub fn key(one: &Tracked, other: &Tracked) -> PairKey {
    PairKey::new(one.collider.index_u32(), other.collider.index_u32())
}

/// The position of a collider in Avian's order: by tree, then by position in the tree.
fn order(tracked: &Tracked) -> (u8, u32) {
    (tracked.key.tree_type() as u8, tracked.key.id().id())
}
