//! The columns of one search, as the kernels read them: `columns.txt`. What draws them shows what the finder really does,
//! but for the plan: it would not cut as few boxes as fit into a picture.

use std::fmt::Write;
use std::string::String;
use std::vec::Vec;

use super::driver::Driver;
use super::grid::{Cells, Grid};
use super::kernel::{Kernel, PairOrder, SortedBoxes};
use super::plan::Plan;
use super::probe::Probe;
use super::sink::Store;
use super::task::Task;
use super::work::compare_with_record;
use crate::{Aabb, Scalar};
use sweep_and_prune_scenes::Scene;

/// Writes one line for each column that is swept, and one for each of its boxes in sweep order.
#[derive(Default)]
struct Record(String);

impl Probe for Record {
    fn swept<T: Scalar>(&mut self, sorted: &[SortedBoxes<T>]) {
        let boxes = &sorted[0];
        writeln!(self.0, "column of {}", boxes.len()).expect("a string grows");
        for at in 0..boxes.len() {
            let [left, right] = [boxes.left[at], boxes.right[at]];
            let [min, max] = [boxes.min[0][at], boxes.max[0][at]];
            let (id, dedup) = (boxes.id[at], boxes.dedup[at]);
            writeln!(self.0, "{left:?} {right:?} {min:?} {max:?} {id} {dedup}")
                .expect("a string grows");
        }
    }
}

#[test]
fn columns_are_those_that_are_recorded() {
    let boxes = Scene::Uniform.boxes::<2, f32>(500, 1).expect("a scene in two dimensions");
    // The scenes know this crate as it is compiled without tests.
    let boxes = boxes.iter().map(|aabb| Aabb::new(aabb.min, aabb.max)).collect::<Vec<_>>();
    let mut driver = Driver::<2, f32, Record>::new(Kernel::best());
    let mut store = Store::default();
    let [low, high] = boxes.iter().fold([f64::INFINITY, -f64::INFINITY], |[low, high], aabb| {
        [low.min(aabb.min[1].into()), high.max(aabb.max[1].into())]
    });
    let plan = Plan::Cut(Grid::new(0, &[Cells::one(0), Cells::new(1, 1.0, low, high, 3)]));
    let task = Task::new(PairOrder::Ascending, None);
    driver.run_plan(plan, &[&boxes[..]], task, &mut store).expect("the boxes are valid");
    let Record(mut record) = driver.probe;
    for [a, b] in store.pairs() {
        writeln!(record, "pair {a} {b}").expect("a string grows");
    }
    compare_with_record("src/pairs/columns.txt", &record);
}
