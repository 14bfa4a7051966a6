//! What can go wrong on a device, as errors; reading back.

use std::sync::mpsc;

use bytemuck::{AnyBitPattern, NoUninit};
use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, CommandEncoder, Device, ErrorFilter, MapMode, PollType, Queue,
};

use crate::GpuError;

/// Runs `work`, whose calls of the device would panic where the device refuses.
///
/// Errors: those of `work`; the device has no memory left, or refused something.
pub(crate) fn guarded<T>(device: &Device, work: impl FnOnce() -> Result<T, GpuError>) -> Result<T, GpuError> {
    let filters = [ErrorFilter::Validation, ErrorFilter::Internal, ErrorFilter::OutOfMemory];
    let scopes = filters.map(|filter| device.push_error_scope(filter));
    let done = work();
    // The last that was pushed is popped first.
    let errors = scopes.into_iter().rev().map(|scope| pollster::block_on(scope.pop()));
    match errors.fold(None, Option::or) {
        None => done,
        Some(wgpu::Error::OutOfMemory { .. }) => Err(GpuError::OutOfMemory),
        // A lost device refuses everything.
        Some(error) => done.and(Err(GpuError::Refused { reason: error.to_string() })),
    }
}

/// Submits what `record` records; gives copies of the `wanted` buffers as they are then.
pub(crate) fn submit<const N: usize>(
    device: &Device,
    queue: &Queue,
    record: impl FnOnce(&mut CommandEncoder),
    wanted: [&Buffer; N],
) -> [Copy; N] {
    let mut encoder = device.create_command_encoder(&Default::default());
    record(&mut encoder);
    let copies = wanted.map(|buffer| Copy::record(device, &mut encoder, buffer));
    queue.submit([encoder.finish()]);
    copies
}

/// A copy of a buffer's words, for reading.
pub(crate) struct Copy(Buffer);

impl Copy {
    /// `source` allows to be copied from.
    fn record(device: &Device, encoder: &mut CommandEncoder, source: &Buffer) -> Self {
        let copy = device.create_buffer(&BufferDescriptor {
            label: Some("copy"),
            size: source.size(),
            usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        encoder.copy_buffer_to_buffer(source, 0, &copy, 0, source.size());
        Self(copy)
    }

    /// Waits for all submitted work, then gives the elements. Errors: the device is lost.
    pub fn read<T: AnyBitPattern + NoUninit>(self, device: &Device) -> Result<Vec<T>, GpuError> {
        let (sender, receiver) = mpsc::channel();
        self.0.map_async(MapMode::Read, .., move |mapped| {
            // Nobody waits for it only where this function has failed already.
            let _unheard = sender.send(mapped.is_ok());
        });
        let waited = device.poll(PollType::wait_indefinitely());
        if waited.is_err() || receiver.recv() != Ok(true) {
            return Err(GpuError::Lost);
        }
        let bytes = self.0.get_mapped_range(..).map_err(|_| GpuError::Lost)?;
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }
}
