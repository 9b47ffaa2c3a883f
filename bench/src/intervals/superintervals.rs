//! superintervals: sorted intervals, each with a reference to one that encloses it, by Kez Cleal.

use anyhow::Result;
use superintervals::IntervalMap;

use super::draw::{Set, Sets};
use super::library::{IntervalLibrary, Intervals};
use crate::libraries::Origin;

/// A map of the smaller set, asked once for each interval of the larger.
pub const LIBRARY: IntervalLibrary = IntervalLibrary {
    name: "superintervals",
    origin: Origin::Crate("superintervals"),
    how: "`IntervalMap::add` of the smaller set, `build`, `search_values` or `count` for each interval of the larger one; \
          compiled for the processor, as its README does",
    alternative: true,
    make: || Box::new(Map::default()),
};

struct Map {
    map: IntervalMap<u32>,
    indexed: Set,
    /// `None` if pairs within the only set are wanted.
    asked: Option<Set>,
    found: Vec<u32>,
    pairs: Vec<[u32; 2]>,
}

impl Default for Map {
    fn default() -> Self {
        Self {
            map: IntervalMap::new(),
            indexed: Vec::new(),
            asked: None,
            found: Vec::new(),
            pairs: Vec::new(),
        }
    }
}

impl Map {
    fn build(&mut self) {
        self.map.clear();
        self.map.reserve(self.indexed.len());
        for (&[from, to], index) in self.indexed.iter().zip(0..) {
            self.map.add(from, to, index);
        }
        self.map.build();
    }
}

impl Intervals for Map {
    fn prepare(&mut self, sets: &Sets) {
        self.indexed.clone_from(sets.second.as_ref().unwrap_or(&sets.first));
        self.asked = sets.second.is_some().then(|| sets.first.clone());
    }

    fn pairs(&mut self) -> Result<&[[u32; 2]]> {
        self.build();
        let Self { map, indexed, asked, found, pairs } = self;
        pairs.clear();
        let within = asked.is_none();
        for (&[from, to], a) in asked.as_ref().unwrap_or(indexed).iter().zip(0..) {
            found.clear();
            map.search_values(from, to, found);
            let wanted = found.iter().filter(|&&b| !within || a < b);
            pairs.extend(wanted.map(|&b| [a, b]));
        }
        Ok(pairs)
    }

    fn count(&mut self) -> Result<u64> {
        self.build();
        let all = self.asked.as_ref().unwrap_or(&self.indexed).iter();
        let found = all.map(|&[from, to]| self.map.count(from, to) as u64).sum();
        // Within a set, each interval finds itself, and each pair is found twice.
        let own = self.indexed.len() as u64;
        Ok(if self.asked.is_none() { (found - own) / 2 } else { found })
    }
}
