//! What this repository is about.

use anyhow::Result;
use sweep_and_prune::{Aabb, PairFinder};

use super::library::{Finder, Library, ON_TWO_THREADS, Origin, THIS_CRATE, TWO_AT_ONCE};

/// A finder that keeps its buffers.
pub const LIBRARY: Library = Library {
    name: THIS_CRATE,
    origin: Origin::Here,
    how: "`PairFinder::find`, one finder for all calls",
    alternative: false,
    two: Some(|| Box::new(Reused(PairFinder::<2>::new()))),
    three: Some(|| Box::new(Reused(PairFinder::<3>::new()))),
};

/// The same on two threads.
pub const TWO_THREADS: Library = Library {
    name: ON_TWO_THREADS,
    origin: Origin::Here,
    how: "`PairFinder::find` with `threads(2)`, one finder for all calls",
    alternative: false,
    two: Some(|| Box::new(Reused(PairFinder::<2>::new().threads(2)))),
    three: Some(|| Box::new(Reused(PairFinder::<3>::new().threads(2)))),
};

/// Two finders at the same time, each on one thread and all boxes: how the machine runs two threads that are
/// independent of each other.
pub const TWICE: Library = Library {
    name: TWO_AT_ONCE,
    origin: Origin::Here,
    how: "two finders on two threads, each `PairFinder::find` of all boxes",
    alternative: false,
    two: Some(|| Box::new(Twice([PairFinder::<2>::new(), PairFinder::new()]))),
    three: Some(|| Box::new(Twice([PairFinder::<3>::new(), PairFinder::new()]))),
};

/// A new finder for each call.
pub const FRESH: Library = Library {
    name: "sweep-and-prune, fresh",
    origin: Origin::Here,
    how: "`find_pairs`, which makes and drops a finder in each call",
    alternative: false,
    two: Some(|| Box::new(Fresh(Vec::new()))),
    three: Some(|| Box::new(Fresh(Vec::new()))),
};

struct Reused<const D: usize>(PairFinder<D>);

impl<const D: usize> Finder<D> for Reused<D> {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<&'a [[u32; 2]]> {
        Ok(self.0.find(boxes)?)
    }

    fn forget(&mut self, shuffled: &[Aabb<D>]) -> Result<()> {
        self.0.find(shuffled)?;
        Ok(())
    }
}

struct Twice<const D: usize>([PairFinder<D>; 2]);

impl<const D: usize> Finder<D> for Twice<D> {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<&'a [[u32; 2]]> {
        let [first, second] = &mut self.0;
        std::thread::scope(|scope| {
            scope.spawn(|| second.find(boxes).map(<[_]>::len));
            Ok(first.find(boxes)?)
        })
    }

    fn forget(&mut self, shuffled: &[Aabb<D>]) -> Result<()> {
        for finder in &mut self.0 {
            finder.find(shuffled)?;
        }
        Ok(())
    }
}

struct Fresh(Vec<[u32; 2]>);

impl<const D: usize> Finder<D> for Fresh {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<&'a [[u32; 2]]> {
        self.0 = sweep_and_prune::find_pairs(boxes)?;
        Ok(&self.0)
    }
}
