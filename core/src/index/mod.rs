//! A static index: built once over boxes that do not move, and then asked which of them a box, a point or a
//! ray meets.
//!
//! It is a packed R-tree. A node has 16 boxes. The first level is all boxes, 16 to a leaf; each higher level
//! has the bounds of the nodes below it, until one node is left. All nodes are full but the last of each
//! level, so the number of boxes alone gives the place of every node: nothing in the bytes is a position
//! that could lead out of them.
//!
//! ```text
//! boxes -> pack (the order of the leaves) -> build (the bytes) -> search, nearest -> the user
//! ```
//!
//! `format.rs` says what the bytes mean, and `api.rs` is what users see. A node stores each corner coordinate
//! of its 16 boxes side by side, so that a kernel compares many boxes at once. Lanes without a box are NaN,
//! which is `<=` nothing.
//!
//! # Any bytes are safe
//! Bytes are read through slices, as little-endian numbers at any alignment. A search visits each node at
//! most once, and indices of boxes are clamped to the number of boxes. So bytes that were damaged, or made
//! to do harm, give wrong results and nothing else.
//!
//! # Sources
//! Leutenegger, Lopez and Edgington 1997, *STR: a simple and efficient algorithm for R-tree packing*.
//! Agafonkin's flatbush showed how far an index in one buffer goes.

// Iterators over several arrays at once are not inlined into functions with target features.
#![allow(clippy::needless_range_loop)]

mod api;
mod build;
mod format;
mod nearest;
mod pack;
mod search;

pub use api::Index;
pub use build::IndexBuffer;
pub use format::IndexInfo;
pub use search::SearchBuffer;
