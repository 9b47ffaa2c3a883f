//! Sorts lists of pairs, and finds how two sorted lists differ.

use alloc::vec::Vec;

use crate::memory::{OutOfMemory, reserve_for};

/// Shorter lists are sorted by the standard library.
const RADIX_FROM: usize = 128;
/// Longer lists do not fit the second-level cache together with their copy: then the copy is first
/// overwritten in order, which is fast and caches it for the scattered writes (an update from scratch of
/// 100,000 bodies takes 0.94 of the time).
const PRELOAD_FROM: usize = 1 << 15;
/// Lists of this length and longer are cut into parts by their first numbers, and each part is sorted in the first-level cache.
/// (An update from scratch of a million bodies takes 0.69 to 0.84 of the time, of 300,000 0.84 to 1, of 100,000 it would take
/// 1.02; one core of an AMD EPYC, Zen 3.)
const SPLIT_FROM: usize = 1 << 18;
/// How many pairs a part has, about.
const PART: usize = 1024;
/// Not in WebAssembly, where code is to be small.
const SPLITS: bool = cfg!(not(target_arch = "wasm32"));
/// Bits that a pass sorts by, at most: as many counters as the first-level cache holds. If there are as many pairs as
/// counters, the first number is sorted by in one pass, and the second if it has no more bits than [`ONE_PASS`].
const DIGIT: u32 = 11;
/// Measured on updates from scratch of 10,000 bodies, which take 0.95 of the time.
const ONE_PASS: u32 = 15;

/// Sorts pairs, longer lists by radix (least digit first), since slots are small numbers. Keeps its
/// buffers.
#[derive(Clone, Debug, Default)]
pub struct PairSorter {
    pub buffer: Vec<[u32; 2]>,
    pub unsorted: Vec<[u32; 2]>,
    starts: Vec<u32>,
    parts: Vec<u32>,
    keys: Vec<u64>,
}

impl PairSorter {
    /// Reserves memory for sorting this many pairs into a list and comparing them with others.
    ///
    /// # Errors
    /// [`OutOfMemory`].
    pub fn reserve(&mut self, sorted: &mut Vec<[u32; 2]>, count: usize) -> Result<(), OutOfMemory> {
        for list in [sorted, &mut self.buffer, &mut self.unsorted] {
            reserve_for(list, count)?;
        }
        Ok(())
    }

    /// Sorts pairs of numbers less than `bound`. Copies them, so that each list keeps its own memory: with that of a short one a
    /// long one would have to grow again.
    pub fn sort(&mut self, pairs: &mut Vec<[u32; 2]>, bound: usize) {
        let mut unsorted = core::mem::take(&mut self.unsorted);
        unsorted.clear();
        unsorted.extend_from_slice(pairs);
        self.sort_into(&unsorted, pairs, bound);
        self.unsorted = unsorted;
    }

    /// Sorts pairs of numbers less than `bound` from one list into another, which is overwritten. Each list keeps its memory.
    #[inline(never)]
    pub fn sort_into(&mut self, from: &[[u32; 2]], sorted: &mut Vec<[u32; 2]>, bound: usize) {
        if from.len() < RADIX_FROM || u32::try_from(from.len()).is_err() {
            sorted.clear();
            sorted.extend(self.sort_keys(from.iter().map(|&pair| key(pair))).map(pair));
            return;
        }
        let bits = usize::BITS - (bound.saturating_sub(1) | 1).leading_zeros();
        let Self { buffer, starts, parts, .. } = self;
        for buffer in [&mut *sorted, &mut *buffer] {
            if from.len() > PRELOAD_FROM {
                buffer.clear();
            }
            buffer.resize(from.len(), [0; 2]);
        }
        starts.clear();
        starts.reserve(bound.min(1 << 16));
        if !SPLITS || from.len() < SPLIT_FROM {
            return sort_by_digits(Some(from), buffer, sorted, [bits; 2], bound, starts);
        }
        // By the high bits of the first number.
        let low_bits = bits.saturating_sub((from.len() / PART).ilog2());
        parts.clear();
        parts.resize(((bound - 1) >> low_bits) + 1, 0);
        distribute(from, buffer, parts, |pair| pair[0] >> low_bits);
        let mut begin = 0;
        for &end in &*parts {
            let part = begin..end as usize;
            let (here, there) = (&mut buffer[part.clone()], &mut sorted[part]);
            sort_by_digits(None, here, there, [low_bits, bits], bound, starts);
            begin = end as usize;
        }
    }

    /// Sorts numbers that stand for pairs or ids. All short lists are sorted as such numbers, because each type that
    /// is sorted takes a kilobyte of a WebAssembly file.
    pub fn sort_keys(&mut self, keys: impl Iterator<Item = u64>) -> impl Iterator<Item = u64> {
        self.keys.clear();
        self.keys.extend(keys);
        self.keys.sort_unstable();
        self.keys.drain(..)
    }

    /// Of two sorted lists without duplicates, appends what only the first has and what only the second
    /// has, sorted. Where a step leads is known only after the one before, so the processor works on both
    /// halves at once: updates from scratch take 0.93 of the time (fast and teleport, 2D and 3D).
    #[inline(never)]
    pub fn differences(
        &mut self,
        before: &[[u32; 2]],
        now: &[[u32; 2]],
        ended: &mut Vec<[u32; 2]>,
        begun: &mut Vec<[u32; 2]>,
    ) {
        let middle = before.len() / 2;
        let cut = before.get(middle).map_or(0, |pair| now.partition_point(|other| other < pair));
        for (buffer, list) in [(&mut self.buffer, before), (&mut self.unsorted, now)] {
            buffer.resize(buffer.len().max(list.len()), [0; 2]);
        }
        let compare = |before, now, ended, begun| Comparison {
            before,
            now,
            ended,
            begun,
            counts: [0; 2],
            at: [0; 2],
        };
        let (ended_low, ended_high) = self.buffer.split_at_mut(middle);
        let (begun_low, begun_high) = self.unsorted.split_at_mut(cut);
        let mut low = compare(&before[..middle], &now[..cut], ended_low, begun_low);
        let mut high = compare(&before[middle..], &now[cut..], ended_high, begun_high);
        while low.step() & high.step() {}
        low.finish(ended, begun);
        high.finish(ended, begun);
    }
}

/// Sorts the pairs of a list, or if there is none those that are `here`, by radix, least digit first. They end `there`, and both
/// are overwritten. Their numbers are less than `bound`; given are the lowest bits of the first one that may differ, and those of
/// the second.
fn sort_by_digits<'a>(
    mut from: Option<&[[u32; 2]]>,
    mut here: &'a mut [[u32; 2]],
    mut there: &'a mut [[u32; 2]],
    bits: [u32; 2],
    bound: usize,
    starts: &mut Vec<u32>,
) {
    let most = DIGIT.max((there.len() | 1).ilog2() + 1);
    let most = [most, if bits[1] > ONE_PASS { DIGIT } else { most }];
    let passes = [0, 1].map(|side| bits[side].div_ceil(most[side]));
    let ends_there = (passes[0] ^ passes[1]) & 1 == 1;
    // An even number of passes ends there if it begins here.
    let is_copied = !ends_there && from.is_none();
    if !ends_there && !is_copied {
        core::mem::swap(&mut here, &mut there);
    }
    for side in [1, 0] {
        let digit = bits[side].div_ceil(passes[side].max(1));
        for pass in 0..passes[side] {
            starts.clear();
            starts.resize(bound.min(1 << digit), 0);
            let mask = u32::MAX >> (u32::BITS - digit);
            distribute(from.take().unwrap_or(&*here), there, starts, |pair| {
                pair[side] >> (pass * digit) & mask
            });
            core::mem::swap(&mut here, &mut there);
        }
    }
    if is_copied {
        there.copy_from_slice(here);
    }
}

/// A stable counting sort by a key, of which there are as many values as `starts`.
fn distribute(
    from: &[[u32; 2]],
    to: &mut [[u32; 2]],
    starts: &mut [u32],
    key: impl Fn(&[u32; 2]) -> u32,
) {
    for pair in from {
        starts[key(pair) as usize] += 1;
    }
    let mut sum = 0;
    for start in &mut *starts {
        sum += core::mem::replace(start, sum);
    }
    for pair in from {
        let start = &mut starts[key(pair) as usize];
        to[*start as usize] = *pair;
        *start += 1;
    }
}

/// The pair as one number in the same order.
#[inline(always)]
fn key(pair: [u32; 2]) -> u64 {
    u64::from(pair[0]) << 32 | u64::from(pair[1])
}

/// The pair of a [`key`].
#[inline(always)]
fn pair(key: u64) -> [u32; 2] {
    [(key >> 32) as u32, key as u32]
}

/// Two sorted lists that are compared, and how far.
struct Comparison<'a> {
    before: &'a [[u32; 2]],
    now: &'a [[u32; 2]],
    /// What only the first has, and what only the second has.
    ended: &'a mut [[u32; 2]],
    begun: &'a mut [[u32; 2]],
    /// How many of these there are.
    counts: [usize; 2],
    /// What comes next in each list.
    at: [usize; 2],
}

impl Comparison<'_> {
    /// Goes one pair further in the list whose next pair is less, or in both; returns whether it could.
    /// Without a branch that depends on what they hold: it would be unpredictable.
    #[inline(always)]
    fn step(&mut self) -> bool {
        let next = self.before.get(self.at[0]).zip(self.now.get(self.at[1]));
        let Some((&old, &new)) = next else { return false };
        let (old_key, new_key) = (key(old), key(new));
        self.ended[self.counts[0]] = old;
        self.begun[self.counts[1]] = new;
        self.counts[0] += usize::from(old_key < new_key);
        self.counts[1] += usize::from(new_key < old_key);
        self.at[0] += usize::from(old_key <= new_key);
        self.at[1] += usize::from(new_key <= old_key);
        true
    }

    /// Goes to the end, and appends what was found.
    fn finish(mut self, ended: &mut Vec<[u32; 2]>, begun: &mut Vec<[u32; 2]>) {
        while self.step() {}
        ended.extend_from_slice(&self.ended[..self.counts[0]]);
        ended.extend_from_slice(&self.before[self.at[0]..]);
        begun.extend_from_slice(&self.begun[..self.counts[1]]);
        begun.extend_from_slice(&self.now[self.at[1]..]);
    }
}

#[cfg(test)]
mod tests;
