//! What this repository is about.

use anyhow::Result;
use sweep_and_prune::{Aabb, PairFinder};

use super::{Contender, OURS, OURS_AGAIN, OURS_ON_TWO, OURS_TWICE, Origin, Peer};

/// A finder that keeps its buffers.
pub const PEER: Peer = Peer {
    name: OURS,
    origin: Origin::Here,
    how: "`PairFinder::find`, one finder for all calls",
    rival: false,
    two: Some(|| Box::new(Warm(PairFinder::<2>::new()))),
    three: Some(|| Box::new(Warm(PairFinder::<3>::new()))),
};

/// The same on two threads.
pub const TWO_THREADS: Peer = Peer {
    name: OURS_ON_TWO,
    origin: Origin::Here,
    how: "`PairFinder::find` with `threads(2)`, one finder for all calls",
    rival: false,
    two: Some(|| Box::new(Warm(PairFinder::<2>::new().threads(2)))),
    three: Some(|| Box::new(Warm(PairFinder::<3>::new().threads(2)))),
};

/// The same, called with the boxes of the last call once more.
pub const AGAIN: Peer = Peer {
    name: OURS_AGAIN,
    origin: Origin::Here,
    how: "`PairFinder::find` with the boxes of the last call, all at rest",
    rival: false,
    two: Some(|| Box::new(Again(PairFinder::<2>::new()))),
    three: Some(|| Box::new(Again(PairFinder::<3>::new()))),
};

/// Two finders of one thread each at work at once, each on all boxes: what the machine makes of
/// two threads that have nothing to do with each other.
pub const TWICE: Peer = Peer {
    name: OURS_TWICE,
    origin: Origin::Here,
    how: "two finders on two threads, each `PairFinder::find` of all boxes",
    rival: false,
    two: Some(|| Box::new(Twice([PairFinder::<2>::new(), PairFinder::new()]))),
    three: Some(|| Box::new(Twice([PairFinder::<3>::new(), PairFinder::new()]))),
};

/// A new finder for each call.
pub const FRESH: Peer = Peer {
    name: "ours, fresh",
    origin: Origin::Here,
    how: "`find_pairs`, which makes and drops a finder in each call",
    rival: false,
    two: Some(|| Box::new(Fresh(Vec::new()))),
    three: Some(|| Box::new(Fresh(Vec::new()))),
};

struct Warm<const D: usize>(PairFinder<D>);

impl<const D: usize> Contender<D> for Warm<D> {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<&'a [[u32; 2]]> {
        Ok(self.0.find(boxes)?)
    }

    fn forget(&mut self, shuffled: &[Aabb<D>]) -> Result<()> {
        self.0.find(shuffled)?;
        Ok(())
    }
}

struct Again<const D: usize>(PairFinder<D>);

impl<const D: usize> Contender<D> for Again<D> {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<&'a [[u32; 2]]> {
        Ok(self.0.find(boxes)?)
    }
}

struct Twice<const D: usize>([PairFinder<D>; 2]);

impl<const D: usize> Contender<D> for Twice<D> {
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

impl<const D: usize> Contender<D> for Fresh {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<&'a [[u32; 2]]> {
        self.0 = sweep_and_prune::find_pairs(boxes)?;
        Ok(&self.0)
    }
}
