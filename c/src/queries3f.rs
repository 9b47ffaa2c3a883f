//! Queries of worlds of boxes of the kind `3f`: the bodies in a region, near a point, or hit by a ray or a moving box.

use std::ffi::c_void;
use std::ops::ControlFlow;

use sweep_and_prune::{Aabb, Cast, Hit};

use crate::boxes3f::{aabb_at, point_at, sap_aabb3f};
use crate::common::{SAP_NO_ID, sap_body_callback, sap_id, sap_neighbor, sap_query, wanted};
use crate::failure::{Failure, run, sap_error, sap_status};
use crate::handle::write;
use crate::memory::{list, one, place};
use crate::world::ask;
use crate::world3f::sap_world3f;

/// A moving box, or a ray. It is at `from + t * direction` for each t from 0 to `limit`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sap_cast3f {
    /// The box at t = 0. For a ray both corners are its origin.
    pub from: sap_aabb3f,
    /// How far it moves as t grows by 1: of any length, finite. If its length is 1, t is a distance.
    pub direction: [f32; 3],
    /// The largest t: 0 or more, may be infinite.
    pub limit: f32,
    /// Whether it hits only what it enters: what it touches at its start and moves away from, or slides along, is not hit.
    pub ignore_touching: bool,
}

/// A body that a cast hits.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sap_hit3f {
    /// The id of the body; `SAP_NO_ID` if nothing is hit.
    pub id: sap_id,
    /// Where the hit is: at `from + t * direction`. 0 if they overlap at the start.
    pub t: f64,
    /// Which way the face that is hit looks: of length 1 along an axis, away from the body. All 0 if the cast starts inside the
    /// body. At an edge or a corner, the face of the first axis.
    pub normal: [f32; 3],
    /// Whether the insides of the boxes overlap at the start.
    pub starts_inside: bool,
}

const NO_HIT: sap_hit3f =
    sap_hit3f { id: SAP_NO_ID, t: 0.0, normal: [0.0; 3], starts_inside: false };

impl From<Hit<3, f32>> for sap_hit3f {
    fn from(hit: Hit<3, f32>) -> Self {
        let Hit { id, t, normal, starts_inside, .. } = hit;
        Self { id: id.to_bits(), t, normal, starts_inside }
    }
}

/// A cast.
///
/// # Safety `cast` is null or points to a cast.
unsafe fn cast_at(cast: *const sap_cast3f) -> Result<Cast<3, f32>, Failure> {
    // SAFETY: as promised above.
    let &sap_cast3f { from, direction, limit, ignore_touching } = unsafe { one(cast, "cast")? };
    let cast = Cast::aabb(Aabb::new(from.min, from.max), direction, limit);
    Ok(if ignore_touching { cast.ignore_touching() } else { cast })
}

/// The cast of a ray from `origin`. Both arrays have 3 numbers. `ignore_touching` is false. If a pointer is NULL, its numbers
/// are NaN, which no query accepts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_ray3f(
    origin: *const f32,
    direction: *const f32,
    limit: f32,
) -> sap_cast3f {
    // SAFETY: C promises it, see lib.rs.
    let numbers = |from| unsafe { point_at(from, "ray") }.unwrap_or([f32::NAN; 3]);
    let origin = numbers(origin);
    let from = sap_aabb3f { min: origin, max: origin };
    sap_cast3f { from, direction: numbers(direction), limit, ignore_touching: false }
}

/// Prepares for queries, which takes time if bodies changed since the last query. A query does so by itself if it must. But
/// until a body is inserted or changed, or the next update, several threads may ask at the same time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_prepare_queries(
    world: *mut sap_world3f,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            write(world, |state| {
                state.bodies.prepare_queries();
                Ok(())
            })
        })
    }
}

/// The bodies whose boxes overlap a box. Writes the first `capacity` of them to `ids`, which may be NULL if `capacity` is 0;
/// `*count` is how many there are in all. All queries see the boxes as last set, updated or not.
///
/// Errors: `SAP_ERROR_INVALID_BOX`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_overlapping(
    world: *mut sap_world3f,
    aabb: *const sap_aabb3f,
    query: *const sap_query,
    ids: *mut sap_id,
    capacity: usize,
    count: *mut usize,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let (aabb, mut list) = (aabb_at(aabb, "aabb")?, list(ids, capacity, count)?);
            let wanted = wanted(query)?;
            ask(world, &wanted, |queries| {
                if wanted.unsorted {
                    queries.visit_overlapping(&aabb, |id| {
                        list.push(id.to_bits());
                        ControlFlow::Continue(())
                    })?;
                } else {
                    queries.overlapping(&aabb)?.into_iter().for_each(|id| list.push(id.to_bits()));
                }
                list.end()
            })
        })
    }
}

/// Calls `callback` with each body whose box overlaps a box, in no particular order, until it returns false: is this place
/// free? The callback may read from this world, and ask it, but not change it.
///
/// Errors: `SAP_ERROR_INVALID_BOX`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_each_overlapping(
    world: *mut sap_world3f,
    aabb: *const sap_aabb3f,
    query: *const sap_query,
    callback: sap_body_callback,
    context: *mut c_void,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let (aabb, wanted) = (aabb_at(aabb, "aabb")?, wanted(query)?);
            let callback =
                callback.ok_or(Failure::Argument { name: "callback", fault: "is NULL" })?;
            ask(world, &wanted, |queries| {
                let visit = |id: sweep_and_prune::ProxyId| {
                    if callback(context, id.to_bits()) {
                        ControlFlow::Continue(())
                    } else {
                        ControlFlow::Break(())
                    }
                };
                Ok(queries.visit_overlapping(&aabb, visit)?)
            })
        })
    }
}

/// The bodies whose boxes contain a point. `point` points to 3 numbers. Writes the first `capacity` of them to `ids`, which may
/// be NULL if `capacity` is 0; `*count` is how many there are in all.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` for a NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_containing(
    world: *mut sap_world3f,
    point: *const f32,
    query: *const sap_query,
    ids: *mut sap_id,
    capacity: usize,
    count: *mut usize,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let (point, mut list) = (point_at(point, "point")?, list(ids, capacity, count)?);
            let wanted = wanted(query)?;
            ask(world, &wanted, |queries| {
                queries.containing(point)?.into_iter().for_each(|id| list.push(id.to_bits()));
                list.end()
            })
        })
    }
}

/// The bodies whose boxes are at most `radius` away from a point. `center` points to 3 numbers. Writes the first `capacity` of
/// them to `ids`, which may be NULL if `capacity` is 0; `*count` is how many there are in all.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` if the center is not finite, or the radius negative or NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_within(
    world: *mut sap_world3f,
    center: *const f32,
    radius: f32,
    query: *const sap_query,
    ids: *mut sap_id,
    capacity: usize,
    count: *mut usize,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let (center, mut list) = (point_at(center, "center")?, list(ids, capacity, count)?);
            let wanted = wanted(query)?;
            ask(world, &wanted, |queries| {
                queries.within(center, radius)?.into_iter().for_each(|id| list.push(id.to_bits()));
                list.end()
            })
        })
    }
}

/// The bodies nearest to a point, at most `capacity` of them and at most `max_distance` away (which may be infinite), nearest
/// first. `point` points to 3 numbers. Writes them to `neighbors`; `*count` is how many were written.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` if the point is not finite, or the distance negative or NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_nearest(
    world: *mut sap_world3f,
    point: *const f32,
    max_distance: f64,
    query: *const sap_query,
    neighbors: *mut sap_neighbor,
    capacity: usize,
    count: *mut usize,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let (point, mut list) = (point_at(point, "point")?, list(neighbors, capacity, count)?);
            let wanted = wanted(query)?;
            ask(world, &wanted, |queries| {
                for near in queries.nearest(point, capacity, max_distance)? {
                    let distance_squared = near.distance_squared;
                    list.push(sap_neighbor { id: near.id.to_bits(), distance_squared });
                }
                list.end()
            })
        })
    }
}

/// The body that a ray or a moving box hits first; of several at once that with the smallest slot. `hit->id` is `SAP_NO_ID` if
/// it hits none.
///
/// Errors: `SAP_ERROR_INVALID_QUERY` if its box or direction is not finite, its box inverted, or its limit negative or NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_cast(
    world: *mut sap_world3f,
    cast: *const sap_cast3f,
    query: *const sap_query,
    hit: *mut sap_hit3f,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let (cast, hit, wanted) = (cast_at(cast)?, place(hit, "hit")?, wanted(query)?);
            ask(world, &wanted, |queries| hit.set(queries.cast(&cast)?.map_or(NO_HIT, Into::into)))
        })
    }
}

/// Everything that a ray or a moving box hits, sorted by t and then by slot. Writes the first `capacity` of them to `hits`,
/// which may be NULL if `capacity` is 0; `*count` is how many there are in all.
///
/// Errors: as `sap_world3f_cast`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_world3f_cast_all(
    world: *mut sap_world3f,
    cast: *const sap_cast3f,
    query: *const sap_query,
    hits: *mut sap_hit3f,
    capacity: usize,
    count: *mut usize,
    error: *mut sap_error,
) -> sap_status {
    // SAFETY: C promises it, see lib.rs.
    unsafe {
        run(error, || {
            let (cast, mut list) = (cast_at(cast)?, list(hits, capacity, count)?);
            let wanted = wanted(query)?;
            ask(world, &wanted, |queries| {
                queries.cast_all(&cast)?.into_iter().for_each(|hit| list.push(hit.into()));
                list.end()
            })
        })
    }
}
