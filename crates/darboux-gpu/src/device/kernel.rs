//! Compute pipelines from WGSL files, and dispatches of them with their bind groups.

use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindingResource, Buffer, BufferBinding, BufferSize,
    CommandEncoder, ComputePipeline, ComputePipelineDescriptor, Device, ShaderModule, ShaderModuleDescriptor,
    ShaderSource,
};

/// Threads per workgroup. The stress build uses the SIMD width of Mesa's software adapter: with a smaller
/// workgroup, that adapter also runs the unused lanes, which read zeros, and a loop that waits for another
/// value in them ends only after 65,535 iterations.
pub(crate) const WORKGROUP: u32 = if cfg!(small_limits) { 8 } else { 64 };
/// Values that one thread of a prefix sum adds up.
pub(crate) const VALUES_PER_THREAD: u32 = if cfg!(small_limits) { 2 } else { 4 };
/// Values per block of a prefix sum.
pub(crate) const BLOCK: u32 = WORKGROUP * VALUES_PER_THREAD;
/// The most workgroups of an indirect dispatch, which has one dimension.
const MAX_GROUPS: u32 = 65_535;
/// The most loop iterations of one thread. Drivers kill kernels that run too long, and Mesa's software
/// adapter silently leaves all loops of a thread after 65,535 iterations in total.
pub(crate) const MAX_ITERATIONS: u32 = 1 << 15;

/// The constants that every shader's source begins with.
pub(crate) const CONSTANTS: [(&str, u32); 5] = [
    ("WORKGROUP", WORKGROUP),
    ("VALUES_PER_THREAD", VALUES_PER_THREAD),
    ("BLOCK", BLOCK),
    ("MAX_GROUPS", MAX_GROUPS),
    ("MAX_ITERATIONS", MAX_ITERATIONS),
];

/// The source of a shader: the constants, then the files concatenated.
pub(crate) fn shader_source(files: &[&str]) -> String {
    let constants = CONSTANTS.map(|(name, value)| format!("const {name}: u32 = {value}u;\n")).concat();
    [&constants, &files.join("\n")].map(String::as_str).concat()
}

/// Compiles the concatenated files.
pub(crate) fn shader_module(device: &Device, files: &[&str]) -> ShaderModule {
    let source = ShaderSource::Wgsl(shader_source(files).into());
    device.create_shader_module(ShaderModuleDescriptor { label: Some("darboux"), source })
}

/// The pipeline of one entry point.
pub(crate) fn compute_pipeline(device: &Device, module: &ShaderModule, entry_point: &str) -> ComputePipeline {
    device.create_compute_pipeline(&ComputePipelineDescriptor {
        label: Some(entry_point),
        layout: None,
        module,
        entry_point: Some(entry_point),
        compilation_options: Default::default(),
        cache: None,
    })
}

/// A pipeline with its bind group and its number of threads.
#[derive(Clone, Debug)]
pub(crate) struct Dispatch {
    pipeline: ComputePipeline,
    bind_group: BindGroup,
    workgroups: Workgroups,
}

#[derive(Clone, Debug)]
enum Workgroups {
    Direct([u32; 2]),
    /// The first three words of the buffer are the number of workgroups.
    Indirect(Buffer),
}

impl Dispatch {
    /// `buffers`: buffer of each binding. At least `threads` threads run; the shader returns early in the
    /// surplus ones.
    pub fn new(
        device: &Device,
        pipeline: &ComputePipeline,
        buffers: &[(u32, &Buffer)],
        threads: u32,
    ) -> Self {
        let limit = device.limits().max_compute_workgroups_per_dimension;
        Self {
            pipeline: pipeline.clone(),
            bind_group: bind_group(device, pipeline, buffers),
            workgroups: Workgroups::Direct(workgroup_grid(threads, limit)),
        }
    }

    /// A dispatch over a work list whose length only the device knows.
    pub fn indirect(
        device: &Device,
        pipeline: &ComputePipeline,
        buffers: &[(u32, &Buffer)],
        work_list: &Buffer,
    ) -> Self {
        Self {
            pipeline: pipeline.clone(),
            bind_group: bind_group(device, pipeline, buffers),
            workgroups: Workgroups::Indirect(work_list.clone()),
        }
    }

    /// Records a compute pass with this one dispatch. It sees what earlier passes wrote.
    pub fn record(&self, encoder: &mut CommandEncoder) {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bind_group, &[]);
        match &self.workgroups {
            Workgroups::Direct([columns, rows]) => pass.dispatch_workgroups(*columns, *rows, 1),
            Workgroups::Indirect(work_list) => pass.dispatch_workgroups_indirect(work_list, 0),
        }
    }
}

fn bind_group(device: &Device, pipeline: &ComputePipeline, buffers: &[(u32, &Buffer)]) -> BindGroup {
    let entries: Vec<_> = buffers
        .iter()
        .map(|&(binding, buffer)| BindGroupEntry { binding, resource: whole_words(buffer) })
        .collect();
    let layout = pipeline.get_bind_group_layout(0);
    device.create_bind_group(&BindGroupDescriptor { label: None, layout: &layout, entries: &entries })
}

/// The binding of a buffer without the bytes after its last whole word, because wgpu binds only multiples of
/// 4 bytes.
fn whole_words(buffer: &Buffer) -> BindingResource<'_> {
    BindingResource::Buffer(BufferBinding { buffer, offset: 0, size: BufferSize::new(buffer.size() & !3) })
}

/// Columns and rows of workgroups for at least `threads` threads, with at most `limit` columns.
fn workgroup_grid(threads: u32, limit: u32) -> [u32; 2] {
    let groups = threads.div_ceil(WORKGROUP);
    let columns = groups.clamp(1, limit);
    [columns, groups.div_ceil(columns)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn workgroups_continue_in_a_second_dimension() {
        assert_eq!(workgroup_grid(0, 65_535), [1, 0]);
        assert_eq!(workgroup_grid(1, 65_535), [1, 1]);
        assert_eq!(workgroup_grid(WORKGROUP * 65_535, 65_535), [65_535, 1]);
        assert_eq!(workgroup_grid(WORKGROUP * 65_535 + 1, 65_535), [65_535, 2]);
        let [columns, rows] = workgroup_grid(u32::MAX, 65_535);
        assert!(u64::from(columns) * u64::from(rows) * u64::from(WORKGROUP) >= u64::from(u32::MAX));
    }
}
