//! The pairs whose fat boxes overlap: those that may begin or end without anyone leaving his fat
//! box. Each knows whether it is live, that is whether the last update counted it as overlapping.
//!
//! They stand in one flat list, to be gone through in a row when most bodies move, and in a doubly
//! linked list a body, to be found one by one when few do. The links are made when first asked
//! for: a world in which everything moves never pays for them.

use alloc::vec::Vec;

const NONE: u32 = u32::MAX;

/// Where a pair stands in the lists of its two bodies.
#[derive(Clone, Copy, Debug)]
struct Links {
    next: [u32; 2],
    previous: [u32; 2],
}

#[derive(Clone, Debug, Default)]
pub(super) struct Candidates {
    /// Seats, smaller first. A place that is free holds twice the same, which as a pair would
    /// always be live.
    pub pairs: Vec<[u32; 2]>,
    pub live: Vec<bool>,
    links: Vec<Links>,
    /// By seat, the first of its pairs.
    heads: Vec<u32>,
    free: Vec<u32>,
    is_linked: bool,
}

/// Marks a free place.
const FREE: [u32; 2] = [0, 0];

impl Candidates {
    /// Forgets all pairs.
    pub fn clear(&mut self) {
        self.pairs.clear();
        self.live.clear();
        self.free.clear();
        self.is_linked = false;
    }

    /// The live pairs, in no particular order.
    pub fn live_pairs(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let live = self.pairs.iter().zip(&self.live);
        live.filter(|&(pair, &is_live)| is_live && pair[0] != pair[1]).map(|(&pair, _)| pair)
    }

    /// Gives the bodies other seats. There must be no free place.
    pub fn rename(&mut self, renamed: &[u32]) {
        self.is_linked = false;
        for pair in &mut self.pairs {
            let [a, b] = pair.map(|seat| renamed[seat as usize]);
            *pair = [a.min(b), a.max(b)];
        }
    }

    /// Whether the pairs are linked to their bodies.
    pub fn is_linked(&self) -> bool {
        self.is_linked
    }

    /// Links the pairs to their bodies, of which there are `seats`, if they are not yet.
    pub fn link(&mut self, seats: usize) {
        if self.is_linked {
            self.heads.resize(seats, NONE);
            return;
        }
        self.is_linked = true;
        let room = self.make_room();
        self.links.clear();
        self.links.reserve(room);
        self.free.reserve(room / 4);
        self.heads.clear();
        self.heads.resize(seats, NONE);
        for index in 0..self.pairs.len() as u32 {
            let links = Links { next: [NONE; 2], previous: [NONE; 2] };
            self.links.push(links);
            self.hang(index);
        }
    }

    /// Makes room for what moving bodies add, so that it need not be found later. Returns for how
    /// many pairs there is room.
    pub fn make_room(&mut self) -> usize {
        let count = self.pairs.len();
        if self.pairs.capacity() - count < count / 4 {
            self.pairs.reserve(count);
        }
        let room = self.pairs.capacity();
        self.live.reserve(room - self.live.len());
        room
    }

    /// Adds a pair of linked bodies.
    pub fn add(&mut self, a: u32, b: u32, is_live: bool) {
        let pair = [a.min(b), a.max(b)];
        let index = if let Some(index) = self.free.pop() {
            self.pairs[index as usize] = pair;
            self.live[index as usize] = is_live;
            index
        } else {
            self.pairs.push(pair);
            self.live.push(is_live);
            self.links.push(Links { next: [NONE; 2], previous: [NONE; 2] });
            (self.pairs.len() - 1) as u32
        };
        self.hang(index);
    }

    /// Removes a linked pair.
    pub fn remove(&mut self, index: u32) {
        let pair = self.pairs[index as usize];
        let links = self.links[index as usize];
        for (side, &seat) in pair.iter().enumerate() {
            let (next, previous) = (links.next[side], links.previous[side]);
            if previous == NONE {
                self.heads[seat as usize] = next;
            } else {
                let side = self.side(previous, seat);
                self.links[previous as usize].next[side] = next;
            }
            if next != NONE {
                let side = self.side(next, seat);
                self.links[next as usize].previous[side] = previous;
            }
        }
        self.pairs[index as usize] = FREE;
        self.live[index as usize] = true;
        self.free.push(index);
    }

    /// The first pair of a linked body.
    #[inline]
    pub fn first(&self, seat: u32) -> Option<u32> {
        Some(self.heads[seat as usize]).filter(|&index| index != NONE)
    }

    /// The other body of a pair of this one, and the next pair of this one.
    #[inline]
    pub fn step(&self, index: u32, seat: u32) -> (u32, Option<u32>) {
        let side = self.side(index, seat);
        let next = self.links[index as usize].next[side];
        (self.pairs[index as usize][1 - side], Some(next).filter(|&next| next != NONE))
    }

    #[inline]
    fn side(&self, index: u32, seat: u32) -> usize {
        usize::from(self.pairs[index as usize][0] != seat)
    }

    /// Puts a pair first in the lists of its bodies.
    #[inline]
    fn hang(&mut self, index: u32) {
        let pair = self.pairs[index as usize];
        for (side, &seat) in pair.iter().enumerate() {
            let head = core::mem::replace(&mut self.heads[seat as usize], index);
            self.links[index as usize].next[side] = head;
            self.links[index as usize].previous[side] = NONE;
            if head != NONE {
                let side = self.side(head, seat);
                self.links[head as usize].previous[side] = index;
            }
        }
    }
}
