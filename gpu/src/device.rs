//! Opening a device, and errors that a device reports while commands are recorded.

use pollster::block_on;

use crate::error::Error;

/// Opens the fastest GPU of this machine for computing, with the largest buffers that it grants.
///
/// A program that draws has a device already and passes that to [`PairFinder::new`](crate::PairFinder::new). The
/// environment variables of wgpu apply: `WGPU_BACKEND=vulkan` chooses an interface.
///
/// # Errors
/// [`Error::NoAdapter`] if there is no GPU, [`Error::NoDevice`] if it cannot be opened.
pub fn open_device() -> Result<(wgpu::Device, wgpu::Queue), Error> {
    let instance =
        wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = block_on(instance.request_adapter(&wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        ..Default::default()
    }))
    .map_err(|error| Error::NoAdapter { message: error.to_string() })?;
    let granted = adapter.limits();
    let required_limits = wgpu::Limits {
        max_storage_buffer_binding_size: granted.max_storage_buffer_binding_size,
        max_buffer_size: granted.max_buffer_size,
        ..Default::default()
    };
    block_on(adapter.request_device(&wgpu::DeviceDescriptor {
        label: Some("sweep-and-prune"),
        required_limits,
        ..Default::default()
    }))
    .map_err(|error| Error::NoDevice { message: error.to_string() })
}

/// Does something with a device. What the device finds wrong meanwhile is returned, instead of ending the program as wgpu
/// does by default.
pub(crate) fn checked<R>(
    device: &wgpu::Device,
    run: impl FnOnce() -> Result<R, Error>,
) -> Result<R, Error> {
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
    let result = run();
    let errors = [block_on(internal.pop()), block_on(memory.pop()), block_on(validation.pop())];
    // What was done without enough memory makes further errors, which say less.
    for error in errors.iter().flatten() {
        if matches!(error, wgpu::Error::OutOfMemory { .. }) {
            return Err(Error::OutOfMemory);
        }
    }
    match errors.into_iter().flatten().next() {
        Some(_) if is_lost(device) => Err(Error::DeviceLost),
        Some(error) => Err(Error::Device { message: error.to_string() }),
        None => result,
    }
}

/// Whether a device makes buffers that cannot be used, which is how a lost device behaves.
pub(crate) fn is_lost(device: &wgpu::Device) -> bool {
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 4,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    buffer.map_async(wgpu::MapMode::Read, .., |_| ());
    block_on(scope.pop()).is_some()
}

/// Reads the beginning of a buffer. Waits for the device.
pub(crate) fn read(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    buffer: &wgpu::Buffer,
    bytes: u64,
) -> Result<Vec<u32>, Error> {
    if bytes == 0 {
        return Ok(Vec::new());
    }
    let copy = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("sweep-and-prune: copy for reading"),
        size: bytes,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, bytes);
    let submission_index = Some(queue.submit([encoder.finish()]));
    let (sender, receiver) = std::sync::mpsc::channel();
    copy.map_async(wgpu::MapMode::Read, .., move |result| {
        // The receiver waits below.
        let _ = sender.send(result);
    });
    let wait = wgpu::PollType::Wait { submission_index, timeout: None };
    device.poll(wait).map_err(|_| Error::DeviceLost)?;
    // Another thread that waits for this device may be the one that calls back, and do so only after `poll` returns here.
    match receiver.recv() {
        Ok(Ok(())) => {}
        _ => return Err(Error::DeviceLost),
    }
    let numbers = bytemuck::pod_collect_to_vec(&copy.get_mapped_range(..));
    copy.unmap();
    Ok(numbers)
}
