//! When a table of each vertex's triangles is worth making: times of the average both ways, on every adapter and on the CPU.
//!
//! `cargo run -p darboux-gpu --example average_times`

use std::time::Instant;

use darboux::{Method, TangentOptions, generate_tangents};
use darboux_gpu::{Average, AverageOfMesh, Destination, FrameLayout, Gpu, MeshBuffers, Search, VertexLayout};
use darboux_tests::{OwnedMesh, families};
use wgpu::BufferUsages;
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// Quads along a side of the grids.
const SIDES: [usize; 9] = [3, 7, 15, 22, 31, 70, 141, 316, 1000];
/// Beyond this many vertices brute force takes minutes.
const BRUTE_FORCE_ENDS: usize = 25_000;
const ROUNDS: usize = 7;

fn main() -> Result<(), darboux_gpu::GpuError> {
    for gpu in pollster::block_on(Gpu::open_all())? {
        println!("{}, milliseconds, medians of {ROUNDS}", gpu.name);
        println!("| vertices | triangles | brute force | table and frames | frames alone | CPU |");
        println!("|---|---|---|---|---|---|");
        for side in SIDES {
            print_row(&gpu, &families::grid(side, side, false, false))?;
        }
    }
    Ok(())
}

fn print_row(gpu: &Gpu, mesh: &OwnedMesh) -> Result<(), darboux_gpu::GpuError> {
    let vertex_count = mesh.positions.len();
    let buffer = |words: &[u32]| {
        let contents: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        let usage = BufferUsages::STORAGE;
        gpu.device.create_buffer_init(&BufferInitDescriptor { label: None, contents: &contents, usage })
    };
    let (vertices, indices) =
        (buffer(&interleaved(mesh)), buffer(mesh.indices.as_deref().unwrap_or_default()));
    let buffers = MeshBuffers {
        vertices: &vertices,
        layout: VertexLayout { stride: 56, position: 0, uv: 12, normal: 20 },
        vertex_count: vertex_count as u32,
        indices: &indices,
        index_format: wgpu::IndexFormat::Uint32,
        first_index: 0,
        index_count: mesh.corner_count() as u32,
    };
    let frames = Destination::Vertices(FrameLayout { tangent: 32, bitangent: Some(44), sign: None });
    let prepare = |search| Average::new(&gpu.device, search).of_mesh(&buffers, &frames);
    let brute_force = if vertex_count > BRUTE_FORCE_ENDS {
        "-".to_owned()
    } else {
        let average = prepare(Search::BruteForce)?;
        format!("{:.2}", median(|| submit(gpu, &average, AverageOfMesh::record)))
    };
    let average = prepare(Search::Adjacency)?;
    let with_table = median(|| submit(gpu, &average, AverageOfMesh::record));
    let alone = median(|| submit(gpu, &average, AverageOfMesh::record_frames));
    let options = TangentOptions { method: Method::Average, ..Default::default() };
    let cpu = median(|| {
        std::hint::black_box(generate_tangents(&mesh.view(), &options));
    });
    let triangles = mesh.corner_count() / 3;
    println!("| {vertex_count} | {triangles} | {brute_force} | {with_table:.2} | {alone:.2} | {cpu:.2} |");
    Ok(())
}

/// Position, UV, normal, and room for tangent and bitangent.
fn interleaved(mesh: &OwnedMesh) -> Vec<u32> {
    let of_vertex = |v: usize| {
        let (position, normal, uv) = mesh.vertex(v);
        let [x, y, z] = position.map(f32::to_bits);
        let [a, b, c] = normal.map(f32::to_bits);
        let [u, v] = uv.map(f32::to_bits);
        [x, y, z, u, v, a, b, c, 0, 0, 0, 0, 0, 0]
    };
    (0..mesh.positions.len()).flat_map(of_vertex).collect()
}

/// Submits what is recorded, and waits for it.
fn submit(gpu: &Gpu, average: &AverageOfMesh, record: impl Fn(&AverageOfMesh, &mut wgpu::CommandEncoder)) {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    record(average, &mut encoder);
    gpu.queue.submit([encoder.finish()]);
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("a device that goes on");
}

/// Of the milliseconds that `run` takes, after one run that does not count.
fn median(mut run: impl FnMut()) -> f64 {
    run();
    let mut times = [0.0; ROUNDS];
    for time in &mut times {
        let start = Instant::now();
        run();
        *time = start.elapsed().as_secs_f64() * 1e3;
    }
    times.sort_by(f64::total_cmp);
    times[ROUNDS / 2]
}
