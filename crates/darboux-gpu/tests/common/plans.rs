//! Runs plans once, and reads their results.

use darboux::{MikkTSpaceOptions, Mode, TangentOptions};
use darboux_gpu::{Attribute, Gpu, GpuError, MovingMesh, Plan, Planner, TangentsPer};
use darboux_tests::OwnedMesh;
use wgpu::BufferUsages;

use super::{UNTOUCHED, buffer, words_of};

/// The results of a plan: four words per corner or vertex, its counts, and the counts of its check, which
/// exists only for triangles.
#[derive(Debug, PartialEq)]
pub struct Found {
    pub words: Vec<u32>,
    pub counts: [u32; 3],
    pub changes: [u32; 5],
}

/// Runs a plan of `base` on the moved mesh `moved`, with one buffer per attribute.
pub fn run(
    planner: &Planner,
    gpu: &Gpu,
    [base, moved]: [&OwnedMesh; 2],
    mode: Mode,
    per: TangentsPer,
) -> Found {
    let options = TangentOptions::from(MikkTSpaceOptions::new().with_mode(mode));
    let plan = planner.plan(&base.view(), &options).unwrap_or_else(|error| panic!("{error}"));
    let words = |values: &[[f32; 3]]| values.as_flattened().iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
    let [positions, normals] =
        [&moved.positions, &moved.normals].map(|list| buffer(gpu, &words(list), usage));
    let outputs = if per == TangentsPer::Corner { base.corner_count() } else { base.positions.len() };
    let tangents = buffer(gpu, &vec![UNTOUCHED; 4 * outputs], usage);
    let floats = |buffer, stride| Attribute { buffer, stride, offset: 0 };
    let moving = MovingMesh {
        vertex_count: moved.positions.len() as u32,
        positions: floats(&positions, 12),
        normals: floats(&normals, 12),
        tangents: floats(&tangents, 16),
        per,
    };
    record(gpu, &plan, &moving)
}

pub fn record(gpu: &Gpu, plan: &Plan, moving: &MovingMesh<'_>) -> Found {
    let run = plan.bind(moving).unwrap_or_else(|error| panic!("{error}"));
    let check = match plan.bind_check(moving) {
        Err(GpuError::NotTriangles) => None,
        check => Some(check.unwrap_or_else(|error| panic!("{error}"))),
    };
    let no_changes = buffer(gpu, &[UNTOUCHED; 5], BufferUsages::COPY_SRC);
    let changes = check.as_ref().map_or(&no_changes, |check| check.counts());
    let sources = [moving.tangents.buffer, run.counts(), changes];
    let reading = BufferUsages::MAP_READ | BufferUsages::COPY_DST;
    let results = sources.map(|source| buffer(gpu, &vec![0; source.size() as usize / 4], reading));
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    run.record(&mut encoder);
    if let Some(check) = &check {
        check.record(&mut encoder);
    }
    for (source, result) in sources.iter().zip(&results) {
        encoder.copy_buffer_to_buffer(source, 0, result, 0, None);
    }
    gpu.queue.submit([encoder.finish()]);
    let [words, counts, changes] = results.map(|result| words_of(gpu, &result));
    let fixed = "the number of counts";
    Found { words, counts: counts.try_into().expect(fixed), changes: changes.try_into().expect(fixed) }
}
