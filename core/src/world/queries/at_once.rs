//! Many queries of a large world at once: all pairs of a box and a body are found as the pair finder finds them.

use super::lists::Lists;
use super::sorted_bodies::SortedBodies;
use crate::memory::{OutOfMemory, reserve_for};
use crate::pairs::PairFinder;
use crate::world::bodies::{Bodies, ProxyId, Slots};
use crate::{Aabb, Scalar};

/// Of at least this many bodies, not fewer than one query for this many: the finder copies and sorts all boxes, and the smaller
/// a world, the more of it a cache holds for searches of the tree. One core of an AMD EPYC (Zen 3, 2026-11-29), 2D and 3D, 0.5
/// to 50 bodies found by each: one query for 4 of 33,000 bodies takes 0.25 to 0.97 of the time of searches of the tree, one for
/// each body 0.25 to 0.75; one for 16 of 200,000 0.23 to 1.06, one for 8 0.21 to 0.72, one for each 0.15 to 0.29.
const PAYS: &[[usize; 2]] = &[[1 << 15, 4], [1 << 17, 12]];
/// The same if the boxes of bodies are [sorted](SortedBodies) already. As there (2026-11-30): one query for 4 of 8,192 bodies
/// 0.62 to 1.01, one for 16 of 33,000 0.39 to 1.18 and one for 4 0.29 to 0.53, one for 64 of 200,000 0.25 to 1.73, one for 16
/// 0.13 to 0.65, one for 4 0.12 to 0.28.
const PAYS_SORTED: &[[usize; 2]] = &[[1 << 13, 4], [1 << 15, 12], [1 << 17, 32]];

/// With many more pairs than this for each query and body, queries are asked one by one: pairs of bodies that are removed or
/// disabled are found, too, and those of all queries at once might not fit in memory.
const MOST_FOR_EACH: usize = 64;

/// Whether queries may take less time at once than one by one.
pub fn may_pay<const D: usize, T: Scalar>(bodies: &Bodies<D, T>, queries: usize) -> bool {
    are_enough(bodies.shapes().len(), queries, PAYS_SORTED)
}

fn are_enough(bodies: usize, queries: usize, pays: &[[usize; 2]]) -> bool {
    pays.iter().any(|&[least, each]| bodies >= least && queries >= bodies / each)
}

/// Lists for each of many boxes, which are valid, the bodies whose boxes overlap it, unless they are not visible, in no
/// particular order. Returns false if it takes less time one by one, or if the pairs of all are too many at once.
#[inline(never)]
pub fn list<const D: usize, T: Scalar>(
    areas: &[Aabb<D, T>],
    bodies: &Bodies<D, T>,
    sorted: &SortedBodies<D, T>,
    is_visible: Option<impl Fn(u32) -> bool>,
    lists: &mut Lists<ProxyId>,
) -> bool {
    let (shapes, mut finder) = (bodies.shapes(), PairFinder::new());
    let most = MOST_FOR_EACH * (areas.len() + shapes.len());
    let mut found = sorted.pairs_with(areas, shapes, most, &mut finder);
    if found.is_none() && are_enough(shapes.len(), areas.len(), PAYS) {
        let search = finder.search(areas).against(shapes).pairs_up_to(most);
        found = matches!(search, Ok(Some(_))).then(|| finder.take_pairs());
    }
    let Some(mut pairs) = found else { return false };
    if let Some(is_visible) = is_visible {
        pairs.retain(|&[_, body]| is_visible(body));
    }
    place(&pairs, areas.len(), &bodies.slots, lists).is_ok()
}

/// Lists for each of this many boxes the bodies of its pairs, each of a box and a body.
///
/// # Errors
/// [`OutOfMemory`]: then the lists are of no use.
#[inline(never)]
fn place(
    pairs: &[[u32; 2]],
    areas: usize,
    slots: &Slots,
    Lists { ends, values }: &mut Lists<ProxyId>,
) -> Result<(), OutOfMemory> {
    ends.clear();
    reserve_for(ends, areas + 1)?;
    ends.resize(areas + 1, 0);
    for &[area, _] in pairs {
        ends[area as usize + 1] += 1;
    }
    for area in 1..ends.len() {
        ends[area] += ends[area - 1];
    }
    values.clear();
    reserve_for(values, pairs.len())?;
    values.resize(pairs.len(), ProxyId::from_bits(0));
    // Where each list begins becomes where it ends.
    for &[area, body] in pairs {
        let at = &mut ends[area as usize];
        values[*at] = slots.id(body);
        *at += 1;
    }
    ends.pop();
    Ok(())
}
