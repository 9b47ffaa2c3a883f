//! Whether fat boxes pay: what updates with them cost, against finding all pairs of the boxes
//! themselves in each update.
//!
//! Where bodies fly, fat boxes that last have too many candidates; where many jump, too many are
//! looked up. What was done is counted, in bodies: what finding all pairs anew costs for one. (Work
//! and not time, so that nothing depends on the clock.) Where it came to more than that for each
//! body and update, fat boxes are done without for some updates, and then tried again: soon, and
//! less and less often where they fail each time.

use super::update::{IS_WHOLE, REBUILD};

/// For how many updates fat boxes are done without, at least and at most.
const SOON: usize = 16;
const LATE: usize = 128;

/// What it costs that somebody moves: to write here and there, and to see whether he left his fat box.
const MOVES: (usize, usize) = (1, 6);
/// What the test of a candidate costs.
const TEST: (usize, usize) = (1, 16);
/// How much more it costs to look somebody up who jumped than others who left their fat boxes.
const JUMP: usize = 40;
/// What finding all pairs of fat boxes costs for each body: there are more of them, and each is tested.
const FATTEN: usize = 2;

/// What was done since all fat boxes were new.
#[derive(Clone, Debug)]
pub(super) struct Effort {
    spent: usize,
    updates: usize,
    /// For how many more updates fat boxes are done without.
    without: usize,
    /// For how many they are next time.
    patience: usize,
}

impl Default for Effort {
    fn default() -> Self {
        Self { spent: 0, updates: 0, without: 0, patience: SOON }
    }
}

impl Effort {
    /// Whether this update does without fat boxes, in which so many change of so many.
    pub fn is_without(&mut self, changed: usize, bodies: usize) -> bool {
        let is_without = IS_WHOLE && self.without > 0 && changed * REBUILD > bodies;
        self.without = if is_without { self.without - 1 } else { 0 };
        is_without
    }

    /// Notes an update that kept the fat boxes of most bodies. Says whether to do without.
    pub fn note_follow(
        &mut self,
        bodies: usize,
        changed: usize,
        tests: usize,
        escaped: usize,
        jumped: usize,
    ) -> bool {
        if !IS_WHOLE {
            return false;
        }
        let cost = changed * MOVES.0 / MOVES.1
            + tests * TEST.0 / TEST.1
            + escaped * REBUILD
            + jumped * JUMP;
        self.spent = self.spent.saturating_add(cost);
        self.updates = self.updates.saturating_add(1);
        cost > bodies && self.give_up()
    }

    /// Notes an update that found all candidates anew, of fat boxes unless these would not have lasted.
    /// Says whether to do without.
    pub fn note_rebuild(&mut self, bodies: usize, are_fat: bool) -> bool {
        if !IS_WHOLE {
            return false;
        }
        let (spent, updates) = (self.spent, self.updates);
        (self.spent, self.updates) = (FATTEN * bodies, 1);
        if !are_fat || spent > updates.saturating_mul(bodies) {
            return self.give_up();
        }
        if updates > 0 {
            self.patience = SOON;
        }
        false
    }

    fn give_up(&mut self) -> bool {
        (self.spent, self.updates) = (0, 0);
        self.without = self.patience;
        self.patience = (2 * self.patience).min(LATE);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BODIES: usize = 1000;

    /// The updates of so many that did without fat boxes, where each that does not costs so much.
    fn without(updates: usize, mut note: impl FnMut(&mut Effort) -> bool) -> usize {
        let mut effort = Effort::default();
        (0..updates).filter(|_| effort.is_without(BODIES, BODIES) || note(&mut effort)).count()
    }

    #[test]
    fn fat_boxes_are_done_without_where_they_cost_more_and_tried_again_ever_more_seldom() {
        assert_eq!(without(1000, |effort| effort.note_follow(BODIES, BODIES, 3 * BODIES, 1, 0)), 0);
        assert!(without(1000, |effort| effort.note_rebuild(BODIES, false)) > 980);
        // A rebuild and an update after it, in turn.
        let mut is_new = false;
        let failing = |effort: &mut Effort| {
            is_new = !is_new;
            let gives_up = match is_new {
                true => effort.note_rebuild(BODIES, true),
                false => effort.note_follow(BODIES, BODIES, 3 * BODIES, 20, 0),
            };
            is_new &= !gives_up;
            gives_up
        };
        let kept = 1000 - without(1000, failing);
        assert!((10..50).contains(&kept), "{kept}");
    }

    #[test]
    fn a_world_that_comes_to_rest_takes_up_its_fat_boxes_at_once() {
        let mut effort = Effort::default();
        assert!(effort.note_rebuild(BODIES, false) && effort.is_without(BODIES, BODIES));
        assert!(!effort.is_without(1, BODIES) && !effort.is_without(BODIES, BODIES));
    }
}
