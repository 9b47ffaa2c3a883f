//! One number for the state of a world.

use super::BroadPhase;
use super::options::Report;
use super::proxy::flag;
use crate::{Aabb, Scalar};

/// Mixes words into one number: the multiply and rotate of the xxHash family.
#[derive(Clone, Copy)]
pub(super) struct Mixer(u64);

impl Mixer {
    pub const fn new() -> Self {
        Self(0x9e37_79b9_7f4a_7c15)
    }

    #[inline]
    pub fn add(&mut self, word: u64) {
        let mixed = word.wrapping_mul(0xc2b2_ae3d_27d4_eb4f).rotate_left(31);
        self.0 = (self.0 ^ mixed.wrapping_mul(0x9e37_79b1_85eb_ca87))
            .rotate_left(27)
            .wrapping_mul(0x9e37_79b1_85eb_ca87)
            .wrapping_add(0x85eb_ca77_c2b2_ae63);
    }

    /// The number: each bit depends on every word.
    pub const fn finish(self) -> u64 {
        let mut hash = self.0;
        hash = (hash ^ (hash >> 33)).wrapping_mul(0xff51_afd7_ed55_8ccd);
        hash = (hash ^ (hash >> 33)).wrapping_mul(0xc4ce_b9fe_1a85_ec53);
        hash ^ (hash >> 33)
    }

    fn add_box<const D: usize, T: Scalar>(&mut self, aabb: &Aabb<D, T>) {
        for at in aabb.min.iter().chain(&aabb.max) {
            // -0.0 equals 0.0: adding 0.0 makes one of the two.
            self.add((*at + T::default()).to_raw());
        }
    }
}

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// A hash of the whole state: boxes, filters, ids given out, pairs, and what the next update
    /// has to report. Equal for equal states on every platform; to notice when two machines that
    /// should run the same simulation do not. Not for defence against forgery.
    ///
    /// O(n + pairs) time, no memory.
    pub fn state_hash(&self) -> u64 {
        let mut mixer = Mixer::new();
        mixer.add((D * T::BYTES) as u64);
        mixer.add(self.options.margin.to_raw());
        mixer.add(self.options.prediction.to_raw());
        mixer.add(self.options.report as u64);
        for slot in 0..self.slots.len() {
            let flags = self.slots.flags[slot] & (flag::LIVE | flag::LEAVING | flag::SWEPT);
            mixer.add(u64::from(self.slots.generations[slot]) << 8 | u64::from(flags));
            if flags & flag::LIVE != 0 {
                mixer.add_box(&self.boxes[slot]);
                if self.options.report == Report::Fat {
                    mixer.add_box(&self.shapes[slot]);
                }
                if flags & flag::SWEPT != 0 {
                    mixer.add_box(&self.rests[slot]);
                }
                let filter = &self.filters[slot];
                mixer.add(u64::from(filter.category) << 32 | u64::from(filter.mask));
                mixer.add(u64::from(filter.group as u32) << 1 | u64::from(filter.is_static));
            }
        }
        // A sum does not depend on the order of the pairs.
        let mut sum = 0u64;
        for &[a, b] in self.updater.live() {
            let mut pair = Mixer::new();
            pair.add(u64::from(a) << 32 | u64::from(b));
            sum = sum.wrapping_add(pair.finish());
        }
        mixer.add(sum);
        mixer.finish()
    }
}
