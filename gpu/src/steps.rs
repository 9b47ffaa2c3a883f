//! Commands for the device: which kernel runs on which buffers.

use crate::kernels::{Kernel, Kernels};

/// Threads of a workgroup, as in `wgsl/common.wgsl`.
pub const THREADS: u64 = 64;

/// The most workgroups in one dimension that every device grants.
const MOST_GROUPS: u64 = 65_535;

/// The distance of the parameters of two steps in their buffer: a multiple of every device's alignment.
const SLOT: usize = 256;

/// The size of the largest parameters, those of `wgsl/search.wgsl`, in bytes.
const PARAMS: u64 = 96;

/// One dispatch.
#[derive(Debug)]
struct Step {
    kernel: Kernel,
    params: Vec<u32>,
    buffers: Vec<Bound>,
    groups: u64,
}

/// A buffer as a kernel sees it: its first bytes.
#[derive(Clone, Debug)]
pub struct Bound {
    buffer: wgpu::Buffer,
    bytes: u64,
}

impl Bound {
    /// The first `bytes` bytes of a buffer.
    pub fn new(buffer: &wgpu::Buffer, bytes: u64) -> Self {
        Self { buffer: buffer.clone(), bytes }
    }

    pub fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }
}

/// Dispatches in the order in which they run. Each sees what those before it wrote.
#[derive(Debug, Default)]
pub struct Steps {
    steps: Vec<Step>,
}

impl Steps {
    /// Adds a dispatch of this many workgroups. `params` are the fields of the kernel's `Params`, and `buffers` its
    /// bindings from 1 on.
    pub fn add(&mut self, kernel: Kernel, params: &[u32], buffers: &[&Bound], groups: u64) {
        self.steps.push(Step {
            kernel,
            params: params.to_vec(),
            buffers: buffers.iter().map(|&bound| bound.clone()).collect(),
            groups,
        });
    }

    /// Adds a dispatch of one thread for each of `count` items.
    pub fn for_each(&mut self, kernel: Kernel, count: u64, params: &[u32], buffers: &[&Bound]) {
        self.add(kernel, params, buffers, count.div_ceil(THREADS));
    }

    /// Records all dispatches. `params` is a uniform buffer that is grown as needed; its contents are those of the
    /// commands until they are submitted.
    pub fn record(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        kernels: &Kernels,
        params: &mut Option<wgpu::Buffer>,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let mut bytes = vec![0; SLOT * self.steps.len()];
        for (slot, step) in bytes.chunks_exact_mut(SLOT).zip(&self.steps) {
            let fields: &[u8] = bytemuck::cast_slice(&step.params);
            slot[..fields.len()].copy_from_slice(fields);
        }
        if params.as_ref().is_none_or(|buffer| buffer.size() < bytes.len() as u64) {
            *params = Some(device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("sweep-and-prune: parameters"),
                size: bytes.len() as u64,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }));
        }
        let Some(params) = params else { return };
        queue.write_buffer(params, 0, &bytes);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        for (at, step) in self.steps.iter().enumerate() {
            let pipeline = kernels.get(step.kernel);
            let uniform = wgpu::BindGroupEntry {
                binding: 0,
                resource: binding(params, (SLOT * at) as u64, PARAMS),
            };
            let storage =
                (1..).zip(&step.buffers).map(|(binding_number, bound)| wgpu::BindGroupEntry {
                    binding: binding_number,
                    resource: binding(&bound.buffer, 0, bound.bytes),
                });
            let entries: Vec<_> = core::iter::once(uniform).chain(storage).collect();
            let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipeline.get_bind_group_layout(0),
                entries: &entries,
            });
            let columns = step.groups.min(MOST_GROUPS);
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(
                columns as u32,
                step.groups.div_ceil(columns.max(1)) as u32,
                1,
            );
        }
    }
}

fn binding(buffer: &wgpu::Buffer, offset: u64, bytes: u64) -> wgpu::BindingResource<'_> {
    wgpu::BindingResource::Buffer(wgpu::BufferBinding {
        buffer,
        offset,
        size: core::num::NonZeroU64::new(bytes),
    })
}
