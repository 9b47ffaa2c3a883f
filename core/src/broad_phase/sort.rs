//! Sorts pairs of slots.

use alloc::vec::Vec;

/// Fewer are left to the standard library.
const FEW: usize = 128;
/// Bits a pass sorts by, at most: as many counters as the first cache holds. The last number to be
/// sorted by is done with in one pass if there are as many pairs as that takes counters.
const DIGIT: u32 = 11;

/// Sorts pairs: by radix where there are many (least digit first), since slots are small numbers.
/// Keeps its buffers.
#[derive(Clone, Debug, Default)]
pub(super) struct PairSorter {
    buffer: Vec<[u32; 2]>,
    starts: Vec<u32>,
}

impl PairSorter {
    /// Sorts pairs of numbers less than `bound`.
    pub fn sort(&mut self, pairs: &mut Vec<[u32; 2]>, bound: usize) {
        if pairs.len() < FEW || u32::try_from(pairs.len()).is_err() {
            pairs.sort_unstable();
            return;
        }
        let bits = usize::BITS - bound.saturating_sub(1).leading_zeros();
        self.starts.reserve(1 << bits.min(16));
        self.buffer.clear();
        self.buffer.resize(pairs.len(), [0; 2]);
        for (side, most) in [(1, DIGIT), (0, DIGIT.max(pairs.len().ilog2() + 1))] {
            let passes = bits.div_ceil(most).max(1);
            let digit = bits.div_ceil(passes);
            for pass in 0..passes {
                self.starts.clear();
                self.starts.resize(1 << digit, 0);
                let (from, to) = (&*pairs, &mut self.buffer);
                distribute(from, to, &mut self.starts, |pair| pair[side] >> (pass * digit));
                core::mem::swap(pairs, &mut self.buffer);
            }
        }
    }
}

/// A stable counting sort by the low bits of a key, of which there are as many values as `starts`.
fn distribute(
    from: &[[u32; 2]],
    to: &mut [[u32; 2]],
    starts: &mut [u32],
    key: impl Fn(&[u32; 2]) -> u32,
) {
    let mask = starts.len() - 1;
    for pair in from {
        starts[key(pair) as usize & mask] += 1;
    }
    let mut sum = 0;
    for start in &mut *starts {
        sum += core::mem::replace(start, sum);
    }
    for pair in from {
        let start = &mut starts[key(pair) as usize & mask];
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
