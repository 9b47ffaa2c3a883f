//! Which bodies may pair: their filters, and the pairs that are excluded one by one.
//!
//! None of this depends on the type of box, so it is compiled once.

use alloc::vec::Vec;

use super::exclusions::{BEFORE, Exclusions, NOW};
use super::filter::Filter;
use super::rows::put_row;
use super::slots::{Slots, flag};
use crate::cloning::clone_fields;
use crate::memory::{OutOfMemory, reserve_for};

/// How many pairs are filtered at a time.
const CHUNK: usize = 1 << 14;

/// Of which moment a fact is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// As users last set it.
    Now,
    /// As the last update knew it.
    LastUpdate,
}

/// The filters and the excluded pairs, now and at the last update. Bodies are named by their indices.
#[derive(Debug, Default)]
pub struct Rules {
    filters: Vec<Filter>,
    /// The filters at the last update, of bodies of [`flag::REFILTERED`]; only as long as needed.
    old_filters: Vec<Filter>,
    exclusions: Exclusions,
    /// Whether a body ever had another filter than the first one or one that forbids its like, or a pair was excluded.
    are_mixed: bool,
    /// Whether there is a body of [`flag::REFILTERED`].
    any_refiltered: bool,
}

clone_fields! {
    [] Rules {
        filters, old_filters, exclusions, are_mixed, any_refiltered,
    }
}

impl Rules {
    /// Whether any body may pair with any.
    #[inline]
    pub fn allow_all(&self) -> bool {
        !self.are_mixed
    }

    /// Whether any body may pair with any at that moment, because all have the same filter and no pair is excluded.
    #[inline(never)]
    pub fn are_alike(&self, when: When) -> bool {
        let Some(first) = self.filters.first() else { return true };
        self.allow_all()
            || first.allows(first)
                && (when == When::Now || !self.any_refiltered)
                && !self.any_excluded()
                && self.filters.iter().all(|filter| filter == first)
    }

    /// Whether some pair is excluded, or was at the last update.
    pub fn any_excluded(&self) -> bool {
        !self.exclusions.is_empty()
    }

    /// Whether a filter or an excluded pair changed since the last update.
    pub fn any_changed(&self) -> bool {
        self.any_refiltered
    }

    /// Writes the filter of a body whose index is that of an existing row or the next.
    #[inline(never)]
    pub fn put(&mut self, index: u32, filter: Filter) {
        let first = self.filters.first().unwrap_or(&filter);
        self.are_mixed |= filter != *first || !filter.allows(&filter);
        put_row(&mut self.filters, index, filter);
    }

    /// The filter of a body.
    #[inline(never)]
    pub fn filter(&self, slots: &Slots, index: u32, when: When) -> &Filter {
        if when == When::LastUpdate && slots.has(index, flag::REFILTERED) {
            &self.old_filters[index as usize]
        } else {
            self.filter_now(index)
        }
    }

    /// The filter that a body has now.
    #[inline]
    pub fn filter_now(&self, index: u32) -> &Filter {
        &self.filters[index as usize]
    }

    /// Whether two bodies may pair, by their filters and unless they are excluded.
    #[inline(never)]
    pub fn allow(&self, slots: &Slots, [a, b]: [u32; 2], when: When) -> bool {
        let are_listed = slots.has(a, flag::EXCLUDES) && slots.has(b, flag::EXCLUDES);
        self.filter(slots, a, when).allows(self.filter(slots, b, when))
            && !(are_listed && self.excludes(slots, [a, b], when))
    }

    /// Whether a pair is excluded.
    #[inline(never)]
    pub fn excludes(&self, slots: &Slots, pair: [u32; 2], when: When) -> bool {
        let bit = if when == When::Now { NOW } else { BEFORE };
        self.exclusions.excludes(slots.pair(pair), bit)
    }

    /// Appends the pairs that are allowed, smaller index first, of those between the bodies of two lists, given by their
    /// positions in these. `are_all` says that filters allow all of them.
    ///
    /// # Errors
    /// [`OutOfMemory`].
    #[inline(never)]
    pub fn append_allowed(
        &self,
        slots: &Slots,
        when: When,
        [first, second]: [&[u32]; 2],
        positions: &[[u32; 2]],
        are_all: bool,
        allowed: &mut Vec<[u32; 2]>,
    ) -> Result<(), OutOfMemory> {
        let are_all = are_all && !self.any_excluded();
        // A few at a time, since filters may forbid most of them.
        for positions in positions.chunks(CHUNK) {
            reserve_for(allowed, allowed.len() + positions.len())?;
            let named = positions.iter().map(|&[a, b]| [first[a as usize], second[b as usize]]);
            let kept = named.filter(|&pair| are_all || self.allow(slots, pair, when));
            allowed.extend(kept.map(|[a, b]| [a.min(b), a.max(b)]));
        }
        Ok(())
    }

    /// Gives a body another filter, or the same to have its pairs looked at again. The body has to be touched.
    #[inline(never)]
    pub fn refilter(&mut self, slots: &mut Slots, index: u32, filter: Filter) {
        let before = core::mem::replace(&mut self.filters[index as usize], filter);
        self.are_mixed = true;
        if !slots.has(index, flag::NEW | flag::REFILTERED) {
            self.keep_old(slots, index, before);
        }
    }

    /// Keeps the filter that a body had at the last update.
    #[inline(never)]
    pub fn keep_old(&mut self, slots: &mut Slots, index: u32, filter: Filter) {
        slots.raise(index, flag::REFILTERED);
        self.any_refiltered = true;
        self.are_mixed = true;
        if self.old_filters.len() <= index as usize {
            self.old_filters.resize(slots.len(), filter);
        }
        self.old_filters[index as usize] = filter;
    }

    /// Excludes a pair of two bodies, or includes it again. Returns whether that changes it; then both have to be touched.
    #[inline(never)]
    pub fn exclude(&mut self, slots: &mut Slots, pair: [u32; 2], is_excluded: bool) -> bool {
        let changes = self.excludes(slots, pair, When::Now) != is_excluded;
        if changes {
            self.exclusions.set(slots.pair(pair), NOW);
            for index in pair {
                slots.raise(index, flag::EXCLUDES);
                self.refilter(slots, index, self.filters[index as usize]);
            }
        }
        changes
    }

    /// The excluded pairs as slots, sorted, each with [`NOW`] where both bodies are there, [`BEFORE`], or both.
    #[inline(never)]
    pub fn excluded(&self, slots: &Slots) -> Vec<([u32; 2], u8)> {
        let is_here = |slot: u32| slots.has(slots.index_of[slot as usize], flag::LIVE);
        let mut keys: Vec<_> = self.exclusions.keys().collect();
        keys.sort_unstable();
        let pairs = keys.into_iter().map(|key| [(key >> 32) as u32, key as u32]).map(|pair| {
            let bit = |when| if self.exclusions.excludes(pair, when) { when } else { 0 };
            let now = if pair.iter().all(|&slot| is_here(slot)) { bit(NOW) } else { 0 };
            (pair, now | bit(BEFORE))
        });
        pairs.filter(|(_, when)| *when != 0).collect()
    }

    /// Excludes a pair of a snapshot, in which indices are slots. Returns whether it can be: both bodies are there when it
    /// says so.
    #[inline(never)]
    pub fn restore_exclusion(&mut self, slots: &mut Slots, pair: [u32; 2], when: u8) -> bool {
        let are = |flags| pair.iter().all(|&index| slots.has(index, flags));
        let any_new = pair.iter().any(|&index| slots.has(index, flag::NEW));
        let are_known = are(flag::LIVE | flag::LEAVING) && !any_new;
        if when & NOW != 0 && !are(flag::LIVE) || when & BEFORE != 0 && !are_known {
            return false;
        }
        self.are_mixed = true;
        self.exclusions.set(pair, when);
        for index in pair {
            slots.raise(index, flag::EXCLUDES);
            if when != NOW | BEFORE {
                self.refilter(slots, index, self.filters[index as usize]);
            }
        }
        true
    }

    /// Forgets the excluded pairs of bodies that are gone.
    #[inline(never)]
    pub fn forget_gone(&mut self, slots: &Slots) {
        let here = flag::LIVE | flag::LEAVING;
        self.exclusions.retain(&|slot| slots.has(slots.index_of[slot as usize], here));
    }

    /// Makes the rules of now those of the last update. Returns whether a body was of [`flag::REFILTERED`].
    pub fn finish(&mut self) -> bool {
        self.exclusions.finish();
        core::mem::take(&mut self.any_refiltered)
    }

    /// The tables by index, to be reordered.
    pub fn tables(&mut self) -> [&mut Vec<Filter>; 2] {
        [&mut self.filters, &mut self.old_filters]
    }
}
