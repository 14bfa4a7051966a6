//! Runs a function of the library on many samples at once, in a compute or a fragment shader.
//!
//! The call of the function is one line, which is valid in all three languages because the functions have the
//! same names in all of them.

use wgpu::{BufferUsages, ComputePipelineDescriptor};

use crate::adapters::{Gpu, gpus};
use crate::language::{Language, Stage, library};

/// Threads per workgroup in the preludes.
const WORKGROUP: usize = 64;
/// Quads of four pixels per row of the render target.
const QUADS: usize = 128;

/// A function of the library with samples and expected results.
pub struct Case<'a> {
    /// The name in messages.
    pub name: &'a str,
    /// A statement that loads arguments with `given1(offset)`, `given_int2(offset)`, ... and stores results
    /// with `got3(offset, value)`, ...; see the preludes.
    pub body: &'a str,
    /// The words of each sample: bits of floats, or integers. All samples have the same length.
    pub samples: Vec<Vec<u32>>,
    /// The expected result of a sample.
    pub expected: &'a Expected<'a>,
}

/// Returns the correct result of a sample, and the largest error of a component.
pub type Expected<'a> = dyn Fn(&[u32]) -> (Vec<f64>, f64) + 'a;

/// Runs a case in every language on every adapter. Panics if an error is larger than expected.
pub fn check(case: &Case) {
    check_in(Stage::Compute, case);
}

/// As [`check`], in fragment shaders. A quad of four pixels computes each sample, and all four must be
/// correct. Values that the body loads with `spread2(offset)` or `spread3(offset)` change linearly from pixel
/// to pixel.
pub fn check_in_quads(mut case: Case) {
    case.samples = case.samples.into_iter().flat_map(|sample| std::iter::repeat_n(sample, 4)).collect();
    check_in(Stage::Fragment, &case);
}

fn check_in(stage: Stage, case: &Case) {
    let expected: Vec<_> = case.samples.iter().map(|sample| (case.expected)(sample)).collect();
    let width = expected[0].0.len();
    for gpu in gpus() {
        for language in Language::ALL {
            let Some(answers) = run(gpu, language, stage, case, width) else { continue };
            compare(case, &expected, &answers, &format!("{}, {language:?} on {}", case.name, gpu.name));
        }
    }
}

fn compare(case: &Case, expected: &[(Vec<f64>, f64)], answers: &[f32], title: &str) {
    let (mut largest, mut of_bound) = (0f64, 0f64);
    let answers = answers.chunks(expected[0].0.len());
    for ((sample, (right, bound)), answer) in case.samples.iter().zip(expected).zip(answers) {
        let errors: Vec<f64> = right.iter().zip(answer).map(|(x, &y)| (x - f64::from(y)).abs()).collect();
        let is_near = errors.iter().all(|error| error <= bound);
        assert!(is_near, "{title}: {answer:?} instead of {right:?} within {bound:e}, for {sample:x?}");
        let error = errors.into_iter().fold(0.0, f64::max);
        largest = largest.max(error);
        of_bound = of_bound.max(if *bound > 0.0 { error / bound } else { 0.0 });
    }
    let count = case.samples.len();
    println!("{title}: {count} samples, errors up to {largest:.2e}, {of_bound:.2} of the bound");
}

/// The results of one language on one adapter, `width` floats per sample; none if the compiler of the
/// language is not installed.
fn run(gpu: &Gpu, language: Language, stage: Stage, case: &Case, width: usize) -> Option<Vec<f32>> {
    let module = gpu.module(language, stage, &source_text(language, stage, case, width))?;
    let threads =
        case.samples.len().next_multiple_of(if stage == Stage::Compute { WORKGROUP } else { 4 * QUADS });
    let mut words = case.samples.concat();
    words.resize(threads * case.samples[0].len(), 0);
    let empty = vec![0; threads * width];
    let given = gpu.buffer(&words, BufferUsages::STORAGE);
    let got = gpu.buffer(&empty, BufferUsages::STORAGE | BufferUsages::COPY_SRC);
    let read = gpu.buffer(&empty, BufferUsages::MAP_READ | BufferUsages::COPY_DST);

    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    match stage {
        Stage::Compute => dispatch(gpu, &mut encoder, &module, [&given, &got], threads / WORKGROUP),
        Stage::Fragment => draw(gpu, &mut encoder, &module, [&given, &got], threads / (4 * QUADS)),
    }
    encoder.copy_buffer_to_buffer(&got, 0, &read, 0, None);
    gpu.queue.submit([encoder.finish()]);
    Some(gpu.words(&read).into_iter().map(f32::from_bits).collect())
}

fn dispatch(
    gpu: &Gpu,
    encoder: &mut wgpu::CommandEncoder,
    module: &wgpu::ShaderModule,
    buffers: [&wgpu::Buffer; 2],
    groups: usize,
) {
    let pipeline = gpu.device.create_compute_pipeline(&ComputePipelineDescriptor {
        label: None,
        layout: None,
        module,
        entry_point: Some("main"),
        compilation_options: Default::default(),
        cache: None,
    });
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &gpu.bind_group(&pipeline.get_bind_group_layout(0), &buffers), &[]);
    pass.dispatch_workgroups(small(groups), 1, 1);
}

fn draw(
    gpu: &Gpu,
    encoder: &mut wgpu::CommandEncoder,
    module: &wgpu::ShaderModule,
    buffers: [&wgpu::Buffer; 2],
    rows: usize,
) {
    let vertex = gpu.module(Language::Wgsl, Stage::Fragment, include_str!("prelude/vertex.wgsl"));
    let vertex = vertex.expect("a shader of WGSL");
    let pipeline = gpu.render_pipeline(&vertex, &[], module);
    let [width, height] = [small(2 * QUADS), small(2 * rows)];
    let target = gpu.target([width, height]);
    let mut pass = gpu.begin_pass(encoder, &target);
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &gpu.bind_group(&pipeline.get_bind_group_layout(0), &buffers), &[]);
    // The target is a quarter of the viewport, so that one triangle covers it. At an edge between two
    // triangles, both would compute a quad, and the derivatives of pixels outside a triangle are
    // unspecified.
    pass.set_viewport(0.0, 0.0, (2 * width) as f32, (2 * height) as f32, 0.0, 1.0);
    pass.draw(0..3, 0..1);
}

fn small(count: usize) -> u32 {
    count.try_into().expect("fewer samples")
}

fn source_text(language: Language, stage: Stage, case: &Case, width: usize) -> String {
    let prelude = match language {
        Language::Wgsl => include_str!("prelude/kernel.wgsl"),
        Language::Glsl => include_str!("prelude/kernel.glsl"),
        Language::Hlsl => include_str!("prelude/kernel.hlsl"),
    };
    let entry = match (language, stage) {
        (Language::Wgsl, Stage::Compute) => include_str!("prelude/compute.wgsl"),
        (Language::Glsl, Stage::Compute) => include_str!("prelude/compute.glsl"),
        (Language::Hlsl, Stage::Compute) => include_str!("prelude/compute.hlsl"),
        (Language::Wgsl, Stage::Fragment) => include_str!("prelude/fragment.wgsl"),
        (Language::Glsl, Stage::Fragment) => include_str!("prelude/fragment.glsl"),
        (Language::Hlsl, Stage::Fragment) => include_str!("prelude/fragment.hlsl"),
    };
    [prelude, entry]
        .concat()
        .replace("GIVEN", &format!("{}u", case.samples[0].len()))
        .replace("GOT", &format!("{width}u"))
        .replace("QUADS", &format!("{QUADS}u"))
        .replace("LIBRARY", &library(language, stage))
        .replace("BODY", case.body)
}
