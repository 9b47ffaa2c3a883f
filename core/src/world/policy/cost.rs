//! Whether tracking pays: what updates with fat AABBs cost, compared with finding all pairs from scratch.
//!
//! All costs are in *bodies*: the time that finding all pairs from scratch takes for one body, where there are about as
//! many pairs as bodies. Where
//! bodies fly, fat AABBs do not last; where many jump, too many bodies are looked up. Where tracking cost
//! more than from scratch, it is skipped for some updates and then tried again: soon at first, and less
//! and less often while it fails.

// Measured in pairs on one core against the seven weights that were here before (of changed bodies, tests,
// searches, jumps, rebuilds, and two for predicted candidates): drift, fast, mostly-still and teleport of
// `scenes/` in 2D and 3D at 1,000, 10,000 and 100,000 bodies.

/// The ratio of the model: tracking a body that left its fat AABB costs as much as finding all pairs from
/// scratch does for this many bodies. With 64, medians were 0.93 to 1.03 of the time before. With 32,
/// teleport is tracked: 0.75 at 1,000 bodies, but 1.14 in 2D and 1.41 in 3D at 100,000. 100 is as 64
/// or up to 2 % slower.
pub const LOOK_UP: usize = 64;
/// What finding all pairs costs for each pair, where that is more than for each body: where bodies touch several others.
/// In a heap of 1,000 cubes of which 20 or 30 move in each update it takes 0.2 and 0.3 of the time with it, in one of 10,648
/// cubes 0.25 if 320 move. With 0.4, 80 of 1,000 cubes that move a little take 0.6 of the time, but 800 of 10,000 take 1.3
/// of it. With 1 teleport is tracked in 1D and 2D, and costs more there.
const PAIR: f64 = 0.75;
/// What finding all candidates costs for each body: there are more of them than pairs. Without it tracking
/// would never cost more than from scratch. Kept from before.
const REBUILD: usize = 2;
/// What a body that flies costs, but for the leaves and bodies of the tree that are read for it, each of which costs 1.
const FLIGHT: usize = 4;
/// What it costs to take a body out of the tree because it takes off, or to put it in because it lands.
const TURN: usize = 8;
/// For how many updates no body flies once that cost too much.
const GROUNDED: usize = 256;
/// For how many updates tracking is skipped, at least and at most. Kept from before.
const SKIPPED: [usize; 2] = [16, 128];
/// In a heap an update takes longer than one from scratch if it reads more leaves and bodies of the tree than one for this
/// many bodies and one for this many pairs. (Heaps of 10,000 boxes in 2D and 3D in which 2 to 6 % move.)
const DEAR_READS: [usize; 2] = [4, 10];
/// After this many of these in a row, of which the second half read nearly as much as the first, tracking is skipped. (Where
/// bodies tremble in turn, each is looked up as it moves for the first time, and then seldom.)
const DEAR_UPDATES: usize = 16;
/// In a world of more bodies the tree does not fit the second-level cache: reading it takes about twice as long.
const CACHED: usize = 1 << 14;
/// If more than one of this many bodies is looked up in such a world, the finder does that, not the tree. (Where one of 18 flies,
/// of 77,000 bodies in the plane, an update takes 0.7 of the time. In smaller worlds it would take up to 2.7 times as long.)
const FOUND_ONE_IN: usize = 24;
/// In such a world at most one of this many bodies flies: the finder looks more of them up in twice the time of finding all pairs.
/// So fewer may where others are looked up.
const FLIGHT_ONE_IN: usize = 16;
/// How many times the cost of building a tree for a body a search costs more in a tree whose leaves are
/// twice too large. Measured with 1, 100 and 10,000 regions asked for in each frame of drift, fast and
/// teleport, at 10,000 in 2D and 100,000 in 3D: 1 takes 0.89 to 0.99 with one region and up to 1.13 with
/// 10,000 of them; 9 takes up to 1.17 and 0.96 to 1.01.
const LARGE_LEAVES: usize = 3;

/// Whether an update tries on a sample what it might have to give up. Not in WebAssembly: that takes 560 bytes after gzip, which
/// the smallest files do not have left.
pub const TRIES_SAMPLES: bool = cfg!(not(target_arch = "wasm32"));

/// Whether to keep a tree whose leaves became larger by this factor, and which is searched this often
/// between two builds.
pub fn refit_pays(growth: f64, searches: usize, bodies: usize) -> bool {
    (growth - 1.0) * searches as f64 * LARGE_LEAVES as f64 <= bodies as f64
}

/// What tracking cost since all fat AABBs were made, and whether to skip it.
#[derive(Clone, Debug, Default)]
pub struct Policy {
    /// How many pairs of boxes overlap, before filters: as many as the last search for all of them found, or
    /// as all fat AABBs had since then, if they were fewer.
    overlaps: usize,
    cost: usize,
    updates: usize,
    /// How much of the tree the last update read, and how many bodies flew in it.
    reads: usize,
    flights: usize,
    /// How many updates in a row read too much, and how much their first half and the others did.
    dear: usize,
    dear_reads: [usize; 2],
    /// If tracking is skipped because of these: only while at least this many bodies change.
    dear_changes: usize,
    /// For how many more updates tracking is skipped.
    skipped: usize,
    /// For how many more updates no new fat AABB is larger than its body.
    tight: usize,
    /// For how many more updates no body flies.
    grounded: usize,
    /// For how many it is so next time, within the limits.
    next_skipped: usize,
}

impl Policy {
    /// What finding all pairs of a number of bodies costs.
    fn scratch_cost(&self, bodies: usize) -> usize {
        bodies.max((PAIR * self.overlaps as f64) as usize)
    }

    /// Whether finding all candidates is cheaper than looking up the bodies that left their fat AABBs. Where most of the bodies
    /// changed, looked up again and again they would have too many candidates.
    pub fn rebuild_pays(&self, escaped: usize, changed: usize, bodies: usize) -> bool {
        escaped > self.most_look_ups(changed, bodies)
    }

    /// How many bodies may be looked up at most: with more of them finding all candidates is cheaper.
    #[inline(never)]
    pub fn most_look_ups(&self, changed: usize, bodies: usize) -> usize {
        let rebuild = if changed * 2 > bodies { bodies } else { self.scratch_cost(bodies) };
        rebuild / LOOK_UP
    }

    /// How many candidates a number of bodies may have, before filters. In drift and teleport of `scenes/` there are 2.0 to
    /// 2.7 for each pair of boxes that overlap. With more than three fat AABBs do not pay, and could take time and memory
    /// without a limit.
    pub fn most_candidates(&self, bodies: usize) -> usize {
        bodies / 2 + 3 * self.overlaps
    }

    /// How many leaves and bodies of the tree an update may read; half of that where it does not fit the cache.
    pub fn most_reads(&self, bodies: usize) -> usize {
        (bodies - bodies / 4 + self.overlaps) >> usize::from(bodies > CACHED)
    }

    /// Whether the tree, if there is one, looks up this many bodies sooner than the finder does.
    pub fn tree_pays(look_ups: usize, bodies: usize) -> bool {
        bodies <= CACHED || look_ups * FOUND_ONE_IN <= bodies
    }

    /// Whether fast bodies may fly, given how many of the bodies changed.
    pub fn may_fly(&mut self, changed: usize, bodies: usize) -> bool {
        self.grounded = self.grounded.saturating_sub(1);
        self.grounded == 0 && changed * FLIGHT <= bodies
    }

    /// Whether more bodies would fly than pays, since finding all pairs takes less time: mostly bodies that moved once and land a few
    /// at a time. Then none flies for some updates. In a large world the `moves` that are looked up take about as long.
    pub fn too_many_fly(&mut self, flights: usize, moves: usize, bodies: usize) -> bool {
        let [flight, look_up] =
            if bodies > CACHED { [FLIGHT_ONE_IN, LOOK_UP / 2] } else { [FLIGHT, 0] };
        let are_too_many = flights > 0 && flights * flight + moves * look_up > bodies;
        if are_too_many {
            self.note_excess(flights);
        }
        are_too_many
    }

    /// Notes that all candidates will be found, and that no body flies. While tracking is to be skipped none may: it would not
    /// be skipped, and that takes up to twice as long.
    pub fn note_no_flights(&mut self) {
        self.grounded = self.grounded.max(self.skipped);
    }

    /// Notes how many pairs of boxes overlap.
    pub fn note_overlaps(&mut self, count: usize) {
        self.overlaps = count;
    }

    /// Notes how many pairs of fat AABBs overlap: not more of the boxes do.
    pub fn note_candidates(&mut self, count: usize) {
        self.overlaps = self.overlaps.min(count);
    }

    /// Whether this update skips tracking, given how many of the bodies changed.
    pub fn skips_tracking(&mut self, changed: usize, bodies: usize) -> bool {
        let is_dear = self.dear_changes > 0 && changed >= self.dear_changes;
        let skips = self.skipped > 0 && (is_dear || self.rebuild_pays(changed, changed, bodies));
        self.skipped = if skips { self.skipped - 1 } else { 0 };
        self.tight = self.tight.saturating_sub(1);
        skips
    }

    /// Whether tracking is to be skipped.
    pub fn is_skipping(&self) -> bool {
        self.skipped > 0
    }

    /// Whether new fat AABBs must not be larger than their bodies.
    pub fn is_tight(&self) -> bool {
        self.tight > 0
    }

    /// Whether bodies flew in the last update that looked up any, and that did not cost too much.
    pub fn has_flown(&self) -> bool {
        self.flights > 0
    }

    /// Whether nothing speaks for fat AABBs that are larger than their bodies: the last ones did not last, or there were none.
    pub fn is_trial(&self) -> bool {
        self.updates < 2
    }

    /// Notes that fat AABBs have too many candidates, or that looking up bodies of which this many fly was given up.
    pub fn note_excess(&mut self, flights: usize) {
        if flights > 0 {
            (self.grounded, self.flights) = (GROUNDED, 0);
        }
        self.skip();
        self.tight = self.skipped;
    }

    /// Skips tracking from now on.
    #[inline(never)]
    fn skip(&mut self) {
        (self.cost, self.updates, self.dear_changes) = (0, 0, 0);
        self.skipped = self.next_skipped.clamp(SKIPPED[0], SKIPPED[1]);
        self.next_skipped = 2 * self.skipped;
    }

    /// Notes an update that looked up this many bodies, and beside them `flights` that fly.
    pub fn note_incremental(&mut self, escaped: usize, flights: usize) {
        self.cost = self.cost.saturating_add(escaped * LOOK_UP + flights * FLIGHT);
        self.updates = self.updates.saturating_add(1);
    }

    /// Notes that `reads` leaves and bodies of the tree were read in an update in which `flights` bodies flew, and `turns` took
    /// off or landed.
    pub fn note_reads(&mut self, reads: usize, flights: usize, turns: usize, bodies: usize) {
        self.reads = if flights == 0 { reads } else { 0 };
        // All take off once; where others do in each update, that costs more than it saves.
        let turns = if self.flights > 0 { turns } else { 0 };
        self.flights = flights;
        // What finding all pairs from scratch costs, in reads.
        let from_scratch = bodies + bodies / 4 + self.overlaps / 10;
        if flights > 0 && flights * FLIGHT + turns * TURN + reads > from_scratch {
            (self.grounded, self.flights) = (GROUNDED, 0);
        }
    }

    /// Whether updates have read so much of the tree, again and again, that tracking is skipped from now on. To be asked after
    /// each update that looked up bodies, with the number of those that changed.
    #[inline(never)]
    pub fn reads_too_much(&mut self, changed: usize, bodies: usize) -> bool {
        if self.reads <= bodies / DEAR_READS[0] + self.overlaps / DEAR_READS[1] {
            (self.dear, self.dear_reads) = (0, [0; 2]);
            return false;
        }
        self.dear_reads[self.dear / (DEAR_UPDATES / 2)] += self.reads;
        self.dear += 1;
        if self.dear < DEAR_UPDATES {
            return false;
        }
        let [first, second] = core::mem::take(&mut self.dear_reads);
        self.dear = 0;
        let skips = second * 5 > first * 4;
        if skips {
            self.skip();
            self.note_no_flights();
            self.dear_changes = changed / 2;
        }
        skips
    }

    /// Notes an update that found all candidates. `is_fat` says whether fat AABBs are larger than
    /// bodies: they are not if they would not last, or if most bodies are new and their motion is not
    /// known (`is_new`). Returns whether to skip tracking from now on.
    pub fn note_rebuild(&mut self, bodies: usize, is_fat: bool, is_new: bool) -> bool {
        let (cost, updates) = (self.cost, self.updates);
        let from_scratch = self.scratch_cost(bodies);
        (self.cost, self.updates) = if is_fat { (REBUILD * from_scratch, 1) } else { (0, 0) };
        if self.skipped > 0 {
            // Its fat AABBs had too many candidates.
            return true;
        }
        if !is_fat && !is_new || cost > updates.saturating_mul(from_scratch) {
            self.skip();
            return true;
        }
        if updates > 0 {
            self.next_skipped = 0;
        }
        false
    }
}

#[cfg(test)]
mod tests;
