//! Sleep: bodies that rest take no part in an update.
//!
//! An update tests all candidates of the bodies that are awake. One that is asleep costs nothing,
//! but to wake it takes a search of the tree, as much as hundreds of tests: so whoever rests goes to
//! sleep soon in a world in which the same bodies rest all the time, and late where they take
//! turns.

use super::BroadPhase;
use super::candidates::are_asleep;
use super::proxy::flag;
use super::update::overlap;
use super::updater::Updater;
use crate::Scalar;

/// To wake a body takes as long as to test so many candidates.
const WAKE: usize = 400;
/// For how many updates a body rests before it goes to sleep, at least and at most.
const SOON: usize = 8;
const LATE: usize = 256;

/// When bodies go to sleep.
#[derive(Clone, Debug)]
pub(super) struct Sleep {
    /// How many are asleep.
    pub count: usize,
    /// How many woke since bodies last went to sleep.
    pub woke: usize,
    /// The updates since then in which most bodies that are awake rested.
    idle: usize,
    /// How many of those it takes now.
    patience: usize,
    /// How often bodies moved since seats were dealt for the sake of those who are awake.
    moves: usize,
}

impl Default for Sleep {
    fn default() -> Self {
        Self { count: 0, woke: 0, idle: 0, patience: SOON, moves: 0 }
    }
}

impl Sleep {
    /// Notes that all are awake; says whether some were not.
    pub fn wake_all(&mut self) -> bool {
        (self.woke, self.idle) = (0, 0);
        core::mem::take(&mut self.count) > 0
    }

    /// Notes an update that looked at all bodies awake, of which so many moved. Says whether it is
    /// time for others to go to sleep.
    fn note(&mut self, awake: usize, moved: usize, kept: usize) -> bool {
        self.moves = self.moves.saturating_add(moved);
        self.idle += usize::from(moved * 2 < awake);
        // Whoever is asleep is looked at then too, in passing.
        let is_time = self.idle >= self.patience && self.idle * awake * 4 >= kept;
        if is_time {
            let saved = self.count * self.idle;
            let is_worth = self.woke * WAKE <= saved;
            let patience = if is_worth { self.patience / 2 } else { self.patience * 2 };
            self.patience = patience.clamp(SOON, LATE);
            (self.woke, self.idle) = (0, 0);
        }
        is_time
    }
}

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// Has bodies that rested for long go to sleep, if it is time. To be called at the end of an
    /// update of which so many bodies moved. Says whether seats should be dealt anew, so that
    /// those who are awake are near each other.
    #[inline(never)]
    pub(super) fn settle_down(&mut self, moved: usize) -> bool {
        let Updater { sleep, candidates, fat, front, .. } = &mut self.updater;
        if moved == 0 || !sleep.note(self.slots.live - sleep.count, moved, candidates.asleep.len())
        {
            return false;
        }
        let slots = &mut self.slots;
        candidates.asleep.retain(|pair| are_asleep(slots, pair));
        for (at, flags) in slots.flags.iter_mut().enumerate() {
            let rests = *flags & (flag::LIVE | flag::RECENT | flag::ASLEEP) == flag::LIVE;
            if rests {
                *flags |= flag::ASLEEP;
                fat[at] = self.boxes[at];
                sleep.count += 1;
            }
            *flags &= !flag::RECENT;
        }
        candidates.put_to_sleep(slots, |[a, b]| overlap(&fat[a as usize], &fat[b as usize]));
        let awake = slots.live - sleep.count;
        let is_apart = awake * 2 < *front && sleep.moves >= slots.len();
        if is_apart {
            sleep.moves = 0;
        }
        is_apart
    }
}
