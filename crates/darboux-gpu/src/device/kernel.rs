//! Compute pipelines, and how many groups of threads they need.

use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindingResource, Buffer, BufferBinding, BufferDescriptor,
    BufferSize, BufferUsages, CommandEncoder, ComputePipeline, ComputePipelineDescriptor, Device,
    ShaderModule, ShaderModuleDescriptor, ShaderSource,
};

/// Threads of a group. In the stress build as many as Mesa's software adapter runs side by side: with fewer, it runs lanes of no thread, too,
/// which read zeros, and loops that wait for something else end after 65,535 turns.
pub(crate) const WORKGROUP: u32 = if cfg!(small_limits) { 8 } else { 64 };
/// Values that one thread of a prefix sum takes.
pub(crate) const VALUES_PER_THREAD: u32 = if cfg!(small_limits) { 2 } else { 4 };
/// Values of a block of a prefix sum.
pub(crate) const BLOCK: u32 = WORKGROUP * VALUES_PER_THREAD;
/// Groups that an indirect dispatch asks for at most, in its one row.
const MAX_GROUPS: u32 = 65_535;
/// Turns that one thread's loops take at most: drivers end what runs too long, and Mesa's software adapter quietly leaves all loops
/// of a thread after 65,535 turns in sum.
pub(crate) const MAX_TURNS: u32 = 1 << 15;

/// A shader of files that are read one after the other.
pub(crate) fn module(device: &Device, files: &[&str]) -> ShaderModule {
    let source = ShaderSource::Wgsl(text(files).into());
    device.create_shader_module(ShaderModuleDescriptor { label: Some("darboux"), source })
}

/// What every shader's text begins with.
pub(crate) const CONSTANTS: [(&str, u32); 5] = [
    ("WORKGROUP", WORKGROUP),
    ("VALUES_PER_THREAD", VALUES_PER_THREAD),
    ("BLOCK", BLOCK),
    ("MAX_GROUPS", MAX_GROUPS),
    ("MAX_TURNS", MAX_TURNS),
];

/// The text of such a shader.
pub(crate) fn text(files: &[&str]) -> String {
    let constants = CONSTANTS.map(|(name, value)| format!("const {name}: u32 = {value}u;\n")).concat();
    [&constants, &files.join("\n")].map(String::as_str).concat()
}

/// One entry point of a shader.
pub(crate) fn pipeline(device: &Device, module: &ShaderModule, entry_point: &str) -> ComputePipeline {
    device.create_compute_pipeline(&ComputePipelineDescriptor {
        label: Some(entry_point),
        layout: None,
        module,
        entry_point: Some(entry_point),
        compilation_options: Default::default(),
        cache: None,
    })
}

/// A pipeline with its buffers, and how many threads it runs.
#[derive(Clone, Debug)]
pub(crate) struct Step {
    pipeline: ComputePipeline,
    buffers: BindGroup,
    threads: Threads,
}

#[derive(Clone, Debug)]
enum Threads {
    Groups([u32; 2]),
    /// As many as the buffer's first words say.
    Indirect(Buffer),
}

impl Step {
    /// `buffers`: by binding; `threads`: at least this many run, the shader turns others away.
    pub fn new(
        device: &Device,
        pipeline: &ComputePipeline,
        buffers: &[(u32, &Buffer)],
        threads: u32,
    ) -> Self {
        let limit = device.limits().max_compute_workgroups_per_dimension;
        Self {
            pipeline: pipeline.clone(),
            buffers: bind(device, pipeline, buffers),
            threads: Threads::Groups(groups(threads, limit)),
        }
    }

    /// Over a list whose length the device knows.
    pub fn indirect(
        device: &Device,
        pipeline: &ComputePipeline,
        buffers: &[(u32, &Buffer)],
        list: &Buffer,
    ) -> Self {
        Self {
            pipeline: pipeline.clone(),
            buffers: bind(device, pipeline, buffers),
            threads: Threads::Indirect(list.clone()),
        }
    }

    /// Records the step as a pass of its own, which waits for those before it.
    pub fn record(&self, encoder: &mut CommandEncoder) {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.buffers, &[]);
        match &self.threads {
            Threads::Groups([row, rows]) => pass.dispatch_workgroups(*row, *rows, 1),
            Threads::Indirect(list) => pass.dispatch_workgroups_indirect(list, 0),
        }
    }
}

fn bind(device: &Device, pipeline: &ComputePipeline, buffers: &[(u32, &Buffer)]) -> BindGroup {
    let entries: Vec<_> = buffers
        .iter()
        .map(|&(binding, buffer)| BindGroupEntry { binding, resource: whole_words(buffer) })
        .collect();
    let layout = pipeline.get_bind_group_layout(0);
    device.create_bind_group(&BindGroupDescriptor { label: None, layout: &layout, entries: &entries })
}

/// A buffer without the bytes after its last whole word, which cannot be bound.
fn whole_words(buffer: &Buffer) -> BindingResource<'_> {
    BindingResource::Buffer(BufferBinding { buffer, offset: 0, size: BufferSize::new(buffer.size() & !3) })
}

/// Groups for at least `threads` threads, in rows of at most `limit`.
fn groups(threads: u32, limit: u32) -> [u32; 2] {
    let groups = threads.div_ceil(WORKGROUP);
    let row = groups.clamp(1, limit);
    [row, groups.div_ceil(row)]
}

/// A buffer of words that shaders fill.
pub(crate) fn buffer(device: &Device, label: &str, words: u32) -> Buffer {
    device.create_buffer(&BufferDescriptor {
        label: Some(label),
        size: 4 * u64::from(words),
        usage: BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    })
}

/// A buffer with these words.
pub(crate) fn filled(device: &Device, label: &str, contents: &[u8], usage: BufferUsages) -> Buffer {
    let size = contents.len() as u64;
    let descriptor = BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: true };
    let buffer = device.create_buffer(&descriptor);
    // Where there is nothing to write to, the device has said why.
    if let Ok(mut words) = buffer.get_mapped_range_mut(..) {
        words.slice(..).copy_from_slice(contents);
    }
    buffer.unmap();
    buffer
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_go_on_in_a_second_dimension() {
        assert_eq!(groups(0, 65_535), [1, 0]);
        assert_eq!(groups(1, 65_535), [1, 1]);
        assert_eq!(groups(WORKGROUP * 65_535, 65_535), [65_535, 1]);
        assert_eq!(groups(WORKGROUP * 65_535 + 1, 65_535), [65_535, 2]);
        let [row, rows] = groups(u32::MAX, 65_535);
        assert!(u64::from(row) * u64::from(rows) * u64::from(WORKGROUP) >= u64::from(u32::MAX));
    }
}
