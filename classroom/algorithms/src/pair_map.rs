//! A map from pairs to values, for the algorithms that keep overlaps.

use alloc::vec;
use alloc::vec::Vec;

/// A hash table over a dense list: the list holds the pairs, the table their positions in the list.
/// Expected O(1) to find, add and remove. Iterating needs no hash, and its order depends only on
/// the calls made, on every machine.
#[derive(Clone, Debug, Default)]
pub struct PairMap<V> {
    entries: Vec<([u32; 2], V)>,
    /// Open addressing with linear probing: a place in `entries`, or `EMPTY`. Its length is a
    /// power of two, at least twice the number of entries; or 0.
    table: Vec<usize>,
}

const EMPTY: usize = usize::MAX;

impl<V> PairMap<V> {
    /// The value of a pair.
    pub fn get_mut(&mut self, pair: [u32; 2]) -> Option<&mut V> {
        let place = self.table[self.find(pair)?];
        Some(&mut self.entries[place].1)
    }

    /// Adds a pair that is not in it.
    pub fn insert(&mut self, pair: [u32; 2], value: V) {
        if self.table.len() < 2 * (self.entries.len() + 1) {
            self.grow();
        }
        self.entries.push((pair, value));
        self.enter(self.entries.len() - 1);
    }

    /// Removes a pair, if it is in it; the last one takes its place in the list.
    pub fn remove(&mut self, pair: [u32; 2]) -> Option<V> {
        let slot = self.find(pair)?;
        let place = self.table[slot];
        self.free(slot);
        let last = self.entries[self.entries.len() - 1].0;
        if let Some(moved) = self.find(last) {
            self.table[moved] = place;
        }
        Some(self.entries.swap_remove(place).1)
    }

    /// Every pair with its value.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut ([u32; 2], V)> {
        self.entries.iter_mut()
    }

    /// Removes all and keeps the memory.
    pub fn clear(&mut self) {
        self.entries.clear();
        self.table.fill(EMPTY);
    }

    /// The memory it holds.
    pub fn bytes(&self) -> usize {
        self.entries.capacity() * size_of::<([u32; 2], V)>()
            + self.table.capacity() * size_of::<usize>()
    }

    /// The slot at which the search for a pair begins: the high bits of a product with 2^64 over
    /// the golden ratio (Knuth's multiplicative hashing).
    fn home(&self, [a, b]: [u32; 2]) -> usize {
        let key = (u64::from(a) << 32 | u64::from(b)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let bits = self.table.len().trailing_zeros();
        // Twice, because a shift by all 64 bits is none.
        (key >> 1 >> (63 - bits)) as usize
    }

    /// The slot that holds the place of a pair.
    fn find(&self, pair: [u32; 2]) -> Option<usize> {
        if self.table.is_empty() {
            return None;
        }
        let mut slot = self.home(pair);
        loop {
            match self.table[slot] {
                EMPTY => return None,
                place if self.entries[place].0 == pair => return Some(slot),
                _ => slot = self.after(slot),
            }
        }
    }

    fn after(&self, slot: usize) -> usize {
        (slot + 1) & (self.table.len() - 1)
    }

    /// Writes the place of an entry into the first empty slot from its home on.
    fn enter(&mut self, place: usize) {
        let mut slot = self.home(self.entries[place].0);
        while self.table[slot] != EMPTY {
            slot = self.after(slot);
        }
        self.table[slot] = place;
    }

    /// Empties a slot and moves up those behind it that would no longer be found (Knuth's
    /// algorithm R). No entry has left the list yet.
    fn free(&mut self, mut hole: usize) {
        let mask = self.table.len() - 1;
        let mut slot = self.after(hole);
        while self.table[slot] != EMPTY {
            let home = self.home(self.entries[self.table[slot]].0);
            // The probes from its home to its slot pass the hole.
            if slot.wrapping_sub(home) & mask >= slot.wrapping_sub(hole) & mask {
                self.table[hole] = self.table[slot];
                hole = slot;
            }
            slot = self.after(slot);
        }
        self.table[hole] = EMPTY;
    }

    fn grow(&mut self) {
        self.table = vec![EMPTY; (2 * self.table.len()).max(16)];
        (0..self.entries.len()).for_each(|place| self.enter(place));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::collections::BTreeMap;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn it_is_a_map(calls in proptest::collection::vec((0u32..12, 0u32..12, 0u32..3), 0..400)) {
            let (mut map, mut expected) = (PairMap::default(), BTreeMap::new());
            for (number, (a, b, what)) in calls.into_iter().enumerate() {
                let pair = [a, b << 28];
                match what {
                    0 => prop_assert_eq!(map.remove(pair), expected.remove(&pair)),
                    1 => prop_assert_eq!(map.get_mut(pair), expected.get_mut(&pair)),
                    _ => if expected.insert(pair, number).is_none() {
                        map.insert(pair, number);
                    } else {
                        *map.get_mut(pair).unwrap() = number;
                    },
                }
                let listed: BTreeMap<_, _> = map.iter_mut().map(|entry| *entry).collect();
                prop_assert_eq!(&listed, &expected);
            }
            map.clear();
            prop_assert_eq!(map.iter_mut().count(), 0);
            prop_assert_eq!(map.get_mut([1, 2]), None);
        }
    }
}
