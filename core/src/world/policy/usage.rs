//! How much memory for pairs is needed.

/// How many updates a list may have far too much memory, at least, and at most twice as many.
const UPDATES: usize = 64;
/// How many times as much memory as needed is too much. Growing lists have twice as much as they need.
const SPARE: usize = 4;
/// Capacity for this many pairs is never too much: some lists always reserve it.
const LEAST: usize = 1 << 14;

/// How many pairs there were lately.
#[derive(Clone, Debug, Default)]
pub struct Usage {
    most: usize,
    updates: usize,
}

impl Usage {
    /// Notes the numbers of bodies and of pairs of an update. Returns, once in [`UPDATES`], for how many pairs a list
    /// needs capacity at most, judged by what was noted since it last did.
    pub fn note(&mut self, bodies: usize, pairs: usize) -> Option<usize> {
        self.most = self.most.max(bodies.saturating_add(pairs));
        self.updates += 1;
        if self.updates < UPDATES {
            return None;
        }
        self.updates = 0;
        Some(core::mem::take(&mut self.most).saturating_mul(SPARE).max(LEAST))
    }
}
