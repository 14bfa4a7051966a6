//! Welding: which vertices are one.

use wgpu::{Buffer, CommandEncoder, ComputePipeline, Device};

use crate::GpuError;
use crate::buffers::{Description, check_size};
use crate::kernel::{Step, buffer, module, pipeline};

/// The files of the shader.
pub(crate) const WELD: &[&str] = &[
    include_str!("../shaders/mesh.wgsl"),
    include_str!("../shaders/words.wgsl"),
    include_str!("../shaders/common.wgsl"),
    include_str!("../shaders/weld.wgsl"),
];

/// What [`Weld::new`] needs, compiled once.
#[derive(Clone, Debug)]
pub(crate) struct WeldKernels {
    weld: ComputePipeline,
    look_up: ComputePipeline,
}

impl WeldKernels {
    pub fn new(device: &Device) -> Self {
        let module = module(device, WELD);
        Self { weld: pipeline(device, &module, "weld"), look_up: pipeline(device, &module, "look_up") }
    }
}

/// The welded vertex of every vertex of one mesh: the first that equals it.
#[derive(Clone, Debug)]
pub(crate) struct Weld {
    pub welded: Buffer,
    slots: Buffer,
    steps: [Step; 2],
}

impl Weld {
    /// `words`: `description` as a uniform. Errors: the device binds no buffer of that size.
    pub fn new(
        device: &Device,
        kernels: &WeldKernels,
        description: &Description,
        words: &Buffer,
        vertices: &Buffer,
        counts: &Buffer,
    ) -> Result<Self, GpuError> {
        let count = description.vertex_count;
        let slot_count = slot_count(count);
        check_size(device, "the hash table of vertices", 4 * u64::from(slot_count))?;
        let welded = buffer(device, "welded", count);
        let slots = buffer(device, "slots", slot_count);
        let filling = [(0, words), (2, vertices), (3, &slots), (5, counts)];
        let reading = [&filling[..], &[(4, &welded)]].concat();
        let steps = [
            Step::new(device, &kernels.weld, &filling, count),
            Step::new(device, &kernels.look_up, &reading, count),
        ];
        Ok(Self { welded, slots, steps })
    }

    pub fn record(&self, encoder: &mut CommandEncoder) {
        encoder.clear_buffer(&self.slots, 0, None);
        self.steps.iter().for_each(|step| step.record(encoder));
    }
}

/// The slots of a hash table: a power of two, at least twice what it holds, so that the way to a slot is short; in the stress build hardly
/// more.
pub(crate) fn slot_count(held: u32) -> u32 {
    let least = if cfg!(small_limits) { held + 1 } else { 2 * held };
    least.next_power_of_two()
}
