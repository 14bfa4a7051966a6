//! Compiles one kernel source for several kinds of arithmetic, and runs the exact one in two passes.
//!
//! A kernel is written against the scalar type `Real` and its functions (`add`, `multiply`, ...), which
//! `shaders/precision/real_*.wgsl` define three times. Exact arithmetic gives the bits of the CPU on every
//! device:
//!
//! ```text
//! pass 1, every item:       compute with the device's floats, corrected to IEEE rounding; check that every value is in the range in which
//!                           that correction is proven; append the other items to a work list
//! pass 2, listed items:     compute again with floats emulated by integers, which are right for every value
//! ```
//!
//! Pass 2 is an indirect dispatch: the CPU never reads the length of the work list.

use wgpu::{Buffer, BufferDescriptor, BufferUsages, CommandEncoder, ComputePipeline, Device};

use crate::device::buffers::buffer_with_contents;
use crate::device::kernel::{Dispatch, compute_pipeline, shader_module};

/// How numbers are rounded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Precision {
    /// As on the CPU: every device gives the same bits.
    #[default]
    Exact,
    /// As the device rounds.
    Fast,
}

impl From<Precision> for Arithmetic {
    fn from(precision: Precision) -> Self {
        match precision {
            Precision::Exact => Self::Exact,
            Precision::Fast => Self::Fast,
        }
    }
}

/// The arithmetic that a kernel is compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arithmetic {
    /// Corrected floats in the first pass, integers in the second.
    Exact,
    /// As `Exact`, but the first pass lists every item. For tests of the second pass.
    SoftFloat,
    /// As `Exact`, with the floats of a simulated device that rounds as badly as WGSL permits. For tests.
    HostileDevice,
    /// As `Exact`, but the second pass leaves the listed items to the CPU. The npm package does so, because
    /// the software adapters of browsers take minutes to compile the integer arithmetic. For tests of
    /// MikkTSpace.
    CpuFallback,
    /// The device's own floats, in one pass.
    Fast,
}

const DEVICE_FLOATS: &str = include_str!("../../shaders/precision/device_floats.wgsl");
const HOSTILE_FLOATS: &str = include_str!("../../shaders/precision/hostile_floats.wgsl");
const ROUNDING: &[&str] = &[
    include_str!("../../shaders/precision/correct_rounding.wgsl"),
    include_str!("../../shaders/precision/uint64.wgsl"),
    include_str!("../../shaders/precision/arccosine.wgsl"),
];
const REAL_EXACT: &str = include_str!("../../shaders/precision/real_exact.wgsl");
const REAL_SOFT: &[&str] = &[
    include_str!("../../shaders/precision/soft_float.wgsl"),
    include_str!("../../shaders/precision/real_soft.wgsl"),
];
const REAL_FAST: &str = include_str!("../../shaders/precision/real_fast.wgsl");
const VECTORS: &str = include_str!("../../shaders/precision/vectors.wgsl");
const DISPATCH_ALL: &str = include_str!("../../shaders/precision/dispatch_all.wgsl");
const DISPATCH_CHECKED: &str = include_str!("../../shaders/precision/dispatch_checked.wgsl");
const DISPATCH_LISTED: &str = include_str!("../../shaders/precision/dispatch_listed.wgsl");

/// The two passes of [`Arithmetic::Exact`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PassOrder {
    First,
    Second,
}

/// All files of a kernel: the arithmetic, the kernel's own files, and the entry point that calls them.
pub(crate) fn kernel_files(
    arithmetic: Arithmetic,
    order: PassOrder,
    own: &[&'static str],
) -> Vec<&'static str> {
    let floats = if arithmetic == Arithmetic::HostileDevice { HOSTILE_FLOATS } else { DEVICE_FLOATS };
    let (first, last): (&[&[&str]], &[&str]) = match (arithmetic, order) {
        (Arithmetic::Fast, PassOrder::First) => (&[&[REAL_FAST]], &[DISPATCH_ALL]),
        (Arithmetic::Fast, PassOrder::Second) => (&[&[REAL_FAST]], &[DISPATCH_LISTED]),
        (_, PassOrder::Second) => (&[&[floats], ROUNDING, REAL_SOFT], &[DISPATCH_LISTED]),
        (Arithmetic::SoftFloat, PassOrder::First) => {
            (&[&[floats], ROUNDING, &[REAL_EXACT]], &["const ALL_UNSURE: bool = true;", DISPATCH_CHECKED])
        }
        (_, PassOrder::First) => {
            (&[&[floats], ROUNDING, &[REAL_EXACT]], &["const ALL_UNSURE: bool = false;", DISPATCH_CHECKED])
        }
    };
    [&first.concat()[..], &[VECTORS], own, last].concat()
}

/// The pipelines of a kernel: one pass or two.
#[derive(Clone, Debug)]
pub(crate) struct PrecisionKernel {
    first: ComputePipeline,
    second: Option<ComputePipeline>,
}

impl PrecisionKernel {
    /// `own`: files that define `fn run(item: u32)`, `fn item_count() -> u32` and `fn opaque_zero() -> u32`.
    pub fn new(device: &Device, arithmetic: Arithmetic, own: &[&'static str]) -> Self {
        let second = (arithmetic != Arithmetic::Fast)
            .then(|| compile(device, &kernel_files(arithmetic, PassOrder::Second, own)));
        Self { first: compile(device, &kernel_files(arithmetic, PassOrder::First, own)), second }
    }

    /// [`Arithmetic::Exact`] with another kernel as the second pass. `second`: all files of that kernel.
    pub fn with_second(device: &Device, own: &[&'static str], second: &[&str]) -> Self {
        let first = kernel_files(Arithmetic::Exact, PassOrder::First, own);
        Self { first: compile(device, &first), second: Some(compile(device, second)) }
    }
}

fn compile(device: &Device, files: &[&str]) -> ComputePipeline {
    compute_pipeline(device, &shader_module(device, files), "every_item")
}

/// The binding of the work list.
pub(crate) const WORK_LIST_BINDING: u32 = 9;
/// The header of an empty work list: three words of an indirect dispatch without workgroups, then the number
/// of items.
const EMPTY_WORK_LIST: [u32; 4] = [0, 1, 1, 0];

/// Items that one kernel appends and the next one processes with an indirect dispatch.
#[derive(Clone, Debug)]
pub(crate) struct WorkList {
    pub buffer: Buffer,
    empty: Buffer,
}

impl WorkList {
    /// `capacity`: the largest number of items.
    pub fn new(device: &Device, label: &str, capacity: u32) -> Self {
        let buffer = device.create_buffer(&BufferDescriptor {
            label: Some(label),
            size: 4 * (EMPTY_WORK_LIST.len() as u64 + u64::from(capacity.max(1))),
            usage: BufferUsages::STORAGE
                | BufferUsages::INDIRECT
                | BufferUsages::COPY_DST
                | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let contents = bytemuck::cast_slice(&EMPTY_WORK_LIST);
        let empty = buffer_with_contents(device, "empty work list", contents, BufferUsages::COPY_SRC);
        Self { buffer, empty }
    }

    /// Records that the list becomes empty.
    pub fn record_clear(&self, encoder: &mut CommandEncoder) {
        encoder.copy_buffer_to_buffer(&self.empty, 0, &self.buffer, 0, self.empty.size());
    }

    /// Records a copy of the number of items to the word of `destination` at byte `offset`.
    pub fn record_count(&self, encoder: &mut CommandEncoder, destination: &Buffer, offset: u64) {
        encoder.copy_buffer_to_buffer(&self.buffer, 12, destination, offset, 4);
    }
}

/// A [`PrecisionKernel`] with its buffers.
#[derive(Clone, Debug)]
pub(crate) struct PrecisionDispatch {
    first: Dispatch,
    second: Option<(Dispatch, WorkList)>,
}

impl PrecisionDispatch {
    /// `buffers`: buffer of each binding. `items`: the number of items.
    pub fn new(device: &Device, kernel: &PrecisionKernel, buffers: &[(u32, &Buffer)], items: u32) -> Self {
        Self::with_second(device, kernel, buffers, buffers, items)
    }

    /// As [`PrecisionDispatch::new`], with other buffers for the second pass.
    pub fn with_second(
        device: &Device,
        kernel: &PrecisionKernel,
        buffers: &[(u32, &Buffer)],
        second_buffers: &[(u32, &Buffer)],
        items: u32,
    ) -> Self {
        let Some(second) = &kernel.second else {
            return Self { first: Dispatch::new(device, &kernel.first, buffers, items), second: None };
        };
        let unsure = WorkList::new(device, "unsure", items);
        let [buffers, second_buffers] = [buffers, second_buffers]
            .map(|buffers| [buffers, &[(WORK_LIST_BINDING, &unsure.buffer)]].concat());
        let first = Dispatch::new(device, &kernel.first, &buffers, items);
        let second = Dispatch::indirect(device, second, &second_buffers, &unsure.buffer);
        Self { first, second: Some((second, unsure)) }
    }

    /// Records both passes.
    pub fn record(&self, encoder: &mut CommandEncoder) {
        if let Some((_, unsure)) = &self.second {
            unsure.record_clear(encoder);
        }
        self.first.record(encoder);
        if let Some((second, _)) = &self.second {
            second.record(encoder);
        }
    }

    /// Records a copy of the number of items of the second pass to the word of `destination` at byte
    /// `offset`. Without a second pass that word keeps its value.
    pub fn record_count(&self, encoder: &mut CommandEncoder, destination: &Buffer, offset: u64) {
        if let Some((_, unsure)) = &self.second {
            unsure.record_count(encoder, destination, offset);
        }
    }
}
