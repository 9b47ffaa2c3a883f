//! The endpoint sweep: a line moves over the sorted endpoints and knows which boxes it touches.
//!
//! ```text
//! sort the endpoints
//! touching = {}
//! for each endpoint, from left to right
//!     left:  for each other in touching: overlap on the axis -> test the remaining axes
//!            add its box to touching
//!     right: remove its box from touching
//! ```
//!
//! Time: the sort of 2n endpoints, plus O(n + m) where m is the number of overlaps *on the sweep
//! axis*: each is met exactly once, at the later of the two left endpoints. Memory: O(n). The
//! article's table gives O(n) at best with quicksort; that is the sweep alone, the sort still
//! takes O(n log n).
//!
//! Unlike the article's listing the order is total, with left before right at equal coordinates:
//! a box that begins where another ends still finds it in `touching`, because intervals are
//! closed, and a point or a flat box enters before it leaves. Pairs are collected, so that nothing
//! moves while it is being swept. The endpoints keep their order from call to call.

use alloc::vec::Vec;

use crate::endpoint::{Edge, Endpoint, Side};
use crate::endpoint_array::EndpointArray;
use crate::observer::{Observer, test_beside};
use crate::touching::Touching;
use sweep_and_prune::{Aabb, Scalar};

/// Appends all overlapping pairs of the boxes in `array`, which is sorted, in the order in which the sweep along
/// `axis` finds them.
pub(crate) fn endpoint_sweep<const D: usize, T: Scalar, O: Observer>(
    boxes: &[Aabb<D, T>],
    array: &EndpointArray<T>,
    touching: &mut Touching,
    axis: usize,
    observer: &mut O,
    pairs: &mut Vec<[u32; 2]>,
) {
    sweep(&array.endpoints, touching, observer, |observer, a, b| {
        test_beside(boxes, [a, b], axis, observer, pairs);
    });
}

/// Moves the line over sorted endpoints; `meet(a, b)` is called for each pair that overlaps on
/// their axis, when the line enters `b` while touching `a`. Leaves `touching` empty.
pub(crate) fn sweep<T: Scalar, O: Observer>(
    endpoints: &[Endpoint<T>],
    touching: &mut Touching,
    observer: &mut O,
    mut meet: impl FnMut(&mut O, u32, u32),
) {
    for (position, endpoint) in endpoints.iter().enumerate() {
        let Edge { side, id } = endpoint.edge;
        observer.visit(position, endpoint.edge);
        match side {
            Side::Left => {
                observer.enter(id);
                for &other in touching.ids() {
                    meet(observer, other, id);
                }
                touching.add(id);
            }
            Side::Right => {
                touching.remove(id);
                observer.leave(id);
            }
        }
    }
}
