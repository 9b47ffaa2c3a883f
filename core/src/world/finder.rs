//! Finds pairs of bodies with the pair finder.

use alloc::vec::Vec;

use super::bodies::{Bodies, When};
use super::policy::LOOK_UP;
use super::sets::Sets;
use crate::memory::{OutOfMemory, reserve_for};
use crate::pairs::PairFinder;
use crate::{Aabb, Error, Scalar};

/// A pair finder, and its buffers for the case that not all bodies take part.
#[derive(Debug, Default)]
pub struct Finder<const D: usize, T: Scalar> {
    finder: PairFinder<D, T>,
    threads: usize,
    /// The bodies that take part, and their boxes.
    sets: Sets,
    boxes: Vec<Aabb<D, T>>,
    pairs: Vec<[u32; 2]>,
    /// How many pairs the last search found, before filters.
    pub found: usize,
}

impl<const D: usize, T: Scalar> Finder<D, T> {
    pub fn with_threads(threads: usize) -> Self {
        let finder = PairFinder::new();
        #[cfg(feature = "parallel")]
        let finder = finder.threads(threads);
        Self { finder, threads, ..Self::default() }
    }

    /// How many pairs fit the memory that is kept for them, in the larger of two lists.
    pub fn capacity(&self) -> usize {
        self.finder.capacity().max(self.pairs.capacity())
    }

    /// Frees the memory of the pairs that were found.
    pub fn forget(&mut self) {
        self.finder.take_pairs();
        self.pairs = Vec::new();
    }

    /// The pairs of overlapping boxes of a table, as indices, of bodies that have one of the flags of
    /// `any` and none of `none`, that were allowed to pair at that moment. The boxes are valid. Within sets of bodies whose
    /// filters forbid all of them to pair nothing is searched. `None` if more than `most` are found, before filters. That is
    /// seen when a buffer is full, so there may be more than `most`, by one buffer.
    ///
    /// # Errors
    /// [`OutOfMemory`].
    #[inline(never)]
    pub fn find(
        &mut self,
        table: &[Aabb<D, T>],
        bodies: &Bodies<D, T>,
        [any, none]: [u16; 2],
        when: When,
        most: usize,
    ) -> Result<Option<&[[u32; 2]]>, OutOfMemory> {
        let flags = &bodies.slots.flags;
        let takes_part = |flags: u16| (flags & any != 0) & (flags & none == 0);
        if bodies.rules.are_alike(when) && flags.iter().all(|&flags| takes_part(flags)) {
            let pairs = found(self.finder.search(table).pairs_up_to(most))?;
            self.found = pairs.as_ref().map_or(0, |pairs| pairs.len());
            return Ok(pairs.map(|pairs| &*pairs));
        }
        let all = (0..flags.len() as u32).filter(|&index| takes_part(flags[index as usize]));
        self.sets.all.clear();
        self.sets.all.extend(all);
        self.find_in_sets(table, bodies, when, most)
    }

    /// The same of some bodies that are there.
    ///
    /// # Errors
    /// [`OutOfMemory`].
    pub fn find_some(
        &mut self,
        some: &[u32],
        bodies: &Bodies<D, T>,
        most: usize,
    ) -> Result<Option<&[[u32; 2]]>, OutOfMemory> {
        self.sets.all.clear();
        self.sets.all.extend_from_slice(some);
        self.find_in_sets(bodies.boxes.now(), bodies, When::Now, most)
    }

    #[inline(never)]
    fn find_in_sets(
        &mut self,
        table: &[Aabb<D, T>],
        bodies: &Bodies<D, T>,
        when: When,
        most: usize,
    ) -> Result<Option<&[[u32; 2]]>, OutOfMemory> {
        let Self { finder, sets, boxes, pairs, .. } = self;
        boxes.clear();
        if bodies.rules.are_alike(when) {
            boxes.extend(sets.all.iter().map(|&index| table[index as usize]));
            let all = found(finder.search(boxes).pairs_up_to(most))?;
            self.found = all.as_ref().map_or(0, |pairs| pairs.len());
            return Ok(all.map(|pairs| sets.name(pairs)));
        }
        sets.divide(&bodies.slots, &bodies.rules, when);
        boxes.extend(sets.bodies.iter().map(|&index| table[index as usize]));
        pairs.clear();
        self.found = 0;
        for ([a, b], are_all) in sets.meetings() {
            let mut search = finder.search(&boxes[a.clone()]);
            if a != b {
                search = search.against(&boxes[b.clone()]);
            }
            let most = most.saturating_sub(self.found);
            let Some(all) = found(search.pairs_up_to(most))? else { return Ok(None) };
            self.found += all.len();
            let lists = [&sets.bodies[a], &sets.bodies[b]];
            bodies.rules.append_allowed(&bodies.slots, when, lists, all, are_all, pairs)?;
        }
        Ok(Some(pairs))
    }

    /// Lists for each box of `queries` which boxes of a table overlap it, of bodies that `takes_part` names, as pairs of
    /// its position and a body: what a tree lists, where there is none. `most` is how many may still be listed, about, and
    /// becomes less; returns false, with none listed, if that is not enough, or if memory is not.
    #[inline(never)]
    pub fn find_near(
        &mut self,
        queries: &[(u32, Aabb<D, T>)],
        table: &[Aabb<D, T>],
        takes_part: &dyn Fn(u32) -> bool,
        near: &mut Vec<[u32; 2]>,
        most: &mut usize,
    ) -> bool {
        let Self { finder, boxes, .. } = self;
        near.clear();
        boxes.clear();
        // Spare capacity, so that steady motion does not allocate.
        boxes.reserve(table.len() / LOOK_UP + 1);
        boxes.extend(queries.iter().map(|(_, aabb)| *aabb));
        let pairs = finder.search(boxes).against(table).pairs_up_to(*most);
        let Ok(Some(pairs)) = pairs else { return false };
        *most = most.saturating_sub(pairs.len());
        if reserve_for(near, pairs.len()).is_err() {
            return false;
        }
        near.extend(pairs.iter().filter(|[_, body]| takes_part(*body)));
        true
    }

    /// Adds the pairs among the queries of the last [`find_near`](Self::find_near), each once: the position of the body
    /// with the smaller index, and the other body. Returns false if there are more than `most`, or than fit into memory.
    #[inline(never)]
    pub fn find_among(
        &mut self,
        queries: &[(u32, Aabb<D, T>)],
        near: &mut Vec<[u32; 2]>,
        most: &mut usize,
    ) -> bool {
        let Self { finder, boxes, .. } = self;
        let Ok(Some(pairs)) = finder.search(boxes).pairs_up_to(*most) else { return false };
        *most = most.saturating_sub(pairs.len());
        if reserve_for(near, near.len() + pairs.len()).is_err() {
            return false;
        }
        near.extend(pairs.iter().map(|&[a, b]| {
            let [first, second] = [a, b].map(|at| queries[at as usize].0);
            if first < second { [a, second] } else { [b, first] }
        }));
        true
    }
}

impl<const D: usize, T: Scalar> Clone for Finder<D, T> {
    /// A finder with as many threads and empty buffers.
    fn clone(&self) -> Self {
        Self::with_threads(self.threads)
    }

    /// As many threads, and its own buffers.
    fn clone_from(&mut self, source: &Self) {
        if self.threads != source.threads {
            *self = source.clone();
        }
        self.found = 0;
    }
}

/// What the finder found. Its boxes are valid, so it fails only if memory is exhausted.
fn found<P>(result: Result<P, Error>) -> Result<P, OutOfMemory> {
    result.map_err(|_| OutOfMemory)
}
