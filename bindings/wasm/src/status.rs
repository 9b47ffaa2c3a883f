//! How a call ended: a code, and two words of detail where JavaScript can read them.

use core::sync::atomic::{AtomicU32, Ordering::Relaxed};

use sweep_and_prune::{Error, SnapshotFault};

/// What a call returns; `js/src/wasm/engine.ts` has the same list.
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
    /// Details: the position of the id.
    StaleProxy = 4,
    /// Details: the position of the query or number.
    InvalidArgument = 5,
    /// Details: what is wrong, as `js/src/world/snapshot-error.ts` lists it, and the version
    /// found.
    InvalidSnapshot = 6,
}

/// Atomic only because a static must be: in WebAssembly these are plain loads and stores.
static DETAILS: [AtomicU32; 2] = [AtomicU32::new(0), AtomicU32::new(0)];

/// Leaves two words for JavaScript to read.
pub fn report(code: Code, details: [usize; 2]) -> Code {
    for (word, value) in DETAILS.iter().zip(details) {
        word.store(value as u32, Relaxed);
    }
    code
}

/// The code and details of an error of the core.
pub fn report_error(error: Error) -> Code {
    match error {
        Error::InvalidBox { index, axis, .. } => report(Code::InvalidBox, [index, axis]),
        Error::TooManyBoxes { .. } | Error::OutOfMemory => report(Code::OutOfMemory, [0, 0]),
        Error::StaleProxy { index, .. } => report(Code::StaleProxy, [index, 0]),
        Error::InvalidQuery { index, .. } => report(Code::InvalidArgument, [index, 0]),
        Error::InvalidSnapshot(fault) => {
            let fault = match fault {
                SnapshotFault::Foreign => [0, 0],
                SnapshotFault::Version { found } => [1, found.into()],
                SnapshotFault::OtherWorld { dimensions, .. } => [2, dimensions],
                SnapshotFault::Truncated => [3, 0],
                _ => [4, 0],
            };
            report(Code::InvalidSnapshot, fault)
        }
        _ => report(Code::Internal, [0, 0]),
    }
}

/// Where the two words of detail are.
#[unsafe(no_mangle)]
extern "C" fn status() -> *const AtomicU32 {
    DETAILS.as_ptr()
}
