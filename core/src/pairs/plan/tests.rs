//! Plans for boxes whose coordinates are far from usual.

use super::*;
use crate::Aabb;
use crate::float::whole;

/// Boxes of a size at whole multiples of a step below 100, on two axes.
fn boxes<T: Scalar>(step: f64, size: f64) -> alloc::vec::Vec<Aabb<2, T>> {
    let at = |i: u32| f64::from(i.wrapping_mul(0x9E37_79B9) >> 16) * (100.0 / 65536.0);
    let edge = |i: u32, size: f64| T::from_f64((whole(at(i)) + size) * step);
    let aabb = |i| {
        let corner = |size| [edge(i, size), edge(i ^ 0xABCD_EF01, size)];
        Aabb::new(corner(0.0), corner(size))
    };
    (0..10_000).map(aabb).collect()
}

/// How many columns are planned.
fn columns<T: Scalar>(step: f64, size: f64) -> usize {
    match plan(&[&boxes::<T>(step, size)[..]], Among::All { is_crowded: false }).0 {
        Plan::Cut(grid) => grid.len(),
        Plan::SplitBySize(_) => 0,
    }
}

#[test]
fn points_on_few_coordinates_are_cut_as_boxes_are() {
    assert!(columns::<f32>(1.0, 0.0) > 8);
    assert!(columns::<f32>(1.0, 1.0) > 8);
}

#[test]
fn plans_do_not_depend_on_the_unit() {
    let usual = columns::<f32>(1.0, 1.0);
    for step in [f64::from(f32::from_bits(1)), 2f64.powi(-120), 2f64.powi(120)] {
        assert_eq!(columns::<f32>(step, 1.0), usual, "{step}");
    }
    for step in [f64::from_bits(1), 2f64.powi(-1000), 2f64.powi(1000)] {
        assert_eq!(columns::<f64>(step, 1.0), usual, "{step}");
    }
    // In other units other coordinates are round, to which the ends of the distribution are snapped:
    // that may come to a step finer or coarser, by a quarter.
    let is_alike = |columns: usize| 3 * columns <= 4 * usual && 3 * usual <= 4 * columns;
    for step in [1e-40, 1e-30, 1e30, 3.3e36] {
        assert!(is_alike(columns::<f32>(step, 1.0)), "{step}");
    }
    for step in [1e-310, 1e-290, 1e290, 1.7e306] {
        assert!(is_alike(columns::<f64>(step, 1.0)), "{step}");
    }
}

/// Objects that wait at the origin of a large world, as pools of unspawned ones do. Each column
/// costs time and memory even if it is empty.
#[test]
fn coincident_boxes_of_two_sets_do_not_make_many_columns() {
    let mut state = 1u32;
    let mut random = || {
        state = state.wrapping_mul(0x9E37_79B1).wrapping_add(0x85EB_CA6B);
        (state >> 8) as f32 / 16.0
    };
    let mut points = |count: usize| -> alloc::vec::Vec<Aabb<3, f32>> {
        let point =
            |i: usize| if i.is_multiple_of(10) { [0.0; 3] } else { [0; 3].map(|_| random()) };
        (0..count).map(point).map(|point| Aabb::new(point, point)).collect()
    };
    let mut cuts = 0;
    for (few, many) in [(200, 200), (1000, 4000), (4000, 8000)] {
        let sets = [points(few), points(many)];
        let Plan::Cut(grid) =
            plan(&[&sets[0][..], &sets[1][..]], Among::All { is_crowded: false }).0
        else {
            continue;
        };
        cuts += 1;
        assert!(grid.len() <= 8 * (few + many), "{few} {many}: {} columns", grid.len());
    }
    assert!(cuts > 0, "nothing was cut");
}
