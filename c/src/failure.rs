//! Statuses, errors, and the boundary that no panic crosses.

use std::any::Any;
use std::ffi::c_char;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};

use sweep_and_prune::Error;

/// How a call ended. After any status but `SAP_OK` the call has changed nothing and written no result, with one
/// exception: see `SAP_ERROR_PANIC`.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum sap_status {
    /// The call did what it should.
    SAP_OK = 0,
    /// A pointer is NULL that must not be, or not aligned for its type; or a count is larger than memory can be.
    SAP_ERROR_INVALID_ARGUMENT = 1,
    /// A handle is not of the type that this function takes.
    SAP_ERROR_WRONG_HANDLE = 2,
    /// The handle is in use: by another thread, or by the call that runs this callback.
    SAP_ERROR_BUSY = 3,
    /// A box is inverted or NaN: `min <= max` does not hold on each axis. `index` is that of the box.
    SAP_ERROR_INVALID_BOX = 4,
    /// No body of this world has the id: its body was removed, or the id is of another world. `index` is that of the id.
    SAP_ERROR_STALE_ID = 5,
    /// An option of a world is negative, infinite or NaN.
    SAP_ERROR_INVALID_OPTION = 6,
    /// The offset of a shift is infinite or NaN.
    SAP_ERROR_INVALID_OFFSET = 7,
    /// An argument of a query is NaN, or infinite or negative where it must not be.
    SAP_ERROR_INVALID_QUERY = 8,
    /// The bytes are not a snapshot of a world of this kind, or they are damaged.
    SAP_ERROR_INVALID_SNAPSHOT = 9,
    /// More boxes than 2^32 - 1, which is how many one set can have.
    SAP_ERROR_TOO_MANY_BOXES = 10,
    /// The pairs, the memory for finding them, or the answer to a query do not fit. Counting and streaming need less.
    SAP_ERROR_OUT_OF_MEMORY = 11,
    /// The threads that a handle should have could not be started.
    SAP_ERROR_THREADS = 12,
    /// The library has a bug, which this call met. The handle may be half changed: all that it accepts from now on is to be
    /// destroyed.
    SAP_ERROR_PANIC = 13,
    /// An earlier call with this handle ended with `SAP_ERROR_PANIC`. Destroy it.
    SAP_ERROR_POISONED = 14,
    /// An error that this version has no number for. The message says what it is.
    SAP_ERROR_OTHER = 15,
}

use sap_status::*;

/// How many bytes the message of an error has at most, the final zero included.
pub const SAP_MESSAGE_SIZE: usize = 240;

/// What was wrong. Functions that can fail take a pointer to one, which may be NULL. They write it only if they fail.
#[repr(C)]
#[derive(Debug)]
pub struct sap_error {
    /// What the function returned.
    pub status: sap_status,
    /// Which of two sets of boxes has the bad box: 0, or 1 for the second.
    pub set: u32,
    /// The index of the bad box, id or query in the array that was passed; 0 where there is no array.
    pub index: u64,
    /// A sentence in UTF-8 that ends with a zero. It names the argument, its value and the limit that the value broke.
    pub message: [c_char; SAP_MESSAGE_SIZE],
}

/// Why a call fails.
#[derive(Debug)]
pub enum Failure {
    Core(Error),
    Argument { name: &'static str, fault: &'static str },
    WrongHandle { wanted: &'static str },
    Busy,
    Poisoned,
    Threads(String),
    Panic(String),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Core(error)
    }
}

impl Failure {
    fn status(&self) -> sap_status {
        match self {
            Self::Core(error) => match error {
                Error::InvalidBox { .. } => SAP_ERROR_INVALID_BOX,
                Error::StaleProxy { .. } => SAP_ERROR_STALE_ID,
                Error::InvalidOption { .. } => SAP_ERROR_INVALID_OPTION,
                Error::InvalidOffset { .. } => SAP_ERROR_INVALID_OFFSET,
                Error::InvalidQuery { .. } => SAP_ERROR_INVALID_QUERY,
                Error::InvalidSnapshot(_) => SAP_ERROR_INVALID_SNAPSHOT,
                Error::TooManyBoxes { .. } => SAP_ERROR_TOO_MANY_BOXES,
                Error::OutOfMemory => SAP_ERROR_OUT_OF_MEMORY,
                _ => SAP_ERROR_OTHER,
            },
            Self::Argument { .. } => SAP_ERROR_INVALID_ARGUMENT,
            Self::WrongHandle { .. } => SAP_ERROR_WRONG_HANDLE,
            Self::Busy => SAP_ERROR_BUSY,
            Self::Poisoned => SAP_ERROR_POISONED,
            Self::Threads(_) => SAP_ERROR_THREADS,
            Self::Panic(_) => SAP_ERROR_PANIC,
        }
    }

    /// The set and the index of what is bad.
    fn place(&self) -> (usize, usize) {
        match *self {
            Self::Core(Error::InvalidBox { set, index, .. }) => (set, index),
            Self::Core(Error::StaleProxy { index, .. } | Error::InvalidQuery { index, .. }) => {
                (0, index)
            }
            _ => (0, 0),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Core(error) => error.fmt(f),
            Self::Argument { name, fault } => write!(f, "`{name}` {fault}"),
            Self::WrongHandle { wanted } => write!(f, "the handle is not a `{wanted}`"),
            Self::Busy => f.write_str(
                "the handle is in use, by another thread or by the call that runs this callback: wait for that call",
            ),
            Self::Poisoned => f.write_str(
                "an earlier call with this handle met a bug of the library: destroy the handle",
            ),
            Self::Threads(why) => write!(f, "the threads could not be started: {why}"),
            Self::Panic(what) => write!(f, "the library has a bug, please report it: {what}"),
        }
    }
}

/// Runs a call of C and turns its failure, or its panic, into a status and an error.
///
/// # Safety `error` is null or points to memory for an error.
pub unsafe fn run(error: *mut sap_error, call: impl FnOnce() -> Result<(), Failure>) -> sap_status {
    // A panic poisons the handle that is being changed, so that nothing sees what is half done: see `handle.rs`.
    let result = catch_unwind(AssertUnwindSafe(call));
    let result = result.unwrap_or_else(|panic| Err(Failure::Panic(message_of(&*panic))));
    let Err(failure) = result else { return SAP_OK };
    let status = failure.status();
    if !error.is_null() && error.is_aligned() {
        let (set, index) = failure.place();
        let message = text(&failure.to_string());
        let written = sap_error { status, set: set as u32, index: index as u64, message };
        // SAFETY: it points to memory for an error, and it is aligned.
        unsafe { error.write(written) };
    }
    status
}

/// What a panic says.
fn message_of(panic: &(dyn Any + Send)) -> String {
    let said = panic.downcast_ref::<&str>().map(ToString::to_string);
    said.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default()
}

/// A text as C has it, cut off between two characters if it is too long.
fn text(message: &str) -> [c_char; SAP_MESSAGE_SIZE] {
    let mut bytes = [0; SAP_MESSAGE_SIZE];
    let mut end = message.len().min(SAP_MESSAGE_SIZE - 1);
    while !message.is_char_boundary(end) {
        end -= 1;
    }
    for (to, from) in bytes.iter_mut().zip(message[..end].bytes()) {
        *to = from as c_char;
    }
    bytes
}
