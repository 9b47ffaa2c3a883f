//! Queries: what overlaps a box, a point or a sphere, what a ray or a moving box hits, what is nearest.
//!
//! Each query is a search of the tree: a lower bound for all bodies in a box, by which whole parts of the
//! world are skipped, and the same formula for one body. Very many boxes or points are found at once instead, by the pair
//! finder, or among bodies that are sorted already.

mod at_once;
mod cast;
mod heap;
mod lists;
mod math;
mod nearest;
mod region;
mod sorted_bodies;

pub use cast::{Cast, Hit};
pub use lists::Lists;
pub use nearest::Neighbor;
pub use region::Queries;
pub use sorted_bodies::SortedBodies;
