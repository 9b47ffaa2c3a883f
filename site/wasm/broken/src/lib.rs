//! The classroom's algorithms with broken variants: algorithms with one common mistake each, which only the site shows.
#![cfg_attr(target_arch = "wasm32", no_std)]
// SAFETY of the export: its name is that of no other symbol, and JavaScript calls it with a handle that it has not freed.
#![allow(unsafe_code)]

extern crate alloc;

use alloc::boxed::Box;

use sweep_and_prune::Aabb;
use sweep_and_prune_algorithms::Error;
use sweep_and_prune_algorithms_wasm::runner::{Algorithm, Handle, Lists, Recorder, steps};
use sweep_and_prune_wasm_runtime::call::{run, stack};

use crate::wrong::{Wrong, WrongRunner};

mod wrong;

impl<const D: usize> Algorithm<D> for WrongRunner<D> {
    fn step(
        &mut self,
        boxes: &[Aabb<D, f64>],
        recorder: &mut Recorder,
        lists: &mut Lists,
    ) -> Result<usize, Error> {
        let axis = WrongRunner::step(self, boxes, recorder)?;
        *lists = self.found();
        Ok(axis)
    }

    fn bytes(&self) -> usize {
        WrongRunner::bytes(self)
    }
}

/// Chooses the broken variant of the name in the text. Whether there is one.
#[unsafe(no_mangle)]
extern "C" fn runner_choose_variant(handle: &mut Handle) -> bool {
    run(handle, stack::SMALL, |handle| {
        let Some(wrong) = handle.name().and_then(Wrong::from_name) else { return false };
        handle.set_variant(Box::new(move |dimensions, axis| match dimensions {
            1 => steps(WrongRunner::<1>::new(wrong, axis)),
            2 => steps(WrongRunner::<2>::new(wrong, axis)),
            _ => steps(WrongRunner::<3>::new(wrong, axis)),
        }));
        true
    })
}
