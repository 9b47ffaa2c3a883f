//! What the algorithms sort: endpoints of intervals, in one total order.

use core::cmp::Ordering;

use sweep_and_prune::Scalar;

/// Which end of its box's interval an edge is. Left sorts before right, because intervals are
/// closed: where two boxes touch, one begins before the other ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Side {
    /// The minimum, written `(`.
    Left = 0,
    /// The maximum, written `)`.
    Right = 1,
}

/// One side of one box: the name of an endpoint, without its coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Edge {
    /// The side.
    pub side: Side,
    /// The index of the box.
    pub id: u32,
}

/// An edge and where it lies on the axis that is being sorted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Endpoint<T> {
    /// The coordinate.
    pub at: T,
    /// Which box, which side.
    pub edge: Edge,
}

impl<T: Scalar> Endpoint<T> {
    /// The left endpoint of box `id`.
    #[inline]
    pub fn left(at: T, id: u32) -> Self {
        Self { at, edge: Edge { side: Side::Left, id } }
    }

    /// The right endpoint of box `id`.
    #[inline]
    pub fn right(at: T, id: u32) -> Self {
        Self { at, edge: Edge { side: Side::Right, id } }
    }

    /// The total order of endpoints: coordinate, then left before right, then id.
    ///
    /// No two endpoints compare as equal, so every sort gives the same array, and no sort changes a
    /// sorted array, however many coordinates coincide.
    #[inline]
    pub fn order(&self, other: &Self) -> Ordering {
        self.at.order(other.at).then(self.edge.cmp(&other.edge))
    }

    /// Whether this endpoint stands before the other in the total order.
    #[inline]
    pub fn precedes(&self, other: &Self) -> bool {
        self.order(other) == Ordering::Less
    }
}
