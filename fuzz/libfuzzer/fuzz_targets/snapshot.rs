#![no_main]

use libfuzzer_sys::fuzz_target;
use sweep_and_prune_fuzz::{Input, TARGETS};

fuzz_target!(|bytes: &[u8]| {
    (TARGETS[2].run)(&mut Input::new(bytes));
});
