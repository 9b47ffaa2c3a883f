//! The tests on a device: one program, since each would compile the same search again.

mod callers;
mod determinism;
mod random;
mod scenes;
mod support;
mod work;
