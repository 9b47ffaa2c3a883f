//! The pairs of fat AABBs that overlap: only these can begin or end while no body leaves its fat AABB.
//! Each has a flag, whether it was live at the last update: whether the boxes themselves overlapped.
//!
//! Pairs with an awake body are in one flat list, which each update with motion scans. Of pairs of two
//! bodies asleep only the live ones are kept, to be listed to users: before such a pair begins or ends
//! one of the bodies wakes, and the tree finds its candidates.

use alloc::vec;
use alloc::vec::Vec;

use super::sort::PairSorter;
use crate::cloning::clone_fields;
use crate::memory::{OutOfMemory, reserve_for};
use crate::world::bodies::{ProxyId, Slots, flag};

#[derive(Debug, Default)]
pub struct Candidates {
    form: Form,
    /// As [`Form`] says, each once.
    pairs: Vec<[u32; 2]>,
    /// By listed pair, whether it was live at the last update. Sorted ones all are, and have no flags.
    live: Vec<bool>,
    /// The live pairs of bodies that are both asleep, and some of which one woke or was removed since.
    asleep: Vec<[u32; 2]>,
}

/// Which pairs there are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Form {
    /// Each candidate with an awake body, as indices, smaller first. Filters allow them.
    #[default]
    Listed,
    /// After an update from scratch: all live pairs, as slots, sorted. No body is asleep, and indices are slots.
    Sorted,
}

clone_fields! {
    [] Candidates {
        form, pairs, live, asleep,
    }
}

impl Candidates {
    /// How many pairs are kept.
    pub fn len(&self) -> usize {
        self.pairs.len() + self.asleep.len()
    }

    /// The candidates with an awake body. Only while none is [sorted](Self::sorted).
    #[inline]
    pub fn listed(&self) -> &[[u32; 2]] {
        debug_assert!(!self.is_sorted(), "what is sorted is not listed");
        &self.pairs
    }

    /// Whether each of the listed candidates was live at the last update.
    #[inline]
    pub fn live(&self) -> &[bool] {
        &self.live
    }

    /// The live pairs, if they are sorted; otherwise none.
    pub fn sorted(&self) -> &[[u32; 2]] {
        if self.is_sorted() { &self.pairs } else { &[] }
    }

    /// Whether all live pairs are [sorted](Self::sorted), and none is listed.
    pub fn is_sorted(&self) -> bool {
        self.form == Form::Sorted
    }

    /// For how many pairs there is capacity.
    pub fn capacity(&self) -> usize {
        self.pairs.capacity()
    }

    /// Sorts the live pairs, as slots, and drops all other candidates. `spare` is a buffer.
    ///
    /// # Errors
    /// [`OutOfMemory`]: then they are as before.
    pub fn sort(
        &mut self,
        slots: &Slots,
        sorter: &mut PairSorter,
        spare: &mut Vec<[u32; 2]>,
    ) -> Result<(), OutOfMemory> {
        if !self.is_sorted() {
            let live = self.live.iter().filter(|is_live| **is_live).count();
            sorter.reserve(spare, live + self.asleep.len())?;
            spare.clear();
            self.for_each_live(slots, &mut |pair| spare.push(pair));
            slots.to_slots(spare);
            sorter.sort(spare, slots.len());
            self.clear();
            core::mem::swap(&mut self.pairs, spare);
            self.form = Form::Sorted;
        }
        Ok(())
    }

    /// Makes these the sorted pairs, and leaves the ones before in their place. Only after [`sort`](Self::sort).
    pub fn swap_sorted(&mut self, pairs: &mut Vec<[u32; 2]>) {
        debug_assert!(self.is_sorted(), "pairs are swapped that are not sorted");
        core::mem::swap(&mut self.pairs, pairs);
    }

    /// Lists the sorted pairs.
    ///
    /// # Errors
    /// [`OutOfMemory`]: then they are as before.
    pub fn list(&mut self) -> Result<(), OutOfMemory> {
        if self.is_sorted() {
            reserve_for(&mut self.live, self.pairs.len())?;
            self.flag_all_live();
            self.form = Form::Listed;
        }
        Ok(())
    }

    /// Shrinks each list that has capacity for more than this many pairs.
    pub fn shrink(&mut self, enough: usize) {
        for list in [&mut self.pairs, &mut self.asleep] {
            if list.capacity() > enough {
                list.shrink_to_fit();
            }
        }
        if self.live.capacity() > enough {
            self.live.shrink_to_fit();
        }
    }

    /// Drops the candidates that are not live. Does not allocate.
    #[inline(never)]
    pub fn keep_live(&mut self) {
        if self.is_sorted() {
            return;
        }
        let mut kept = 0;
        for at in 0..self.pairs.len() {
            self.pairs[kept] = self.pairs[at];
            kept += usize::from(self.live[at]);
        }
        self.pairs.truncate(kept);
        self.live.truncate(kept);
        self.live.fill(true);
    }

    /// Makes these pairs the candidates, which are to be flagged.
    ///
    /// # Errors
    /// [`OutOfMemory`]: then they are as before.
    #[inline(never)]
    pub fn replace(&mut self, pairs: &[[u32; 2]]) -> Result<(), OutOfMemory> {
        reserve_for(&mut self.pairs, pairs.len())?;
        reserve_for(&mut self.live, pairs.len())?;
        self.clear();
        self.pairs.extend_from_slice(pairs);
        Ok(())
    }

    /// Flags the candidates. `test` says of each whether it is live, and whether it is to be listed.
    pub fn flag_all(
        &mut self,
        listed: &mut Vec<[u32; 2]>,
        mut test: impl FnMut([u32; 2]) -> [bool; 2],
    ) {
        let Self { pairs, live, .. } = self;
        live.resize(pairs.len(), false);
        push_wanted(listed, pairs, |at, pair| {
            let [is_live, is_wanted] = test(pair);
            live[at] = is_live;
            (pair, is_wanted)
        });
    }

    /// Flags all candidates as live.
    pub fn flag_all_live(&mut self) {
        self.live.resize(self.pairs.len(), true);
    }

    /// Flags the candidate at this position.
    #[inline]
    pub fn set_live(&mut self, position: usize, is_live: bool) {
        self.live[position] = is_live;
    }

    /// Drops all.
    fn clear(&mut self) {
        self.form = Form::Listed;
        self.pairs.clear();
        self.live.clear();
        self.asleep.clear();
    }

    /// The live pairs, in no particular order.
    fn live_pairs<'a>(&'a self, slots: &'a Slots) -> impl Iterator<Item = [u32; 2]> + 'a {
        let awake = self.pairs.iter().zip(&self.live).filter(|(_, is_live)| **is_live);
        let awake = awake.map(|(&pair, _)| pair).chain(self.asleep_pairs(slots));
        // What is sorted has no flags.
        awake.chain(self.sorted().iter().copied())
    }

    /// Calls `each` with the live pairs, in no particular order. Compiled once: a loop over the iterator takes half a kilobyte of
    /// a WebAssembly file.
    #[inline(never)]
    pub fn for_each_live(&self, slots: &Slots, each: &mut dyn FnMut([u32; 2])) {
        self.live_pairs(slots).for_each(each);
    }

    /// The ids of the live pairs, smaller first, in no particular order.
    pub fn ids<'a>(&'a self, slots: &'a Slots) -> impl Iterator<Item = [ProxyId; 2]> + 'a {
        self.live_pairs(slots).map(|pair| {
            let [a, b] = pair.map(|index| slots.id(index));
            if a < b { [a, b] } else { [b, a] }
        })
    }

    /// The live pairs as slots, smaller first, sorted.
    fn sorted_slots(&self, slots: &Slots) -> Vec<[u32; 2]> {
        let mut pairs = Vec::new();
        self.for_each_live(slots, &mut |pair| pairs.push(pair));
        slots.to_slots(&mut pairs);
        PairSorter::default().sort(&mut pairs, slots.len());
        pairs
    }

    /// The ids of the live pairs, smaller first, sorted.
    #[inline(never)]
    pub fn sorted_ids<'a>(
        &self,
        slots: &'a Slots,
    ) -> impl ExactSizeIterator<Item = [ProxyId; 2]> + use<'a> {
        self.sorted_slots(slots).into_iter().map(|pair| pair.map(|slot| slots.id_of_slot(slot)))
    }

    /// By slot, the ids of the other bodies of its live pairs, sorted; and where those of each slot end.
    pub fn by_slot(&self, slots: &Slots) -> (Vec<usize>, Vec<ProxyId>) {
        let pairs = self.sorted_slots(slots);
        let mut ends = vec![0; slots.len()];
        pairs.as_flattened().iter().for_each(|&slot| ends[slot as usize] += 1);
        let mut end = 0;
        for count in &mut ends {
            end += *count;
            *count = end;
        }
        // Written from the end, so that what is left of each end is where the list starts.
        let (mut starts, mut others) = (ends.clone(), vec![0; end]);
        for &[a, b] in pairs.iter().rev() {
            for (slot, other) in [(b, a), (a, b)] {
                starts[slot as usize] -= 1;
                others[starts[slot as usize]] = other;
            }
        }
        (ends, others.into_iter().map(|slot| slots.id_of_slot(slot)).collect())
    }

    /// Lists the other bodies of the live pairs of one.
    #[inline(never)]
    pub fn list_others(&self, slots: &Slots, index: u32, others: &mut Vec<u32>) {
        self.for_each_live(slots, &mut |[a, b]| match index {
            _ if a == index => others.push(b),
            _ if b == index => others.push(a),
            _ => {}
        });
    }

    /// The live pairs of bodies that are both asleep.
    pub fn asleep_pairs<'a>(&'a self, slots: &'a Slots) -> impl Iterator<Item = [u32; 2]> + 'a {
        self.asleep.iter().copied().filter(|pair| are_asleep(slots, pair))
    }

    /// How many pairs there are of bodies that are both asleep, and were since one of them woke.
    pub fn asleep(&self) -> usize {
        self.asleep.len()
    }

    /// Drops the pairs of which a body woke or was removed.
    pub fn forget_awake(&mut self, slots: &Slots) {
        self.asleep.retain(|pair| are_asleep(slots, pair));
    }

    /// Follows a new storage order. Sorted pairs are slots, which stay.
    pub fn rename(&mut self, renamed: &[u32]) {
        if self.is_sorted() {
            return;
        }
        for pair in self.pairs.iter_mut().chain(&mut self.asleep) {
            let [a, b] = pair.map(|index| renamed[index as usize]);
            *pair = [a.min(b), a.max(b)];
        }
    }

    /// Reserves capacity for pairs that are added and for a list of those that are dropped, and spare capacity, so that steady
    /// motion does not allocate.
    ///
    /// # Errors
    /// [`OutOfMemory`].
    pub fn reserve(&mut self, added: usize, dropped: &mut Vec<usize>) -> Result<(), OutOfMemory> {
        let count = self.pairs.len();
        if self.pairs.capacity() - count < added.max(count / 4) {
            reserve_for(&mut self.pairs, count + added.max(count))?;
        }
        reserve_for(&mut self.live, self.pairs.capacity())?;
        reserve_for(dropped, self.pairs.capacity() / 4)
    }

    /// Writes a pair to a position that is free, or else to the end.
    #[inline]
    pub fn put(&mut self, position: Option<&usize>, pair: [u32; 2], is_live: bool) {
        if let Some(&at) = position {
            self.pairs[at] = pair;
            self.live[at] = is_live;
        } else {
            self.pairs.push(pair);
            self.live.push(is_live);
        }
    }

    /// Removes the pairs at these positions, which ascend. The others keep their order, which is roughly
    /// that of their boxes in memory.
    pub fn remove(&mut self, positions: &[usize]) {
        let Some(&first) = positions.first() else { return };
        let mut kept = first;
        for (index, &position) in positions.iter().enumerate() {
            let end = positions.get(index + 1).map_or(self.pairs.len(), |&next| next);
            self.pairs.copy_within(position + 1..end, kept);
            self.live.copy_within(position + 1..end, kept);
            kept += end - position - 1;
        }
        self.pairs.truncate(kept);
        self.live.truncate(kept);
    }

    /// Reserves memory for what [`put_to_sleep`](Self::put_to_sleep) will keep, if bodies without the flags `awake` fall asleep.
    ///
    /// # Errors
    /// [`OutOfMemory`].
    #[inline(never)]
    pub fn reserve_asleep(&mut self, slots: &Slots, awake: u16) -> Result<(), OutOfMemory> {
        let sleeps = |index: u32| slots.flags[index as usize] & awake & !flag::ASLEEP == 0;
        let mut count = self.asleep.len();
        for (&[a, b], &is_live) in self.pairs.iter().zip(&self.live) {
            count += usize::from(is_live & sleeps(a) & sleeps(b));
        }
        reserve_for(&mut self.asleep, count)
    }

    /// Takes the pairs of bodies that are both asleep out of the list, and those that are no longer
    /// `is_near`.
    pub fn put_to_sleep(&mut self, slots: &Slots, is_near: impl Fn([u32; 2]) -> bool) {
        let mut kept = 0;
        for at in 0..self.pairs.len() {
            let (pair, is_live) = (self.pairs[at], self.live[at]);
            let sleeps = are_asleep(slots, &pair);
            if sleeps && is_live {
                self.asleep.push(pair);
            }
            self.pairs[kept] = pair;
            self.live[kept] = is_live;
            kept += usize::from(!sleeps && is_near(pair));
        }
        self.pairs.truncate(kept);
        self.live.truncate(kept);
    }
}

/// Whether both bodies are asleep.
pub fn are_asleep(slots: &Slots, pair: &[u32; 2]) -> bool {
    pair.iter().all(|&index| slots.has(index, flag::ASLEEP))
}

/// How many items are chosen from at a time.
pub const CHUNK: usize = 256;

/// Appends what `choose` makes of each item and its position, if it says so, without a branch: it is
/// unpredictable which candidates begin or end.
#[inline]
pub fn push_wanted<I: Copy, O: Copy + Default>(
    out: &mut Vec<O>,
    items: &[I],
    mut choose: impl FnMut(usize, I) -> (O, bool),
) {
    let mut wanted = [O::default(); CHUNK];
    for (chunk, items) in items.chunks(CHUNK).enumerate() {
        let choose = |position, item| choose(chunk * CHUNK + position, item);
        let count = write_wanted(&mut wanted, items, choose);
        out.extend_from_slice(&wanted[..count]);
    }
}

/// Writes what [`push_wanted`] would append, of a chunk at most. Returns how many.
#[inline]
pub fn write_wanted<I: Copy, O>(
    out: &mut [O; CHUNK],
    items: &[I],
    mut choose: impl FnMut(usize, I) -> (O, bool),
) -> usize {
    let mut count = 0;
    for (position, &item) in items.iter().enumerate() {
        let (made, is_wanted) = choose(position, item);
        out[count % CHUNK] = made;
        count += usize::from(is_wanted);
    }
    count
}
