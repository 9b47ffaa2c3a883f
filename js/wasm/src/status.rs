//! How a call ended: a code, and two words of detail where JavaScript can read them.

use core::sync::atomic::{AtomicU32, Ordering::Relaxed};

use sweep_and_prune::Error;

/// What a call returns; `js/src/engine.ts` has the same list.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Code {
    /// Details: where the result is, and its length.
    Ok = 0,
    /// Details: the index of the box, and the axis.
    InvalidBox = 1,
    /// No details.
    OutOfMemory = 2,
    /// An error that these exports should never meet. No details.
    Internal = 3,
}

/// Atomic only because a static must be: in WebAssembly these are plain loads and stores.
static DETAILS: [AtomicU32; 2] = [AtomicU32::new(0), AtomicU32::new(0)];

/// Leaves two words for JavaScript to read.
pub fn tell(code: Code, details: [usize; 2]) -> Code {
    for (word, value) in DETAILS.iter().zip(details) {
        word.store(value as u32, Relaxed);
    }
    code
}

/// The code and details of an error of the core.
pub fn tell_error(error: Error) -> Code {
    match error {
        Error::InvalidBox { index, axis } => tell(Code::InvalidBox, [index, axis]),
        Error::TooManyBoxes { .. } => tell(Code::OutOfMemory, [0, 0]),
        _ => tell(Code::Internal, [0, 0]),
    }
}

/// Where the two words of detail are.
#[unsafe(no_mangle)]
extern "C" fn status() -> *const AtomicU32 {
    DETAILS.as_ptr()
}
