//! A tree of boxes: what one body's box overlaps, and what a query looks for.
//!
//! An R-tree (Guttman 1984) of 16 boxes a node, held axis by axis so that the compiler tests
//! several at once. Built from the top by cutting in the middle, along the axis on which the
//! centers spread most for the size of the boxes; bodies that are far larger than others go into
//! trees of their own under one root, so that a giant does not widen the node of a dwarf.

mod build;
mod edit;
mod node;
mod search;

pub use edit::Tree;
pub use search::{BATCH, TOGETHER};
