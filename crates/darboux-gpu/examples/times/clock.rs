//! Measures the time of commands on the device, and the wall time until they are done.

use std::time::Instant;

use darboux_gpu::Gpu;
use wgpu::{Buffer, BufferDescriptor, BufferUsages, CommandEncoder, Features, QuerySet};

/// Medians in milliseconds.
#[derive(Clone, Copy)]
pub struct Times {
    /// The time between timestamps on the device; none if it does not support timestamps.
    pub device: Option<f64>,
    /// The time from recording until the device has finished.
    pub wall: f64,
}

/// A device with its timestamp queries.
pub struct Clock<'a> {
    gpu: &'a Gpu,
    stamps: Option<QuerySet>,
    resolved: Buffer,
    read: Buffer,
    rounds: usize,
}

impl<'a> Clock<'a> {
    pub fn new(gpu: &'a Gpu, rounds: usize) -> Self {
        let needed = Features::TIMESTAMP_QUERY | Features::TIMESTAMP_QUERY_INSIDE_ENCODERS;
        let stamps = gpu.device.features().contains(needed).then(|| {
            gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: None,
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            })
        });
        let buffer = |usage| {
            gpu.device.create_buffer(&BufferDescriptor {
                label: None,
                size: 16,
                usage,
                mapped_at_creation: false,
            })
        };
        Self {
            gpu,
            stamps,
            resolved: buffer(BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC),
            read: buffer(BufferUsages::MAP_READ | BufferUsages::COPY_DST),
            rounds,
        }
    }

    /// Records, submits and waits, once to warm up and then for the medians.
    pub fn time(&self, record: impl Fn(&mut CommandEncoder)) -> Times {
        self.once(&record);
        let (mut device, mut wall) = (Vec::new(), Vec::new());
        for _ in 0..self.rounds {
            let times = self.once(&record);
            device.extend(times.device);
            wall.push(times.wall);
        }
        Times { device: (!device.is_empty()).then(|| median(device)), wall: median(wall) }
    }

    fn once(&self, record: impl Fn(&mut CommandEncoder)) -> Times {
        let start = Instant::now();
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        if let Some(stamps) = &self.stamps {
            encoder.write_timestamp(stamps, 0);
        }
        record(&mut encoder);
        if let Some(stamps) = &self.stamps {
            encoder.write_timestamp(stamps, 1);
            encoder.resolve_query_set(stamps, 0..2, &self.resolved, 0);
            encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.read, 0, 16);
        }
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("a working device");
        let wall = start.elapsed().as_secs_f64() * 1e3;
        Times { device: self.stamps.as_ref().map(|_| self.stamped()), wall }
    }

    fn stamped(&self) -> f64 {
        self.read.map_async(wgpu::MapMode::Read, .., |result| result.expect("a buffer that can be mapped"));
        self.gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("a working device");
        let bytes = self.read.get_mapped_range(..).expect("a mapped buffer").to_vec();
        self.read.unmap();
        let [start, end] = [0, 8].map(|at| {
            let bytes: [u8; 8] = bytes[at..at + 8].try_into().expect("eight bytes");
            u64::from_le_bytes(bytes)
        });
        end.saturating_sub(start) as f64 * f64::from(self.gpu.queue.get_timestamp_period()) * 1e-6
    }

    /// Measures work on the CPU, as [`Clock::time`] does on the device.
    pub fn time_cpu(&self, mut work: impl FnMut()) -> Times {
        work();
        let mut once = || {
            let start = Instant::now();
            work();
            start.elapsed().as_secs_f64() * 1e3
        };
        // Work on the CPU may take seconds, so it is repeated less often.
        let rounds = self.rounds.min(5);
        Times { device: None, wall: median((0..rounds).map(|_| once()).collect()) }
    }
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
