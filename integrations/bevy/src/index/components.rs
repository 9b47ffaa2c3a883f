//! What an entity has to be in the index.

use bevy::ecs::component::Component;
use sweep_and_prune::{Aabb, Filter};

use crate::versions::{Aabb2d, Aabb3d};

/// The box of an entity in the index, in units of the world. The index is brought up to date by change detection: set
/// it only where it differs.
///
/// A box with NaN, or whose min corner exceeds its max corner, keeps its entity out of the index; see
/// [`SpatialIndex::rejected`](super::SpatialIndex::rejected).
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct BoundingBox<const D: usize>(pub Aabb<D>);

/// With which others an entity of the index may pair; without it, with all. It changes neither what queries find nor the
/// box.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct IndexFilter(pub Filter);

impl From<Aabb2d> for BoundingBox<2> {
    fn from(aabb: Aabb2d) -> Self {
        Self(Aabb::new(aabb.min.to_array(), aabb.max.to_array()))
    }
}

impl From<Aabb3d> for BoundingBox<3> {
    fn from(aabb: Aabb3d) -> Self {
        Self(Aabb::new(aabb.min.to_array(), aabb.max.to_array()))
    }
}
