//! Reads buffers back to the CPU, and turns wgpu's error scopes into [`GpuError`].

use std::sync::mpsc::{self, TryRecvError};
use std::time::{Duration, Instant};

use bytemuck::{AnyBitPattern, NoUninit};
use darboux::Context;
use darboux::internal::cancel_checks::{check, has_token};
use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, CommandEncoder, Device, ErrorFilter, MapMode, PollType, Queue,
};

use crate::error::GpuError;

/// Runs `work` inside error scopes. Without them, wgpu panics when the device reports an error.
///
/// Errors: those of `work`; the device is out of memory, or reported another error.
pub(crate) fn with_error_scopes<T>(
    device: &Device,
    work: impl FnOnce() -> Result<T, GpuError>,
) -> Result<T, GpuError> {
    let filters = [ErrorFilter::Validation, ErrorFilter::Internal, ErrorFilter::OutOfMemory];
    let scopes = filters.map(|filter| device.push_error_scope(filter));
    let result = work();
    // Scopes are a stack.
    let errors = scopes.into_iter().rev().map(|scope| pollster::block_on(scope.pop()));
    match errors.fold(None, Option::or) {
        None => result,
        Some(wgpu::Error::OutOfMemory { .. }) => Err(GpuError::OutOfMemory),
        // After a device is lost, every call reports an error: the error of `work` says more.
        Some(error) => result.and(Err(GpuError::DeviceError { reason: error.to_string() })),
    }
}

/// The time between two checks of the device and of the token.
const SHORTEST_SLEEP: Duration = Duration::from_micros(20);
const LONGEST_SLEEP: Duration = Duration::from_millis(10);

/// Submits the commands of `record`, followed by copies of `sources`, which have `BufferUsages::COPY_SRC`.
/// Errors: the context's token was cancelled.
pub(crate) fn submit<const N: usize>(
    device: &Device,
    queue: &Queue,
    record: impl FnOnce(&mut CommandEncoder),
    sources: [&Buffer; N],
    context: &Context,
) -> Result<[Readback; N], GpuError> {
    check(context)?;
    let mut encoder = device.create_command_encoder(&Default::default());
    record(&mut encoder);
    let copies = sources.map(|buffer| Readback::record(device, &mut encoder, buffer));
    queue.submit([encoder.finish()]);
    Ok(copies)
}

/// A copy of a buffer that can be mapped for reading.
pub(crate) struct Readback(Buffer);

impl Readback {
    fn record(device: &Device, encoder: &mut CommandEncoder, source: &Buffer) -> Self {
        let copy = device.create_buffer(&BufferDescriptor {
            label: Some("readback"),
            size: source.size(),
            usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        encoder.copy_buffer_to_buffer(source, 0, &copy, 0, source.size());
        Self(copy)
    }

    /// Waits for all submitted work and returns the elements. Errors: the device is lost; the context's token
    /// was cancelled.
    pub fn read<T: AnyBitPattern + NoUninit>(
        self,
        device: &Device,
        context: &Context,
    ) -> Result<Vec<T>, GpuError> {
        let (sender, receiver) = mpsc::channel();
        self.0.map_async(MapMode::Read, .., move |mapped| {
            // The receiver is gone only if this function has already returned an error.
            let _ignored = sender.send(mapped.is_ok());
        });
        wait(device, &receiver, context)?;
        let bytes = self.0.get_mapped_range(..).map_err(|_| GpuError::Lost)?;
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }
}

/// Waits until `is_mapped` says whether a buffer was mapped. Errors: it was not, because the device is lost;
/// the context's token was cancelled, after which the device still finishes its work.
///
/// Without a token it blocks. With one it polls, because a timed wait of wgpu 30 can panic while another
/// thread waits for the same device; it sleeps for an eighth of the time so far, so that it finds the end of
/// the work at most that much later.
fn wait(device: &Device, is_mapped: &mpsc::Receiver<bool>, context: &Context) -> Result<(), GpuError> {
    if !has_token(context) {
        device.poll(PollType::wait_indefinitely()).map_err(|_| GpuError::Lost)?;
        return if is_mapped.recv() == Ok(true) { Ok(()) } else { Err(GpuError::Lost) };
    }
    let start = Instant::now();
    loop {
        check(context)?;
        device.poll(PollType::Poll).map_err(|_| GpuError::Lost)?;
        match is_mapped.try_recv() {
            Ok(true) => return Ok(()),
            Ok(false) | Err(TryRecvError::Disconnected) => return Err(GpuError::Lost),
            Err(TryRecvError::Empty) => {}
        }
        std::thread::sleep((start.elapsed() / 8).clamp(SHORTEST_SLEEP, LONGEST_SLEEP));
    }
}
