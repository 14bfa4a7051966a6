//! Measures all algorithms of this crate on every adapter, and the same on one thread of the CPU.
//!
//! `cargo xtask bench --gpu [--quick] [TRIANGLES ...]`

#[path = "times/clock.rs"]
mod clock;

use std::error::Error;
use std::hint::black_box;

use clock::{Clock, Times};
use darboux::{Context, Method, MikkTSpaceOptions, TangentOptions, generate_tangents};
use darboux_gpu::{
    AdapterKind, Attribute, Average, Destination, FrameLayout, Gpu, GpuError, MeshBuffers, MikkTSpace,
    MovingMesh, Planner, Precision, Search, TangentsPer, VertexLayout,
};
use darboux_tests::{OwnedMesh, families};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{Buffer, BufferUsages};

/// The numbers of triangles of the grids.
const SIZES: [usize; 4] = [2_000, 200_000, 1_000_000, 10_000_000];
const QUICK: [usize; 2] = [2_000, 20_000];
/// The largest product of vertices and triangles for which brute force is measured: on a GPU, on a software
/// adapter.
const BRUTE_FORCE_ENDS: [usize; 2] = [30_000_000_000, 50_000_000];
/// The bytes of the copy that measures the memory bandwidth, more than any cache holds.
const COPIED: u64 = 1 << 28;
/// The byte length of a vertex: position, UV, normal, tangent and sign.
const STRIDE: u32 = 48;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let is_quick = arguments.iter().any(|argument| argument == "--quick");
    let given: Vec<usize> = arguments
        .iter()
        .filter(|argument| *argument != "--quick")
        .map(|n| n.parse())
        .collect::<Result<_, _>>()?;
    let sizes: &[usize] = match (is_quick, given.is_empty()) {
        (_, false) => &given,
        (true, _) => &QUICK,
        (false, _) => &SIZES,
    };
    for gpu in pollster::block_on(Gpu::open_all())? {
        let (info, kind) = (gpu.device.adapter_info(), gpu.kind());
        println!("{}, {kind}, {}, {} {}", info.name, info.backend, info.driver, info.driver_info);
        if kind == AdapterKind::Software {
            println!("This is a software adapter. Its times do not indicate those of a GPU.");
        }
        let clock = Clock::new(&gpu, if is_quick { 3 } else { 11 });
        let bench = Bench { gpu: &gpu, rate: copy_rate(&gpu, &clock), clock, kind };
        println!("copies: {:.1} GB/s, read and written\n", bench.rate * 1e-6);
        for &size in sizes {
            bench.print_all(size).or_else(print_limit)?;
        }
    }
    Ok(())
}

/// Prints what the limits of an adapter do not allow. Errors: all other errors.
fn print_limit(error: Box<dyn Error>) -> Result<(), Box<dyn Error>> {
    match error.downcast_ref() {
        Some(GpuError::BufferTooLarge { .. }) => println!("skipped: {error}\n"),
        _ => return Err(error),
    }
    Ok(())
}

/// The bytes per millisecond that a copy on the device reads and writes.
fn copy_rate(gpu: &Gpu, clock: &Clock<'_>) -> f64 {
    let usage = BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
    let buffer = || {
        let size = COPIED.min(gpu.device.limits().max_buffer_size);
        gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage,
            mapped_at_creation: false,
        })
    };
    let (from, to) = (buffer(), buffer());
    let times = clock.time(|encoder| encoder.copy_buffer_to_buffer(&from, 0, &to, 0, None));
    2.0 * from.size() as f64 / times.device.unwrap_or(times.wall)
}

struct Bench<'a> {
    gpu: &'a Gpu,
    clock: Clock<'a>,
    rate: f64,
    kind: AdapterKind,
}

/// A mesh on the device.
struct Uploaded {
    vertices: Buffer,
    indices: Buffer,
    vertex_count: u32,
    triangle_count: u32,
}

impl Bench<'_> {
    fn print_all(&self, triangles: usize) -> Result<(), Box<dyn Error>> {
        let side = (triangles as f64 / 2.0).sqrt().round().max(1.0) as usize;
        let mesh = families::grid(side, side, false, false);
        let uploaded = self.upload(&mesh);
        println!("{} vertices, {} triangles", uploaded.vertex_count, uploaded.triangle_count);
        println!("| what | device, ms | wall, ms | triangles/s | least bytes/triangle | times the copy |");
        println!("|---|---|---|---|---|---|");
        self.print_plans(&mesh, &uploaded)?;
        self.print_mikktspace(&mesh, &uploaded)?;
        self.print_averages(&mesh, &uploaded)?;
        println!();
        Ok(())
    }

    /// `bytes`: the least number of bytes that must be read and written.
    fn print(&self, what: &str, mesh: &Uploaded, times: Times, bytes: Option<u64>) {
        let milliseconds = times.device.unwrap_or(times.wall);
        let device = times.device.map_or("-".to_owned(), |time| format!("{time:.3}"));
        let triangles = f64::from(mesh.triangle_count);
        let [per_triangle, ratio] = match bytes {
            Some(bytes) => [bytes as f64 / triangles, milliseconds / (bytes as f64 / self.rate)]
                .map(|number| format!("{number:.1}")),
            None => ["-"; 2].map(str::to_owned),
        };
        let rate = triangles / milliseconds * 1e3;
        println!("| {what} | {device} | {:.3} | {rate:.3e} | {per_triangle} | {ratio} |", times.wall);
    }

    fn upload(&self, mesh: &OwnedMesh) -> Uploaded {
        let of_vertex = |v: usize| {
            let (position, normal, uv) = mesh.vertex(v);
            let [x, y, z] = position.map(f32::to_bits);
            let [a, b, c] = normal.map(f32::to_bits);
            let [u, v] = uv.map(f32::to_bits);
            [x, y, z, u, v, a, b, c, 0, 0, 0, 0]
        };
        let words: Vec<[u32; 12]> = (0..mesh.positions.len()).map(of_vertex).collect();
        let buffer = |contents| {
            let usage = BufferUsages::STORAGE;
            self.gpu.device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage })
        };
        Uploaded {
            vertices: buffer(bytemuck::cast_slice(&words)),
            indices: buffer(bytemuck::cast_slice(mesh.indices.as_deref().unwrap_or_default())),
            vertex_count: mesh.positions.len() as u32,
            triangle_count: mesh.corner_count() as u32 / 3,
        }
    }

    fn print_plans(&self, mesh: &OwnedMesh, uploaded: &Uploaded) -> Result<(), Box<dyn Error>> {
        let part = |offset| Attribute { buffer: &uploaded.vertices, stride: STRIDE, offset };
        let moving = MovingMesh {
            vertex_count: uploaded.vertex_count,
            positions: part(0),
            normals: part(20),
            tangents: part(32),
            per: TangentsPer::Vertex,
        };
        let [vertices, triangles] = [uploaded.vertex_count, uploaded.triangle_count].map(u64::from);
        // Positions, normals, tangents; triangles, members and ends of sums, vertices of sums, sums of
        // vertices.
        let bytes = (24 + 16) * vertices + (20 + 12) * triangles + 12 * vertices;
        for precision in [Precision::Exact, Precision::Fast] {
            let planner = Planner::new(&self.gpu.device, precision);
            let plan = planner.plan(&mesh.view(), &TangentOptions::default())?;
            let bound = plan.bind(&moving)?;
            let times = self.clock.time(|encoder| bound.record(encoder));
            self.print(&format!("plan, {precision:?}"), uploaded, times, Some(bytes));
            if precision == Precision::Fast {
                let normals = plan.bind_normals(&moving)?;
                let times = self.clock.time(|encoder| normals.record(encoder));
                let bytes = 24 * vertices + 32 * triangles + 8 * vertices;
                self.print("normals of a plan", uploaded, times, Some(bytes));
                let check = plan.bind_check(&moving)?;
                self.print(
                    "check of a plan",
                    uploaded,
                    self.clock.time(|encoder| check.record(encoder)),
                    None,
                );
            }
        }
        let plan = darboux::Plan::new(&mesh.view(), &TangentOptions::default());
        let (mut context, mut out) = (Context::new(), vec![[0.0; 4]; mesh.corner_count()]);
        let times = self.clock.time_cpu(|| {
            plan.write_tangents(&mesh.view(), &mut context, &mut out).expect("the mesh that was planned");
        });
        self.print("plan, CPU", uploaded, times, None);
        Ok(())
    }

    fn print_mikktspace(&self, mesh: &OwnedMesh, uploaded: &Uploaded) -> Result<(), Box<dyn Error>> {
        let [vertices, triangles] = [uploaded.vertex_count, uploaded.triangle_count].map(u64::from);
        let options = TangentOptions::default();
        let mikktspace = MikkTSpace::new(self.gpu)?;
        let recorded = mikktspace.recording(&mesh.view(), &MikkTSpaceOptions::new())?;
        // Vertices, indices and a tangent per corner.
        let bytes = 32 * vertices + 12 * triangles + 48 * triangles;
        let times = self.clock.time(|encoder| recorded.record(encoder));
        self.print("MikkTSpace, buffers", uploaded, times, Some(bytes));
        let times = self.clock.time_cpu(|| {
            black_box(mikktspace.generate_tangents(&mesh.view(), &options)).expect("a working device");
        });
        self.print("MikkTSpace, with transfers", uploaded, times, None);
        let times = self.clock.time_cpu(|| {
            black_box(generate_tangents(&mesh.view(), &options));
        });
        self.print("MikkTSpace, CPU", uploaded, times, None);
        Ok(())
    }

    fn print_averages(&self, mesh: &OwnedMesh, uploaded: &Uploaded) -> Result<(), Box<dyn Error>> {
        let buffers = MeshBuffers {
            vertices: &uploaded.vertices,
            layout: VertexLayout { stride: STRIDE, position: 0, uv: 12, normal: 20 },
            vertex_count: uploaded.vertex_count,
            indices: &uploaded.indices,
            index_format: wgpu::IndexFormat::Uint32,
            first_index: 0,
            index_count: 3 * uploaded.triangle_count,
        };
        let frames = Destination::Vertices(FrameLayout { tangent: 32, bitangent: None, sign: Some(44) });
        let [vertices, triangles] = [uploaded.vertex_count, uploaded.triangle_count].map(u64::from);
        let bytes = Some((32 + 16) * vertices + 12 * triangles);
        let average = Average::new(&self.gpu.device, Search::Adjacency).of_mesh(&buffers, &frames)?;
        let with_table = self.clock.time(|encoder| average.record(encoder));
        self.print("average, table and frames", uploaded, with_table, bytes);
        let alone = self.clock.time(|encoder| average.record_frames(encoder));
        self.print("average, frames alone", uploaded, alone, bytes);
        let end = BRUTE_FORCE_ENDS[usize::from(self.kind == AdapterKind::Software)];
        if vertices.saturating_mul(triangles) <= end as u64 {
            let average = Average::new(&self.gpu.device, Search::BruteForce).of_mesh(&buffers, &frames)?;
            let times = self.clock.time(|encoder| average.record(encoder));
            self.print("average, brute force", uploaded, times, None);
        }
        let options = TangentOptions::from(Method::Average);
        let times = self.clock.time_cpu(|| {
            black_box(generate_tangents(&mesh.view(), &options));
        });
        self.print("average, CPU", uploaded, times, None);
        Ok(())
    }
}
