//! Compiles the crate's functions for each number of dimensions and each coordinate type.
//!
//! Generic functions are otherwise compiled with the crate that calls them. In a debug build of a game that would be
//! without optimizations, even where the game optimizes its dependencies (`[profile.dev.package."*"] opt-level = 3`). A
//! function that is `#[inline(never)]` is compiled here instead if something here calls it, and others call that one. So
//! each public function that does more than a few steps is marked so, and called below. Without the static nothing
//! changes but the time of debug builds.
//!
//! WebAssembly is left out: there the sizes of files count, and bindings choose how each crate is optimized.

use core::ops::ControlFlow;

use crate::{
    Aabb, BroadPhase, Cast, Filter, Lists, PairFinder, ProxyId, Scalar, count_pairs, find_pairs,
    find_pairs_between, validate,
};

type CallAll<const D: usize, T> = fn(&mut BroadPhase<D, T>, &[ProxyId], &[Aabb<D, T>]);

/// One function for each kind of box, so that the compiler compiles what they call. Linkers drop it.
#[expect(dead_code, clippy::type_complexity, reason = "it is there to be compiled")]
static KINDS: (
    (CallAll<1, f32>, CallAll<2, f32>, CallAll<3, f32>),
    (CallAll<1, f64>, CallAll<2, f64>, CallAll<3, f64>),
) = ((call_all, call_all, call_all), (call_all, call_all, call_all));

/// Calls what is to be compiled; is never called itself.
fn call_all<const D: usize, T: Scalar>(
    world: &mut BroadPhase<D, T>,
    ids: &[ProxyId],
    boxes: &[Aabb<D, T>],
) {
    let (aabb, id, point) = (boxes[0], ids[0], boxes[0].min);
    let _ = (validate(boxes), find_pairs(boxes), find_pairs_between(boxes, boxes));
    let mut finder = PairFinder::<D, T>::new();
    let _ = (count_pairs(boxes), finder.find(boxes).is_ok(), finder.search(boxes).counts());
    let _ = finder.find_between(boxes, boxes).is_ok();
    let _ = finder.search(boxes).for_each_chunk(|_| ControlFlow::Break(()));
    let _ = (world.insert_with(aabb, Filter::ALL), world.insert_many(boxes, Filter::ALL));
    let _ = (world.set(id, aabb), world.set_many(ids, boxes), world.set_swept(id, aabb, aabb));
    let _ = (world.teleport(id, aabb), world.shift(point), world.set_filter(id, Filter::ALL));
    let _ = (world.remove_many(ids), world.update().is_empty(), world.pairs().len());
    let _ = (world.pairs_of(id).is_ok(), world.pairs_by_body());
    let _ = (world.snapshot(), world.state_hash());
    let _ = (world.snapshot_into(&mut alloc::vec::Vec::new()), world.prepare_queries());
    let _ = (world.set_enabled(id, false), world.exclude_pair(id, id), world.is_excluded(id, id));
    let _ = (BroadPhase::<D, T>::from_snapshot(&[]), world.clear());
    let saved = world.clone();
    world.clone_from(&saved);
    let cast = Cast::ray(point, point, point[0]);
    let queries = world.queries();
    let (mut found, mut hits) = (Lists::new(), Lists::new());
    let _ = (queries.overlapping(&aabb), queries.overlapping_many(boxes, &mut found));
    let _ = queries.visit_overlapping(&aabb, |_| ControlFlow::Break(()));
    let _ = (queries.containing(point), queries.containing_many(&[point], &mut found));
    let near = [(point, point[0])];
    let _ = (queries.within(point, point[0]), queries.within_many(&near, &mut found));
    let _ = queries.nearest(point, 1, 0.0);
    let _ = queries.nearest_many(&[point], 1, 0.0, &mut Lists::new());
    let _ = (queries.cast(&cast), queries.cast_many(&[cast], &mut alloc::vec::Vec::new()));
    let _ = (queries.cast_all(&cast), queries.cast_all_many(&[cast], &mut hits));
    let _ = queries.cast_with(&cast, |_| ControlFlow::Break(()));
}
