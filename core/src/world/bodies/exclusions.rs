//! The pairs that users excluded one by one.

use crate::cloning::clone_fields;
use alloc::vec::Vec;

/// Excluded now.
pub const NOW: u8 = 1;
/// Excluded at the last update.
pub const BEFORE: u8 = 2;
/// Listed as edited.
const LISTED: u8 = 4;
/// The size of the smallest hash table.
const FEWEST: usize = 16;
/// No pair: the slots of a pair differ, the smaller first.
const NOTHING: [u32; 2] = [0; 2];

/// Pairs of slots, smaller first, that are excluded now or were at the last update.
#[derive(Debug, Default)]
pub struct Exclusions {
    /// A hash table with linear probing. Its length is 0 or a power of two, and at most half of it is taken.
    table: Vec<Entry>,
    /// How many entries are taken, also by pairs that are excluded no more.
    taken: usize,
    /// How many of these are not: they are excluded, were so at the last update, or are listed.
    kept: usize,
    /// The pairs of which it changed since the last update whether they are excluded now, each once.
    edited: Vec<[u32; 2]>,
}

clone_fields! {
    [] Exclusions {
        table, taken, kept, edited,
    }
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    pair: [u32; 2],
    /// Bits: [`NOW`], [`BEFORE`], [`LISTED`].
    when: u8,
}

impl Exclusions {
    /// Whether surely no pair is excluded, nor was at the last update.
    pub fn is_empty(&self) -> bool {
        self.taken == 0
    }

    /// Whether a pair is excluded: `NOW`, or at the last update (`BEFORE`).
    #[inline(never)]
    pub fn excludes(&self, pair: [u32; 2], when: u8) -> bool {
        !self.table.is_empty() && self.table[self.position(pair)].when & when != 0
    }

    /// Excludes a pair, or includes it again.
    #[inline(never)]
    pub fn set(&mut self, pair: [u32; 2], when: u8) {
        if self.taken * 2 >= self.table.len() {
            self.grow();
        }
        let at = self.position(pair);
        let entry = &mut self.table[at];
        self.taken += usize::from(entry.pair == NOTHING);
        self.kept += usize::from(entry.when == 0);
        if entry.when & LISTED == 0 {
            self.edited.push(pair);
        }
        *entry = Entry { pair, when: (entry.when ^ when) | LISTED };
    }

    /// Makes what is excluded now what was at the last update. Where nothing is, the table is empty again, and a clone smaller.
    pub fn finish(&mut self) {
        while let Some(pair) = self.edited.pop() {
            let at = self.position(pair);
            let when = &mut self.table[at].when;
            *when = (*when & NOW) * (NOW | BEFORE);
            self.kept -= usize::from(*when == 0);
        }
        if self.kept == 0 {
            self.table.clear();
            self.taken = 0;
        }
    }

    /// Forgets the pairs of slots that are not kept.
    #[inline(never)]
    pub fn retain(&mut self, is_kept: &dyn Fn(u32) -> bool) {
        for Entry { pair, when } in &mut self.table {
            if *when & (NOW | BEFORE) != 0 && !pair.iter().all(|&slot| is_kept(slot)) {
                *when &= LISTED;
                self.kept -= usize::from(*when == 0);
            }
        }
    }

    /// All of them as numbers in the order of pairs, unsorted.
    pub fn keys(&self) -> impl Iterator<Item = u64> + '_ {
        let excluded = self.table.iter().filter(|entry| entry.when & (NOW | BEFORE) != 0);
        excluded.map(|entry| u64::from(entry.pair[0]) << 32 | u64::from(entry.pair[1]))
    }

    /// Where a pair is, or would be.
    fn position(&self, pair: [u32; 2]) -> usize {
        let mask = self.table.len() - 1;
        let hash = (pair[0].rotate_left(16) ^ pair[1]).wrapping_mul(0x9E37_79B1);
        let mut at = (hash ^ hash >> 15) as usize & mask;
        while self.table[at].pair != pair && self.table[at].pair != NOTHING {
            at = (at + 1) & mask;
        }
        at
    }

    /// Enlarges the table so that one more fits, and drops the pairs that are excluded no more, nor listed.
    fn grow(&mut self) {
        let kept: Vec<_> = self.table.iter().copied().filter(|entry| entry.when != 0).collect();
        self.taken = kept.len();
        let size = (self.taken * 4).next_power_of_two().max(FEWEST);
        self.table.clear();
        self.table.resize(size, Entry { pair: NOTHING, when: 0 });
        for entry in kept {
            let at = self.position(entry.pair);
            self.table[at] = entry;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::collections::BTreeMap;

    #[test]
    fn says_what_a_map_says_through_edits_updates_and_reused_slots() {
        let (mut exclusions, mut model) = (Exclusions::default(), BTreeMap::new());
        let mut state = 7_u64;
        let mut draw = |below: u64| {
            state = state.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(0x1405_7B7E_F767_814F);
            (state >> 33) % below
        };
        for step in 0..20_000 {
            let slots = [8, 60, 1000][step / 100 % 3];
            let [a, b] = [draw(slots) as u32, draw(slots) as u32];
            match draw(40) {
                0 => {
                    exclusions.finish();
                    model.values_mut().for_each(|when| *when = (*when & NOW) * 3);
                }
                1 => {
                    exclusions.retain(&|slot| slot != a && slot % 7 != 3);
                    model.retain(|pair: &[u32; 2], _| {
                        !pair.contains(&a) && pair.iter().all(|slot| slot % 7 != 3)
                    });
                }
                _ if a != b => {
                    let pair = [a.min(b), a.max(b)];
                    exclusions.set(pair, NOW);
                    *model.entry(pair).or_insert(0) ^= NOW;
                }
                _ => {}
            }
            model.retain(|_, when| *when != 0);
            let pair = [a.min(b), a.max(b)];
            for when in [NOW, BEFORE] {
                let expected = model.get(&pair).is_some_and(|bits| bits & when != 0);
                assert_eq!(exclusions.excludes(pair, when), expected, "step {step}: {pair:?}");
            }
            if step % 100 == 0 {
                let mut keys: Vec<_> = exclusions.keys().collect();
                keys.sort_unstable();
                let expected: Vec<_> =
                    model.keys().map(|[a, b]| u64::from(*a) << 32 | u64::from(*b)).collect();
                assert_eq!(keys, expected);
                assert!(exclusions.taken * 2 <= exclusions.table.len());
                assert!(exclusions.edited.len() <= exclusions.taken, "each once");
                let kept = exclusions.table.iter().filter(|entry| entry.when != 0).count();
                assert_eq!(exclusions.kept, kept);
            }
        }
        (0..1000).for_each(|slot| exclusions.retain(&|other| other != slot));
        exclusions.finish();
        assert!(exclusions.is_empty() && exclusions.table.is_empty(), "none is left");
    }
}
