//! Worlds of boxes of the kind `3f`: bodies, and the pairs that begin and end.

use sweep_and_prune::Report;

use crate::boxes3f::{aabb_at, boxes_at, point_at, sap_aabb3f};
use crate::common::{
    filter_at, from_filter, id_pair, proxies, proxy, sap_changes, sap_filter, sap_id, sap_id_pair,
};
use crate::failure::{run, sap_error, sap_status};
use crate::handle::{Handle, create, destroy, read, write};
use crate::memory::{array, list, optional, optional_place, optional_places, place};
use crate::world::World;

/// The persistent broad phase: a set of bodies, each with a box, that reports which overlaps begin and which end. The same
/// calls give the same results on every platform. Where memory runs out the program ends, except in an update whose pairs do not
/// fit and in a query whose answer does not: these return `SAP_ERROR_OUT_OF_MEMORY`.
pub struct sap_world3f {
    _state: World<3, f32>,
}

impl Handle for sap_world3f {
    type State = World<3, f32>;
    const NAME: &'static str = "sap_world3f";
    const TAG: u64 = u64::from_le_bytes(*b"sapwld3f");
}

/// How a world treats its boxes. All zeros: the pairs of the exact boxes, one thread.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sap_options3f {
    /// Whether the pairs of fattened AABBs are reported, which begin and end less often than those of the boxes themselves.
    pub fat: bool,
    /// How far a fat AABB reaches beyond the box on every side, in units of length: finite, 0 or more. Not read unless `fat`.
    pub margin: f32,
    /// How many displacements of the last update it reaches ahead: finite, 0 or more. Not read unless `fat`.
    pub prediction: f32,
    /// The most threads of updates in which most bodies move; 0 counts as 1. The threads are the world's own, and no more than
    /// there are processors. Results do not depend on them.
    pub threads: u32,
}

/// Creates an empty world. `options` may be NULL, which is the same as all zeros. Destroy the world by `sap_world3f_destroy`.
///
/// Errors: `SAP_ERROR_INVALID_OPTION`, `SAP_ERROR_THREADS`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_create(
    options: *const sap_options3f,
    world: *mut *mut sap_world3f,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let world = place(world, "world")?;
            let (report, threads) = match optional(options, "options")? {
                None => (Report::Exact, 1),
                Some(&sap_options3f { fat: false, threads, .. }) => (Report::Exact, threads),
                Some(&sap_options3f { margin, prediction, threads, .. }) => {
                    (Report::Fat { margin, prediction }, threads)
                }
            };
            world.set(create(World::new(report, threads)?))
        })
    }
}

/// Destroys a world and sets the pointer to it to NULL. Does nothing if `world` or the pointer that it points to is NULL, or if
/// the world is in use.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_destroy(world: *mut *mut sap_world3f) {
    let call = || {
        // SAFETY: C promises it, see lib.rs.
        unsafe { destroy(world) };
        Ok(())
    };
    // SAFETY: there is no error to write.
    unsafe { run(std::ptr::null_mut(), call) };
}

/// Copies a world: the copy has the same bodies under the same ids, and continues as the world would. For rollback this is
/// faster than a snapshot. Takes O(n + pairs) time.
///
/// Errors: `SAP_ERROR_THREADS`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_copy(
    world: *const sap_world3f,
    copy: *mut *mut sap_world3f,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let copy = place(copy, "copy")?;
            copy.set(create(read(world, World::copy)?))
        })
    }
}

/// Makes a world equal to another one, as if it were a copy. Its memory is used again, so that saving a world now and then, in
/// turn to the same few worlds, allocates little. Keeps the threads of `world`. If `world` and `from` are the same:
/// `SAP_ERROR_BUSY`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_assign(
    world: *mut sap_world3f,
    from: *const sap_world3f,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            read(from, |from| {
                write(world, |state| {
                    state.assign(from);
                    Ok(())
                })
            })
        })
    }
}

/// Adds a body. `filter` may be NULL, which is the default filter. `id` may be NULL if the id is not needed.
///
/// Errors: `SAP_ERROR_INVALID_BOX`, `SAP_ERROR_TOO_MANY_BOXES`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_insert(
    world: *mut sap_world3f,
    aabb: *const sap_aabb3f,
    filter: *const sap_filter,
    id: *mut sap_id,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let (aabb, filter) = (aabb_at(aabb, "aabb")?, filter_at(filter)?);
            let place = optional_place(id, "id")?;
            let id = write(world, |state| Ok(state.bodies.insert_with(aabb, filter)?))?;
            place.map_or(Ok(()), |place| place.set(id.to_bits()))
        })
    }
}

/// Adds a body for each of `count` boxes, all with the same filter, which may be NULL. Writes `count` ids to `ids`, in the
/// order of the boxes; `ids` may be NULL if they are not needed.
///
/// Errors: as `sap_world3f_insert`; then no body has been added.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_insert_many(
    world: *mut sap_world3f,
    boxes: *const sap_aabb3f,
    count: usize,
    filter: *const sap_filter,
    ids: *mut sap_id,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let (boxes, filter) = (boxes_at(boxes, count, "boxes")?, filter_at(filter)?);
            let mut places = optional_places(ids, count, "ids")?;
            for id in write(world, |state| Ok(state.bodies.insert_many(boxes, filter)?))? {
                places.push(id.to_bits());
            }
            Ok(())
        })
    }
}

/// Gives a body another box: it moved there. You don't have to track which bodies moved; a body whose box stays the same costs
/// next to nothing.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_set(
    world: *mut sap_world3f,
    id: sap_id,
    aabb: *const sap_aabb3f,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let aabb = aabb_at(aabb, "aabb")?;
            write(world, |state| Ok(state.bodies.set(proxy(id), aabb)?))
        })
    }
}

/// Gives `count` bodies other boxes: `boxes[i]` to `ids[i]`. Of an id that is there twice the last box counts. Takes less time
/// than a call for each.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX`; then no box has been set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_set_many(
    world: *mut sap_world3f,
    ids: *const sap_id,
    boxes: *const sap_aabb3f,
    count: usize,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let (ids, boxes) =
                (proxies(array(ids, count, "ids")?), boxes_at(boxes, count, "boxes")?);
            write(world, |state| Ok(state.bodies.set_many(&ids, boxes)?))
        })
    }
}

/// Moves a body from one box to another: the next update sees the smallest box that contains both, so that nothing is missed on
/// the way; the update after it sees `to`, if the body is not set before.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX` (`index` is 0 for `from` and 1 for `to`).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_set_swept(
    world: *mut sap_world3f,
    id: sap_id,
    from: *const sap_aabb3f,
    to: *const sap_aabb3f,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let (from, to) = (aabb_at(from, "from")?, aabb_at(to, "to")?);
            write(world, |state| Ok(state.bodies.set_swept(proxy(id), from, to)?))
        })
    }
}

/// Gives a body another box, to which it did not move: a fat AABB does not reach ahead after it. For exact boxes the same as
/// `sap_world3f_set`.
///
/// Errors: `SAP_ERROR_STALE_ID`, `SAP_ERROR_INVALID_BOX`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_teleport(
    world: *mut sap_world3f,
    id: sap_id,
    aabb: *const sap_aabb3f,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let aabb = aabb_at(aabb, "aabb")?;
            write(world, |state| Ok(state.bodies.teleport(proxy(id), aabb)?))
        })
    }
}

/// Adds an offset to all boxes, for an origin that follows the player. `offset` points to 3 numbers, one for each axis.
/// Coordinates are rounded, so pairs that barely touch may begin or end.
///
/// Errors: `SAP_ERROR_INVALID_OFFSET`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_shift(
    world: *mut sap_world3f,
    offset: *const f32,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let offset = point_at(offset, "offset")?;
            write(world, |state| Ok(state.bodies.shift(offset)?))
        })
    }
}

/// Gives a body another filter, which counts from the next update on. NULL is the default filter.
///
/// Errors: `SAP_ERROR_STALE_ID`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_set_filter(
    world: *mut sap_world3f,
    id: sap_id,
    filter: *const sap_filter,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let filter = filter_at(filter)?;
            write(world, |state| Ok(state.bodies.set_filter(proxy(id), filter)?))
        })
    }
}

/// Disables a body (`false`), or enables it again. While it is disabled it pairs with no other, and queries do not find it; its
/// box and its filter can be set. Its pairs end or begin at the next update.
///
/// Errors: `SAP_ERROR_STALE_ID`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_set_enabled(
    world: *mut sap_world3f,
    id: sap_id,
    is_enabled: bool,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || write(world, |state| Ok(state.bodies.set_enabled(proxy(id), is_enabled)?)))
    }
}

/// Excludes a pair, whatever the filters of its bodies allow: those of a joint, say. It ends at the next update if it was there,
/// and does not begin until it is included again. A body that is removed is forgotten, and a pair of a body with itself is never
/// there.
///
/// Errors: `SAP_ERROR_STALE_ID` with index 0 for `a` and 1 for `b`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_exclude_pair(
    world: *mut sap_world3f,
    a: sap_id,
    b: sap_id,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || write(world, |state| Ok(state.bodies.exclude_pair(proxy(a), proxy(b))?)))
    }
}

/// Includes a pair that was excluded.
///
/// Errors: `SAP_ERROR_STALE_ID` with index 0 for `a` and 1 for `b`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_include_pair(
    world: *mut sap_world3f,
    a: sap_id,
    b: sap_id,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || write(world, |state| Ok(state.bodies.include_pair(proxy(a), proxy(b))?)))
    }
}

/// Removes a body. The next update reports the end of its pairs.
///
/// Errors: `SAP_ERROR_STALE_ID`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_remove(
    world: *mut sap_world3f,
    id: sap_id,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe { run(error, || write(world, |state| Ok(state.bodies.remove(proxy(id))?))) }
}

/// Removes `count` bodies.
///
/// Errors: `SAP_ERROR_STALE_ID` with the index of the first id that is stale or there twice; then no body has been removed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_remove_many(
    world: *mut sap_world3f,
    ids: *const sap_id,
    count: usize,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let ids = proxies(array(ids, count, "ids")?);
            write(world, |state| Ok(state.bodies.remove_many(&ids)?))
        })
    }
}

/// Removes all bodies. The next update reports the end of all pairs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_clear(
    world: *mut sap_world3f,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            write(world, |state| {
                state.bodies.clear();
                Ok(())
            })
        })
    }
}

/// Finds the pairs that began and those that ended since the last update. `changes` may be NULL if they are not needed.
///
/// Takes time in proportion to the bodies that changed and their neighbors.
///
/// Errors: `SAP_ERROR_OUT_OF_MEMORY` if the pairs of a crowd do not fit. The next call then reports what this one should have.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_update(
    world: *mut sap_world3f,
    changes: *mut sap_changes,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let place = optional_place(changes, "changes")?;
            let changes = write(world, |state| state.update())?;
            place.map_or(Ok(()), |place| place.set(changes))
        })
    }
}

/// How many bodies there are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_len(
    world: *const sap_world3f,
    len: *mut usize,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let len = place(len, "len")?;
            read(world, |state| len.set(state.bodies.len()))
        })
    }
}

/// Whether an id names a body that is here. No id is an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_contains(
    world: *const sap_world3f,
    id: sap_id,
    contains: *mut bool,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let contains = place(contains, "contains")?;
            read(world, |state| contains.set(state.bodies.contains(proxy(id))))
        })
    }
}

/// The box of a body as last set. That of a swept body is, until the next update, the smallest one that contains both of its
/// boxes.
///
/// Errors: `SAP_ERROR_STALE_ID`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_aabb(
    world: *const sap_world3f,
    id: sap_id,
    aabb: *mut sap_aabb3f,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let aabb = place(aabb, "aabb")?;
            read(world, |state| aabb.set(state.bodies.aabb(proxy(id))?.into()))
        })
    }
}

/// The box of a body whose overlaps are reported: its fat AABB if the world has the option `fat`, otherwise its box.
///
/// Errors: `SAP_ERROR_STALE_ID`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_reported_aabb(
    world: *const sap_world3f,
    id: sap_id,
    aabb: *mut sap_aabb3f,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let aabb = place(aabb, "aabb")?;
            read(world, |state| aabb.set(state.bodies.reported_aabb(proxy(id))?.into()))
        })
    }
}

/// The filter of a body.
///
/// Errors: `SAP_ERROR_STALE_ID`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_filter(
    world: *const sap_world3f,
    id: sap_id,
    filter: *mut sap_filter,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let filter = place(filter, "filter")?;
            read(world, |state| filter.set(from_filter(state.bodies.filter(proxy(id))?)))
        })
    }
}

/// Whether a body is enabled, as it is until `sap_world3f_set_enabled` says otherwise.
///
/// Errors: `SAP_ERROR_STALE_ID`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_is_enabled(
    world: *const sap_world3f,
    id: sap_id,
    is_enabled: *mut bool,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let is_enabled = place(is_enabled, "is_enabled")?;
            read(world, |state| is_enabled.set(state.bodies.is_enabled(proxy(id))?))
        })
    }
}

/// Whether a pair is excluded.
///
/// Errors: `SAP_ERROR_STALE_ID` with index 0 for `a` and 1 for `b`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_is_excluded(
    world: *const sap_world3f,
    a: sap_id,
    b: sap_id,
    is_excluded: *mut bool,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let is_excluded = place(is_excluded, "is_excluded")?;
            read(world, |state| is_excluded.set(state.bodies.is_excluded(proxy(a), proxy(b))?))
        })
    }
}

/// The ids of all bodies, sorted by slot. Writes the first `capacity` of them to `ids`, which may be NULL if `capacity` is 0;
/// `*count` is how many there are in all.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_ids(
    world: *const sap_world3f,
    ids: *mut sap_id,
    capacity: usize,
    count: *mut usize,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let mut list = list(ids, capacity, count)?;
            read(world, |state| {
                state.bodies.ids().for_each(|id| list.push(id.to_bits()));
                list.end()
            })
        })
    }
}

/// The pairs that overlapped at the last update, each once, sorted by slot. Writes the first `capacity` of them to `pairs`,
/// which may be NULL if `capacity` is 0; `*count` is how many there are in all. Takes O(pairs) time and memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_pairs(
    world: *const sap_world3f,
    pairs: *mut sap_id_pair,
    capacity: usize,
    count: *mut usize,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let mut list = list(pairs, capacity, count)?;
            read(world, |state| {
                state.bodies.pairs().for_each(|pair| list.push(id_pair(pair)));
                list.end()
            })
        })
    }
}

/// The bodies that overlapped this one at the last update, sorted by slot. Writes the first `capacity` of them to `ids`, which
/// may be NULL if `capacity` is 0; `*count` is how many there are in all. Takes O(log n) time and that of its neighbors after
/// `sap_world3f_prepare_queries` until the next update, otherwise O(pairs) time.
///
/// Errors: `SAP_ERROR_STALE_ID`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_pairs_of(
    world: *const sap_world3f,
    id: sap_id,
    ids: *mut sap_id,
    capacity: usize,
    count: *mut usize,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let mut list = list(ids, capacity, count)?;
            read(world, |state| {
                state.bodies.pairs_of(proxy(id))?.for_each(|id| list.push(id.to_bits()));
                list.end()
            })
        })
    }
}

/// The whole state as bytes. `*bytes` points to memory of the world, which is valid until its next snapshot, or its end. A
/// world restored from them gives, for the same calls, the same ids, events and results, bit for bit, on every platform. Takes
/// O(n) time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_snapshot(
    world: *mut sap_world3f,
    bytes: *mut *const u8,
    count: *mut usize,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let (bytes, count) = (place(bytes, "bytes")?, place(count, "count")?);
            write(world, |state| {
                let snapshot = state.snapshot();
                count.set(snapshot.len())?;
                bytes.set(snapshot.as_ptr())
            })
        })
    }
}

/// Makes a world that of a snapshot, with its options and ids; the bodies that it had are gone. Any bytes give a world or an
/// error. Keeps its threads. Takes the time of finding all pairs.
///
/// Errors: `SAP_ERROR_INVALID_SNAPSHOT`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_restore(
    world: *mut sap_world3f,
    bytes: *const u8,
    count: usize,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let bytes = array(bytes, count, "bytes")?;
            write(world, |state| state.restore(bytes))
        })
    }
}

/// A hash of the whole state: equal for equal states, on every platform. It shows whether two machines that run the same
/// simulation diverged. Takes O(n) time and memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_state_hash(
    world: *const sap_world3f,
    hash: *mut u64,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let hash = place(hash, "hash")?;
            read(world, |state| hash.set(state.bodies.state_hash()))
        })
    }
}

/// Gives back memory that is not needed now, and changes no result. Takes O(n + pairs) time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_shrink_to_fit(
    world: *mut sap_world3f,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            write(world, |state| {
                state.bodies.shrink_to_fit();
                Ok(())
            })
        })
    }
}
