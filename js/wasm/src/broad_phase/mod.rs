//! The persistent broad phase.
//!
//! Few numbers go in and out through an area of 16 `f64`, many boxes through rows, many ids through
//! an array.

mod handle;
#[cfg(feature = "broad-phase")]
mod stored;
mod types;
#[cfg(feature = "broad-phase")]
mod whole;

use alloc::boxed::Box;

use sweep_and_prune::{Filter, Report};
use sweep_and_prune_bindings::{Id, filter};

use handle::{Handle, Number};
use sweep_and_prune_wasm_runtime::call::{self, run, stack, truth};
use sweep_and_prune_wasm_runtime::status::{Code, report, report_error};

/// A filter from its numbers; `None` if `is_static` is no truth value.
fn filter_of(category: u32, mask: u32, group: i32, is_static: u32) -> Option<Filter> {
    truth(is_static).map(|is_static| filter(category, mask, group, is_static))
}

/// A new broad phase, to be freed by [`world_free`]; null for dimensions other than 1 to 3, or a
/// margin or prediction that is negative, infinite or NaN.
#[unsafe(no_mangle)]
extern "C" fn world_new(
    dimensions: u32,
    is_double: u32,
    margin: f64,
    prediction: f64,
    is_fat: u32,
) -> Option<Box<Handle>> {
    stack::check(stack::SMALL);
    let report = match truth(is_fat)? {
        true => Report::Fat { margin, prediction },
        false => Report::Exact,
    };
    let world = types::broad_phase(dimensions, truth(is_double)?, report)?;
    Some(Box::new(Handle::new(world, dimensions)))
}

/// Frees a broad phase and all that it holds.
#[unsafe(no_mangle)]
extern "C" fn world_free(handle: Option<Box<Handle>>) {
    call::free(handle);
}

/// Where the 16 numbers are, until the broad phase is freed.
#[unsafe(no_mangle)]
extern "C" fn world_numbers(handle: &mut Handle) -> *mut f64 {
    handle.numbers.as_mut_ptr()
}

/// Where to write `count` rows of boxes; null if there is no memory for them.
#[unsafe(no_mangle)]
extern "C" fn world_rows(handle: &mut Handle, count: usize) -> *mut u8 {
    run(handle, stack::SMALL, |handle| handle.world.rows(count).unwrap_or(core::ptr::null_mut()))
}

/// Where to write `count` ids; null if there is no memory for them.
#[unsafe(no_mangle)]
extern "C" fn world_ids_in(handle: &mut Handle, count: usize) -> *mut f64 {
    run(handle, stack::SMALL, |handle| {
        if let Some(more) = count.checked_sub(handle.ids_in.len()) {
            if handle.ids_in.try_reserve(more).is_err() {
                return core::ptr::null_mut();
            }
            handle.ids_in.resize(count, 0.0);
        }
        handle.ids_in.as_mut_ptr()
    })
}

/// Adds a body whose box is in the numbers; the first of them is then its id.
#[unsafe(no_mangle)]
extern "C" fn world_insert(handle: &mut Handle) -> Code {
    run(handle, stack::SMALL, |handle| match handle.world.insert(&handle.numbers) {
        Ok(id) => {
            handle.note(id);
            handle.numbers[0] = Number::from_proxy(id).0;
            report(Code::Ok, [0, 0])
        }
        Err(error) => report_error(error),
    })
}

/// Adds a body for each of the first `count` rows. Details: where their ids are, and how many.
#[unsafe(no_mangle)]
extern "C" fn world_insert_many(
    handle: &mut Handle,
    count: usize,
    category: u32,
    mask: u32,
    group: i32,
    is_static: u32,
) -> Code {
    run(handle, stack::SMALL, |handle| {
        handle.ids_out.clear();
        let Some(filter) = filter_of(category, mask, group, is_static) else {
            return report(Code::Internal, [0, 0]);
        };
        let result = handle.world.insert_many(count, filter).map(|ids| {
            for id in ids {
                handle.note(id);
                handle.ids_out.push(Number::from_proxy(id));
            }
        });
        handle.answer(result)
    })
}

/// Gives a body the box in the numbers, to which it moved or, unless `teleports` is 0, did not.
#[unsafe(no_mangle)]
extern "C" fn world_set(handle: &mut Handle, id: f64, teleports: u32) -> Code {
    run(handle, stack::SMALL, |handle| {
        let result = handle.id(id, 0).and_then(|id| match teleports {
            0 => handle.world.set(id, &handle.numbers),
            _ => handle.world.teleport(id, &handle.numbers),
        });
        handle.answer(result)
    })
}

/// Adds the first numbers, one an axis, to all boxes.
#[unsafe(no_mangle)]
extern "C" fn world_shift(handle: &mut Handle) -> Code {
    run(handle, stack::SMALL, |handle| {
        let result = handle.world.shift(&handle.numbers);
        handle.answer(result)
    })
}

/// Gives the bodies of the first `count` ids the boxes in the rows.
#[unsafe(no_mangle)]
extern "C" fn world_set_many(handle: &mut Handle, count: usize) -> Code {
    run(handle, stack::SMALL, |handle| {
        let result = handle.read_ids(count).and_then(|()| handle.world.set_many(&handle.ids));
        handle.answer(result)
    })
}

/// Moves a body from the first box in the numbers to the second.
#[unsafe(no_mangle)]
extern "C" fn world_set_swept(handle: &mut Handle, id: f64) -> Code {
    run(handle, stack::SMALL, |handle| {
        let (from, to) = handle.numbers.split_at(handle.width());
        let result = handle.id(id, 0).and_then(|id| handle.world.set_swept(id, from, to));
        handle.answer(result)
    })
}

/// Changes the filter of a body.
#[unsafe(no_mangle)]
extern "C" fn world_set_filter(
    handle: &mut Handle,
    id: f64,
    category: u32,
    mask: u32,
    group: i32,
    is_static: u32,
) -> Code {
    run(handle, stack::SMALL, |handle| {
        let Some(filter) = filter_of(category, mask, group, is_static) else {
            return report(Code::Internal, [0, 0]);
        };
        let result = handle.id(id, 0).and_then(|id| handle.world.set_filter(id, filter));
        handle.answer(result)
    })
}

/// Disables a body, or enables it again.
#[unsafe(no_mangle)]
extern "C" fn world_set_enabled(handle: &mut Handle, id: f64, is_enabled: u32) -> Code {
    let Some(is_enabled) = truth(is_enabled) else { return report(Code::Internal, [0, 0]) };
    run(handle, stack::SMALL, |handle| {
        let result = handle.id(id, 0).and_then(|id| handle.world.set_enabled(id, is_enabled));
        handle.answer(result)
    })
}

/// Leaves the filter of a body in the first four numbers, and in the next whether it is enabled.
#[unsafe(no_mangle)]
extern "C" fn world_filter(handle: &mut Handle, id: f64) -> Code {
    run(handle, stack::SMALL, |handle| {
        let result =
            handle.id(id, 0).and_then(|id| handle.world.filter(id)).map(|(filter, is_enabled)| {
                handle.numbers[0] = f64::from(filter.category);
                handle.numbers[1] = f64::from(filter.mask);
                handle.numbers[2] = f64::from(filter.group);
                handle.numbers[3] = f64::from(u8::from(filter.is_static));
                handle.numbers[4] = f64::from(u8::from(is_enabled));
            });
        handle.answer(result)
    })
}

/// Leaves the box of a body in the numbers: as set or, unless `reported` is 0, as its overlaps are reported.
#[unsafe(no_mangle)]
extern "C" fn world_box(handle: &mut Handle, id: f64, reported: u32) -> Code {
    run(handle, stack::SMALL, |handle| {
        let width = handle.width();
        let result = handle
            .id(id, 0)
            .and_then(|id| handle.world.corners(id, reported != 0, &mut handle.numbers[..width]));
        handle.answer(result)
    })
}

/// Whether a body is here.
#[unsafe(no_mangle)]
extern "C" fn world_contains(handle: &mut Handle, id: f64) -> bool {
    handle.id(id, 0).is_ok_and(|id| handle.world.contains(id))
}

/// Removes the bodies of the first `count` ids.
#[unsafe(no_mangle)]
extern "C" fn world_remove_many(handle: &mut Handle, count: usize) -> Code {
    run(handle, stack::SMALL, |handle| {
        let result = handle.read_ids(count).and_then(|()| handle.world.remove_many(&handle.ids));
        handle.answer(result)
    })
}

/// Details: where the ids are, and how many: two for each pair that began, and then two for each pair that ended. The first
/// number is how many ids belong to pairs that began. If updates before it failed, these are the changes of the last
/// one, if it had any.
#[unsafe(no_mangle)]
extern "C" fn world_update(handle: &mut Handle, failures: u32) -> Code {
    run(handle, stack::LARGE, |handle| {
        handle.ids_out.clear();
        let begun = handle.world.update(failures > 0, &mut handle.ids_out);
        let result = begun.map(|count| handle.numbers[0] = count as f64);
        handle.answer(result)
    })
}

/// Details: where the ids of all bodies are, and how many.
#[unsafe(no_mangle)]
extern "C" fn world_ids(handle: &mut Handle) -> Code {
    run(handle, stack::SMALL, |handle| {
        handle.ids_out.clear();
        let ids = &mut handle.ids_out;
        handle.world.for_each_id(&mut |id| ids.push(Number::from_proxy(id)));
        handle.answer(Ok(()))
    })
}

/// How many bodies there are.
#[unsafe(no_mangle)]
extern "C" fn world_len(handle: &mut Handle) -> usize {
    handle.world.len()
}
