//! Tests devices with small limits: meshes in several tiles, and errors that name the buffer that is too
//! large.

mod common;

use std::io::Write;
use std::sync::OnceLock;

use common::{APART, APART_STRIDE, ENGINE, buffer, gpus, triangulated};
use darboux::internal::cancel_checks::cancel_after;
use darboux::{Context, TangentOptions, generate_tangents};
use darboux_gpu::{
    Average, Destination, Gpu, GpuError, MeshBuffers, MikkTSpace, Planner, Precision, Search, Splitter,
};
use darboux_tests::{Case, OwnedMesh, families};
use wgpu::{Backends, BufferUsages, DeviceDescriptor, IndexFormat, Instance, InstanceDescriptor, Limits};

/// A device of every adapter whose buffers are limited to this many bytes.
fn small_devices(bytes: u64) -> Vec<Gpu> {
    devices(InstanceDescriptor::new_without_display_handle(), |limits| Limits {
        max_buffer_size: bytes,
        max_storage_buffer_binding_size: bytes,
        ..limits
    })
}

fn devices(descriptor: InstanceDescriptor, limited: impl Fn(Limits) -> Limits) -> Vec<Gpu> {
    // Prints once if there are no adapters.
    if gpus().is_empty() {
        return Vec::new();
    }
    let instance = Instance::new(InstanceDescriptor { backends: Backends::PRIMARY, ..descriptor });
    let adapters = pollster::block_on(instance.enumerate_adapters(Backends::PRIMARY));
    let open = |adapter: &wgpu::Adapter| {
        let required_limits = limited(adapter.limits());
        let asked = adapter.request_device(&DeviceDescriptor { required_limits, ..Default::default() });
        let (device, queue) = pollster::block_on(asked).expect("a device with smaller limits");
        Gpu { name: adapter.get_info().name, device, queue }
    };
    adapters.iter().map(open).collect()
}

/// The byte length of 42 triangles, and of 128 vertices.
const SMALL_LIMIT: u64 = 4096;

/// MikkTSpace on such devices, compiled once.
fn small_kernels() -> &'static [MikkTSpace] {
    static KERNELS: OnceLock<Vec<MikkTSpace>> = OnceLock::new();
    let compile = |gpu: &Gpu| MikkTSpace::new(gpu).expect("valid shaders");
    KERNELS.get_or_init(|| small_devices(SMALL_LIMIT).iter().map(compile).collect())
}

fn has_the_bits_of_the_core(kernels: &MikkTSpace, name: &str, mesh: &OwnedMesh) -> usize {
    let (view, options) = (mesh.view(), TangentOptions::default());
    let expected = generate_tangents(&view, &options);
    let made = kernels.generate_tangents(&view, &options).unwrap_or_else(|error| panic!("{name}: {error}"));
    let bits = |tangents: &darboux::Tangents| {
        let words = |tangent: &[f32; 4]| tangent.map(|x| if x.is_nan() { f32::NAN } else { x }.to_bits());
        tangents.corners.per_corner().iter().map(words).collect::<Vec<_>>()
    };
    assert!(bits(&made.tangents) == bits(&expected), "{name}");
    assert_eq!(made.tangents.report, expected.report, "{name}");
    made.cpu_corners
}

#[test]
fn vertices_past_a_binding_are_split_into_submeshes() {
    for kernels in small_kernels() {
        for (name, mesh) in [
            ("as many vertices as fit", families::grid(15, 7, false, false)),
            ("more", families::grid(15, 8, false, false)),
            ("many more", families::grid(40, 9, false, true)),
            ("unindexed", families::sphere(9, 12, false).unindexed()),
        ] {
            let of_cpu = has_the_bits_of_the_core(kernels, name, &mesh);
            assert!(of_cpu < mesh.corner_count(), "{name}");
        }
    }
}

/// As tests/cancel.rs, where each tile has its own vertices.
#[test]
fn submeshes_are_cancelled() {
    let (mesh, options) = (families::grid(40, 9, false, true), TangentOptions::default());
    for kernels in small_kernels() {
        for checks in 0..10 {
            let context = &mut Context::new().with_cancel(&cancel_after(checks));
            let run = kernels.generate_tangents_with(&mesh.view(), &options, context);
            assert_eq!(run.err(), Some(GpuError::Cancelled), "cancelled at check {checks}");
        }
    }
}

#[test]
fn random_meshes_in_small_tiles_have_the_bits_of_the_core() {
    for kernels in small_kernels() {
        for seed in 0..150 {
            let mesh = triangulated(&Case::from_seed(seed).mesh);
            has_the_bits_of_the_core(kernels, &format!("seed {seed}"), &mesh);
        }
    }
}

#[test]
fn a_limit_below_one_triangle_is_an_error() {
    let mesh = families::grid(4, 4, false, false);
    for gpu in small_devices(64) {
        let kernels = MikkTSpace::new(&gpu).expect("valid shaders");
        let refused = kernels.generate_tangents(&mesh.view(), &TangentOptions::default()).err();
        assert_eq!(refused, Some(GpuError::BufferTooLarge { what: "a triangle", bytes: 96, limit: 64 }));
    }
}

#[test]
fn buffers_past_small_limits_are_errors() {
    let mesh = families::grid(20, 20, false, false);
    let (view, options) = (mesh.view(), TangentOptions::default());
    let tangents = generate_tangents(&view, &options).corners;
    for gpu in small_devices(SMALL_LIMIT) {
        let limit = SMALL_LIMIT;
        let split = Splitter::new(&gpu).expect("valid shaders").split_vertices(&view, &tangents);
        let bytes = 16 * mesh.corner_count() as u64;
        assert_eq!(split.err(), Some(GpuError::BufferTooLarge { what: "the tangents", bytes, limit }));
        let plan = Planner::new(&gpu.device, Precision::Exact).plan(&view, &options);
        let bytes = 4 * mesh.corner_count() as u64;
        assert_eq!(plan.err(), Some(GpuError::BufferTooLarge { what: "sums of corners", bytes, limit }));
    }
}

/// The buffers of the caller fit, those of the adjacency do not.
#[test]
fn an_adjacency_past_a_binding_is_an_error() {
    for gpu in small_devices(SMALL_LIMIT) {
        let words = |count: usize| buffer(&gpu, &vec![0; count], BufferUsages::STORAGE);
        let (vertices, indices, frames) = (words(14), words(1_023), words(7));
        let mesh = MeshBuffers {
            vertices: &vertices,
            layout: ENGINE,
            vertex_count: 1,
            indices: &indices,
            index_format: IndexFormat::Uint16,
            first_index: 0,
            index_count: 2_046,
        };
        let frames = Destination::Buffer { buffer: &frames, stride: APART_STRIDE, layout: APART };
        let refused = Average::new(&gpu.device, Search::Adjacency).of_mesh(&mesh, &frames).err();
        let bytes = 4 * 2_046;
        let what = "the triangles at each vertex";
        assert_eq!(refused, Some(GpuError::BufferTooLarge { what, bytes, limit: SMALL_LIMIT }));
    }
}

/// Runs in a separate process whose memory is limited after everything is compiled.
#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "processes have no limits elsewhere")]
fn exhausted_memory_is_an_error() {
    const NAME: &str = "exhausted_memory_is_an_error";
    const IS_CHILD: &str = "DARBOUX_TEST_LIMITED_MEMORY";
    if std::env::var_os(IS_CHILD).is_some() {
        return run_with_limited_memory();
    }
    // The memory of a hardware GPU cannot be limited per process.
    if software().is_none() || !has_prlimit() {
        let why = "skipped: no adapter whose memory is this machine's, or no prlimit (Debian: util-linux)";
        writeln!(std::io::stdout(), "{why}").expect("standard output");
        return;
    }
    let program = std::env::current_exe().expect("this test");
    let mut child = std::process::Command::new(program);
    let output = child.args([NAME, "--exact", "--nocapture"]).env(IS_CHILD, "1").output().expect("a process");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && said.contains("rejected with limited memory"), "{said}");
}

fn has_prlimit() -> bool {
    std::process::Command::new("prlimit")
        .arg("--version")
        .output()
        .is_ok_and(|output| output.status.success())
}

/// An adapter that uses the memory of the CPU.
fn software() -> Option<&'static Gpu> {
    gpus().iter().find(|gpu| gpu.name.contains("llvmpipe"))
}

fn run_with_limited_memory() {
    let gpu = software().expect("an adapter, as in the parent process");
    // One tile, in the stress build too.
    let kernels = MikkTSpace::new(gpu).expect("valid shaders").with_tile_size(1 << 28);
    let status = std::fs::read_to_string("/proc/self/status").expect("Linux");
    let size = status.lines().find_map(|line| line.strip_prefix("VmSize:")?.trim().strip_suffix(" kB"));
    let size: u64 = size.and_then(|size| size.trim().parse().ok()).expect("a size");
    let limit = format!("--as={}", 1024 * size + (100 << 20));
    let id = format!("--pid={}", std::process::id());
    let limited = std::process::Command::new("prlimit").args([id, limit]).status();
    assert!(limited.is_ok_and(|status| status.success()));
    let mesh = families::grid(500, 500, false, false);
    let refused = kernels.generate_tangents(&mesh.view(), &TangentOptions::default()).err();
    assert_eq!(refused, Some(GpuError::OutOfMemory));
    // A mesh that fits still works.
    has_the_bits_of_the_core(&kernels, "after that", &families::grid(10, 10, false, false));
    println!("rejected with limited memory");
}

#[test]
fn a_device_lost_during_a_run_is_an_error() {
    let mesh = families::grid(100, 100, false, true);
    let options = TangentOptions::default();
    let expected = generate_tangents(&mesh.view(), &options);
    for milliseconds in [0, 10, 100] {
        for gpu in devices(InstanceDescriptor::new_without_display_handle(), |limits| limits) {
            let kernels = MikkTSpace::new(&gpu).expect("valid shaders").with_tile_size(2_000);
            let device = gpu.device.clone();
            let end = std::thread::spawn(move || {
                std::thread::sleep(std::time::Duration::from_millis(milliseconds));
                device.destroy();
            });
            match kernels.generate_tangents(&mesh.view(), &options) {
                Ok(made) => assert!(made.tangents.corners.per_corner() == expected.corners.per_corner()),
                Err(error) => assert_eq!(error, GpuError::Lost, "after {milliseconds} ms"),
            }
            end.join().expect("no panic");
        }
    }
}
