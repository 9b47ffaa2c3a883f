//! What every call with a handle does around its work, because the engine may end it by throwing.
//!
//! Where JavaScript has recursed deeply, the engine throws in whichever function finds no stack left, and skips the
//! frames below it. So a call first checks that there is some stack left, while nothing has changed. If the engine cuts the
//! call off all the same, the handle still says that a call is running: JavaScript refuses the handle from then on.

use alloc::boxed::Box;

/// The first word of every handle.
#[repr(transparent)]
#[derive(Debug, Default)]
pub struct Running(u32);

const IDLE: u32 = 0;
/// A call with the handle is running, or was cut off.
const RUNNING: u32 = 1;

/// What JavaScript holds a pointer to. In memory, it begins with its [`Running`].
pub trait Handle {
    /// The first word.
    fn running(&mut self) -> &mut Running;
}

/// Frees the object behind a handle. If a call with it was cut off, or an earlier call of this function, its memory is leaked:
/// freeing it could free parts of it twice.
pub fn free<H: Handle>(handle: Option<Box<H>>) {
    stack::check(stack::SMALL);
    let Some(mut handle) = handle else { return };
    if handle.running().0 == IDLE {
        set(handle.running(), RUNNING);
    } else {
        core::mem::forget(handle);
    }
}

/// Does the work of a call, if there is stack for this many frames.
#[inline]
pub fn run<H: Handle, R>(handle: &mut H, frames: u32, work: impl FnOnce(&mut H) -> R) -> R {
    stack::check(frames);
    set(handle.running(), RUNNING);
    let result = work(handle);
    set(handle.running(), IDLE);
    result
}

fn set(running: &mut Running, value: u32) {
    // SAFETY: a reference is valid to write to. Volatile, because the compiler sees no reader.
    unsafe { (&raw mut running.0).write_volatile(value) }
}

/// Whether the number is that of `true`; `None` if it is no truth value.
pub const fn truth(number: u32) -> Option<bool> {
    match number {
        0 => Some(false),
        1 => Some(true),
        _ => None,
    }
}

/// How much of the engine's stack a call needs.
pub mod stack {
    /// Frames for a call with one body.
    pub const SMALL: u32 = 1;
    /// For the allocator, which every object shares: it must never be cut off. In V8 it takes less than half of this.
    pub const ALLOCATOR: u32 = 4;
    /// For all other calls. Some need more, so the engine may still cut them off; then their handle says so.
    pub const LARGE: u32 = 8;

    #[cfg(not(target_arch = "wasm32"))]
    pub use super::no_frames::check;

    #[cfg(target_arch = "wasm32")]
    pub use super::frames::check;
}

#[cfg(not(target_arch = "wasm32"))]
mod no_frames {
    /// Only an engine ends a call by throwing.
    pub fn check(_: u32) {}
}

#[cfg(target_arch = "wasm32")]
mod frames {
    //! The engine's stack cannot be measured, but a function that finds no space on it does not begin.

    use core::sync::atomic::AtomicU64;

    static WORDS: [AtomicU64; 64] = [const { AtomicU64::new(0) }; 64];

    fn word(at: usize) -> u64 {
        // SAFETY: a static is valid to read. Volatile, so that the compiler does not know that every word is zero.
        unsafe { WORDS[at].as_ptr().read_volatile() }
    }

    /// Keeps more words in the frame of the function while it evaluates an expression; their sum.
    macro_rules! keeping {
        (1, $at:expr, $inner:expr) => {{
            let kept = word($at);
            kept ^ $inner
        }};
        (2, $at:expr, $inner:expr) => {
            keeping!(1, $at, keeping!(1, $at + 1, $inner))
        };
        (8, $at:expr, $inner:expr) => {
            keeping!(
                2,
                $at,
                keeping!(2, $at + 2, keeping!(2, $at + 4, keeping!(2, $at + 6, $inner)))
            )
        };
        (32, $at:expr, $inner:expr) => {
            keeping!(
                8,
                $at,
                keeping!(8, $at + 8, keeping!(8, $at + 16, keeping!(8, $at + 24, $inner)))
            )
        };
        (64, $inner:expr) => {
            keeping!(32, 0, keeping!(32, 32, $inner))
        };
    }

    /// Throws the engine's own error if the stack has no space for this many frames. A frame of this function is larger than
    /// that of any other here: it has space for 64 words, which are never stored. The check takes two nanoseconds a frame.
    ///
    /// A frame takes a KiB in V8's baseline compiler. In the optimizing one it takes only 130 bytes, but there other functions
    /// take less, too.
    #[inline(never)]
    pub fn check(frames: u32) {
        if frames > 1 {
            check(frames - 1);
        }
        if word(0) != 0 {
            let sum = keeping!(64, {
                check(frames);
                0
            });
            // SAFETY: a static is valid to write to, and there is one thread.
            unsafe { WORDS[0].as_ptr().write_volatile(sum) }
        }
    }
}
