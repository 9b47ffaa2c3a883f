//! A spatial index over any entities with a box, without physics.

mod components;
mod messages;
mod plugin;
mod resource;

pub use components::{BoundingBox, IndexFilter};
pub use messages::{OverlapBegan, OverlapEnded};
pub use plugin::{SpatialIndexPlugin, SpatialIndexSystems};
pub use resource::{IndexHit, IndexNeighbor, SpatialIndex};
