//! The exports of the npm package: plain functions over linear memory, called by `js/src/`.
//!
//! Each feature is a build of its own, a file that a page loads if it uses it.
//!
//! A function that can fail gives a code, with details in the area that `status` returns. Handles and
//! pointers are those that this module gave out.
#![cfg_attr(target_arch = "wasm32", no_std)]
// SAFETY of the exports: each has a name that no other symbol has, and is called by `js/src/`
// alone, which keeps handles private, passes none after it was freed, and while a call with one
// is under way (which calls back) passes none but others. Counts are checked here, where memory depends on them, and
// so are truth values, which come as numbers.
#![allow(unsafe_code)]

extern crate alloc;

#[cfg(any(feature = "broad-phase", feature = "events-2d", feature = "events-3d"))]
mod broad_phase;
#[cfg(feature = "finder")]
mod finder;
