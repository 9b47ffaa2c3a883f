//! What callers may get wrong, and buffers of their own.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use crate::support::{
    UNTOUCHED, core_pairs, core_pairs_between, device, filled, finder, numbers, read, upload,
};
use sweep_and_prune::Aabb;
use sweep_and_prune_gpu::{Boxes, Error, PairFinder, Summary, open_device};
use sweep_and_prune_scenes::Scene;

fn uniform(count: usize) -> Vec<Aabb<3, f32>> {
    Scene::Uniform.boxes(count, 5).unwrap()
}

#[test]
fn a_buffer_that_is_too_small_receives_what_fits() {
    let boxes = uniform(3000);
    let expected = core_pairs(&boxes).len();
    let mut finder = finder::<3>().sorted(false);
    let all = finder.find(&upload(&boxes)).unwrap().read().unwrap();
    for capacity in [0, 1, 2, 100, expected - 1, expected, expected + 5] {
        for sorted in [false, true] {
            finder = finder.sorted(sorted);
            let (pairs, summary) = (filled(2 * capacity + 3), filled(16));
            // A buffer of `2 * capacity + 3` numbers holds one pair more.
            let capacity = capacity + 1;
            finder.find_into(&upload(&boxes), &pairs, &summary).unwrap();
            let summary = finder.read_summary(&summary).unwrap();
            let written = expected.min(capacity);
            assert_eq!(summary.found as usize, expected);
            assert_eq!(summary.written as usize, written);
            assert_eq!(summary.is_complete(), expected <= capacity);
            let mut first = all[..written].to_vec();
            if sorted {
                first.sort_unstable();
            }
            assert!(finder.read_pairs(&pairs, &summary).unwrap() == first);
            assert!(read(&pairs)[2 * written..].iter().all(|&number| number == UNTOUCHED));
        }
    }
}

#[test]
fn a_buffer_without_space_for_a_pair_still_counts() {
    let boxes = uniform(100);
    let (pairs, summary) = (filled(1), filled(16));
    let mut finder = finder::<3>();
    finder.find_into(&upload(&boxes), &pairs, &summary).unwrap();
    let summary = finder.read_summary(&summary).unwrap();
    assert_eq!((summary.found as usize, summary.written), (core_pairs(&boxes).len(), 0));
    assert_eq!(read(&pairs), [UNTOUCHED]);
}

#[test]
fn two_sets_are_written_to_a_buffer_of_the_caller() {
    let (first, second) = (uniform(700), uniform(900));
    let (pairs, summary) = (filled(1 << 16), filled(16));
    let mut finder = finder::<3>();
    finder.find_between_into(&upload(&first), &upload(&second), &pairs, &summary).unwrap();
    let summary = finder.read_summary(&summary).unwrap();
    let expected = core_pairs_between(&first, &second);
    assert!(finder.read_pairs(&pairs, &summary).unwrap() == expected);
}

#[test]
fn the_summary_has_indirect_arguments() {
    let boxes = vec![Aabb::new([0.0; 2], [1.0; 2]); 700];
    let mut finder = PairFinder::<2>::new(&device().0, &device().1).unwrap();
    let found = finder.find(&upload(&boxes)).unwrap();
    let pairs: u32 = 700 * 699 / 2;
    assert_eq!(
        read(found.summary_buffer())[..16],
        [pairs, pairs, 0, 0, pairs.div_ceil(64), 1, 1, 0, 2, pairs, 0, 0, 0, 0, 0, 0]
    );
    // More groups than one dimension has.
    finder = finder.dispatch_group_size(1).draw_vertices(36);
    let found = finder.find(&upload(&boxes)).unwrap();
    let summary = read(found.summary_buffer());
    assert_eq!(summary[4..7], [65_535, pairs.div_ceil(65_535), 1]);
    assert_eq!(summary[8..10], [36, pairs]);
    let none = finder.find(&upload(&boxes[..1])).unwrap();
    assert_eq!(read(none.summary_buffer())[4..7], [0, 0, 1]);
}

#[test]
fn sets_without_boxes_have_no_pairs() {
    let mut finder = finder::<3>();
    let (none, some) = (upload::<3>(&[]), upload(&uniform(50)));
    assert!(finder.find(&none).unwrap().is_empty());
    assert!(finder.find(&upload(&uniform(1))).unwrap().is_empty());
    assert!(finder.find_between(&none, &some).unwrap().is_empty());
    assert!(finder.find_between(&some, &none).unwrap().is_empty());
    assert!(finder.find_between(&none, &none).unwrap().is_empty());
}

#[test]
fn a_part_of_a_buffer_is_searched() {
    let boxes = uniform(1000);
    let all = upload(&boxes);
    let some = Boxes::<3>::new(all.buffer(), 600);
    let found = finder().find(&some).unwrap().read().unwrap();
    assert!(found == core_pairs(&boxes[..600]));
}

#[test]
fn wrong_buffers_are_rejected() {
    let mut finder = finder::<3>();
    let boxes = upload(&uniform(10));
    let error = finder.find(&Boxes::new(boxes.buffer(), 11)).unwrap_err();
    assert_eq!(error, Error::BufferTooSmall { buffer: "boxes", needed: 264, size: 240 });
    assert_eq!(error.to_string(), "the buffer `boxes` has 240 bytes, but 264 are needed");
    let error = finder.find(&boxes.clone().worlds(&numbers(&[1; 9]))).unwrap_err();
    assert_eq!(error, Error::BufferTooSmall { buffer: "worlds", needed: 40, size: 36 });
    let error = finder.find(&boxes.clone().filters(&numbers(&[1; 19]))).unwrap_err();
    assert_eq!(error, Error::BufferTooSmall { buffer: "filters", needed: 80, size: 76 });
    let error = finder.find_into(&boxes, &filled(2), &filled(15)).unwrap_err();
    assert_eq!(error, Error::BufferTooSmall { buffer: "summary", needed: 64, size: 60 });
    let vertices = device().0.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 240,
        usage: wgpu::BufferUsages::VERTEX,
        mapped_at_creation: false,
    });
    let error = finder.find(&Boxes::new(&vertices, 10)).unwrap_err();
    assert_eq!(error, Error::BufferUsage { buffer: "boxes", missing: wgpu::BufferUsages::STORAGE });
    // The finder works on.
    assert!(finder.find(&boxes).unwrap().read().unwrap() == core_pairs(&uniform(10)));
}

/// A device with these limits.
fn device_with(required_limits: wgpu::Limits) -> (wgpu::Device, wgpu::Queue) {
    let instance =
        wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter =
        pollster::block_on(instance.request_adapter(&Default::default())).expect("a device");
    let descriptor = wgpu::DeviceDescriptor { required_limits, ..Default::default() };
    pollster::block_on(adapter.request_device(&descriptor)).expect("a device")
}

#[test]
fn the_limits_of_a_device_are_respected() {
    let limits = wgpu::Limits { max_storage_buffer_binding_size: 1 << 16, ..Default::default() };
    let (device, queue) = device_with(limits);
    let mut finder = PairFinder::<3>::new(&device, &queue).unwrap().sorted(true);
    let (most_boxes, most_pairs) = (finder.most_boxes() as usize, finder.most_pairs());
    assert_eq!((most_boxes, most_pairs), (1778, 1 << 13));
    let boxes = uniform(most_boxes);
    let found = finder.find(&Boxes::upload(&device, &queue, &boxes).unwrap()).unwrap();
    assert!(found.read().unwrap() == core_pairs(&boxes));
    let error = finder
        .find(&Boxes::upload(&device, &queue, &uniform(most_boxes + 1)).unwrap())
        .unwrap_err();
    assert_eq!(error, Error::TooManyBoxes { count: 1779, most: 1778 });
    // 128 coincident boxes have 8128 pairs, 129 have 8256.
    let same = vec![Aabb::new([0.0; 3], [1.0; 3]); 129];
    assert_eq!(
        finder.find(&Boxes::upload(&device, &queue, &same[..128]).unwrap()).unwrap().len(),
        8128
    );
    let error = finder.find(&Boxes::upload(&device, &queue, &same).unwrap()).unwrap_err();
    assert_eq!(error, Error::TooManyPairs { count: 8256, most: 8192 });
    assert_eq!(
        finder.find(&Boxes::upload(&device, &queue, &same[..128]).unwrap()).unwrap().len(),
        8128
    );
}

#[test]
fn a_device_with_less_than_the_defaults_is_rejected() {
    let limits = wgpu::Limits { max_compute_invocations_per_workgroup: 128, ..Default::default() };
    let (device, queue) = device_with(limits);
    let error = PairFinder::<2>::new(&device, &queue).unwrap_err();
    let limit = "maxComputeInvocationsPerWorkgroup";
    assert_eq!(error, Error::Limit { limit, needed: 256, granted: 128 });
}

#[test]
fn a_lost_device_is_an_error() {
    let (device, queue) = open_device().unwrap();
    let mut finder = PairFinder::<3>::new(&device, &queue).unwrap();
    let boxes = Boxes::upload(&device, &queue, &uniform(10)).unwrap();
    finder.find(&boxes).unwrap();
    device.destroy();
    assert_eq!(finder.find(&boxes).unwrap_err(), Error::DeviceLost);
    // Also when it needs new buffers.
    assert_eq!(finder.find(&boxes).unwrap_err(), Error::DeviceLost);
    assert_eq!(Boxes::upload(&device, &queue, &uniform(10)).unwrap_err(), Error::DeviceLost);
    assert_eq!(PairFinder::<3>::new(&device, &queue).unwrap_err(), Error::DeviceLost);
}

#[test]
fn a_summary_has_sixteen_numbers() {
    let wrong = filled(15);
    let error = finder::<2>().read_summary(&wrong).unwrap_err();
    assert_eq!(
        error,
        Error::BufferTooSmall { buffer: "summary", needed: Summary::BYTES, size: 60 }
    );
}

/// A thread that waits for a device also calls back for the buffers of other threads, and may take its time between two.
#[test]
fn other_threads_wait_for_the_same_device() {
    let boxes = uniform(200);
    let expected = core_pairs(&boxes);
    let (device, queue) = open_device().unwrap();
    let mut finder = PairFinder::<3>::new(&device, &queue).unwrap().sorted(true);
    let uploaded = Boxes::upload(&device, &queue, &boxes).unwrap();
    let is_done = AtomicBool::new(false);
    let wait = || {
        while !is_done.load(Ordering::Relaxed) {
            let buffer = device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: 4,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            buffer.map_async(wgpu::MapMode::Read, .., |_| {
                std::thread::sleep(Duration::from_millis(1));
            });
            device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(wait);
        }
        let found: Vec<_> = (0..50).map(|_| finder.find(&uploaded)?.read()).collect();
        is_done.store(true, Ordering::Relaxed);
        for pairs in found {
            assert!(pairs.unwrap() == expected);
        }
    });
}
