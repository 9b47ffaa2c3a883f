//! The update when many bodies left their fat boxes: find all candidates anew.

use alloc::alloc::{Layout, handle_alloc_error};

use super::BroadPhase;
use super::filter::Filter;
use super::options::hull;
use super::proxy::flag;
use super::seating::Deal;
use super::update::{overlap, push_wanted};
use super::updater::{Scratch, Updater};
use crate::memory::{preload, reserve};
use crate::{Aabb, Error, Scalar};

/// Where fewer than one body in so many moves, each is taken by itself.
const FEW: usize = 4;

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// Reports what begins and ends, given who changed, escaped and left. Says how seats should be
    /// dealt.
    #[inline(never)]
    pub(super) fn rebuild(&mut self) -> Deal {
        let has_same_bodies = self.leaving.is_empty() && !self.updater.any_refiltered;
        let is_new = |seat: &&u32| self.slots.has(**seat, flag::NEW);
        let Updater { any_new, scratch, .. } = &self.updater;
        let new = if *any_new { scratch.escaped.iter().filter(is_new).count() } else { 0 };

        let Updater { candidates, ended, .. } = &mut self.updater;
        let (flags, boxes, filters) = (&self.slots.flags, &self.boxes, &self.filters);
        push_wanted(ended, &candidates.pairs, |index, [a, b]| {
            let is_apart = !overlap(&boxes[a as usize], &boxes[b as usize]);
            ([a, b], candidates.live[index] & is_apart)
        });
        let asleep = candidates.asleep_pairs(&self.slots);
        ended.extend(asleep.filter(|&[a, b]| !overlap(&boxes[a as usize], &boxes[b as usize])));
        if !has_same_bodies {
            // The boxes alone do not say what ends.
            ended.clear();
            ended.extend(candidates.live_pairs(&self.slots).filter(|pair| {
                let [a, b] = pair.map(|seat| seat as usize);
                flags[a] & flags[b] & flag::LIVE == 0
                    || !filters[a].allows(&filters[b])
                    || !overlap(&boxes[a], &boxes[b])
            }));
        }

        self.wake_all();
        let are_fat = self.fatten_all();
        self.find_candidates(false, is_live);
        self.drop_forbidden();

        preload(&self.boxes);
        preload(&self.updater.previous);
        let mut begun = core::mem::take(&mut self.updater.begun);
        let Updater { candidates, previous, .. } = &mut self.updater;
        let (pairs, live) = (&candidates.pairs, &mut candidates.live);
        live.resize(pairs.len(), true);
        if are_fat {
            push_wanted(&mut begun, pairs, |index, [a, b]| {
                let (first, second) = (a as usize, b as usize);
                live[index] = overlap(&self.boxes[first], &self.boxes[second]);
                ([a, b], live[index] & !overlap(&previous[first], &previous[second]))
            });
        } else {
            push_wanted(&mut begun, pairs, |_, [a, b]| {
                ([a, b], !overlap(&previous[a as usize], &previous[b as usize]))
            });
        }
        if new > 0 || !has_same_bodies {
            // Nor what began.
            begun.clear();
            begun.extend(
                self.updater
                    .candidates
                    .live_pairs(&self.slots)
                    .filter(|&[a, b]| !self.was_live(a, b)),
            );
        }
        self.updater.begun = begun;
        self.age_tree();
        let (bodies, moved) = (self.len(), self.updater.scratch.escaped.len());
        let is_worn = self.wear_seating(moved, new);
        let are_new = (moved - new) * 2 < bodies;
        if self.updater.effort.note_rebuild(bodies, are_fat, are_new) {
            Deal::BySlot
        } else if is_worn {
            Deal::ByPlace
        } else {
            Deal::No
        }
    }

    /// Ends all sleep.
    pub(super) fn wake_all(&mut self) {
        if self.updater.sleep.wake_all() {
            self.slots.flags.iter_mut().for_each(|flags| *flags &= !flag::ASLEEP);
        }
        self.updater.front = self.slots.len();
    }

    /// Drops the candidates whose filters do not allow them.
    pub(super) fn drop_forbidden(&mut self) {
        if self.any_filter {
            let filters = &self.filters;
            let is_allowed = |[a, b]: &[u32; 2]| filters[*a as usize].allows(&filters[*b as usize]);
            self.updater.candidates.pairs.retain(is_allowed);
        }
    }

    /// Looks at how those move that changed.
    pub(super) fn look_at_motion(&mut self) {
        let Updater { previous, prediction, .. } = &mut self.updater;
        prediction.look(self.changed.iter().map(|&seat| {
            let at = seat as usize;
            // Of a body that is new this is no motion.
            let before = if self.slots.has(seat, flag::NEW) { &self.boxes } else { &*previous };
            (&before[at], &self.boxes[at])
        }));
    }

    /// Gives all bodies new fat boxes; the fat box of a body that rests is its own. Says whether
    /// any is larger.
    #[inline(never)]
    fn fatten_all(&mut self) -> bool {
        self.look_at_motion();
        let Updater { fat, previous, prediction, .. } = &mut self.updater;
        fat.copy_from_slice(&self.boxes);
        // Where few bodies move they should not all leave their fat boxes at once.
        let are_few = self.changed.len() * FEW < self.slots.live;
        let are_fat = are_few || prediction.reaches() || self.options.margin > T::default();
        if are_fat {
            for &seat in &self.changed {
                let at = seat as usize;
                let (before, now) = (&previous[at], &self.boxes[at]);
                if !self.slots.has(seat, flag::NEW) {
                    fat[at] = if are_few {
                        prediction.alone(seat, before, now, &self.options)
                    } else {
                        prediction.together(before, now, &self.options)
                    };
                }
            }
        }
        are_fat
    }

    /// Replaces the candidates by the pairs of fat boxes, or of the boxes themselves if `exact`, of the
    /// seats with such flags. Those of two bodies that are and were static are not even looked for.
    #[inline(never)]
    pub(super) fn find_candidates(&mut self, exact: bool, takes_part: impl Fn(u16) -> bool) {
        let mut seats = core::mem::take(&mut self.updater.scratch.seats);
        let flags = &self.slots.flags;
        let is_whole = !self.any_filter && flags.iter().all(|&flags| takes_part(flags));
        let mut movers = 0;
        if !is_whole {
            let everyone =
                || (0..flags.len() as u32).filter(|&seat| takes_part(flags[seat as usize]));
            let is_static = |seat: &u32| {
                self.filters[*seat as usize].is_static && self.old_filter(*seat).is_static
            };
            seats.clear();
            seats.extend(everyone().filter(|seat| !is_static(seat)));
            movers = seats.len();
            seats.extend(everyone().filter(is_static));
        }
        let Updater { fat, candidates, scratch, .. } = &mut self.updater;
        let Scratch { finder, boxes, .. } = scratch;
        let table = if exact { &self.boxes } else { &*fat };
        candidates.clear();
        let pairs = &mut candidates.pairs;
        // Boxes were checked when they came and fat boxes are no worse: the finder takes them.
        if is_whole {
            let found = found(finder.find(table));
            reserve(pairs, found.len());
            pairs.extend_from_slice(found);
        } else {
            boxes.clear();
            boxes.extend(seats.iter().map(|&seat| table[seat as usize]));
            let (moving, fixed) = boxes.split_at(movers);
            let (mover, other) = seats.split_at(movers);
            let moving_pairs = found(finder.find(moving));
            pairs.extend(moving_pairs.iter().map(|pair| pair.map(|index| mover[index as usize])));
            let fixed_pairs = found(finder.find_between(moving, fixed));
            pairs.extend(fixed_pairs.iter().map(|&[a, b]| {
                let (a, b) = (mover[a as usize], other[b as usize]);
                [a.min(b), a.max(b)]
            }));
        }
        self.updater.scratch.seats = seats;
    }

    /// Whether a pair was live at the last update.
    pub(super) fn was_live(&self, a: u32, b: u32) -> bool {
        let previous = &self.updater.previous;
        !self.slots.has(a, flag::NEW)
            && !self.slots.has(b, flag::NEW)
            && overlap(self.at_hand(a, previous), self.at_hand(b, previous))
            && (!self.any_filter || self.old_filter(a).allows(self.old_filter(b)))
    }

    /// The box of a body in a table by seat. Who sleeps has one in all tables, and where bodies are looked up
    /// the fat one was just looked at.
    #[inline]
    pub(super) fn at_hand<'a>(&'a self, seat: u32, table: &'a [Aabb<D, T>]) -> &'a Aabb<D, T> {
        let sleeps = self.slots.has(seat, flag::ASLEEP);
        let table = if sleeps { &self.updater.fat } else { table };
        &table[seat as usize]
    }

    /// The filter of a body at the last update.
    pub(super) fn old_filter(&self, seat: u32) -> &Filter {
        if self.slots.has(seat, flag::REFILTERED) {
            &self.updater.old_filters[seat as usize]
        } else {
            &self.filters[seat as usize]
        }
    }

    /// Makes up what follows from the world of the last update, which was read from a snapshot.
    pub(super) fn restore_candidates(&mut self) {
        let Updater { fat, previous, .. } = &mut self.updater;
        for seat in 0..self.slots.len() {
            let is_live = self.slots.flags[seat] & flag::LIVE != 0;
            fat[seat] = previous[seat];
            if is_live {
                fat[seat] = hull(&previous[seat], &self.boxes[seat]);
            }
        }
        self.find_candidates(false, |flags| {
            flags & (flag::LIVE | flag::LEAVING) != 0 && flags & flag::NEW == 0
        });
        let mut candidates = core::mem::take(&mut self.updater.candidates);
        candidates.pairs.retain(|&[a, b]| {
            self.filters[a as usize].allows(&self.filters[b as usize])
                || self.old_filter(a).allows(self.old_filter(b))
        });
        candidates.live = candidates.pairs.iter().map(|&[a, b]| self.was_live(a, b)).collect();
        self.updater.candidates = candidates;
    }
}

/// Whether a body is there.
pub(super) fn is_live(flags: u16) -> bool {
    flags & flag::LIVE != 0
}

/// What the finder found. Its boxes are valid, so it can have failed only where memory ended; a
/// world that lacks pairs would be wrong, so then the program ends, as when any collection of its
/// own fails to grow.
pub(super) fn found(result: Result<&[[u32; 2]], Error>) -> &[[u32; 2]] {
    result.unwrap_or_else(|_| handle_alloc_error(Layout::new::<[u32; 2]>()))
}
