//! What the index reports.

use bevy::ecs::entity::Entity;
use bevy::ecs::message::Message;

/// The boxes of two entities overlap, and did not when the index was last brought up to date.
#[derive(Message, Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct OverlapBegan<const D: usize> {
    /// The two entities, the one that has been in the index for longer first, unless it has the place of one that left.
    pub entities: [Entity; 2],
}

/// The boxes of two entities overlapped when the index was last brought up to date, and do not now, or one of the two left
/// the index. It may be despawned.
#[derive(Message, Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct OverlapEnded<const D: usize> {
    /// The two entities, in the order in which their overlap began.
    pub entities: [Entity; 2],
}

impl<const D: usize> OverlapBegan<D> {
    pub(super) fn new(entities: [Entity; 2]) -> Self {
        Self { entities }
    }
}

impl<const D: usize> OverlapEnded<D> {
    pub(super) fn new(entities: [Entity; 2]) -> Self {
        Self { entities }
    }
}
