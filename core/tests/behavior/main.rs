//! What the library promises, in one program: the generic code of the core is compiled once for all of these tests.
//! Tests that replace the allocator or take time are programs of their own beside this folder.

mod broad_phase;
#[cfg(feature = "serde")]
mod broad_phase_serde;
mod broad_phase_snapshots;
#[cfg(feature = "parallel")]
mod broad_phase_threads;
mod errors;
mod geometry;
mod lookups;
mod oracle;
mod package;
mod pairs;
mod send_sync;
