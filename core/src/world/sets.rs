//! Divides bodies into sets by their filters, so that pairs that filters forbid are not even searched: bullets that do
//! not meet each other, static bodies, and bodies that are switched off.
//!
//! Filters that forbid themselves and each other share a set, in which nothing is searched. All others are in the first
//! set, whose pairs are tested by their filters once they are found.

use alloc::vec::Vec;
use core::ops::Range;

use super::bodies::{Filter, Rules, Slots, When};

/// How many filters are told apart: the first ones. All others count as one that allows everybody, in the first set.
const FILTERS: usize = 48;
/// The size of the hash table of filters. Some of it stays free.
const BUCKETS: usize = 64;
/// The first set, and three more: of scenery, projectiles and triggers, say.
const SETS: usize = 4;
/// In place of a set, for bodies that can pair with no other.
const NOWHERE: u8 = SETS as u8;

/// Bodies by set. Keeps its buffers.
#[derive(Debug, Default)]
pub struct Sets {
    /// The bodies that may pair with some other, set by set.
    pub bodies: Vec<u32>,
    /// By set, where its bodies end.
    ends: [usize; SETS],
    /// By set, which kinds are in it, and which kinds one of those may pair with, as bits.
    members: [u64; SETS],
    allowed: [u64; SETS],
    /// The filters, and at the end what stands for all others.
    kinds: Vec<Kind>,
    /// The bodies that take part, and by their positions those of their filters.
    pub all: Vec<u32>,
    kind_of: Vec<u8>,
}

/// Bodies of the same filter.
#[derive(Debug)]
struct Kind {
    filter: Filter,
    count: usize,
    set: u8,
    /// The kinds that bodies of this one may pair with, as bits.
    allowed: u64,
}

impl Sets {
    /// Divides the bodies that take part by the filters that they have.
    #[inline(never)]
    pub fn divide(&mut self, slots: &Slots, rules: &Rules, when: When) {
        let mut buckets = [u8::MAX; BUCKETS];
        self.kinds.clear();
        self.kind_of.clear();
        for at in 0..self.all.len() {
            let kind = self.kind(&mut buckets, *rules.filter(slots, self.all[at], when));
            self.kinds[usize::from(kind)].count += 1;
            self.kind_of.push(kind);
        }
        self.choose_sets();
        self.bodies.clear();
        for set in 0..NOWHERE {
            let kinds = self.all.iter().zip(&self.kind_of);
            let of_set = kinds.filter(|(_, kind)| self.kinds[usize::from(**kind)].set == set);
            self.bodies.extend(of_set.map(|(index, _)| index));
            self.ends[usize::from(set)] = self.bodies.len();
        }
    }

    /// Replaces positions in the list of all that take part by bodies, the smaller index first.
    #[inline(never)]
    pub fn name<'p>(&self, pairs: &'p mut [[u32; 2]]) -> &'p [[u32; 2]] {
        for pair in &mut *pairs {
            let [a, b] = pair.map(|at| self.all[at as usize]);
            *pair = [a.min(b), a.max(b)];
        }
        pairs
    }

    /// The position of a filter among the kinds. `buckets` has it by hash.
    #[inline(always)]
    fn kind(&mut self, buckets: &mut [u8; BUCKETS], filter: Filter) -> u8 {
        let Filter { category, mask, group, is_static, is_enabled } = filter;
        let bits = category ^ mask.rotate_left(11) ^ group.rotate_left(22) as u32;
        let mut bucket = (bits ^ u32::from(is_static) ^ u32::from(is_enabled) << 1)
            .wrapping_mul(0x9E37_79B1) as usize
            >> 26;
        loop {
            let kind = buckets[bucket % BUCKETS];
            if kind == u8::MAX {
                let count = self.kinds.len();
                if count > FILTERS {
                    return FILTERS as u8;
                }
                // The last kind allows everybody.
                let filter = if count == FILTERS { Filter::ALL } else { filter };
                self.kinds.push(Kind { filter, count: 0, set: NOWHERE, allowed: 0 });
                if count < FILTERS {
                    buckets[bucket % BUCKETS] = count as u8;
                }
                return count as u8;
            }
            if self.kinds[usize::from(kind)].filter == filter {
                return kind;
            }
            bucket += 1;
        }
    }

    /// Whether bodies of two kinds may pair.
    #[inline(never)]
    fn may_pair(&self, a: usize, b: usize) -> bool {
        let [one, other] = [a, b].map(|kind| &self.kinds[kind].filter);
        // Of filters that are not told apart any group may be that of the other.
        let is_unknown = a.max(b) == FILTERS && !one.allows_none() && !other.allows_none();
        is_unknown || one.allows(other)
    }

    /// Puts each kind that may pair with some other into a set. Those of most bodies choose first.
    #[inline(never)]
    fn choose_sets(&mut self) {
        let count = self.kinds.len();
        let mut chosen = 0_u64;
        (self.members, self.allowed) = ([0; SETS], [0; SETS]);
        let left = |chosen: u64| (0..count).filter(move |kind| chosen >> kind & 1 == 0);
        while let Some(kind) = left(chosen).max_by_key(|&kind| self.kinds[kind].count) {
            chosen |= 1 << kind;
            let allowed = (0..count)
                .fold(0, |bits, other| bits | u64::from(self.may_pair(kind, other)) << other);
            if allowed != 0 {
                let is_apart = |&set: &usize| (self.members[set] | 1 << kind) & allowed == 0;
                let set = (1..SETS).find(is_apart).unwrap_or(0);
                self.members[set] |= 1 << kind;
                self.allowed[set] |= allowed;
                (self.kinds[kind].set, self.kinds[kind].allowed) = (set as u8, allowed);
            }
        }
    }

    /// Whether filters surely allow each body of one set to pair with each of the other.
    #[inline(never)]
    fn allow_all(&self, [set, other]: [usize; 2]) -> bool {
        let others = self.members[other];
        self.kinds.len() <= FILTERS
            && self
                .kinds
                .iter()
                .all(|kind| usize::from(kind.set) != set || kind.allowed & others == others)
    }

    /// The sets whose bodies may meet, two each or one twice, as ranges of `bodies`; and whether filters allow all of their
    /// bodies to pair.
    pub fn meetings(&self) -> impl Iterator<Item = ([Range<usize>; 2], bool)> + '_ {
        let range = |set: usize| if set == 0 { 0 } else { self.ends[set - 1] }..self.ends[set];
        let all = (0..SETS * SETS).map(|both| [both / SETS, both % SETS]);
        let meet = |&[set, other]: &[usize; 2]| {
            set <= other && self.allowed[set] & self.members[other] != 0
        };
        all.filter(meet).map(move |sets| (sets.map(range), self.allow_all(sets)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn divided(filters: &[Filter]) -> (Sets, Vec<[Vec<u32>; 2]>) {
        let all = (0..filters.len() as u32).collect();
        let mut sets = Sets { all, ..Sets::default() };
        let mut rules = Rules::default();
        (0..).zip(filters).for_each(|(index, &filter)| rules.put(index, filter));
        sets.divide(&Slots::default(), &rules, When::Now);
        let meetings = sets.meetings().map(|(ranges, are_all)| {
            let meeting = ranges.map(|range| sets.bodies[range].to_vec());
            let allows = |a: u32, b: u32| filters[a as usize].allows(&filters[b as usize]);
            let all = || meeting[0].iter().flat_map(|&a| meeting[1].iter().map(move |&b| (a, b)));
            assert!(!are_all || all().all(|(a, b)| allows(a, b)));
            meeting
        });
        let meetings = meetings.collect();
        (sets, meetings)
    }

    fn check(filters: &[Filter]) {
        let (_, meetings) = divided(filters);
        for (a, one) in (0..).zip(filters) {
            for (b, other) in (0..a).zip(filters) {
                let meets = |[first, second]: &&[Vec<u32>; 2]| {
                    first.contains(&a) && second.contains(&b)
                        || first.contains(&b) && second.contains(&a)
                };
                let count = meetings.iter().filter(meets).count();
                assert!(
                    count < 2 && (count == 1 || !one.allows(other)),
                    "{one:?} {other:?}: {count}"
                );
            }
        }
    }

    #[test]
    fn bodies_that_may_pair_meet_once_whatever_their_filters() {
        let mut state = 1_u64;
        let mut draw = |below: u64| {
            state = state.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(0x1405_7B7E_F767_814F);
            (state >> 33) % below
        };
        for round in 0..200 {
            // Up to more filters than are told apart.
            let bits = 1 << (1 + round % 6);
            let filters: Vec<_> = (0..150)
                .map(|_| Filter {
                    category: draw(bits) as u32,
                    mask: draw(bits) as u32,
                    group: [0, 0, 0, 1, -1, -2, 2][draw(7) as usize] * (1 + draw(bits) as i32),
                    is_static: draw(4) == 0,
                    is_enabled: draw(4) != 0,
                })
                .collect();
            check(&filters);
        }
    }

    #[test]
    fn the_largest_sets_that_do_not_meet_within_are_not_searched_within() {
        let bullet = Filter::default().category(2).mask(4);
        let enemy = Filter::default().category(4);
        let shot = Filter::default().category(8).mask(1);
        let off = Filter::default().mask(0);
        let mut filters = Vec::new();
        // Few of five kinds that cannot share a set, then many bullets and shots.
        filters.extend(
            (0..5).map(|bit| Filter::default().category(16 << bit).mask(15 | 0x1F0 & !(16 << bit))),
        );
        filters.extend([enemy; 50]);
        filters.extend([bullet; 900]);
        filters.extend([shot; 800]);
        filters.extend([Filter::STATIC; 700]);
        filters.extend([off; 600]);
        let (sets, meetings) = divided(&filters);
        assert_eq!(sets.bodies.len(), filters.len() - 600);
        let within: Vec<_> = meetings.iter().filter(|[first, second]| first == second).collect();
        // The enemies, and what is left of the five kinds.
        assert_eq!(within.len(), 1);
        assert!((50..=55).contains(&within[0][0].len()), "{}", within[0][0].len());
    }
}
