//! Where to look for a sample of many items.

/// The positions of up to `len` of `count` items: one at a random place of each of equal chunks, so that no pattern in
/// the order of the items hides from it. The randomness is the same in every run.
pub(crate) fn positions(count: usize, len: usize) -> impl ExactSizeIterator<Item = usize> {
    let len = len.min(count);
    // `usize` has 32 bits in WebAssembly.
    let (count, chunks) = (count as u64, len as u64);
    let mut random = 0x9E37_79B9_7F4A_7C15u64;
    (0..len).map(move |i| {
        random = random.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(1);
        let (from, to) = (i as u64 * count / chunks, (i as u64 + 1) * count / chunks);
        (from + (random >> 33) % (to - from)) as usize
    })
}
