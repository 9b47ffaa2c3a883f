//! Software vectors of any number of lanes: they run the loop as NEON, AVX-512 and the others do, on
//! any machine.

use super::vector::{Packs, Reporter, Vector};

/// `N` lanes. `PACKS` is a [`Packs`] as a number, since a parameter of a type cannot be one: `Dense` is as in WebAssembly, `Always`
/// as on AVX2 and AVX-512.
#[derive(Clone, Copy)]
pub struct Lanes<T, const N: usize, const PACKS: usize>([T; N]);

// SAFETY: reads N coordinates, ids and bitmaps, writes at most N pairs; needs no instructions.
unsafe impl<T: Copy + PartialOrd, const N: usize, const PACKS: usize> Vector<T>
    for Lanes<T, N, PACKS>
{
    const LANES: usize = N;
    type Mask = u32;

    unsafe fn splat(value: T) -> Self {
        Lanes([value; N])
    }

    unsafe fn load(from: *const T) -> Self {
        // SAFETY: the caller has N coordinates at `from`.
        Lanes(unsafe { *from.cast() })
    }

    unsafe fn le(a: Self, b: Self) -> u32 {
        (0..N).fold(0, |mask, lane| mask | u32::from(a.0[lane] <= b.0[lane]) << lane)
    }

    unsafe fn and_le(mask: u32, a: Self, b: Self) -> u32 {
        // SAFETY: it needs no instructions.
        mask & unsafe { Self::le(a, b) }
    }

    unsafe fn bits(mask: u32) -> u32 {
        mask
    }

    const PACKS: Packs = [Packs::Never, Packs::Dense, Packs::Always][PACKS];

    unsafe fn pack(
        hits: u32,
        probe: &Reporter,
        ids: *const u32,
        dedup: *const u32,
        out: *mut [u32; 2],
    ) -> usize {
        let mut count = 0;
        for lane in (0..N).filter(|lane| hits >> lane & 1 == 1) {
            // SAFETY: the caller has N ids and bitmaps, and space for N pairs.
            unsafe {
                if *dedup.add(lane) & probe.dedup == 0 {
                    *out.add(count) = probe.pair(*ids.add(lane));
                    count += 1;
                }
            }
        }
        count
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;
    use alloc::vec::Vec;

    use super::super::Kernel;
    use super::super::scalar::One;
    use super::super::scan::{self, Cursor};
    use super::super::sorted_boxes::{PAD, SortedBoxes};
    use super::super::vector::PairOrder;
    use super::*;

    /// Boxes on few coordinates, so that many touch and begin together, with random ids and bitmaps.
    fn sorted_boxes(len: usize, seed: u32) -> SortedBoxes<f32> {
        let mut state = seed;
        let mut random = |below: u32| {
            state = state.wrapping_mul(0x9E37_79B1).wrapping_add(0x85EB_CA6B);
            (state >> 16) % below
        };
        let mut lefts: Vec<f32> = (0..len).map(|_| random(1 + len as u32 / 3) as f32).collect();
        lefts.sort_by(f32::total_cmp);
        let mut boxes = SortedBoxes::default();
        boxes.reset(len, 2).unwrap();
        for (at, left) in lefts.into_iter().enumerate() {
            boxes.left[at] = left;
            boxes.right[at] = if random(20) == 0 { f32::INFINITY } else { left + random(5) as f32 };
            for axis in 0..2 {
                boxes.min[axis][at] = random(6) as f32;
                boxes.max[axis][at] = boxes.min[axis][at] + random(4) as f32;
            }
            (boxes.id[at], boxes.dedup[at]) = (random(1 << 16), random(8) & random(8));
        }
        boxes
    }

    /// All pairs, taken from an output of a given size.
    fn swept<V: Vector<f32>>(
        sets: &[SortedBoxes<f32>],
        order: PairOrder,
        size: usize,
    ) -> Vec<[u32; 2]> {
        let (mut all, mut out, mut cursor) = (Vec::new(), vec![[0; 2]; size], Cursor::default());
        while !cursor.is_done() {
            // SAFETY: the vectors need no instructions, the boxes are ready for two axes, the cursor
            // is from this sweep, and the output is long enough.
            let count = unsafe {
                match sets {
                    [a, b] => scan::sweep::<_, V, true, 2>(a, b, order, &mut cursor, &mut out),
                    _ => scan::sweep::<_, V, false, 2>(
                        &sets[0],
                        &sets[0],
                        order,
                        &mut cursor,
                        &mut out,
                    ),
                }
            };
            all.extend_from_slice(&out[..count]);
        }
        all
    }

    fn lanes_agree<V: Vector<f32>>(name: &str) {
        for (len, seed) in [(0, 1), (1, 2), (2, 3), (15, 4), (16, 5), (17, 6), (100, 7), (600, 8)] {
            let two = [sorted_boxes(len, seed), sorted_boxes(len / 2 + 3, seed + 100)];
            for size in [PAD, PAD + 5, 5000] {
                for order in [PairOrder::Ascending, PairOrder::BySet] {
                    let pairs = swept::<One<f32>>(&two, order, 5000);
                    assert!(swept::<V>(&two, order, size) == pairs, "{name} {len} {size} between");
                }
                let pairs = swept::<One<f32>>(&two[..1], PairOrder::Ascending, 5000);
                let found = swept::<V>(&two[..1], PairOrder::Ascending, size);
                assert!(found == pairs && (len < 100 || !pairs.is_empty()), "{name} {len} {size}");
            }
        }
    }

    #[test]
    fn all_numbers_of_lanes_give_the_pairs_of_scalar_code_in_its_order() {
        lanes_agree::<Lanes<f32, 2, { Packs::Never as usize }>>("2 lanes, noted");
        lanes_agree::<Lanes<f32, 4, { Packs::Never as usize }>>("4 lanes, noted");
        lanes_agree::<Lanes<f32, 8, { Packs::Never as usize }>>("8 lanes, noted");
        lanes_agree::<Lanes<f32, 16, { Packs::Never as usize }>>("16 lanes, noted");
        lanes_agree::<Lanes<f32, 2, { Packs::Dense as usize }>>("2 lanes, packed where dense");
        lanes_agree::<Lanes<f32, 2, { Packs::Always as usize }>>("2 lanes, packed");
        lanes_agree::<Lanes<f32, 4, { Packs::Dense as usize }>>("4 lanes, packed where dense");
        lanes_agree::<Lanes<f32, 4, { Packs::Always as usize }>>("4 lanes, packed");
        lanes_agree::<Lanes<f32, 8, { Packs::Dense as usize }>>("8 lanes, packed where dense");
        lanes_agree::<Lanes<f32, 8, { Packs::Always as usize }>>("8 lanes, packed");
        lanes_agree::<Lanes<f32, 16, { Packs::Dense as usize }>>("16 lanes, packed where dense");
        lanes_agree::<Lanes<f32, 16, { Packs::Always as usize }>>("16 lanes, packed");
    }

    #[test]
    #[should_panic(expected = "fits")]
    fn a_cursor_from_another_sweep_is_refused() {
        let (long, short) = ([sorted_boxes(600, 8)], [sorted_boxes(16, 5)]);
        let (mut out, mut cursor) = (vec![[0; 2]; PAD], Cursor::default());
        let mut sweep = |boxes, cursor: &mut Cursor| {
            Kernel::SCALAR.sweep::<2, _>(boxes, true, PairOrder::Ascending, cursor, &mut out);
        };
        while cursor.fits(&short) && !cursor.is_done() {
            sweep(&long, &mut cursor);
        }
        sweep(&short, &mut cursor);
    }
}
