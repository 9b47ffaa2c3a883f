//! The C interface of sweep-and-prune.
//!
//! ```text
//! failure -> handle, memory -> common -> finder, world -> boxes3f -> finder3f, world3f -> queries3f
//! ```
//!
//! `boxes3f.rs`, `finder3f.rs`, `world3f.rs` and `queries3f.rs` are what C programs call. They are written for boxes of the
//! kind `3f` (3D, `f32`); `build.rs` writes the same files for the other three kinds. The rest does the work for all kinds.
//!
//! What callers have to keep to stands at the top of the header, which `header/` makes from the comments of this crate:
//! pointers point to what their type says, for as many items as their count says, and no handle is used after it was
//! destroyed. Under these rules every function is sound. What can be checked is checked: null pointers, pointers that are
//! not aligned, handles of another type, a second call while one is running, ids, and every number.
#![allow(non_camel_case_types)] // the types have the names that they have in C
#![allow(clippy::missing_safety_doc)] // what C promises stands above, once

mod common;
mod failure;
mod finder;
mod handle;
mod memory;
mod threads;
mod world;

mod boxes3f;
mod finder3f;
mod queries3f;
mod world3f;

/// Includes the files that `build.rs` wrote.
macro_rules! written {
    ($($module:ident $file:literal),* $(,)?) => {
        $(mod $module {
            include!(concat!(env!("OUT_DIR"), "/", $file));
        })*
    };
}

written! {
    boxes2f "boxes2f.rs", finder2f "finder2f.rs", world2f "world2f.rs", queries2f "queries2f.rs",
    boxes3d "boxes3d.rs", finder3d "finder3d.rs", world3d "world3d.rs", queries3d "queries3d.rs",
    boxes2d "boxes2d.rs", finder2d "finder2d.rs", world2d "world2d.rs", queries2d "queries2d.rs",
}
