//! Library functions on many samples at once, as compute shaders.
//!
//! What is between loading and storing is one line that all three languages read alike, as their functions have the same names.

use wgpu::{BufferUsages, ComputePipelineDescriptor};

use crate::gpu::{Gpu, gpus};
use crate::language::{Language, Stage, library};

const WORKGROUP: usize = 64;

/// A library function, its samples, and what it should give.
pub struct Case<'a> {
    /// Its name, for messages.
    pub name: &'a str,
    /// A statement that loads with `given1(offset)`, `given_int2(offset)`... and stores with `got3(offset, value)`...; see the preludes.
    pub body: &'a str,
    /// The words of each sample: bits of floats, or integers. As many in each.
    pub samples: Vec<Vec<u32>>,
    /// The right answer, and how far from it each component may be.
    pub expected: &'a dyn Fn(&[u32]) -> (Vec<f64>, f64),
}

/// Runs a case in every language on every adapter. Panics where an answer is off by more than it may be.
pub fn check(case: &Case) {
    let expected: Vec<_> = case.samples.iter().map(|sample| (case.expected)(sample)).collect();
    let width = expected[0].0.len();
    for gpu in gpus() {
        for language in Language::ALL {
            let Some(answers) = run(gpu, language, case, width) else { continue };
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
        assert!(is_near, "{title}: {answer:?}, not {right:?} to {bound:e}, for {sample:x?}");
        let error = errors.into_iter().fold(0.0, f64::max);
        largest = largest.max(error);
        of_bound = of_bound.max(if *bound > 0.0 { error / bound } else { 0.0 });
    }
    let count = case.samples.len();
    println!("{title}: {count} samples, off by up to {largest:.2e}, {of_bound:.2} of the bound");
}

/// The answers of one language on one adapter, `width` for each sample; none where the language has no compiler here.
fn run(gpu: &Gpu, language: Language, case: &Case, width: usize) -> Option<Vec<f32>> {
    let module = gpu.module(language, Stage::Compute, &text(language, case, width))?;
    let pipeline = gpu.device.create_compute_pipeline(&ComputePipelineDescriptor {
        label: Some(case.name),
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: Default::default(),
        cache: None,
    });
    let groups = case.samples.len().div_ceil(WORKGROUP);
    let mut words = case.samples.concat();
    words.resize(groups * WORKGROUP * case.samples[0].len(), 0);
    let empty = vec![0; groups * WORKGROUP * width];
    let given = gpu.buffer(&words, BufferUsages::STORAGE);
    let got = gpu.buffer(&empty, BufferUsages::STORAGE | BufferUsages::COPY_SRC);
    let read = gpu.buffer(&empty, BufferUsages::MAP_READ | BufferUsages::COPY_DST);
    let entries = [(0, &given), (1, &got)]
        .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() });
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(groups.try_into().expect("fewer samples"), 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&got, 0, &read, 0, None);
    gpu.queue.submit([encoder.finish()]);
    Some(gpu.words(&read).into_iter().map(f32::from_bits).collect())
}

fn text(language: Language, case: &Case, width: usize) -> String {
    let prelude = match language {
        Language::Wgsl => include_str!("prelude/kernel.wgsl"),
        Language::Glsl => include_str!("prelude/kernel.glsl"),
        Language::Hlsl => include_str!("prelude/kernel.hlsl"),
    };
    prelude
        .replace("GIVEN", &format!("{}u", case.samples[0].len()))
        .replace("GOT", &format!("{width}u"))
        .replace("LIBRARY", &library(language, Stage::Compute))
        .replace("BODY", case.body)
}
