//! What this repository is about.

use anyhow::Result;
use sweep_and_prune::{Aabb, PairFinder};

use super::{Contender, OURS, OURS_ON_TWO, Origin, Peer};

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

struct Fresh(Vec<[u32; 2]>);

impl<const D: usize> Contender<D> for Fresh {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<&'a [[u32; 2]]> {
        self.0 = sweep_and_prune::find_pairs(boxes)?;
        Ok(&self.0)
    }
}
