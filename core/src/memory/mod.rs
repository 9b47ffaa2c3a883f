//! Memory: growing arrays with an error instead of an abort, large pages, prefetching.
//!
//! Besides the kernels this is the only folder of the crate with `unsafe`: hints to the processor and
//! the operating system.
#![allow(unsafe_code)]

mod grow;
mod pages;
mod prefetch;

pub use grow::{OutOfMemory, grow, grow_to, only_item, push, reserve, reserve_for};
pub use prefetch::{
    prefetch, prefetch_ahead, prefetch_item, prefetch_pays, prefetch_range, preload,
};
