//! Bodies that have no candidate, by place. The order of the candidates says nothing of where to seat
//! them, and one in ten out of place is enough that in a large world memory is what is waited for: so
//! they get seats beside somebody who is near.

use alloc::vec::Vec;

/// No seat.
pub(super) const NONE: u32 = u32::MAX;

/// The centre of the body in a seat, on an axis.
pub(super) type Centre<'a> = &'a dyn Fn(u32, usize) -> f64;

/// Bodies, by the cell of a grid in which their centres lie.
#[derive(Debug, Default)]
pub(super) struct Loners {
    /// By axis: where the grid begins, and cells a unit of length.
    axes: Vec<[f64; 2]>,
    /// The binary logarithm of the cells on an axis.
    bits: u32,
    /// By cell, the seat of one who is there.
    first: Vec<u32>,
    /// By seat, another in the same cell.
    next: Vec<u32>,
}

impl Loners {
    /// Puts bodies into cells, of which there are at most half as many as all seats.
    pub fn gather(&mut self, loners: &[u32], seats: usize, dimensions: usize, centre: Centre) {
        self.bits = (seats / 2).max(1).ilog2() / dimensions as u32;
        self.axes.clear();
        for axis in 0..dimensions {
            let mut range = [f64::INFINITY, f64::NEG_INFINITY];
            for &seat in loners {
                let at = centre(seat, axis);
                range = [range[0].min(at), range[1].max(at)];
            }
            self.axes.push([range[0], f64::from(1 << self.bits) / (range[1] - range[0])]);
        }
        self.first.clear();
        self.first.resize(1 << (self.bits as usize * dimensions), NONE);
        self.next.clear();
        self.next.resize(seats, NONE);
        for &seat in loners {
            let cell = self.cell(seat, centre);
            self.next[seat as usize] = core::mem::replace(&mut self.first[cell], seat);
        }
    }

    /// Takes one after the other out of the cell in which somebody is.
    pub fn take_near(&mut self, seat: u32, centre: Centre) -> impl Iterator<Item = u32> {
        let cell = self.cell(seat, centre);
        let first = core::mem::replace(&mut self.first[cell], NONE);
        let is_there = |&seat: &u32| seat != NONE;
        let next = |seat: &u32| self.next[*seat as usize];
        core::iter::successors(Some(first).filter(is_there), move |seat| {
            Some(next(seat)).filter(is_there)
        })
    }

    /// The cell of somebody's centre, or the nearest one.
    fn cell(&self, seat: u32, centre: Centre) -> usize {
        let last = (1 << self.bits) - 1;
        self.axes.iter().enumerate().fold(0, |cell, (axis, [low, per_unit])| {
            // What is less than nothing, or not a number, becomes 0.
            let at = (centre(seat, axis) - low) * per_unit;
            cell << self.bits | (at as usize).min(last)
        })
    }
}
