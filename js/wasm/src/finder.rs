//! Finds pairs.
//!
//! Each type of box adds nine kilobytes to the download, so there are three: 2D and 3D in single
//! precision, 3D in double precision. JavaScript stores 1D boxes as 2D, and 1D and 2D boxes in
//! double precision as 3D: they are flat on the axes that are added, which changes no pair.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::ops::ControlFlow::{self, Break, Continue};

use sweep_and_prune::Error;
use sweep_and_prune_bindings::{AnyPairFinder, TypedPairFinder};

use sweep_and_prune_wasm_runtime::call::{self, Running, stack, truth};
use sweep_and_prune_wasm_runtime::status::{Code, report, report_error};

/// Stands for the count of the second set where there is only one.
const NO_SET: usize = usize::MAX;

/// Takes pairs. One type for every purpose, so that the search is compiled once.
struct Taker {
    /// How many pairs are kept before they are handed to JavaScript; 0 if they are only counted.
    chunk: usize,
    buffer: Vec<[u32; 2]>,
    count: u64,
}

impl Taker {
    #[inline]
    fn take(&mut self, pairs: &[[u32; 2]]) -> ControlFlow<()> {
        self.count += pairs.len() as u64;
        if self.chunk == 0 {
            return Continue(());
        }
        self.buffer.extend_from_slice(pairs);
        if self.buffer.len() < self.chunk {
            return Continue(());
        }
        let wants_more = hand_over(&self.buffer);
        self.buffer.clear();
        if wants_more { Continue(()) } else { Break(()) }
    }
}

#[cfg(target_arch = "wasm32")]
#[link(wasm_import_module = "sweep_and_prune")]
unsafe extern "C" {
    /// Hands `count` pairs to the callback of the running call. Returns 0 if the callback wants no more. Never
    /// throws: an exception of the callback is thrown when the call has returned.
    safe fn each(pairs: *const [u32; 2], count: usize) -> u32;
}

#[cfg(target_arch = "wasm32")]
fn hand_over(pairs: &[[u32; 2]]) -> bool {
    each(pairs.as_ptr(), pairs.len()) != 0
}

#[cfg(not(target_arch = "wasm32"))]
fn hand_over(_: &[[u32; 2]]) -> bool {
    true
}

/// What JavaScript holds a pointer to.
#[repr(C)]
struct Finder {
    running: Running,
    finder: Box<dyn AnyPairFinder>,
    taker: Taker,
}

impl call::Handle for Finder {
    fn running(&mut self) -> &mut Running {
        &mut self.running
    }
}

/// A new finder, to be freed by [`finder_free`]; null if there is none for such boxes.
#[unsafe(no_mangle)]
extern "C" fn finder_new(dimensions: u32, is_double: u32) -> Option<Box<Finder>> {
    stack::check(stack::SMALL);
    let finder: Box<dyn AnyPairFinder> = match (dimensions, truth(is_double)?) {
        (2, false) => Box::new(TypedPairFinder::<2, f32>::new(1)),
        (3, false) => Box::new(TypedPairFinder::<3, f32>::new(1)),
        (3, true) => Box::new(TypedPairFinder::<3, f64>::new(1)),
        _ => return None,
    };
    let taker = Taker { chunk: 0, buffer: Vec::new(), count: 0 };
    Some(Box::new(Finder { running: Running::default(), finder, taker }))
}

/// Where to write `count` rows of boxes of set 0 or 1, valid until the next call with this finder;
/// null if there is no memory for them.
#[unsafe(no_mangle)]
extern "C" fn finder_rows(finder: Option<&mut Finder>, set: usize, count: usize) -> *mut u8 {
    let rows = finder.and_then(|handle| {
        call::run(handle, stack::SMALL, |handle| handle.finder.rows(set, count))
    });
    rows.unwrap_or(core::ptr::null_mut())
}

/// Finds the pairs of the first `a` rows of set 0, or those between them and the first `b` of
/// set 1, if `b` is not 2^32 - 1. If `chunk` is 0 it counts them: details are the low and the high
/// word. Otherwise it hands them to the import `each` as soon as it has `chunk` of them. Details:
/// where the rest is and how many, valid until the next call with this finder; none if `each`
/// wanted no more.
#[unsafe(no_mangle)]
extern "C" fn finder_find(finder: Option<&mut Finder>, a: usize, b: usize, chunk: usize) -> Code {
    let Some(handle) = finder else { return report(Code::Internal, [0, 0]) };
    call::run(handle, stack::LARGE, |handle| find(handle, a, b, chunk))
}

fn find(Finder { finder, taker, .. }: &mut Finder, a: usize, b: usize, chunk: usize) -> Code {
    (taker.chunk, taker.count) = (chunk, 0);
    taker.buffer.clear();
    let b = (b != NO_SET).then_some(b);
    if let Err(mut error) = finder.for_each_chunk(a, b, &mut |pairs| taker.take(pairs)) {
        // JavaScript counts the boxes of the second set after those of the first.
        if let Error::InvalidBox { set: 1, index, .. } = &mut error {
            *index += a;
        }
        return report_error(error);
    }
    if chunk == 0 {
        report(Code::Ok, [taker.count as usize, (taker.count >> 32) as usize])
    } else {
        report(Code::Ok, [taker.buffer.as_ptr().addr(), taker.buffer.len()])
    }
}

/// Frees a finder and all that it holds.
#[unsafe(no_mangle)]
extern "C" fn finder_free(finder: Option<Box<Finder>>) {
    call::free(finder);
}
