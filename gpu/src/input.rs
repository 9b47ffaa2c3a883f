//! What is searched: buffers on the device.

use sweep_and_prune::Aabb;

use crate::error::Error;

/// Boxes in a buffer on the device, and what else is known of them.
///
/// Make it with [`Boxes::new`] for a buffer that a program fills, or upload boxes with [`Boxes::upload`]. Cloning it
/// copies no box.
#[derive(Clone, Debug)]
pub struct Boxes<const D: usize> {
    pub(crate) boxes: wgpu::Buffer,
    pub(crate) count: u32,
    pub(crate) filters: Option<wgpu::Buffer>,
    pub(crate) worlds: Option<wgpu::Buffer>,
}

impl<const D: usize> Boxes<D> {
    /// The first `count` boxes of a buffer, which needs the usage `STORAGE`. A box is a row of `2 * D` `f32` without
    /// padding: the min corner, then the max corner. So a 2D box has 16 bytes and a 3D box 24.
    pub fn new(boxes: &wgpu::Buffer, count: u32) -> Self {
        Self { boxes: boxes.clone(), count, filters: None, worlds: None }
    }

    /// Copies boxes to a new buffer with the usages `STORAGE`, `COPY_SRC` and `COPY_DST`.
    ///
    /// # Errors
    /// [`Error::TooManyBoxes`] if the device has no buffer of this size, [`Error::OutOfMemory`].
    pub fn upload(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        boxes: &[Aabb<D, f32>],
    ) -> Result<Self, Error> {
        let row = 8 * D as u64;
        let most = (device.limits().max_buffer_size / row).min(u64::from(u32::MAX));
        let count = boxes.len() as u64;
        if count > most {
            return Err(Error::TooManyBoxes { count, most });
        }
        let buffer = upload(device, queue, "boxes", bytemuck::cast_slice(boxes))?;
        Ok(Self::new(&buffer, count as u32))
    }

    /// Lets two boxes pair only if the category of each has a bit in the mask of the other. The buffer needs the usage
    /// `STORAGE` and has two `u32` for each box: its category, then its mask.
    ///
    /// Filters choose among overlapping boxes; they do not make the search faster.
    #[must_use]
    pub fn filters(mut self, filters: &wgpu::Buffer) -> Self {
        self.filters = Some(filters.clone());
        self
    }

    /// Puts each box into a world; boxes of different worlds never pair, however many worlds there are. The buffer needs
    /// the usage `STORAGE` and has one `u32` for each box, below 2^31. A box with a greater number counts as invalid.
    ///
    /// Without this all boxes are in world 0.
    #[must_use]
    pub fn worlds(mut self, worlds: &wgpu::Buffer) -> Self {
        self.worlds = Some(worlds.clone());
        self
    }

    /// The number of boxes.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// The buffer with the boxes.
    pub fn buffer(&self) -> &wgpu::Buffer {
        &self.boxes
    }

    /// Checks the sizes and usages of the buffers.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let count = u64::from(self.count);
        let storage = wgpu::BufferUsages::STORAGE;
        check_buffer("boxes", &self.boxes, 8 * D as u64 * count, storage)?;
        if let Some(filters) = &self.filters {
            check_buffer("filters", filters, 8 * count, storage)?;
        }
        if let Some(worlds) = &self.worlds {
            check_buffer("worlds", worlds, 4 * count, storage)?;
        }
        Ok(())
    }
}

/// Copies numbers to a new buffer with the usages `STORAGE`, `COPY_SRC` and `COPY_DST`: worlds, or the categories and
/// masks of filters.
///
/// # Errors
/// [`Error::OutOfMemory`], or [`Error::Device`] if the device has no buffer of this size.
pub fn upload_numbers(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    numbers: &[u32],
) -> Result<wgpu::Buffer, Error> {
    upload(device, queue, "numbers", bytemuck::cast_slice(numbers))
}

fn upload(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    bytes: &[u8],
) -> Result<wgpu::Buffer, Error> {
    crate::device::checked(device, || {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            // A buffer without bytes cannot be bound.
            size: (bytes.len() as u64).max(4),
            usage: wgpu::BufferUsages::STORAGE
                | wgpu::BufferUsages::COPY_SRC
                | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        queue.write_buffer(&buffer, 0, bytes);
        Ok(buffer)
    })
}

/// Checks the size and the usages of a buffer that a caller passed.
pub(crate) fn check_buffer(
    name: &'static str,
    buffer: &wgpu::Buffer,
    needed: u64,
    usages: wgpu::BufferUsages,
) -> Result<(), Error> {
    if buffer.size() < needed {
        return Err(Error::BufferTooSmall { buffer: name, needed, size: buffer.size() });
    }
    let missing = usages - buffer.usage();
    if !missing.is_empty() {
        return Err(Error::BufferUsage { buffer: name, missing });
    }
    Ok(())
}
