//! What a broad phase of all types does beside tracking bodies: queries, lists of its pairs, snapshots.

use alloc::vec::Vec;

use sweep_and_prune_bindings::{Answer, Query};

use super::filter_of;
use super::handle::{Handle, id_of, note};
use super::stored;
use sweep_and_prune_wasm_runtime::call::{run, stack, truth};
use sweep_and_prune_wasm_runtime::status::{Code, report, report_error};

/// Where to write `count` bytes of a snapshot; null if there is no memory for them.
#[unsafe(no_mangle)]
extern "C" fn world_bytes(handle: &mut Handle, count: usize) -> *mut u8 {
    run(handle, stack::SMALL, |handle| {
        handle.bytes.clear();
        if handle.bytes.try_reserve(count).is_err() {
            return core::ptr::null_mut();
        }
        handle.bytes.resize(count, 0);
        handle.bytes.as_mut_ptr()
    })
}

/// Excludes a pair if `excluded` is 1, includes it if 0, and else changes nothing. Leaves in the first number whether it was
/// excluded.
#[unsafe(no_mangle)]
extern "C" fn world_exclude(handle: &mut Handle, a: f64, b: f64, excluded: u32) -> Code {
    run(handle, stack::SMALL, |handle| {
        let result = handle.id(a, 0).and_then(|a| {
            let pair = [a, handle.id(b, 1)?];
            handle.numbers[0] = f64::from(u8::from(handle.world.is_excluded(pair)?));
            if excluded > 1 { Ok(()) } else { handle.world.set_excluded(pair, excluded == 1) }
        });
        handle.answer(result)
    })
}

/// Details: where the pairs of the last update are, and how many ids.
#[unsafe(no_mangle)]
extern "C" fn world_pairs(handle: &mut Handle, is_sorted: u32) -> Code {
    let Some(is_sorted) = truth(is_sorted) else { return report(Code::Internal, [0, 0]) };
    run(handle, stack::LARGE, |handle| {
        handle.ids_out.clear();
        if is_sorted {
            handle.world.pairs(&mut handle.ids_out);
        } else {
            handle.world.pairs_unsorted(&mut handle.ids_out);
        }
        handle.answer(Ok(()))
    })
}

/// Details: where the ids of the bodies that overlapped this one are, and how many.
#[unsafe(no_mangle)]
extern "C" fn world_pairs_of(handle: &mut Handle, id: f64) -> Code {
    run(handle, stack::LARGE, |handle| {
        handle.ids_out.clear();
        let result = handle.id(id, 0).and_then(|id| handle.world.pairs_of(id, &mut handle.ids_out));
        handle.answer(result)
    })
}

/// Answers a query, whose numbers are in the numbers, or many, whose `many` numbers follow the excluded ids. Details: where
/// the ids are that it found, and how many. The first number is where their values are (t, or squared distances), as many,
/// the second where the faces of hits are, the third where the ids of each query end, 32 bits for each query. If `is_static`
/// is 2 there is no filter. `is_sorted` is for queries whose answer has no values. The first `excluded` ids that were written
/// are not found; one of them that is stale excludes nothing.
#[unsafe(no_mangle)]
extern "C" fn world_query(
    handle: &mut Handle,
    query: u32,
    k: usize,
    category: u32,
    mask: u32,
    group: i32,
    is_static: u32,
    is_sorted: u32,
    excluded: usize,
    many: usize,
) -> Code {
    let internal = || report(Code::Internal, [0, 0]);
    let filter = match is_static {
        2 => None,
        _ => match filter_of(category, mask, group, is_static) {
            Some(filter) => Some(filter),
            None => return internal(),
        },
    };
    let dimensions = handle.world.kind().dimensions;
    let max_distance = handle.numbers[dimensions];
    let Some(query) = Query::numbered(query, k, max_distance) else { return internal() };
    let Some(is_sorted) = truth(is_sorted) else { return internal() };
    run(handle, stack::LARGE, |handle| {
        let (excluded, rest) = handle.ids_in.split_at(excluded.min(handle.ids_in.len()));
        let numbers = match many {
            0 => &handle.numbers[..query.width(dimensions)],
            _ => &rest[..many.min(rest.len())],
        };
        handle.ids.clear();
        handle.ids.extend(excluded.iter().filter_map(|&id| id_of(&handle.generations, id)));
        let (excluded, answer) = (&handle.ids, &mut handle.answer);
        let result = handle.world.query(query, numbers, filter, excluded, is_sorted, answer);
        // After an error JavaScript reads the box that was passed.
        if let Err(error) = result {
            return report_error(error);
        }
        let Answer { ids, values, faces, ends, .. } = answer;
        handle.numbers[0] = values.as_ptr().addr() as f64;
        handle.numbers[1] = faces.as_ptr().addr() as f64;
        handle.numbers[2] = ends.as_ptr().addr() as f64;
        report(Code::Ok, [ids.as_ptr().addr(), ids.len()])
    })
}

/// Details: where the snapshot is, and how many bytes; until the next call.
#[unsafe(no_mangle)]
extern "C" fn world_snapshot(handle: &mut Handle) -> Code {
    run(handle, stack::LARGE, |handle| {
        handle.bytes = stored::snapshot(&handle.world, handle.dimensions);
        report(Code::Ok, [handle.bytes.as_ptr().addr(), handle.bytes.len()])
    })
}

/// Becomes the broad phase of the snapshot in the bytes. Details: whether it is in double precision.
#[unsafe(no_mangle)]
extern "C" fn world_restore(handle: &mut Handle) -> Code {
    run(handle, stack::LARGE, |handle| {
        let restored = stored::restore(&mut handle.bytes, handle.dimensions);
        handle.bytes = Vec::new();
        match restored {
            Ok(world) => {
                handle.world = world;
                let generations = &mut handle.generations;
                generations.clear();
                handle.world.for_each_id(&mut |id| note(generations, id));
                report(Code::Ok, [usize::from(handle.world.kind().is_double), 0])
            }
            Err(error) => report_error(error),
        }
    })
}

/// Details: the hash of the state, the low and the high word.
#[unsafe(no_mangle)]
extern "C" fn world_state_hash(handle: &mut Handle) -> Code {
    run(handle, stack::LARGE, |handle| {
        let hash = handle.world.state_hash();
        report(Code::Ok, [hash as u32 as usize, (hash >> 32) as usize])
    })
}
