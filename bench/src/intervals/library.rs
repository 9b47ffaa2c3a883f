//! What a library of intervals is to the harness.

use anyhow::Result;

use super::draw::Sets;
use crate::libraries::{LibraryInfo, Origin};

/// Finds or counts the pairs of intervals that overlap, touching ones too. An index that a library needs is built within
/// each call, from what `prepare` left.
pub trait Intervals {
    /// Takes over the intervals in the library's own form. Not timed.
    fn prepare(&mut self, sets: &Sets);

    /// The pairs of an index of the first set and one of the second, or of two indices of the only set, each once.
    fn pairs(&mut self) -> Result<&[[u32; 2]]>;

    /// How many pairs there are.
    fn count(&mut self) -> Result<u64>;
}

/// A library of intervals as the harness knows it.
pub struct IntervalLibrary {
    /// How tables and the command line call it.
    pub name: &'static str,
    /// Where it comes from, for the version.
    pub origin: Origin,
    /// In one line: which of its functions are called, and what was adapted.
    pub how: &'static str,
    /// Whether it is another library.
    pub alternative: bool,
    /// Makes it.
    pub make: fn() -> Box<dyn Intervals>,
}

impl IntervalLibrary {
    /// What is known of it without making it.
    pub fn info(&self) -> LibraryInfo {
        LibraryInfo {
            name: self.name,
            how: self.how,
            alternative: self.alternative,
            version: self.origin.version(),
            package: self.origin.package(),
            dimensions: vec![1],
        }
    }
}
