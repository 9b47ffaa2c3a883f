//! What the tests share: one device, and the pairs that the core finds.

use std::sync::OnceLock;

use sweep_and_prune::Aabb;
use sweep_and_prune_gpu::{Boxes, PairFinder, open_device, upload_numbers};

/// The number that an environment variable has, or else this one.
pub fn setting(variable: &str, otherwise: usize) -> usize {
    std::env::var(variable).map_or(otherwise, |number| number.parse().expect("a number"))
}

/// The device of all tests of a process. Without one the tests fail: `./test gpu` installs a software device.
pub fn device() -> &'static (wgpu::Device, wgpu::Queue) {
    static DEVICE: OnceLock<(wgpu::Device, wgpu::Queue)> = OnceLock::new();
    DEVICE.get_or_init(|| open_device().expect("Vulkan in software: Debian's mesa-vulkan-drivers"))
}

/// A finder whose pairs are sorted.
pub fn finder<const D: usize>() -> PairFinder<D> {
    let (device, queue) = device();
    PairFinder::new(device, queue).expect("the shaders compile").sorted(true)
}

/// Boxes on the device.
pub fn upload<const D: usize>(boxes: &[Aabb<D, f32>]) -> Boxes<D> {
    let (device, queue) = device();
    Boxes::upload(device, queue, boxes).expect("there is memory")
}

/// Numbers on the device.
pub fn numbers(values: &[u32]) -> wgpu::Buffer {
    let (device, queue) = device();
    upload_numbers(device, queue, values).expect("there is memory")
}

/// A buffer of a caller, filled with a number that no search writes.
pub fn filled(count: usize) -> wgpu::Buffer {
    numbers(&vec![UNTOUCHED; count])
}

/// What [`filled`] writes.
pub const UNTOUCHED: u32 = 0xdead_beef;

/// All numbers of a buffer.
pub fn read(buffer: &wgpu::Buffer) -> Vec<u32> {
    let (device, queue) = device();
    let copy = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: buffer.size(),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, buffer.size());
    queue.submit([encoder.finish()]);
    copy.map_async(wgpu::MapMode::Read, .., |result| result.expect("the device is there"));
    device.poll(wgpu::PollType::wait_indefinitely()).expect("the device is there");
    let bytes = copy.get_mapped_range(..);
    bytes.chunks_exact(4).map(|b| u32::from_ne_bytes([b[0], b[1], b[2], b[3]])).collect()
}

/// The pairs of the core, sorted.
pub fn core_pairs<const D: usize>(boxes: &[Aabb<D, f32>]) -> Vec<[u32; 2]> {
    let mut pairs = sweep_and_prune::find_pairs(boxes).expect("the boxes are valid");
    pairs.sort_unstable();
    pairs
}

/// The pairs of the core between two sets, sorted.
pub fn core_pairs_between<const D: usize>(
    first: &[Aabb<D, f32>],
    second: &[Aabb<D, f32>],
) -> Vec<[u32; 2]> {
    let mut pairs =
        sweep_and_prune::find_pairs_between(first, second).expect("the boxes are valid");
    pairs.sort_unstable();
    pairs
}
