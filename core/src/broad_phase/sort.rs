//! Sorts pairs of slots, and tells how two sorted lists differ.

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
    unsorted: Vec<[u32; 2]>,
    starts: Vec<u32>,
}

impl PairSorter {
    /// Sorts pairs of numbers less than `bound`.
    pub fn sort(&mut self, pairs: &mut Vec<[u32; 2]>, bound: usize) {
        let mut unsorted = core::mem::take(&mut self.unsorted);
        core::mem::swap(&mut unsorted, pairs);
        self.sort_into(&unsorted, pairs, bound);
        self.unsorted = unsorted;
    }

    /// As [`sort`](Self::sort), from one list into another, whatever that held.
    #[inline(never)]
    pub fn sort_into(&mut self, from: &[[u32; 2]], sorted: &mut Vec<[u32; 2]>, bound: usize) {
        sorted.clear();
        if from.len() < FEW || u32::try_from(from.len()).is_err() {
            sorted.extend_from_slice(from);
            sorted.sort_unstable();
            return;
        }
        let bits = usize::BITS - bound.saturating_sub(1).leading_zeros();
        self.starts.reserve(1 << bits.min(16));
        for buffer in [&mut *sorted, &mut self.buffer] {
            buffer.resize(from.len(), [0; 2]);
        }
        let mut is_first = true;
        for (side, most) in [(1, DIGIT), (0, DIGIT.max(from.len().ilog2() + 1))] {
            let passes = bits.div_ceil(most).max(1);
            let digit = bits.div_ceil(passes);
            for pass in 0..passes {
                self.starts.clear();
                self.starts.resize(1 << digit, 0);
                let from = if is_first { from } else { &self.buffer };
                distribute(from, sorted, &mut self.starts, |pair| pair[side] >> (pass * digit));
                core::mem::swap(sorted, &mut self.buffer);
                is_first = false;
            }
        }
        core::mem::swap(sorted, &mut self.buffer);
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

/// The pair as one number in the same order.
#[inline(always)]
fn key(pair: [u32; 2]) -> u64 {
    u64::from(pair[0]) << 32 | u64::from(pair[1])
}

/// Of two sorted lists without duplicates, appends what is in the first alone and what is in the
/// second alone, sorted. Without a branch that depends on what they hold.
#[inline(never)]
pub(super) fn differences(
    before: &[[u32; 2]],
    now: &[[u32; 2]],
    ended: &mut Vec<[u32; 2]>,
    begun: &mut Vec<[u32; 2]>,
) {
    let (mut end, mut begin) = (ended.len(), begun.len());
    ended.resize(end + before.len(), [0; 2]);
    begun.resize(begin + now.len(), [0; 2]);
    let (mut i, mut j) = (0, 0);
    while let (Some(&old), Some(&new)) = (before.get(i), now.get(j)) {
        let (old_key, new_key) = (key(old), key(new));
        ended[end] = old;
        begun[begin] = new;
        end += usize::from(old_key < new_key);
        begin += usize::from(new_key < old_key);
        i += usize::from(old_key <= new_key);
        j += usize::from(new_key <= old_key);
    }
    ended.truncate(end);
    begun.truncate(begin);
    ended.extend_from_slice(&before[i..]);
    begun.extend_from_slice(&now[j..]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;

    fn random_pairs() -> impl FnMut(usize, u64) -> Vec<[u32; 2]> {
        let mut state = 1u64;
        let mut random = move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) as u32
        };
        move |count, bound| {
            (0..count).map(|_| [0; 2].map(|_| (u64::from(random()) % bound) as u32)).collect()
        }
    }

    #[test]
    fn sorts_like_the_standard_library_at_every_size_of_number() {
        let mut random = random_pairs();
        for bound in [1u64, 2, 5, 2048, 2049, 1 << 22, 1 << 32] {
            for count in [0, 1, FEW - 1, FEW, 1000] {
                let mut pairs = random(count, bound);
                let mut expected = pairs.clone();
                expected.sort();
                PairSorter::default().sort(&mut pairs, bound as usize);
                assert_eq!(pairs, expected);
            }
        }
    }

    #[test]
    fn differences_are_what_either_list_has_alone() {
        let mut random = random_pairs();
        for (count, bound) in [(0, 9), (1, 2), (30, 7), (300, 20), (300, 1 << 32)] {
            for other in [0, 1, count] {
                let [before, now] = [count, other].map(|count| {
                    let mut pairs = random(count, bound);
                    pairs.sort();
                    pairs.dedup();
                    pairs
                });
                let (mut ended, mut begun) = (vec![[7, 8]], vec![[9, 9]]);
                differences(&before, &now, &mut ended, &mut begun);
                let alone = |a: &[[u32; 2]], b: &[[u32; 2]]| {
                    a.iter().copied().filter(|pair| !b.contains(pair)).collect::<Vec<_>>()
                };
                assert_eq!(ended[1..], alone(&before, &now));
                assert_eq!(begun[1..], alone(&now, &before));
            }
        }
    }
}
