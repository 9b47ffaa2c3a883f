//! Scenes that took 11 to 217 times as long as uniform boxes, found by `fuzz/examples/slow.rs`: groups of
//! boxes that need different sweep axes, far smaller than the scene. The test counts work, not time.

use alloc::vec::Vec;

use super::driver::Driver;
use super::kernel::Kernel;
use super::near::Near;
use super::search::run;
use super::sink::Count;
use super::work::Work;
use crate::{Aabb, Scalar};

/// Boxes of one kind: how many, of which set, where they begin, over what extents, and their size.
pub(super) type Group<const D: usize> = (usize, usize, [f64; D], [f64; D], [f64; D]);

/// The boxes of each set.
pub(super) fn boxes<const D: usize, T: Scalar>(groups: &[Group<D>]) -> [Vec<Aabb<D, T>>; 2] {
    let mut sets = [Vec::new(), Vec::new()];
    let mut state = 1u64;
    for (count, set, low, spread, size) in groups {
        for _ in 0..*count {
            let min: [f64; D] = core::array::from_fn(|axis| {
                state = state.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(1);
                low[axis] + spread[axis] * (state >> 11) as f64 / (1u64 << 53) as f64
            });
            let max = core::array::from_fn(|axis| T::from_f64(min[axis] + size[axis]));
            sets[*set].push(Aabb::new(min.map(T::from_f64), max));
        }
    }
    sets
}

/// A search sorts each box less than 5 times, and tests it against less than 150 others.
fn takes_little_work<const D: usize, T: Scalar>(groups: &[Group<D>]) {
    let sets = boxes::<D, T>(groups);
    let count = (sets[0].len() + sets[1].len()) as u64;
    let used = if sets[1].is_empty() { 1 } else { 2 };
    let slices = sets.each_ref().map(|set| &set[..]);
    let mut driver = Driver::<_, _, Work>::new(Kernel::best());
    let near = Some(&mut Near::default());
    run(&mut driver, near, &slices[..used], None, &mut Count::default())
        .expect("the boxes are valid");
    let Work { sorted, tests, .. } = driver.probe;
    assert!(sorted < 5 * count, "{sorted} of {count} boxes sorted");
    assert!(tests < 150 * count, "{tests} tests of {count} boxes");
}

#[test]
fn a_group_in_a_small_part_of_every_axis_is_swept_on_the_axis_that_tells_its_boxes_apart() {
    takes_little_work::<3, f64>(&[
        (16497, 0, [0.886, 0.8083, 0.5782], [0.0, 0.0, 8.966e-5], [1.7e-5, 0.001, 0.0]),
        (1000, 0, [0.9349, 0.7715, 0.9193], [0.0494, 1.4e-4, 0.001], [0.0, 0.0547, 0.0557]),
    ]);
}

#[test]
fn groups_that_need_different_axes_are_divided() {
    takes_little_work::<2, f32>(&[
        (656, 0, [0.1716, 0.2671], [0.0, 0.2069], [0.843, 0.0]),
        (14750, 0, [0.176, 0.9263], [0.0138, 0.0], [0.0, 0.0918]),
    ]);
}

#[test]
fn a_column_that_still_holds_nearly_all_boxes_is_not_cut_the_same_way_again() {
    takes_little_work::<3, f64>(&[
        (197, 0, [0.2262, 0.526, 0.241], [2.2e-4, 6.6e-6, 0.0036], [0.2581, 0.0, 0.3202]),
        (10000, 1, [0.4238, 0.4599, 0.8673], [0.0486, 9.3e-4, 0.0042], [0.0, 0.0283, 0.5008]),
    ]);
    takes_little_work::<3, f32>(&[
        (194, 0, [0.2328, 0.5209, 0.1443], [2.6e-4, 0.0, 0.126], [0.4983, 0.6816, 0.0]),
        (8660, 1, [0.6358, 0.7137, 0.356], [1.2e-5, 0.0, 3.1e-6], [0.0564, 6.7e-4, 0.0]),
    ]);
    takes_little_work::<2, f32>(&[
        (4104, 0, [0.8458, 0.127], [1.6e-4, 0.0], [2e-6, 0.3668]),
        (3546, 1, [0.7944, 0.18], [1.3e-5, 4e-5], [3.5e-4, 0.0181]),
        (14244, 1, [0.8349, 0.5486], [0.0217, 0.0415], [0.0225, 5.8e-5]),
    ]);
}

#[test]
fn boxes_that_reach_over_several_columns_are_not_expected_to_share_none() {
    takes_little_work::<3, f64>(&[
        (4000, 0, [0.79, 0.7, 0.6672], [0.0016, 2.3e-4, 1.1e-6], [0.0358, 0.0, 1.1e-6]),
        (1452, 0, [0.1259, 0.7284, 0.309], [0.0171, 9e-6, 2.5e-4], [5.7e-6, 0.0, 0.3299]),
        (10000, 0, [0.5485, 0.3317, 0.3699], [7.2e-5, 3.3e-5, 1.2e-5], [0.4312, 0.5499, 0.0]),
    ]);
    takes_little_work::<3, f64>(&[
        (10000, 0, [0.5485, 0.3317, 0.3699], [7.2e-5, 3.3e-5, 1.2e-5], [0.4312, 0.5499, 0.0]),
        (1452, 1, [0.1259, 0.7284, 0.309], [0.0171, 9e-6, 2.5e-4], [5.7e-6, 0.0, 0.3299]),
        (4000, 1, [0.79, 0.7, 0.6672], [0.0016, 2.3e-4, 1.1e-6], [0.0358, 0.0, 1.1e-6]),
    ]);
}
