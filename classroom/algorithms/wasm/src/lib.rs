//! The observable algorithms as WebAssembly: plain functions over linear memory, called by `classroom/demo/src/algorithms/`.
//!
//! [`runner`] has a runner chosen by names, its counts and its trace; [`player`] plays what it recorded. A crate that uses this
//! one can add algorithms ([`runner::Handle::set_variant`]), as the site does.
#![cfg_attr(target_arch = "wasm32", no_std)]
// SAFETY of the exports: each has a name that no other symbol has, and is called by `classroom/demo/src/algorithms/` alone, which keeps
// handles private and passes none after it was freed. Truth values are checked here: they come as numbers.
#![allow(unsafe_code)]

extern crate alloc;

mod numbers;
pub mod player;
pub mod runner;
