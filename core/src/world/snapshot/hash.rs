//! One number for the state of a world.

/// A 64-bit hash of bytes, which mixes word by word as those of the xxHash family do. Each bit
/// depends on every byte and on their number.
pub fn hash(bytes: &[u8]) -> u64 {
    const FIRST: u64 = 0x9e37_79b1_85eb_ca87;
    const SECOND: u64 = 0xc2b2_ae3d_27d4_eb4f;
    let mut hash = FIRST ^ bytes.len() as u64;
    for chunk in bytes.chunks(8) {
        let mut word = [0; 8];
        word[..chunk.len()].copy_from_slice(chunk);
        let mixed = u64::from_le_bytes(word).wrapping_mul(SECOND).rotate_left(31);
        hash = (hash ^ mixed.wrapping_mul(FIRST)).rotate_left(27).wrapping_mul(FIRST);
        hash = hash.wrapping_add(0x85eb_ca77_c2b2_ae63);
    }
    hash = (hash ^ (hash >> 33)).wrapping_mul(SECOND);
    hash = (hash ^ (hash >> 29)).wrapping_mul(FIRST);
    hash ^ (hash >> 32)
}
