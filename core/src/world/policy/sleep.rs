//! Sleep: bodies that rest take no part in updates.
//!
//! An update tests all candidates of awake bodies. A sleeping body costs nothing, but waking it takes a
//! search of the tree, as long as hundreds of tests: so bodies fall asleep soon in a world in which the
//! same ones always rest, and late where they take turns.

/// Waking a body takes as long as testing this many candidates.
const WAKE: usize = 400;
/// For how many updates a body rests before it falls asleep, at least and at most.
const PATIENCE: [usize; 2] = [8, 256];

/// When bodies fall asleep.
#[derive(Clone, Debug)]
pub struct Sleep {
    /// How many are asleep.
    pub count: usize,
    /// How many woke since bodies last fell asleep.
    pub woke: usize,
    /// The updates since then in which most awake bodies rested.
    idle: usize,
    /// How many of these it takes now.
    patience: usize,
    /// How often bodies moved since storage was last reordered to bring awake bodies together.
    moves: usize,
}

impl Default for Sleep {
    fn default() -> Self {
        Self { count: 0, woke: 0, idle: 0, patience: PATIENCE[0], moves: 0 }
    }
}

impl Sleep {
    /// Notes that all bodies wake. Returns whether one was asleep.
    pub fn wake_all(&mut self) -> bool {
        (self.woke, self.idle) = (0, 0);
        core::mem::take(&mut self.count) > 0
    }

    /// Notes an update in which `moved` of `awake` bodies moved, and that `kept` live pairs are kept of
    /// sleeping bodies. Returns whether it is time for bodies to fall asleep.
    pub fn note(&mut self, awake: usize, moved: usize, kept: usize) -> bool {
        self.moves = self.moves.saturating_add(moved);
        self.idle += usize::from(moved * 2 < awake);
        // Then sleeping bodies and their pairs are scanned too.
        let is_time = self.idle >= self.patience && self.idle * awake * 4 >= kept;
        if is_time {
            let saved = self.count * self.idle;
            let is_worth = self.woke * WAKE <= saved;
            let patience = if is_worth { self.patience / 2 } else { self.patience * 2 };
            self.patience = patience.clamp(PATIENCE[0], PATIENCE[1]);
            (self.woke, self.idle) = (0, 0);
        }
        is_time
    }

    /// Notes that bodies fell asleep. Returns whether to reorder storage, so that the awake ones, which
    /// have indices below `front` now, are together.
    pub fn scatters(&mut self, awake: usize, front: usize, all: usize) -> bool {
        let is_scattered = awake * 2 < front && self.moves >= all;
        if is_scattered {
            self.moves = 0;
        }
        is_scattered
    }
}
