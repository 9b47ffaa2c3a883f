//! What the WebAssembly files of the site share: 16 numbers that JavaScript writes before a call and
//! reads after it, and a clock.
//!
//! A file that uses [`clock`] imports one function, `env.now() -> f64`: milliseconds from any origin.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// How many numbers the area holds.
pub const NUMBERS: usize = 16;

/// Atomic only because a static must be: in WebAssembly these are plain loads and stores.
static AREA: [AtomicU64; NUMBERS] = [const { AtomicU64::new(0) }; NUMBERS];

/// Where the area is: 16 `f64`.
pub fn area() -> *const AtomicU64 {
    AREA.as_ptr()
}

/// The numbers in the area.
pub fn read_area() -> [f64; NUMBERS] {
    std::array::from_fn(|index| f64::from_bits(AREA[index].load(Relaxed)))
}

/// Writes the first numbers of the area; those beyond its end are dropped.
pub fn write_area(numbers: &[f64]) {
    for (word, number) in AREA.iter().zip(numbers) {
        word.store(number.to_bits(), Relaxed);
    }
}

// The only foreign function: it takes nothing and returns a number.
#[allow(unsafe_code)]
#[cfg(target_arch = "wasm32")]
#[link(wasm_import_module = "env")]
unsafe extern "C" {
    /// Milliseconds from any origin.
    safe fn now() -> f64;
}

/// Outside WebAssembly there is nothing to time: the crates are only checked and tested.
#[cfg(not(target_arch = "wasm32"))]
fn now() -> f64 {
    0.0
}

/// Milliseconds from any origin. (A Rust function, since an imported function does not implement `Fn`.)
pub fn clock() -> f64 {
    now()
}

#[cfg(test)]
mod tests {
    #[test]
    fn what_is_written_is_read_and_what_does_not_fit_is_dropped() {
        let numbers: [f64; 20] = std::array::from_fn(|index| index as f64 - 0.5);
        super::write_area(&numbers);
        assert_eq!(super::read_area(), numbers[..super::NUMBERS]);
        super::write_area(&[f64::INFINITY]);
        assert_eq!(super::read_area()[..2], [f64::INFINITY, 0.5]);
    }
}
