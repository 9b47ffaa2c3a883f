//! The buffers that a finder keeps between calls.

use crate::error::Error;
use crate::steps::Bound;

/// What a buffer holds.
#[derive(Clone, Copy, Debug)]
pub enum Slot {
    /// Bounds of each box, in the order of the input: eight numbers.
    Rows,
    /// Bounds of the nodes of the tree, level by level.
    Nodes,
    /// The min corners on each axis, sorted.
    SortedX,
    SortedY,
    SortedZ,
    /// What is sorted: keys, and the order of the boxes.
    HighKeys,
    Keys,
    OtherKeys,
    Order,
    OtherOrder,
    /// The table of the sort, and the sums of each level of a scan.
    Table,
    Sums0,
    Sums1,
    Sums2,
    Sums3,
    /// Category and mask of each box.
    Filters,
    /// The number of pairs of each box, or of all boxes before it.
    Tally,
    /// How many boxes are invalid, and the first.
    Invalid,
    /// Pairs and summary of a call without buffers of its own.
    Pairs,
    Summary,
    /// The indices of pairs while they are sorted.
    Firsts,
    OtherFirsts,
    Seconds,
    OtherSeconds,
    /// Bound where a kernel's input is missing.
    Unused,
}

/// The number of slots.
const SLOTS: usize = Slot::Unused as usize + 1;

/// Buffers that grow as needed and never shrink.
#[derive(Debug, Default)]
pub struct Buffers {
    slots: [Option<wgpu::Buffer>; SLOTS],
    /// The parameters of the steps.
    pub params: Option<wgpu::Buffer>,
}

impl Buffers {
    /// The first `numbers` numbers of a buffer. Its contents are kept unless it has to grow.
    pub fn get(&mut self, device: &wgpu::Device, slot: Slot, numbers: u64) -> Bound {
        // The largest element of any array, so that an empty array can be bound.
        let bytes = (4 * numbers).max(64);
        let buffer = &mut self.slots[slot as usize];
        if let Some(buffer) = buffer.as_ref().filter(|buffer| buffer.size() >= bytes) {
            return Bound::new(buffer, bytes);
        }
        // An eighth more than needed, so that sizes that vary a little do not make a new buffer each time.
        let limit = most_bytes(device) / 4 * 4;
        let size = (bytes + bytes / 32 * 4).min(limit).max(bytes);
        let made = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("sweep-and-prune"),
            size,
            usage: wgpu::BufferUsages::STORAGE
                | wgpu::BufferUsages::COPY_SRC
                | wgpu::BufferUsages::COPY_DST
                | wgpu::BufferUsages::INDIRECT
                | wgpu::BufferUsages::VERTEX,
            mapped_at_creation: false,
        });
        let bound = Bound::new(&made, bytes);
        *buffer = Some(made);
        bound
    }

    /// Gives all buffers back, after an error: some may be invalid.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

/// The largest array that a kernel can see on a device, in bytes.
pub fn most_bytes(device: &wgpu::Device) -> u64 {
    let limits = device.limits();
    limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
}

/// Checks what the shaders need of a device beside memory. Every WebGPU device grants it.
pub fn check_limits(device: &wgpu::Device) -> Result<(), Error> {
    let limits = device.limits();
    let checks: [(&'static str, u32, u32); 5] = [
        ("maxComputeInvocationsPerWorkgroup", 256, limits.max_compute_invocations_per_workgroup),
        ("maxComputeWorkgroupSizeX", 256, limits.max_compute_workgroup_size_x),
        ("maxComputeWorkgroupStorageSize", 8192, limits.max_compute_workgroup_storage_size),
        ("maxComputeWorkgroupsPerDimension", 65_535, limits.max_compute_workgroups_per_dimension),
        ("maxStorageBuffersPerShaderStage", 7, limits.max_storage_buffers_per_shader_stage),
    ];
    for (limit, needed, granted) in checks {
        if granted < needed {
            return Err(Error::Limit {
                limit,
                needed: u64::from(needed),
                granted: u64::from(granted),
            });
        }
    }
    Ok(())
}
