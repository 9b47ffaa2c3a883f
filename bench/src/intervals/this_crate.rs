//! What this repository is about, in one dimension.

use anyhow::Result;
use sweep_and_prune::{Aabb, PairFinder};

use super::draw::{Set, Sets};
use super::library::{IntervalLibrary, Intervals};
use crate::libraries::{Origin, THIS_CRATE};

/// A finder that keeps its buffers.
pub const LIBRARY: IntervalLibrary = IntervalLibrary {
    name: THIS_CRATE,
    origin: Origin::Here,
    how: "`PairFinder::<1, f64>`, one finder for all calls: `find`, `find_between` or `search(..).count()`",
    alternative: false,
    make: || Box::new(Finder::default()),
};

#[derive(Default)]
struct Finder {
    finder: PairFinder<1, f64>,
    first: Vec<Aabb<1, f64>>,
    second: Option<Vec<Aabb<1, f64>>>,
}

fn boxes(set: &Set) -> Vec<Aabb<1, f64>> {
    set.iter().map(|&[from, to]| Aabb::new([from.into()], [to.into()])).collect()
}

impl Intervals for Finder {
    fn prepare(&mut self, sets: &Sets) {
        self.first = boxes(&sets.first);
        self.second = sets.second.as_ref().map(boxes);
    }

    fn pairs(&mut self) -> Result<&[[u32; 2]]> {
        Ok(match &self.second {
            Some(second) => self.finder.find_between(&self.first, second)?,
            None => self.finder.find(&self.first)?,
        })
    }

    fn count(&mut self) -> Result<u64> {
        let search = self.finder.search(&self.first);
        Ok(match &self.second {
            Some(second) => search.against(second).count()?,
            None => search.count()?,
        })
    }
}
