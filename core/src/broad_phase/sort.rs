//! Sorts pairs of slots.

use alloc::vec::Vec;

/// Fewer are left to the standard library.
const FEW: usize = 128;
/// Bits a pass sorts by, at most.
const DIGIT: u32 = 11;

/// Sorts pairs: by radix where there are many (least digit first), since slots are small numbers.
/// Keeps its buffer.
#[derive(Clone, Debug, Default)]
pub(super) struct PairSorter {
    buffer: Vec<[u32; 2]>,
}

impl PairSorter {
    /// Sorts pairs of numbers less than `bound`.
    pub fn sort(&mut self, pairs: &mut Vec<[u32; 2]>, bound: usize) {
        if pairs.len() < FEW {
            pairs.sort_unstable();
            return;
        }
        let bits = usize::BITS - bound.saturating_sub(1).leading_zeros();
        let passes = bits.div_ceil(DIGIT).max(1);
        let digit = bits.div_ceil(passes);
        self.buffer.clear();
        self.buffer.resize(pairs.len(), [0; 2]);
        for side in [1, 0] {
            for pass in 0..passes {
                distribute(pairs, &mut self.buffer, digit, |pair| pair[side] >> (pass * digit));
                core::mem::swap(pairs, &mut self.buffer);
            }
        }
    }
}

/// A stable counting sort by the low `digit` bits of a key.
fn distribute(from: &[[u32; 2]], to: &mut [[u32; 2]], digit: u32, key: impl Fn(&[u32; 2]) -> u32) {
    let mut starts = [0u32; 1 << DIGIT];
    let mask = (1 << digit) - 1;
    for pair in from {
        starts[(key(pair) & mask) as usize] += 1;
    }
    let mut sum = 0;
    for start in &mut starts[..=mask as usize] {
        sum += core::mem::replace(start, sum);
    }
    for pair in from {
        let start = &mut starts[(key(pair) & mask) as usize];
        to[*start as usize] = *pair;
        *start += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sorts_like_the_standard_library_at_every_size_of_number() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) as u32
        };
        for bound in [1u64, 2, 5, 2048, 2049, 1 << 22, 1 << 32] {
            for count in [0, 1, FEW - 1, FEW, 1000] {
                let mut pairs: Vec<[u32; 2]> = (0..count)
                    .map(|_| [0; 2].map(|_| (u64::from(random()) % bound) as u32))
                    .collect();
                let mut expected = pairs.clone();
                expected.sort();
                PairSorter::default().sort(&mut pairs, bound as usize);
                assert_eq!(pairs, expected);
            }
        }
    }
}
