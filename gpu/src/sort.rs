//! Prefix sums and a stable radix sort, as steps.

use crate::kernels::Kernel;
use crate::steps::{Bound, Steps, THREADS};

/// The numbers that a workgroup of `wgsl/scan.wgsl` sums.
const BLOCK: u64 = 16 * THREADS;

/// The keys of a workgroup of `wgsl/sort_count.wgsl` and `wgsl/sort_scatter.wgsl`.
const TILE: u64 = 16 * THREADS;

/// The values of a digit, and its bits.
const DIGITS: u64 = 16;
const DIGIT_BITS: u32 = 4;

/// How many numbers the table of a sort has.
pub fn table_len(keys: u64) -> u64 {
    DIGITS * keys.div_ceil(TILE)
}

/// How many numbers the sums of each level of a scan have.
pub fn scan_levels(count: u64) -> [u64; 4] {
    let mut len = count;
    core::array::from_fn(|_| {
        len = len.div_ceil(BLOCK).max(1);
        len
    })
}

/// Replaces each of `count` numbers by the sum of those before it. `sums` has [`scan_levels`] numbers.
pub fn scan(steps: &mut Steps, numbers: &Bound, count: u64, sums: &[Bound]) {
    let blocks = count.div_ceil(BLOCK);
    let (block_sums, above) = sums.split_first().expect("2^32 numbers have four levels of sums");
    steps.add(Kernel::Scan, &[count as u32, blocks as u32], &[numbers, block_sums], blocks);
    if blocks > 1 {
        scan(steps, block_sums, blocks, above);
        steps.for_each(Kernel::ScanAdd, count, &[count as u32], &[numbers, block_sums]);
    }
}

/// Two arrays that a pass of the sort reads and writes in turn.
#[derive(Clone, Debug)]
pub struct Swapped {
    pub now: Bound,
    pub other: Bound,
}

/// What a sort needs beside the keys.
#[derive(Clone, Debug)]
pub struct SortSpace {
    /// [`table_len`] numbers.
    pub table: Bound,
    /// The sums of a scan of that many numbers.
    pub sums: [Bound; 4],
}

/// Sorts `count` keys by their lowest `bits` bits, and the values beside them. Equal keys keep their order. Afterwards
/// `now` of both is the sorted array.
pub fn sort(
    steps: &mut Steps,
    space: &SortSpace,
    keys: &mut Swapped,
    mut values: Option<&mut Swapped>,
    count: u64,
    bits: u32,
) {
    let tiles = count.div_ceil(TILE);
    for shift in (0..bits).step_by(DIGIT_BITS as usize) {
        let params = [count as u32, tiles as u32, shift];
        steps.add(Kernel::CountDigits, &params, &[&keys.now, &space.table], tiles);
        scan(steps, &space.table, table_len(count), &space.sums);
        match &mut values {
            Some(values) => {
                let buffers = [&space.table, &keys.now, &keys.other, &values.now, &values.other];
                steps.add(Kernel::ScatterValues, &params, &buffers, tiles);
                core::mem::swap(&mut values.now, &mut values.other);
            }
            None => {
                let buffers = [&space.table, &keys.now, &keys.other];
                steps.add(Kernel::ScatterKeys, &params, &buffers, tiles);
            }
        }
        core::mem::swap(&mut keys.now, &mut keys.other);
    }
}
