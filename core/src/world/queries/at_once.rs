//! Many queries of a large world at once: the pair finder finds all pairs of boxes and bodies.

use super::lists::Lists;
use crate::pairs::PairFinder;
use crate::world::bodies::{Bodies, ProxyId};
use crate::{Aabb, Scalar};

/// Of at least this many bodies, not fewer than one query for this many: the finder copies and sorts all boxes, and the smaller
/// a world, the more of it a cache holds for searches of the tree. One core of an AMD EPYC (Zen 3, 2026-11-29), 2D and 3D, 0.5
/// to 50 bodies found by each: one query for 4 of 33,000 bodies takes 0.25 to 0.97 of the time of searches of the tree, one for
/// each body 0.25 to 0.75; one for 16 of 200,000 0.23 to 1.06, one for 8 0.21 to 0.72, one for each 0.15 to 0.29.
const PAYS: [[usize; 2]; 2] = [[1 << 15, 4], [1 << 17, 12]];
/// No body: the one that overlaps is not visible.
const HIDDEN: u32 = u32::MAX;

/// Whether queries take less time at once than one by one.
pub fn pays<const D: usize, T: Scalar>(bodies: &Bodies<D, T>, queries: usize) -> bool {
    let count = bodies.shapes().len();
    PAYS.iter().any(|&[least, each]| count >= least && queries >= count / each)
}

/// Lists for each of many boxes, which are valid, the visible bodies whose boxes overlap it, in no particular order. Returns
/// false if there is not enough memory for all pairs at once.
#[inline(never)]
pub fn list<const D: usize, T: Scalar>(
    areas: &[Aabb<D, T>],
    bodies: &Bodies<D, T>,
    is_visible: impl Fn(u32) -> bool,
    Lists { ends, values }: &mut Lists<ProxyId>,
) -> bool {
    let mut finder = PairFinder::new();
    let search = finder.search(areas).against(bodies.shapes());
    let Ok(Some(pairs)) = search.pairs_up_to(usize::MAX) else { return false };
    ends.clear();
    ends.resize(areas.len() + 1, 0);
    for [area, body] in &mut *pairs {
        if is_visible(*body) {
            ends[*area as usize + 1] += 1;
        } else {
            *body = HIDDEN;
        }
    }
    for area in 1..ends.len() {
        ends[area] += ends[area - 1];
    }
    values.clear();
    values.resize(ends[areas.len()], ProxyId::from_bits(0));
    // Where each list begins becomes where it ends.
    for &[area, body] in pairs.iter().filter(|[_, body]| *body != HIDDEN) {
        let at = &mut ends[area as usize];
        values[*at] = bodies.slots.id(body);
        *at += 1;
    }
    ends.pop();
    true
}
