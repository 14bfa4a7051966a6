//! Kernels that are written once for several arithmetics, and what is done again where the first was unsure.

use wgpu::{Buffer, BufferDescriptor, BufferUsages, CommandEncoder, ComputePipeline, Device};

use crate::device::kernel::{Step, filled, module, pipeline};

/// How numbers are rounded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// As on the CPU: the same bits on every device.
    #[default]
    Exact,
    /// As the device likes.
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

/// What real numbers are to a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arithmetic {
    /// Floats rounded as the CPU's; where they might not be, whole numbers.
    Exact,
    /// Whole numbers alone, after floats have been tried: what a device would do that is never sure. For tests.
    Soft,
    /// As `Exact`, on a device that takes every liberty with floats. For tests.
    Hostile,
    /// As `Exact`, without whole numbers: the CPU does what floats are unsure of, as in browsers, whose adapters take minutes to compile these.
    /// For tests of MikkTSpace.
    Leaving,
    /// Floats as the device rounds them.
    Fast,
}

const DEVICE: &str = include_str!("../../shaders/precision/device_floats.wgsl");
const HOSTILE: &str = include_str!("../../shaders/precision/hostile_floats.wgsl");
const WHOLE: &[&str] = &[
    include_str!("../../shaders/precision/correct_rounding.wgsl"),
    include_str!("../../shaders/precision/uint64.wgsl"),
    include_str!("../../shaders/precision/arccosine.wgsl"),
];
const EXACT: &str = include_str!("../../shaders/precision/real_exact.wgsl");
const SOFT: &[&str] = &[
    include_str!("../../shaders/precision/soft_float.wgsl"),
    include_str!("../../shaders/precision/real_soft.wgsl"),
];
const FAST: &str = include_str!("../../shaders/precision/real_fast.wgsl");
const VECTORS: &str = include_str!("../../shaders/precision/vectors.wgsl");
const ALL: &str = include_str!("../../shaders/precision/dispatch_all.wgsl");
const SURE: &str = include_str!("../../shaders/precision/dispatch_checked.wgsl");
const LISTED: &str = include_str!("../../shaders/precision/dispatch_listed.wgsl");

/// The whole text of a kernel: arithmetic, its own files, and what calls these. `second`: with what a first kernel has listed.
pub(crate) fn files(arithmetic: Arithmetic, second: bool, own: &[&'static str]) -> Vec<&'static str> {
    let device = if arithmetic == Arithmetic::Hostile { HOSTILE } else { DEVICE };
    let (first, last): (&[&[&str]], &[&str]) = match (arithmetic, second) {
        (Arithmetic::Fast, false) => (&[&[FAST]], &[ALL]),
        (Arithmetic::Fast, true) => (&[&[FAST]], &[LISTED]),
        (_, true) => (&[&[device], WHOLE, SOFT], &[LISTED]),
        (Arithmetic::Soft, false) => {
            (&[&[device], WHOLE, &[EXACT]], &["const ALL_UNSURE: bool = true;", SURE])
        }
        (_, false) => (&[&[device], WHOLE, &[EXACT]], &["const ALL_UNSURE: bool = false;", SURE]),
    };
    [&first.concat()[..], &[VECTORS], own, last].concat()
}

/// A kernel, compiled.
#[derive(Clone, Debug)]
pub(crate) struct RealKernel {
    first: ComputePipeline,
    second: Option<ComputePipeline>,
}

impl RealKernel {
    /// `own`: files with `fn run(item: u32)`, `fn item_count() -> u32` and `fn zero() -> u32`, all numbers in the functions of
    /// shaders/reals.
    pub fn new(device: &Device, arithmetic: Arithmetic, own: &[&'static str]) -> Self {
        let second =
            (arithmetic != Arithmetic::Fast).then(|| compiled(device, &files(arithmetic, true, own)));
        Self { first: compiled(device, &files(arithmetic, false, own)), second }
    }

    /// Of exact arithmetic, with another kernel for what it is unsure of.
    pub fn with_second(device: &Device, own: &[&'static str], second: &[&str]) -> Self {
        let first = files(Arithmetic::Exact, false, own);
        Self { first: compiled(device, &first), second: Some(compiled(device, second)) }
    }
}

fn compiled(device: &Device, files: &[&str]) -> ComputePipeline {
    pipeline(device, &module(device, files), "every_item")
}

/// The binding of the list.
pub(crate) const LIST: u32 = 9;
/// An indirect dispatch of no groups, and an empty list.
const NOTHING: [u32; 4] = [0, 1, 1, 0];

/// Items that a kernel leaves to another, which runs as many threads as there are.
#[derive(Clone, Debug)]
pub(crate) struct List {
    pub items: Buffer,
    nothing: Buffer,
}

impl List {
    /// Room for `items`.
    pub fn new(device: &Device, label: &str, items: u32) -> Self {
        let items = device.create_buffer(&BufferDescriptor {
            label: Some(label),
            size: 4 * (NOTHING.len() as u64 + u64::from(items.max(1))),
            usage: BufferUsages::STORAGE
                | BufferUsages::INDIRECT
                | BufferUsages::COPY_DST
                | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let nothing = filled(device, "nothing", bytemuck::cast_slice(&NOTHING), BufferUsages::COPY_SRC);
        Self { items, nothing }
    }

    pub fn record_clear(&self, encoder: &mut CommandEncoder) {
        encoder.copy_buffer_to_buffer(&self.nothing, 0, &self.items, 0, self.nothing.size());
    }

    /// Records a copy of the number of items to a word of `into`.
    pub fn record_count(&self, encoder: &mut CommandEncoder, into: &Buffer, offset: u64) {
        encoder.copy_buffer_to_buffer(&self.items, 12, into, offset, 4);
    }
}

/// A kernel with its buffers.
#[derive(Clone, Debug)]
pub(crate) struct RealStep {
    first: Step,
    second: Option<(Step, List)>,
}

impl RealStep {
    /// `buffers`: by binding; `items`: how many there are.
    pub fn new(device: &Device, kernel: &RealKernel, buffers: &[(u32, &Buffer)], items: u32) -> Self {
        Self::with_second(device, kernel, buffers, buffers, items)
    }

    /// As [`RealStep::new`], the second kernel with other buffers.
    pub fn with_second(
        device: &Device,
        kernel: &RealKernel,
        buffers: &[(u32, &Buffer)],
        of_second: &[(u32, &Buffer)],
        items: u32,
    ) -> Self {
        let Some(second) = &kernel.second else {
            return Self { first: Step::new(device, &kernel.first, buffers, items), second: None };
        };
        let list = List::new(device, "unsure", items);
        let [buffers, of_second] = [buffers, of_second].map(|own| [own, &[(LIST, &list.items)]].concat());
        let first = Step::new(device, &kernel.first, &buffers, items);
        let step = Step::indirect(device, second, &of_second, &list.items);
        Self { first, second: Some((step, list)) }
    }

    pub fn record(&self, encoder: &mut CommandEncoder) {
        if let Some((_, list)) = &self.second {
            list.record_clear(encoder);
        }
        self.first.record(encoder);
        if let Some((step, _)) = &self.second {
            step.record(encoder);
        }
    }

    /// Records a copy of the number of items done in whole numbers to a word of `into`, which is 0 before.
    pub fn record_count(&self, encoder: &mut CommandEncoder, into: &Buffer, offset: u64) {
        if let Some((_, list)) = &self.second {
            list.record_count(encoder, into, offset);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::average::tests::validate;
    use crate::mikktspace::passes::{DERIVATIVES, EVALUATE, WEDGES};
    use crate::plan::{
        CHECK_TRIANGLES, CHECK_VERTICES, GATHER, NORMALS, REPAIR, TERMS, WRITE, WRITE_NORMALS,
    };

    #[test]
    fn shaders_are_valid_in_every_arithmetic() {
        for arithmetic in [Arithmetic::Exact, Arithmetic::Soft, Arithmetic::Hostile, Arithmetic::Fast] {
            for own in [DERIVATIVES.files, WEDGES.files, EVALUATE.files, TERMS, GATHER] {
                validate(&files(arithmetic, false, own));
                validate(&files(arithmetic, true, own));
            }
        }
        validate(&files(Arithmetic::Fast, true, REPAIR));
        for own in [CHECK_TRIANGLES, CHECK_VERTICES, NORMALS] {
            validate(&files(Arithmetic::Fast, false, own));
        }
        validate(WRITE);
        validate(WRITE_NORMALS);
    }
}
