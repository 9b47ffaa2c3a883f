//! What every call with a handle does around its work, because the engine may end it by throwing.
//!
//! Where JavaScript has recursed deeply, the engine throws in whichever function finds no stack left, and skips the
//! frames below it. So a call first checks that there is some stack left, while nothing has changed. Should it be ended
//! all the same, its handle still says that a call is under way: JavaScript refuses it from then on.

use alloc::boxed::Box;

/// The first word of every handle.
#[repr(transparent)]
#[derive(Debug, Default)]
pub struct Running(u32);

const IDLE: u32 = 0;
/// A call with the handle is under way, or ended halfway.
const RUNNING: u32 = 1;

/// What JavaScript holds a pointer to. In memory, it begins with its [`Running`].
pub trait Handle {
    /// The first word.
    fn running(&mut self) -> &mut Running;
}

/// Frees what a handle stands for. If a call with it ended halfway, or freeing it did, it is lost: parts of it could be freed
/// twice.
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
    /// For the allocator, which every object shares: it must never be ended halfway. In V8 it takes less than half of this.
    pub const ALLOCATOR: u32 = 4;
    /// For all other calls. Some take more, so they may be ended halfway all the same; then their handle says so.
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
        // SAFETY: it is a static. Volatile, so that the compiler cannot know what is there: always zero.
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

    /// Ends by the engine's own error if there is not enough stack left for this many frames, of a size that no other function
    /// here has: its frame has space for 64 words, which are never kept. That takes two nanoseconds a frame.
    ///
    /// A frame takes a KiB in V8's baseline compiler. The optimizing one makes do with 130 bytes, but then other functions
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
            // SAFETY: as above, and there is one thread.
            unsafe { WORDS[0].as_ptr().write_volatile(sum) }
        }
    }
}
