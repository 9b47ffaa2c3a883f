//! The living world: of either precision, chosen at run time.
//!
//! Numbers go in and out through one small area of `f64`, many boxes through rows, many ids
//! through an array. As in `finder.rs` there are three types of world, and JavaScript makes boxes
//! of fewer dimensions flat on the others.

mod handle;
mod typed;

use alloc::boxed::Box;
use alloc::vec::Vec;

use sweep_and_prune::{Filter, Report};

use crate::status::{Code, tell, tell_error};
use handle::{Handle, note, to_number};
use typed::{Query, Typed};

fn filter_of(category: u32, mask: u32, group: i32, is_static: bool) -> Filter {
    Filter { category, mask, group, is_static }
}

/// A new world, to be freed by [`world_free`]; null if there is none for such boxes, or a margin
/// is negative, infinite or NaN.
#[unsafe(no_mangle)]
extern "C" fn world_new(
    dimensions: u32,
    is_double: bool,
    margin: f64,
    prediction: f64,
    is_fat: bool,
) -> Option<Box<Handle>> {
    let report = if is_fat { Report::Fat } else { Report::Exact };
    let world = match (dimensions, is_double) {
        (2, false) => Typed::<2, f32>::boxed(margin, prediction, report),
        (3, false) => Typed::<3, f32>::boxed(margin, prediction, report),
        (3, true) => Typed::<3, f64>::boxed(margin, prediction, report),
        _ => None,
    }?;
    Some(Box::new(Handle::new(world)))
}

/// Frees a world and all that it holds.
#[unsafe(no_mangle)]
extern "C" fn world_free(handle: Option<Box<Handle>>) {
    drop(handle);
}

/// Where the 16 numbers are, as long as the world lives.
#[unsafe(no_mangle)]
extern "C" fn world_numbers(handle: &mut Handle) -> *mut f64 {
    handle.numbers.as_mut_ptr()
}

/// Where to write `count` rows of boxes; null if there is no memory for them.
#[unsafe(no_mangle)]
extern "C" fn world_rows(handle: &mut Handle, count: usize) -> *mut u8 {
    handle.world.rows(count).unwrap_or(core::ptr::null_mut())
}

/// Where to write `count` ids; null if there is no memory for them.
#[unsafe(no_mangle)]
extern "C" fn world_ids_in(handle: &mut Handle, count: usize) -> *mut f64 {
    if let Some(more) = count.checked_sub(handle.ids_in.len()) {
        if handle.ids_in.try_reserve(more).is_err() {
            return core::ptr::null_mut();
        }
        handle.ids_in.resize(count, 0.0);
    }
    handle.ids_in.as_mut_ptr()
}

/// Where to write `count` bytes of a snapshot; null if there is no memory for them.
#[unsafe(no_mangle)]
extern "C" fn world_bytes(handle: &mut Handle, count: usize) -> *mut u8 {
    handle.bytes.clear();
    if handle.bytes.try_reserve(count).is_err() {
        return core::ptr::null_mut();
    }
    handle.bytes.resize(count, 0);
    handle.bytes.as_mut_ptr()
}

/// Adds a body whose box is in the numbers; the first of them is then its id.
#[unsafe(no_mangle)]
extern "C" fn world_insert(handle: &mut Handle) -> Code {
    match handle.world.insert(&handle.numbers) {
        Ok(id) => {
            handle.note(id);
            handle.numbers[0] = to_number(id);
            tell(Code::Ok, [0, 0])
        }
        Err(error) => tell_error(error),
    }
}

/// Adds a body for each of the first `count` rows. Details: where their ids are, how many.
#[unsafe(no_mangle)]
extern "C" fn world_insert_many(
    handle: &mut Handle,
    count: usize,
    category: u32,
    mask: u32,
    group: i32,
    is_static: bool,
) -> Code {
    handle.out.clear();
    let filter = filter_of(category, mask, group, is_static);
    let result = handle.world.insert_many(count, filter).map(|ids| {
        for id in ids {
            handle.note(id);
            handle.out.push(to_number(id));
        }
    });
    handle.answer(result)
}

/// Gives a body the box in the numbers.
#[unsafe(no_mangle)]
extern "C" fn world_set(handle: &mut Handle, id: f64) -> Code {
    let result = handle.id(id, 0).and_then(|id| handle.world.set(id, &handle.numbers));
    handle.answer(result)
}

/// Gives the bodies of the first `count` ids the boxes in the rows.
#[unsafe(no_mangle)]
extern "C" fn world_set_many(handle: &mut Handle, count: usize) -> Code {
    let result = handle.read_ids(count).and_then(|()| handle.world.set_many(&handle.ids));
    handle.answer(result)
}

/// Moves a body from the first box in the numbers to the second.
#[unsafe(no_mangle)]
extern "C" fn world_set_swept(handle: &mut Handle, id: f64) -> Code {
    let result = handle.id(id, 0).and_then(|id| handle.world.set_swept(id, &handle.numbers));
    handle.answer(result)
}

/// Changes the filter of a body.
#[unsafe(no_mangle)]
extern "C" fn world_set_filter(
    handle: &mut Handle,
    id: f64,
    category: u32,
    mask: u32,
    group: i32,
    is_static: bool,
) -> Code {
    let filter = filter_of(category, mask, group, is_static);
    let result = handle.id(id, 0).and_then(|id| handle.world.set_filter(id, filter));
    handle.answer(result)
}

/// Leaves the filter of a body in the first four numbers.
#[unsafe(no_mangle)]
extern "C" fn world_filter(handle: &mut Handle, id: f64) -> Code {
    let result = handle.id(id, 0).and_then(|id| handle.world.filter(id)).map(|filter| {
        handle.numbers[0] = f64::from(filter.category);
        handle.numbers[1] = f64::from(filter.mask);
        handle.numbers[2] = f64::from(filter.group);
        handle.numbers[3] = f64::from(u8::from(filter.is_static));
    });
    handle.answer(result)
}

/// Leaves the box of a body in the numbers.
#[unsafe(no_mangle)]
extern "C" fn world_box(handle: &mut Handle, id: f64) -> Code {
    let result = handle.id(id, 0).and_then(|id| handle.world.aabb(id, &mut handle.numbers));
    handle.answer(result)
}

/// Whether an id names a body.
#[unsafe(no_mangle)]
extern "C" fn world_has(handle: &mut Handle, id: f64) -> bool {
    handle.id(id, 0).and_then(|id| handle.world.filter(id)).is_ok()
}

/// Removes the bodies of the first `count` ids.
#[unsafe(no_mangle)]
extern "C" fn world_remove_many(handle: &mut Handle, count: usize) -> Code {
    let result = handle.read_ids(count).and_then(|()| handle.world.remove_many(&handle.ids));
    handle.answer(result)
}

/// Details: where the pairs are that began and then those that ended, and how many ids; the first
/// number says how many of those are of pairs that began.
#[unsafe(no_mangle)]
extern "C" fn world_update(handle: &mut Handle) -> Code {
    handle.out.clear();
    handle.numbers[0] = handle.world.update(&mut handle.out) as f64;
    handle.answer(Ok(()))
}

/// Details: where the pairs of the last update are, and how many ids.
#[unsafe(no_mangle)]
extern "C" fn world_pairs(handle: &mut Handle) -> Code {
    handle.out.clear();
    handle.world.pairs(&mut handle.out);
    handle.answer(Ok(()))
}

/// Details: where the ids are of the bodies that overlapped this one, and how many.
#[unsafe(no_mangle)]
extern "C" fn world_pairs_of(handle: &mut Handle, id: f64) -> Code {
    handle.out.clear();
    let result = handle.id(id, 0).and_then(|id| handle.world.pairs_of(id, &mut handle.out));
    handle.answer(result)
}

/// Details: where the ids of all bodies are, and how many.
#[unsafe(no_mangle)]
extern "C" fn world_ids(handle: &mut Handle) -> Code {
    handle.out.clear();
    handle.world.ids(&mut |id| handle.out.push(to_number(id)));
    handle.answer(Ok(()))
}

/// How many bodies there are.
#[unsafe(no_mangle)]
extern "C" fn world_len(handle: &mut Handle) -> usize {
    handle.world.len()
}

/// Asks a query whose numbers are in the numbers. Details: where its answer is, and how many
/// numbers that is: ids, or ids each followed by a place or a squared distance.
#[unsafe(no_mangle)]
extern "C" fn world_query(
    handle: &mut Handle,
    query: u32,
    k: usize,
    category: u32,
    mask: u32,
    group: i32,
    is_static: bool,
) -> Code {
    let query = match query {
        0 => Query::Overlapping,
        1 => Query::Containing,
        2 => Query::Within,
        3 => Query::Cast,
        4 => Query::CastAll,
        _ => Query::Nearest(k),
    };
    let filter = filter_of(category, mask, group, is_static);
    handle.out.clear();
    let result = handle.world.query(query, filter, &handle.numbers, &mut handle.out);
    handle.answer(result)
}

/// Details: where the snapshot is, and how many bytes; until the next call.
#[unsafe(no_mangle)]
extern "C" fn world_snapshot(handle: &mut Handle) -> Code {
    handle.bytes = handle.world.snapshot();
    tell(Code::Ok, [handle.bytes.as_ptr().addr(), handle.bytes.len()])
}

/// Makes the world that of the snapshot in the bytes.
#[unsafe(no_mangle)]
extern "C" fn world_restore(handle: &mut Handle) -> Code {
    let result = handle.world.restore(&handle.bytes);
    handle.bytes = Vec::new();
    if result.is_ok() {
        let generations = &mut handle.generations;
        generations.clear();
        handle.world.ids(&mut |id| note(generations, id));
    }
    handle.answer(result)
}

/// Details: the hash of the state, the low and the high word.
#[unsafe(no_mangle)]
extern "C" fn world_hash(handle: &mut Handle) -> Code {
    let hash = handle.world.hash();
    tell(Code::Ok, [hash as u32 as usize, (hash >> 32) as usize])
}
