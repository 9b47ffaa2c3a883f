//! Whether tracking pays: what updates with fat AABBs cost, compared with finding all pairs from scratch.
//!
//! All costs are in *bodies*: the time that finding all pairs from scratch takes for one body. Where
//! bodies fly, fat AABBs that last have too many candidates; where many jump, too many bodies are looked
//! up. Where tracking cost more than from scratch, it is skipped for some updates and then tried
//! again: soon at first, and less and less often while it fails or the motion shows that it would.
//!
//! The weights are fitted to paired runs of all motions of `scenes/` at 1,000 to 1,000,000 bodies (one
//! core of a virtual AMD EPYC of 2024).

/// What it costs to look up a body in the tree that left its fat AABB.
pub const LOOK_UP: usize = 24;
/// What it additionally costs to look up a body that jumped: nothing near it is cached.
const JUMP: usize = 40;
/// How many changed bodies can be written and compared with their fat AABBs at the cost of one body.
const CHANGES: usize = 6;
/// How many candidates can be tested at the cost of one body.
const TESTS: usize = 16;
/// What finding all candidates costs for each body: there are more of them than pairs.
const REBUILD: usize = 2;
/// About how many candidates there are for each pair.
const CANDIDATES: f64 = 3.0;
/// For how many updates tracking is skipped, at least and at most.
const SKIPPED: [usize; 2] = [16, 128];
/// How many times the cost of building a tree for a body a search costs more in a tree whose leaves are
/// twice too large.
const LARGE_LEAVES: usize = 3;

/// The work of an update.
#[derive(Clone, Copy, Debug)]
pub struct Work {
    /// How many bodies there are.
    pub bodies: usize,
    /// How many changed or were removed.
    pub changed: usize,
    /// How many candidates are tested.
    pub tests: usize,
    /// How many are looked up, since they left their fat AABBs.
    pub escaped: usize,
    /// How many of these jumped.
    pub jumped: usize,
}

impl Work {
    fn cost(&self) -> usize {
        self.changed / CHANGES + self.tests / TESTS + self.escaped * LOOK_UP + self.jumped * JUMP
    }
}

/// Whether finding all candidates is cheaper than looking up this many bodies.
pub fn rebuild_pays(escaped: usize, bodies: usize) -> bool {
    escaped * LOOK_UP > bodies
}

/// Whether to keep a tree whose leaves became larger by this factor, and which is searched this often
/// between two builds.
pub fn refit_pays(growth: f64, searches: usize, bodies: usize) -> bool {
    (growth - 1.0) * (searches * LARGE_LEAVES) as f64 <= bodies as f64
}

/// What tracking cost since all fat AABBs were made, and whether to skip it.
#[derive(Clone, Debug)]
pub struct Policy {
    cost: usize,
    updates: usize,
    /// For how many more updates tracking is skipped.
    skipped: usize,
    /// For how many it is skipped next time.
    next_skipped: usize,
}

impl Default for Policy {
    fn default() -> Self {
        Self { cost: 0, updates: 0, skipped: 0, next_skipped: SKIPPED[0] }
    }
}

impl Policy {
    /// Whether this update skips tracking, given that this many of so many bodies changed.
    pub fn skips_tracking(&mut self, changed: usize, bodies: usize) -> bool {
        let skips = self.skipped > 0 && rebuild_pays(changed, bodies);
        self.skipped = if skips { self.skipped - 1 } else { 0 };
        skips
    }

    /// Notes an incremental update. Returns whether to skip tracking from now on.
    pub fn note_incremental(&mut self, work: &Work) -> bool {
        self.cost = self.cost.saturating_add(work.cost());
        self.updates = self.updates.saturating_add(1);
        work.cost() > work.bodies && self.skip()
    }

    /// Notes an update that found all candidates. `is_fat` says whether fat AABBs are larger than
    /// bodies: they are not if they would not last, or if most bodies are new and their motion is not
    /// known (`is_new`). Returns whether to skip tracking from now on.
    pub fn note_rebuild(&mut self, bodies: usize, is_fat: bool, is_new: bool) -> bool {
        let (cost, updates) = (self.cost, self.updates);
        (self.cost, self.updates) = if is_fat { (REBUILD * bodies, 1) } else { (0, 0) };
        if !is_fat && !is_new || cost > updates.saturating_mul(bodies) {
            return self.skip();
        }
        if updates > 0 {
            self.next_skipped = SKIPPED[0];
        }
        false
    }

    /// Whether to skip tracking again although it is time to try it, given the bodies, the changed and
    /// the jumped of this update, how many pairs there are, and how many updates fat AABBs would last.
    pub fn skips_again(&mut self, work: &Work, pairs: usize, lifetime: f64) -> bool {
        let moving = (2.0 * work.changed as f64 / work.bodies as f64).min(1.0);
        let tests = (CANDIDATES * pairs as f64 * moving) as usize;
        let rebuild = ((REBUILD * work.changed) as f64 / lifetime.max(1.0)) as usize;
        let cost = Work { tests, escaped: work.jumped, ..*work }.cost() + rebuild;
        rebuild_pays(work.changed, work.bodies) && cost > work.bodies && self.skip()
    }

    fn skip(&mut self) -> bool {
        (self.cost, self.updates) = (0, 0);
        self.skipped = self.next_skipped;
        self.next_skipped = (2 * self.next_skipped).min(SKIPPED[1]);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BODIES: usize = 1000;
    const NONE: Work = Work { bodies: BODIES, changed: 0, tests: 0, escaped: 0, jumped: 0 };
    const DRIFT: Work = Work { changed: BODIES, tests: 3 * BODIES, ..NONE };

    /// How many of so many updates skip tracking, where `note` notes each that does not.
    fn skipped(updates: usize, mut note: impl FnMut(&mut Policy) -> bool) -> usize {
        let mut policy = Policy::default();
        (0..updates).filter(|_| policy.skips_tracking(BODIES, BODIES) || note(&mut policy)).count()
    }

    #[test]
    fn tracking_is_skipped_where_it_costs_more_and_tried_less_and_less_often() {
        let cheap = Work { escaped: 1, ..DRIFT };
        assert_eq!(skipped(1000, |policy| policy.note_incremental(&cheap)), 0);
        assert!(skipped(1000, |policy| policy.note_rebuild(BODIES, false, false)) > 980);
        let dear = Work { escaped: 20, ..DRIFT };
        let mut is_rebuild = false;
        let failing = |policy: &mut Policy| {
            is_rebuild = !is_rebuild;
            let skips = match is_rebuild {
                true => policy.note_rebuild(BODIES, true, false),
                false => policy.note_incremental(&dear),
            };
            is_rebuild &= !skips;
            skips
        };
        let tracked = 1000 - skipped(1000, failing);
        assert!((10..50).contains(&tracked), "{tracked}");
    }

    #[test]
    fn a_world_that_comes_to_rest_is_tracked_at_once() {
        let mut policy = Policy::default();
        assert!(policy.note_rebuild(BODIES, false, false));
        assert!(policy.skips_tracking(BODIES, BODIES));
        assert!(!policy.skips_tracking(1, BODIES) && !policy.skips_tracking(BODIES, BODIES));
    }

    #[test]
    fn new_bodies_are_tracked_as_soon_as_they_move() {
        let mut policy = Policy::default();
        assert!(!policy.note_rebuild(BODIES, false, true));
        assert!(!policy.note_rebuild(BODIES, true, false));
    }

    #[test]
    fn tracking_is_skipped_again_while_the_motion_shows_that_it_would_not_pay() {
        let mut policy = Policy::default();
        let mut skips = |changed, jumped, lifetime| {
            policy.skips_again(&Work { changed, jumped, ..NONE }, BODIES, lifetime)
        };
        assert!(skips(BODIES, 0, 0.5), "all fly");
        assert!(skips(BODIES, 20, 12.0), "too many jump");
        assert!(!skips(BODIES, 1, 12.0), "all drift");
        assert!(!skips(BODIES / 10, 1, 0.5), "few fly");
        assert!(!skips(BODIES / 100, BODIES / 100, 0.0), "few jump");
    }
}
