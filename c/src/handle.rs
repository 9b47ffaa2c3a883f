//! Handles: what a C program holds a pointer to.
//!
//! A handle is locked while a call uses it. The lock never waits: a second call while one is running is an error, since the
//! first may be waiting for the second. A panic in a call that changes the handle poisons the lock.

use std::sync::{PoisonError, RwLock, TryLockError};

use crate::failure::Failure;

/// A type of handle as C sees it.
pub trait Handle {
    /// What is behind it.
    type State;
    /// Its name in C.
    const NAME: &'static str;
    /// A number that no other type has.
    const TAG: u64;
}

/// What a handle points to. The tag comes first in each type of handle, so that it can be read before the type is known.
#[repr(C)]
struct Locked<S> {
    tag: u64,
    state: RwLock<S>,
}

/// A new handle, which C destroys by [`destroy`].
pub fn create<H: Handle>(state: H::State) -> *mut H {
    Box::into_raw(Box::new(Locked { tag: H::TAG, state: RwLock::new(state) })).cast()
}

/// Destroys a handle and sets the pointer to it to null. Does nothing if it is null, or of another type, or in use.
///
/// # Safety `handle` is null or points to a pointer that is null or a handle that was not destroyed.
pub unsafe fn destroy<H: Handle>(handle: *mut *mut H) {
    if handle.is_null() || !handle.is_aligned() {
        return;
    }
    // SAFETY: it points to a pointer.
    let pointer = unsafe { handle.replace(std::ptr::null_mut()) };
    // SAFETY: what it points to is null or a handle.
    let is_free = unsafe { locked(pointer) }
        .is_ok_and(|locked| !matches!(locked.state.try_write(), Err(TryLockError::WouldBlock)));
    if is_free {
        // SAFETY: `create` made it, for this type as the tag says, and no call uses it.
        drop(unsafe { Box::from_raw(pointer.cast::<Locked<H::State>>()) });
    } else {
        // SAFETY: it points to a pointer.
        unsafe { handle.write(pointer) };
    }
}

/// Calls with what a handle holds, beside other calls that only read.
///
/// # Safety `handle` is null or a handle that was not destroyed, of any type.
pub unsafe fn read<H: Handle, R>(
    handle: *const H,
    call: impl FnOnce(&H::State) -> Result<R, Failure>,
) -> Result<R, Failure> {
    // SAFETY: as promised above.
    let locked = unsafe { locked(handle)? };
    call(&*locked.state.try_read().map_err(fail)?)
}

/// Calls with what a handle holds, alone.
///
/// # Safety As [`read`].
pub unsafe fn write<H: Handle, R>(
    handle: *const H,
    call: impl FnOnce(&mut H::State) -> Result<R, Failure>,
) -> Result<R, Failure> {
    // SAFETY: as promised above.
    let locked = unsafe { locked(handle)? };
    call(&mut *locked.state.try_write().map_err(fail)?)
}

/// What a handle points to, if it is of the type that it should be of.
///
/// # Safety As [`read`]. The handle is not destroyed while the result is in use.
unsafe fn locked<'h, H: Handle>(handle: *const H) -> Result<&'h Locked<H::State>, Failure> {
    let wrong = Failure::WrongHandle { wanted: H::NAME };
    if handle.is_null() {
        return Err(Failure::Argument { name: H::NAME, fault: "is NULL" });
    }
    let tag = handle.cast::<u64>();
    // SAFETY: every handle begins with a tag, which never changes.
    if !tag.is_aligned() || unsafe { tag.read() } != H::TAG {
        return Err(wrong);
    }
    // SAFETY: the tag says that `create` made it for this type.
    Ok(unsafe { &*handle.cast::<Locked<H::State>>() })
}

fn fail<G>(error: TryLockError<G>) -> Failure {
    match error {
        TryLockError::WouldBlock => Failure::Busy,
        TryLockError::Poisoned(PoisonError { .. }) => Failure::Poisoned,
    }
}

#[cfg(test)]
mod tests {
    use std::ptr::{null, null_mut};

    use super::*;
    use crate::failure::{run, sap_error, sap_status};

    struct Number;

    impl Handle for Number {
        type State = u32;
        const NAME: &'static str = "Number";
        const TAG: u64 = 1;
    }

    fn status(call: impl FnOnce() -> Result<(), Failure>) -> (sap_status, String) {
        let mut error: sap_error =
            sap_error { status: sap_status::SAP_OK, set: 0, index: 0, message: [0; 240] };
        // SAFETY: it is an error.
        let status = unsafe { run(&mut error, call) };
        let text = error.message.iter().take_while(|&&byte| byte != 0).map(|&byte| byte as u8);
        (status, String::from_utf8(text.collect()).unwrap())
    }

    // No call of C can make the library panic, as far as we know, so this is not among the tests in C.
    #[test]
    fn a_panic_is_a_status_and_poisons_what_it_may_have_left_half_done() {
        let mut handle = create::<Number>(7);
        // SAFETY: it is a handle.
        let read = || unsafe {
            read(handle, |number| {
                assert_eq!(*number, 7);
                Ok(())
            })
        };
        assert_eq!(status(read).0, sap_status::SAP_OK);

        // A panic while reading harms nothing.
        // SAFETY: it is a handle.
        let (failed, text) = status(|| unsafe { super::read(handle, |_| panic!("read {}", 1)) });
        assert_eq!(failed, sap_status::SAP_ERROR_PANIC);
        assert!(text.ends_with("please report it: read 1"), "{text}");
        assert_eq!(status(read).0, sap_status::SAP_OK);

        // SAFETY: it is a handle.
        let (failed, _) = status(|| unsafe { write(handle, |_| panic!("write")) });
        assert_eq!(failed, sap_status::SAP_ERROR_PANIC);
        assert_eq!(status(read).0, sap_status::SAP_ERROR_POISONED);
        // SAFETY: it is a handle.
        let (failed, _) = status(|| unsafe { write(handle, |_| Ok(())) });
        assert_eq!(failed, sap_status::SAP_ERROR_POISONED);
        // SAFETY: it points to a pointer to a handle.
        unsafe { destroy(&mut handle) };
        assert!(handle.is_null());
    }

    #[test]
    fn a_message_that_is_too_long_is_cut_off_between_characters() {
        let long = "é".repeat(500);
        let (_, text) = status(|| Err(Failure::Threads(long)));
        assert!((230..240).contains(&text.len()) && text.ends_with('é'), "{text}");
        // SAFETY: null is allowed in both places.
        let failed = unsafe { run(null_mut(), || super::read(null::<Number>(), |_| Ok(()))) };
        assert_eq!(failed, sap_status::SAP_ERROR_INVALID_ARGUMENT);
    }
}
