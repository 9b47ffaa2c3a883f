//! What the WebAssembly files with handles share: the guard around each call, the code with which it ends, the allocator, and what
//! happens on a panic. `js/src/wasm/` is the other side.
//!
//! A file that uses this crate has `link.rs` as its build script, which tells the linker where the stack is.
#![cfg_attr(target_arch = "wasm32", no_std)]
// The allocator, and words that the compiler must not optimize away: each place says why it is sound.
#![allow(unsafe_code)]

extern crate alloc;

pub mod call;
#[cfg(target_arch = "wasm32")]
mod runtime;
pub mod status;
