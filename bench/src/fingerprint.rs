//! What two sets of pairs are compared by.

use std::ops::Add;

use serde::{Deserialize, Serialize};

/// The number of pairs and a hash of them. The hash depends on how often each pair is given, but not on the order of the
/// pairs, nor on which box of a pair comes first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fingerprint {
    /// How many pairs there are.
    pub pairs: u64,
    /// The sum of a hash of each.
    pub hash: u64,
}

impl Fingerprint {
    /// O(pairs) time.
    pub fn of(pairs: &[[u32; 2]]) -> Self {
        Self::with(pairs, |&[a, b]| [a.min(b), a.max(b)])
    }

    /// The fingerprint of pairs between two sets, which depends on the set of each index. O(pairs) time.
    pub fn between(pairs: &[[u32; 2]]) -> Self {
        Self::with(pairs, |&pair| pair)
    }

    fn with(pairs: &[[u32; 2]], order: impl Fn(&[u32; 2]) -> [u32; 2]) -> Self {
        let hash = |[a, b]: [u32; 2]| mix(u64::from(a) << 32 | u64::from(b));
        let sum = pairs.iter().map(order).map(hash).fold(0, u64::wrapping_add);
        Self { pairs: pairs.len() as u64, hash: sum }
    }
}

/// The fingerprint of the pairs of both together.
impl Add for Fingerprint {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { pairs: self.pairs + other.pairs, hash: self.hash.wrapping_add(other.hash) }
    }
}

/// The finalizer of SplitMix64 (Steele, Lea and Flood, 2014).
fn mix(mut x: u64) -> u64 {
    x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::Fingerprint;

    #[test]
    fn order_and_orientation_do_not_matter_and_everything_else_does() {
        let of = Fingerprint::of;
        let pairs = of(&[[1, 2], [3, 4]]);
        assert_eq!(pairs, of(&[[4, 3], [1, 2]]));
        assert_ne!(pairs, of(&[[1, 2]]));
        assert_ne!(pairs, of(&[[1, 3], [2, 4]]));
        assert_ne!(pairs, of(&[[1, 2], [1, 2]]));
        assert_ne!(of(&[[1, 2], [1, 2], [3, 4]]), of(&[[1, 2], [3, 4], [3, 4]]));
        let between = Fingerprint::between;
        assert_eq!(between(&[[1, 2], [4, 3]]), between(&[[4, 3], [1, 2]]));
        assert_ne!(between(&[[1, 2]]), between(&[[2, 1]]));
    }
}
