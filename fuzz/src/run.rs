//! Runs targets, catches their panics, and shortens the inputs that make them panic.

use std::cell::{Cell, RefCell};
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook};
use std::sync::Once;

use sweep_and_prune_scenes::Random;

use super::{Input, broad_phase, finder, snapshot};

/// Something that can be fuzzed: its name, and what it does with an input. It returns how many calls of the library it
/// made, and panics if one of them was wrong.
pub struct Target {
    /// Its name, which is also the name of its folder in `corpus/`.
    pub name: &'static str,
    /// The most bytes of a random input: of most inputs, and of one in 64.
    pub lengths: [usize; 2],
    /// What it does with an input.
    pub run: fn(&mut Input) -> u64,
}

/// All targets.
pub const TARGETS: [Target; 3] = [
    Target { name: "broad_phase", lengths: [1024, 8192], run: broad_phase::target },
    Target { name: "finder", lengths: [2048, 65_536], run: finder::target },
    Target { name: "snapshot", lengths: [512, 4096], run: snapshot::target },
];

/// Why a target panicked, and where the operations of its input begin, up to that one.
#[derive(Debug)]
pub struct Failure {
    /// The message of the panic and where it happened.
    pub message: String,
    starts: Vec<usize>,
    /// How many bytes were used.
    end: usize,
}

thread_local! {
    static MESSAGE: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Runs a target, and returns how many calls it made.
///
/// # Errors
/// A [`Failure`] if it panics.
pub fn run(target: &Target, bytes: &[u8], is_verbose: bool) -> Result<u64, Failure> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        set_hook(Box::new(|info| MESSAGE.with(|message| *message.borrow_mut() = info.to_string())));
    });
    let mut input = Input::new(bytes);
    input.is_verbose = is_verbose;
    catch_unwind(AssertUnwindSafe(|| (target.run)(&mut input))).map_err(|_| Failure {
        message: MESSAGE.with(RefCell::take),
        starts: input.starts().to_vec(),
        end: input.end(),
    })
}

/// The random input of a seed and a number.
pub fn random_input(target: &Target, seed: u64, number: u64) -> Vec<u8> {
    let mut random = Random::new(Random::new(seed).bits() ^ number);
    let [most, seldom] = target.lengths;
    let is_long = random.below(64) == 0;
    let length = random.below(if is_long { seldom } else { most });
    let words = (0..length.div_ceil(8)).flat_map(|_| random.bits().to_le_bytes());
    let mut bytes: Vec<u8> = words.collect();
    bytes.truncate(length);
    bytes
}

/// How often a failing input is run to shorten it.
const TRIES: usize = 20_000;

/// A shorter and plainer input that makes a target panic too: operations are left out, many at once and then one by one,
/// and bytes become smaller.
pub fn shorten(target: &Target, bytes: &[u8]) -> Vec<u8> {
    let mut best = bytes.to_vec();
    let tries = Cell::new(TRIES);
    let fails = |bytes: &[u8]| {
        tries.set(tries.get().saturating_sub(1));
        if tries.get() == 0 { None } else { run(target, bytes, false).err() }
    };
    let Some(mut failure) = fails(bytes) else {
        return best;
    };
    best.truncate(failure.end);
    loop {
        let before = best.clone();
        let mut chunk = failure.starts.len();
        while chunk > 0 {
            let mut first = 0;
            while first < failure.starts.len() {
                let end = failure.starts.get(first + chunk).copied().unwrap_or(best.len());
                let shorter = [&best[..failure.starts[first]], &best[end..]].concat();
                match fails(&shorter) {
                    Some(found) => (best, failure) = (shorter, found),
                    None => first += chunk,
                }
            }
            chunk /= 2;
        }
        for at in 0..best.len() {
            // Most bytes choose one of a few possibilities by their remainder, so small values reach all of them.
            for plainer in 0..best[at].min(64) {
                let mut bytes = best.clone();
                bytes[at] = plainer;
                if let Some(found) = fails(&bytes) {
                    (best, failure) = (bytes, found);
                    break;
                }
            }
        }
        if best == before || tries.get() == 0 {
            return best;
        }
    }
}
