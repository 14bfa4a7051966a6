//! Library functions on many samples at once, as compute shaders.
//!
//! What is between loading and storing is one line that all three languages read alike, as their functions have the same names.

use wgpu::{BufferUsages, ComputePipelineDescriptor};

use crate::gpu::{Gpu, gpus};
use crate::language::{Language, Stage, library};

const WORKGROUP: usize = 64;

/// A library function, its samples, and what it should give.
pub struct Case<'a, const GIVEN: usize, const GOT: usize> {
    /// Its name, for messages.
    pub name: &'a str,
    /// A statement between `given1..4(offset)`, `given_int(offset)`... and `got1..4(offset, value)`; see the preludes.
    pub body: &'a str,
    /// The words of each sample: bits of floats, or integers.
    pub samples: Vec<[u32; GIVEN]>,
    /// The right answer, and how far from it each component may be.
    pub expected: &'a dyn Fn([u32; GIVEN]) -> ([f64; GOT], f64),
}

/// Runs a case in every language on every adapter. Panics where an answer is off by more than it may be.
pub fn check<const GIVEN: usize, const GOT: usize>(case: &Case<GIVEN, GOT>) {
    let expected: Vec<_> = case.samples.iter().map(|&sample| (case.expected)(sample)).collect();
    for gpu in gpus() {
        for language in Language::ALL {
            let Some(answers) = run(gpu, language, case) else { continue };
            compare(case, &expected, &answers, &format!("{}, {language:?} on {}", case.name, gpu.name));
        }
    }
}

fn compare<const GIVEN: usize, const GOT: usize>(
    case: &Case<GIVEN, GOT>,
    expected: &[([f64; GOT], f64)],
    answers: &[[f32; GOT]],
    title: &str,
) {
    assert_eq!(expected.len(), answers.len());
    let (mut largest, mut of_bound, mut exact) = (0f64, 0f64, 0);
    for ((sample, (right, bound)), answer) in case.samples.iter().zip(expected).zip(answers) {
        let errors = right.iter().zip(answer).map(|(right, &answer)| (right - f64::from(answer)).abs());
        let error =
            errors.fold(0.0, |worst: f64, error| if error > worst { error } else { worst.max(error) });
        let is_near =
            right.iter().zip(answer).all(|(right, &answer)| (right - f64::from(answer)).abs() <= *bound);
        assert!(is_near, "{title}: {answer:?}, not {right:?} to {bound:e}, for {sample:x?}");
        largest = largest.max(error);
        of_bound = of_bound.max(if *bound > 0.0 { error / bound } else { 0.0 });
        exact += usize::from(error == 0.0);
    }
    let count = answers.len();
    println!(
        "{title}: {count} samples, {exact} equal, off by up to {largest:.2e}, {of_bound:.2} of the bound"
    );
}

/// The answers of one language on one adapter; none where the language has no compiler here.
fn run<const GIVEN: usize, const GOT: usize>(
    gpu: &Gpu,
    language: Language,
    case: &Case<GIVEN, GOT>,
) -> Option<Vec<[f32; GOT]>> {
    let module = gpu.module(language, Stage::Compute, &text(language, case))?;
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
    words.resize(groups * WORKGROUP * GIVEN, 0);
    let given = gpu.buffer(&words, BufferUsages::STORAGE);
    let got = gpu.buffer(&vec![0; groups * WORKGROUP * GOT], BufferUsages::STORAGE | BufferUsages::COPY_SRC);
    let read =
        gpu.buffer(&vec![0; groups * WORKGROUP * GOT], BufferUsages::MAP_READ | BufferUsages::COPY_DST);
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
    let floats: Vec<f32> = gpu.words(&read).into_iter().map(f32::from_bits).collect();
    Some(floats.as_chunks().0[..case.samples.len()].to_vec())
}

fn text<const GIVEN: usize, const GOT: usize>(language: Language, case: &Case<GIVEN, GOT>) -> String {
    let prelude = match language {
        Language::Wgsl => include_str!("prelude/kernel.wgsl"),
        Language::Glsl => include_str!("prelude/kernel.glsl"),
        Language::Hlsl => include_str!("prelude/kernel.hlsl"),
    };
    let counts = [("GIVEN", GIVEN), ("GOT", GOT)];
    let prelude =
        counts.iter().fold(prelude.to_owned(), |text, (name, n)| text.replace(name, &format!("{n}u")));
    prelude.replace("LIBRARY", &library(language, Stage::Compute)).replace("BODY", case.body)
}
