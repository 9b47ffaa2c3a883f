//! What a search reports beside the pairs.

/// What a search wrote to the summary buffer: sixteen `u32`.
///
/// | numbers | what |
/// |---|---|
/// | 0 | pairs found; `u32::MAX` if there are that many or more |
/// | 1 | pairs written |
/// | 2, 3 | invalid boxes; the index of the first, where boxes of a second set count on from those of the first |
/// | 4 to 6 | arguments of an indirect dispatch with at least one thread for each pair written |
/// | 8 to 11 | arguments of an indirect draw with one instance for each pair written |
///
/// Numbers 7 and 12 to 15 are 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Summary {
    /// The exact number of pairs, also where not all of them were written; `u32::MAX` means that many or more.
    pub found: u32,
    /// The number of pairs that were written.
    pub written: u32,
    /// The number of invalid boxes: NaN, inverted, or in a world of 2^31 or more. They have no pairs.
    pub invalid: u32,
    /// The index of the first invalid box; boxes of a second set count on from those of the first. 0 if there is none.
    pub first_invalid: u32,
}

impl Summary {
    /// The bytes of a summary buffer.
    pub const BYTES: u64 = 64;

    /// Where the arguments of an indirect dispatch begin, in bytes.
    pub const DISPATCH: u64 = 16;

    /// Where the arguments of an indirect draw begin, in bytes.
    pub const DRAW: u64 = 32;

    pub(crate) fn from_numbers(numbers: &[u32]) -> Self {
        let at = |index: usize| numbers.get(index).copied().unwrap_or(0);
        Self { found: at(0), written: at(1), invalid: at(2), first_invalid: at(3) }
    }

    /// Whether all pairs were written.
    pub fn is_complete(&self) -> bool {
        self.found == self.written && self.found < u32::MAX
    }
}
