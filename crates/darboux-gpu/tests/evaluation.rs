//! Compares the derivatives and frames of the shaders with the core, bit by bit. The groups are those of the
//! core.

mod common;

use std::collections::HashMap;
use std::sync::Mutex;

use common::{buffer, gpus, words_of};
use darboux::internal::stage_arrays::{NONE, Stages};
use darboux::{Context, Frame, MikkTSpaceOptions, Mode, generate_frames};
use darboux_gpu::Gpu;
use darboux_gpu::internal::{Arithmetic, Evaluation, EvaluationKernels, GroupedMesh};
use darboux_tests::{Case, OwnedMesh, corpus, families};
use wgpu::BufferUsages;

/// Several meshes as one: their welded vertices, triangles and groups, and the results of the core.
#[derive(Default)]
struct Batch {
    vertices: Vec<u32>,
    vertex_of_corner: Vec<u32>,
    triangle_flags: Vec<u32>,
    seed_of_corner: Vec<u32>,
    /// Eight words per triangle, and its orientation; none for halves of quads, whose orientation depends on
    /// the other half.
    derivatives: Vec<([u32; 8], u32)>,
    /// Eight words per corner; none for corners with several sums.
    frames: Vec<Option<[u32; 8]>>,
    /// The first triangle of each mesh, and its name.
    names: Vec<(usize, String)>,
}

const ALL: &[Arithmetic] = &[Arithmetic::Exact, Arithmetic::HostileDevice, Arithmetic::SoftFloat];

/// The most members of all sums of one mesh.
const LIMIT: usize = 1 << 22;

fn bits(x: f32) -> u32 {
    if x.is_nan() { f32::NAN } else { x }.to_bits()
}

fn words(s: [f32; 3], t: [f32; 3], magnitude: [f32; 2]) -> [u32; 8] {
    let [a, b, c] = s.map(bits);
    let [d, e, f] = t.map(bits);
    let [m, n] = magnitude.map(bits);
    [a, b, c, d, e, f, m, n]
}

fn without_sign_of_zero(word: u32) -> u32 {
    if word == 1 << 31 { 0 } else { word }
}

impl Batch {
    fn add(&mut self, name: &str, mesh: &OwnedMesh, threshold: f32) {
        let view = mesh.view();
        let options = MikkTSpaceOptions::new().with_mode(Mode::Reference).with_threshold(threshold);
        let stages = Stages::new(&view, &options, &mut Context::new(), LIMIT).unwrap().expect("small groups");
        let frames = generate_frames(&view, &options.into()).corners;
        let good = &stages.triangulation.good;
        let first_triangle = self.triangles();
        self.names.push((first_triangle, name.to_owned()));
        let mut vertices = HashMap::new();
        let mut vertex = |corner: u32| {
            let (position, normal, uv) = mesh.vertex(mesh.vertex_of_corner(corner as usize));
            *vertices.entry(corner).or_insert_with(|| {
                self.vertices.extend(position.iter().chain(&normal).chain(&uv).map(|x| x.to_bits()));
                self.vertices.len() as u32 / 8 - 1
            })
        };
        self.vertex_of_corner.extend(good.vertices.as_flattened().iter().map(|&corner| vertex(corner)));
        for (t, derivative) in stages.derivatives.iter().enumerate() {
            let second = t > 0 && good.face[t - 1] == good.face[t];
            let first = good.face.get(t + 1) == Some(&good.face[t]);
            let triangle_flags = u32::from(stages.preserves[t]) | u32::from(derivative.joins_any) << 1;
            self.triangle_flags.push(triangle_flags | u32::from(second) << 3);
            // The derivatives of UV-degenerate triangles are not used.
            let values = words(derivative.s, derivative.t, derivative.magnitude).map(without_sign_of_zero);
            let sides = if first || second { NONE } else { u32::from(derivative.preserves) };
            self.derivatives.push((values, sides));
        }
        self.add_groups(&stages, frames.per_corner(), 3 * first_triangle);
    }

    fn add_groups(&mut self, stages: &Stages, frames: &[Frame], first: usize) {
        let corners = stages.triangulation.good.corners.as_flattened();
        self.seed_of_corner.resize(first + corners.len(), NONE);
        for group in 0..stages.groups.ends().len() {
            let members = stages.groups.members(group);
            for &member in members {
                self.seed_of_corner[first + member as usize] = first as u32 + members[0];
            }
        }
        for (&corner, &seed) in corners.iter().zip(&self.seed_of_corner[first..]) {
            let sums = stages.sums.of_corner[corner as usize];
            let frame = &frames[corner as usize];
            let values = words(frame.tangent, frame.bitangent, frame.magnitude);
            // The average of a frame with itself is that frame, unless it has a NaN.
            let is_nan = values.contains(&f32::NAN.to_bits());
            let is_one = sums[1] == NONE || (sums[0] == sums[1] && !is_nan);
            self.frames.push((seed != NONE && is_one).then_some(values));
        }
    }

    fn triangles(&self) -> usize {
        self.triangle_flags.len()
    }

    /// The triangles at each vertex, and the ends of their ranges.
    fn adjacency(&self) -> [Vec<u32>; 2] {
        let mut of_vertex = vec![Vec::new(); self.vertices.len() / 8];
        for (corner, &vertex) in self.vertex_of_corner.iter().enumerate() {
            of_vertex[vertex as usize].push(corner as u32 / 3);
        }
        let ends = of_vertex.iter().scan(0, |end, list| {
            *end += list.len() as u32;
            Some(*end)
        });
        [of_vertex.concat(), ends.collect()]
    }

    fn name(&self, triangle: usize) -> &str {
        let at = self.names.partition_point(|(first, _)| *first <= triangle);
        &self.names[at - 1].1
    }

    fn check(&self, threshold: f32, arithmetics: &[Arithmetic]) {
        for gpu in gpus() {
            arithmetics.iter().for_each(|&arithmetic| self.check_on(gpu, arithmetic, threshold));
        }
    }

    fn check_on(&self, gpu: &Gpu, arithmetic: Arithmetic, threshold: f32) {
        let found = self.run(gpu, arithmetic, threshold);
        let name = |triangle| format!("{}, triangle {triangle}, {arithmetic:?}", self.name(triangle));
        for (t, (expected, sides)) in self.derivatives.iter().enumerate() {
            if *sides != NONE {
                assert_eq!(found.triangle_flags[t] & 1, *sides, "{}: orientation", name(t));
            }
            assert_eq!(found.triangle_flags[t] & 2, self.triangle_flags[t] & 2, "{}: any", name(t));
            // Results do not depend on the signs of these zeros.
            let derivatives = canonical(&found.derivatives, t).map(without_sign_of_zero);
            assert_eq!(derivatives, *expected, "{}: derivatives", name(t));
        }
        let mut compared = 0;
        for (corner, expected) in self.frames.iter().enumerate() {
            if let Some(expected) = expected {
                let frame = canonical(&found.frames, corner);
                assert_eq!(frame, *expected, "{}, corner {}: frame", name(corner / 3), corner % 3);
                compared += 1;
            }
        }
        println!(
            "{} on {}, {arithmetic:?}: {} triangles and {compared} corners identical; computed with integers: {:?}",
            self.names[0].1,
            gpu.name,
            self.triangles(),
            found.counts
        );
        let all = [self.triangles(), self.triangles(), 3 * self.triangles()].map(|count| count as u32);
        assert!(arithmetic != Arithmetic::SoftFloat || found.counts == all);
    }

    fn run(&self, gpu: &Gpu, arithmetic: Arithmetic, threshold: f32) -> Found {
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let [vertices, vertex_of_corner, triangle_flags, own_flags, seed_of_corner] = [
            &self.vertices,
            &self.vertex_of_corner,
            &self.triangle_flags,
            &vec![0; self.triangle_flags.len()],
            &self.seed_of_corner,
        ]
        .map(|words| buffer(gpu, words, usage));
        let [adjacent_triangles, ends] = self.adjacency().map(|words| buffer(gpu, &words, usage));
        let grouped = GroupedMesh {
            vertices: &vertices,
            vertex_of_corner: &vertex_of_corner,
            adjacency_ends: &ends,
            adjacent_triangles: &adjacent_triangles,
            triangle_flags: &own_flags,
            seed_of_corner: &seed_of_corner,
        };
        let sizes = [self.vertices.len() as u32 / 8, self.triangles() as u32];
        let cosine = ((threshold * std::f32::consts::PI / 180.0) as f64).cos() as f32;
        let evaluation = Evaluation::new(&gpu.device, &kernels(gpu, arithmetic), sizes, cosine, &grouped)
            .unwrap_or_else(|error| panic!("{error}"));
        let read = |buffer_: &wgpu::Buffer| {
            let words = vec![0; buffer_.size() as usize / 4];
            buffer(gpu, &words, BufferUsages::MAP_READ | BufferUsages::COPY_DST)
        };
        let sources = [&own_flags, &evaluation.derivatives, &evaluation.frames, &evaluation.counts];
        let results = sources.map(read);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        evaluation.record_derivatives(&mut encoder);
        encoder.copy_buffer_to_buffer(&own_flags, 0, &results[0], 0, None);
        encoder.copy_buffer_to_buffer(&triangle_flags, 0, &own_flags, 0, None);
        evaluation.record_frames(&mut encoder);
        for (source, result) in sources.iter().zip(&results).skip(1) {
            encoder.copy_buffer_to_buffer(source, 0, result, 0, None);
        }
        gpu.queue.submit([encoder.finish()]);
        let [triangle_flags, derivatives, frames, counts] = results.map(|result| words_of(gpu, &result));
        Found { triangle_flags, derivatives, frames, counts: [counts[0], counts[1], counts[2]] }
    }
}

/// Compiled once.
fn kernels(gpu: &Gpu, arithmetic: Arithmetic) -> EvaluationKernels {
    static COMPILED: Mutex<Vec<(wgpu::Device, Arithmetic, EvaluationKernels)>> = Mutex::new(Vec::new());
    let mut compiled = COMPILED.lock().expect("no panic");
    let found = compiled.iter().find(|(device, of, _)| *device == gpu.device && *of == arithmetic);
    if let Some((.., kernels)) = found {
        return kernels.clone();
    }
    let kernels = EvaluationKernels::new(&gpu.device, arithmetic);
    compiled.push((gpu.device.clone(), arithmetic, kernels.clone()));
    kernels
}

struct Found {
    triangle_flags: Vec<u32>,
    derivatives: Vec<u32>,
    frames: Vec<u32>,
    counts: [u32; 3],
}

/// Eight words, with all NaNs replaced by one.
fn canonical(words: &[u32], at: usize) -> [u32; 8] {
    std::array::from_fn(|k| bits(f32::from_bits(words[8 * at + k])))
}

#[test]
fn families_are_as_in_the_core() {
    let mut batch = Batch::default();
    batch.add("grid", &families::grid(37, 23, false, false), 180.0);
    batch.add("mirrored quads", &families::grid(30, 30, true, true), 180.0);
    batch.add("sphere", &families::sphere(20, 31, false), 180.0);
    batch.add("fan", &families::fan(1_000, false), 180.0);
    batch.add("moebius", &families::moebius(64, false), 180.0);
    batch.check(180.0, ALL);
}

#[test]
fn the_corpus_is_as_in_the_core() {
    let mut batch = Batch::default();
    for corpus_case in corpus::corpus() {
        batch.add(&corpus_case.name, &corpus_case.mesh, 180.0);
    }
    batch.check(180.0, ALL);
}

#[test]
fn random_meshes_are_as_in_the_core() {
    const EXACT: &[Arithmetic] = &[Arithmetic::Exact, Arithmetic::HostileDevice];
    for (threshold, count, arithmetics) in
        [(180.0, 3_000, EXACT), (180.0, 300, ALL), (90.0, 500, EXACT), (30.0, 500, EXACT)]
    {
        let mut batch = Batch::default();
        for seed in 0..count {
            batch.add(&format!("seed {seed}, {threshold} degrees"), &Case::from_seed(seed).mesh, threshold);
        }
        batch.check(threshold, arithmetics);
    }
}
