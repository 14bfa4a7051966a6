//! Measurements for docs/notes/c.md: `cargo test --release --package darboux-c -- --ignored --nocapture
//! --test-threads=1 speed`.

use std::hint::black_box;
use std::io::Write;
use std::process::Command;
use std::ptr::{null, null_mut};
use std::time::Instant;

use darboux::{Context, CornerTangentsRef, TangentOptions, split_vertices, write_tangents};
use darboux_c::*;
use darboux_tests::{OwnedMesh, families};

use crate::agreement::packed;
use crate::support::{Link, build, folder, has, reference_sources, run, source};

fn print(line: &str) {
    writeln!(std::io::stdout(), "{line}").expect("standard output");
}

/// Environments of the measured program: the allocator keeps freed memory, so that no call pays for new
/// pages; and the default.
const ALLOCATORS: [(&str, &str); 2] =
    [("kept", "glibc.malloc.mmap_max=0:glibc.malloc.trim_threshold=17179869184"), ("fresh", "")];

/// Times the drop-in and mikktspace.c alternately, with the same callbacks. The hashes of their results must
/// be equal.
#[test]
#[ignore = "a measurement"]
fn speed_through_callbacks() {
    if !has("gcc") {
        return;
    }
    let ours = build("grid-ours", "c99", &[source("grid.c")], &["darboux_mikktspace"], Link::Shared);
    let (theirs, mikktspace) = (folder().join("grid-reference"), reference_sources());
    let mut command = Command::new("gcc");
    command.args(["-O3", "-DNDEBUG", "-ffp-contract=off", "-I"]).arg(&mikktspace).arg(source("grid.c"));
    run(command.arg(mikktspace.join("mikktspace.c")).args(["-lm", "-o"]).arg(&theirs));
    for (memory, tunables) in ALLOCATORS {
        for setter in ["basic", "full"] {
            let time = |program, rounds| {
                let mut command = Command::new(program);
                let output = run(command.env("GLIBC_TUNABLES", tunables).args([rounds, setter])).stdout;
                String::from_utf8(output).expect("text").trim().to_owned()
            };
            for _ in 0..3 {
                let (reference, found) = (time(&theirs, "3"), time(&ours, "9"));
                assert_eq!(reference.split(' ').nth(2), found.split(' ').nth(2), "another answer");
                print(&format!("{setter}, memory {memory}: mikktspace.c {reference}, ours {found}"));
            }
        }
    }
}

/// The minimum time of a call in nanoseconds.
fn least(rounds: usize, mut call: impl FnMut()) -> f64 {
    let time = |_| {
        let start = Instant::now();
        call();
        start.elapsed().as_nanos() as f64
    };
    (0..rounds).map(time).fold(f64::INFINITY, f64::min)
}

/// The overhead of the C interface over Rust, on one thread, with reused memory on both sides.
#[test]
#[ignore = "a measurement"]
fn speed_over_rust() {
    let one_quad = OwnedMesh { indices: Some(vec![0, 1, 3, 0, 3, 2]), ..families::grid(1, 1, false, false) };
    let meshes = [
        ("2 triangles", one_quad, 200_000),
        ("5,000 triangles", families::grid(50, 50, false, false), 2_000),
        ("1M triangles", families::grid(707, 707, false, false), 20),
    ];
    for (name, mesh, rounds) in meshes {
        let (view, c_view, count) = (mesh.view(), packed(&mesh), mesh.corner_count());
        let (mut context, mut tangents) = (Context::new().with_max_threads(1), vec![[0.0; 4]; count]);
        let rust = least(rounds, || {
            _ = write_tangents(&view, &TangentOptions::default(), &mut context, &mut tangents)
                .expect("one tangent per corner");
        });
        let mut c_context = null_mut();
        // SAFETY: the context is writable.
        assert_eq!(unsafe { darboux_context_create(1, &mut c_context) }, darboux_status::Ok);
        let mut out = vec![[0.0f32; 4]; count];
        let c = least(rounds, || {
            // SAFETY: all pointers refer to arrays of the given lengths.
            let status = unsafe {
                darboux_generate_tangents(
                    &c_view,
                    null(),
                    c_context,
                    out.as_mut_ptr().cast(),
                    count,
                    0,
                    null_mut(),
                )
            };
            assert_eq!(status, darboux_status::Ok);
        });
        let rust_split = least(rounds.min(200), || {
            _ = black_box(split_vertices(&view, CornerTangentsRef::from_per_corner(&tangents)))
        });
        let c_split = least(rounds.min(200), || {
            let mut split = null_mut();
            // SAFETY: all pointers refer to arrays of the given lengths; the split is freed once.
            unsafe {
                darboux_split_vertices(&c_view, out.as_ptr().cast(), count, 0, null(), &mut split);
                darboux_vertex_split_free(split);
            }
        });
        // SAFETY: the context is from `darboux_context_create`.
        unsafe { darboux_context_free(c_context) };
        print(&format!(
            "{name}: tangents Rust {rust:.0} ns, C {c:.0} ns; splits Rust {rust_split:.0} ns, C {c_split:.0} ns"
        ));
    }
}
