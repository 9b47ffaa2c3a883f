//! Whether fat boxes pay: what updates with them cost, against finding all pairs of the boxes
//! themselves in each update.
//!
//! Where bodies fly, fat boxes that last have too many candidates; where many jump, too many are
//! looked up. What was done is counted, in bodies: what finding all pairs anew costs for one. (Work
//! and not time, so that nothing depends on the clock.) Where it came to more than that for each
//! body and update, fat boxes are done without for some updates, and then tried again: soon, and
//! less and less often where they fail each time, or would by what is seen of the motion.

use super::update::REBUILD;

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

/// How many candidates there are for each pair, roughly.
const FAT_PAIRS: f64 = 3.0;

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
        let is_without = self.without > 0 && changed * REBUILD > bodies;
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
        let cost = cost(changed, tests, escaped, jumped);
        self.spent = self.spent.saturating_add(cost);
        self.updates = self.updates.saturating_add(1);
        cost > bodies && self.give_up()
    }

    /// Notes an update that found all candidates anew, and whether of fat boxes, which they are not if
    /// these would not have lasted: unless it is that most bodies are `new`, of which no motion is known.
    /// Says whether to do without.
    pub fn note_rebuild(&mut self, bodies: usize, are_fat: bool, are_new: bool) -> bool {
        let (spent, updates) = (self.spent, self.updates);
        (self.spent, self.updates) = if are_fat { (FATTEN * bodies, 1) } else { (0, 0) };
        if !are_fat && !are_new || spent > updates.saturating_mul(bodies) {
            return self.give_up();
        }
        if updates > 0 {
            self.patience = SOON;
        }
        false
    }

    /// Whether to go on without, since to try would be in vain: given how many moved now and how many of
    /// these jumped, how many pairs there are, and how many updates fat boxes would last.
    pub fn goes_on(
        &mut self,
        bodies: usize,
        changed: usize,
        pairs: usize,
        jumped: usize,
        steps: f64,
    ) -> bool {
        let share = (2.0 * changed as f64 / bodies as f64).min(1.0);
        let tests = FAT_PAIRS * pairs as f64 * share;
        let anew = (FATTEN * changed) as f64 / steps.max(1.0);
        let cost = cost(changed, tests as usize, jumped, jumped) + anew as usize;
        changed * REBUILD > bodies && cost > bodies && self.give_up()
    }

    fn give_up(&mut self) -> bool {
        (self.spent, self.updates) = (0, 0);
        self.without = self.patience;
        self.patience = (2 * self.patience).min(LATE);
        true
    }
}

/// What an update costs that keeps the fat boxes of most bodies.
fn cost(changed: usize, tests: usize, escaped: usize, jumped: usize) -> usize {
    changed * MOVES.0 / MOVES.1 + tests * TEST.0 / TEST.1 + escaped * REBUILD + jumped * JUMP
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
        assert!(without(1000, |effort| effort.note_rebuild(BODIES, false, false)) > 980);
        // A rebuild and an update after it, in turn.
        let mut is_new = false;
        let failing = |effort: &mut Effort| {
            is_new = !is_new;
            let gives_up = match is_new {
                true => effort.note_rebuild(BODIES, true, false),
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
        assert!(effort.note_rebuild(BODIES, false, false) && effort.is_without(BODIES, BODIES));
        assert!(!effort.is_without(1, BODIES) && !effort.is_without(BODIES, BODIES));
    }

    #[test]
    fn a_new_world_has_fat_boxes_as_soon_as_it_moves() {
        let mut effort = Effort::default();
        assert!(
            !effort.note_rebuild(BODIES, false, true) && !effort.note_rebuild(BODIES, true, false)
        );
    }

    #[test]
    fn fat_boxes_are_not_tried_in_vain() {
        let mut effort = Effort::default();
        let mut goes_on =
            |changed, jumped, steps| effort.goes_on(BODIES, changed, BODIES, jumped, steps);
        assert!(goes_on(BODIES, 0, 0.5), "they fly");
        assert!(goes_on(BODIES, 20, 12.0), "too many jump");
        assert!(!goes_on(BODIES, 1, 12.0), "they drift");
        assert!(!goes_on(BODIES / 10, 1, 0.5), "few fly");
        assert!(!goes_on(BODIES / 100, BODIES / 100, 0.0), "few jump");
    }
}
