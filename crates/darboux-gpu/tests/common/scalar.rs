//! Runs WGSL functions of single numbers on many samples at once.

use darboux_gpu::Gpu;
use wgpu::{BufferUsages, ComputePipelineDescriptor, ShaderModuleDescriptor, ShaderSource};

use super::{buffer, words_of};

/// The source after the tested files. A sample has `GIVEN` words, a result `GOT` words.
const PRELUDE: &str = "
@group(0) @binding(0) var<storage, read> given: array<u32>;
@group(0) @binding(1) var<storage, read_write> got: array<u32>;

fn opaque_zero() -> u32 {
    return given[arrayLength(&given) - 1u];
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let sample = thread.x + thread.y * groups.x * 64u;
    if sample >= (arrayLength(&given) - 1u) / GIVENu {
        return;
    }
    let at = sample * GIVENu;
    let into = sample * GOTu;
    BODY
}
";

/// The most samples per dispatch.
const BATCH: usize = 1 << 20;

/// Runs `body` on samples of `N` words, with results of `M` words. It reads `given[at]`, ... and writes
/// `got[into]`, ...
pub fn map<const N: usize, const M: usize>(
    gpu: &Gpu,
    files: &[&str],
    body: &str,
    samples: &[[u32; N]],
) -> Vec<[u32; M]> {
    let prelude =
        PRELUDE.replace("GIVEN", &N.to_string()).replace("GOT", &M.to_string()).replace("BODY", body);
    let text = [&files.concat(), &prelude].map(String::as_str).concat();
    let source = ShaderSource::Wgsl(text.into());
    let module = gpu.device.create_shader_module(ShaderModuleDescriptor { label: None, source });
    let pipeline = gpu.device.create_compute_pipeline(&ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: Default::default(),
        cache: None,
    });
    samples.chunks(BATCH).flat_map(|samples| batch(gpu, &pipeline, samples)).collect()
}

fn batch<const N: usize, const M: usize>(
    gpu: &Gpu,
    pipeline: &wgpu::ComputePipeline,
    samples: &[[u32; N]],
) -> Vec<[u32; M]> {
    let words = [samples.as_flattened(), &[0]].concat();
    let given = buffer(gpu, &words, BufferUsages::STORAGE);
    let empty = vec![0; samples.len() * M];
    let got = buffer(gpu, &empty, BufferUsages::STORAGE | BufferUsages::COPY_SRC);
    let read = buffer(gpu, &empty, BufferUsages::MAP_READ | BufferUsages::COPY_DST);
    let entries = [
        wgpu::BindGroupEntry { binding: 0, resource: given.as_entire_binding() },
        wgpu::BindGroupEntry { binding: 1, resource: got.as_entire_binding() },
    ];
    let layout = pipeline.get_bind_group_layout(0);
    let descriptor = wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries };
    let group = gpu.device.create_bind_group(&descriptor);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(samples.len().div_ceil(64) as u32, 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&got, 0, &read, 0, None);
    gpu.queue.submit([encoder.finish()]);
    words_of(gpu, &read).as_chunks().0.to_vec()
}
