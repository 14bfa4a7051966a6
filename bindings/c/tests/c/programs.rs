//! Builds and runs the examples and test programs with CMake, pkg-config and plain compilers, with static and
//! shared libraries.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use darboux::{Faces, Mesh, TangentOptions, generate_tangents, split_vertices};

use crate::drop_in::a_few_meshes;
use crate::support::{Link, build, compiler, dist, folder, has, repository, run, run_with_input, source};

fn example(name: &str) -> PathBuf {
    dist().join("examples").join(name)
}

/// Two rows of three vertices. The texture is mirrored at the middle column.
struct Strip {
    positions: Vec<[f32; 3]>,
    normals: [[f32; 3]; 6],
    uvs: Vec<[f32; 2]>,
}

fn strip() -> Strip {
    let positions: Vec<[f32; 3]> = (0..6).map(|v| [(v % 3) as f32 - 1.0, (v / 3) as f32, 0.0]).collect();
    let uvs = positions.iter().map(|[x, y, _]| [x.abs(), *y]).collect();
    Strip { positions, normals: [[0.0, 0.0, 1.0]; 6], uvs }
}

/// The expected output of `examples/tangents`, computed by the core.
fn corners() -> String {
    let (strip, quads) = (strip(), [0u32, 1, 4, 3, 1, 2, 5, 4]);
    let (positions, normals, uvs) = (&strip.positions, &strip.normals, &strip.uvs);
    let mesh = Mesh::with_faces(positions, normals, uvs, &quads, Faces::Quads).expect("a mesh");
    let tangents = generate_tangents(&mesh, &TangentOptions::default()).corners.into_per_corner();
    let lines = quads.iter().zip(tangents);
    lines.map(|(vertex, [x, y, z, w])| format!("vertex {vertex}: {x} {y} {z} {w}\n")).collect()
}

/// The expected output of `examples/vertices`, computed by the core.
fn vertices() -> String {
    let (strip, indices) = (strip(), [0u16, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4]);
    let mesh = Mesh::triangles(&strip.positions, &strip.normals, &strip.uvs, &indices).expect("a mesh");
    let tangents = generate_tangents(&mesh, &TangentOptions::default());
    let split = split_vertices(&mesh, &tangents.corners).expect("its tangents");
    let mut text = format!("6 vertices became {}\n", split.source_of_vertex.len());
    for (&old, [a, b, c, d]) in split.source_of_vertex.iter().zip(&split.tangent_of_vertex) {
        let [x, y, z] = strip.positions[old as usize];
        text += &format!("{x} {y} {z}: tangent {a} {b} {c} {d}\n");
    }
    text
}

#[test]
fn examples_print_what_rust_computes() {
    if !has("gcc") || !has("g++") {
        return;
    }
    for (example_name, expected) in [("tangents", corners()), ("vertices", vertices())] {
        for (standard, extension) in [("c99", "c"), ("c++17", "cpp"), ("c++20", "cpp")] {
            for link in [Link::Shared, Link::Static] {
                let name = format!("example-{example_name}-{standard}-{link:?}");
                let file = example(&format!("{example_name}.{extension}"));
                let program = build(&name, standard, &[file], &["darboux"], link);
                let printed = String::from_utf8(run(&mut Command::new(program)).stdout).expect("text");
                assert_eq!(printed, expected, "{name}");
            }
        }
    }
    let program =
        build("example-mikktspace", "c99", &[example("mikktspace.c")], &["darboux_mikktspace"], Link::Static);
    assert_eq!(run(&mut Command::new(program)).stdout, "1 0 0 1\n".repeat(4).as_bytes());
}

#[test]
fn the_readmes_example_prints_what_it_says() {
    if !has("gcc") {
        return;
    }
    let readme = fs::read_to_string(repository().join("README.md")).expect("the README");
    let rest = readme.split("```c\n").nth(1).expect("an example in C");
    let code = rest.split("```").next().expect("its end");
    let file = folder().join("readme.c");
    fs::write(&file, code).expect("a file");
    let program = build("readme", "c99", &[file], &["darboux"], Link::Shared);
    let printed = run(&mut Command::new(program)).stdout;
    let (_, said) =
        code.split_once("printf").and_then(|(_, rest)| rest.split_once("// ")).expect("a comment");
    assert_eq!(printed, format!("{}\n", said.lines().next().unwrap_or_default()).as_bytes());
}

#[test]
fn headers_are_clean() {
    if !has("gcc") || !has("g++") {
        return;
    }
    let check = |standards: &[&str], header: &str| {
        for standard in standards {
            let file = folder().join("header.c");
            fs::write(
                &file,
                format!("#include \"{header}\"\n#include \"{header}\"\nint main(void) {{ return 0; }}\n"),
            )
            .expect("a file");
            let language = if standard.starts_with("c++") { "c++" } else { "c" };
            run(compiler(standard)
                .args(["-fsyntax-only", "-x", language])
                .arg(file)
                .arg("-I")
                .arg(dist().join("include")));
        }
    };
    let all = ["c99", "c11", "c17", "c++11", "c++14", "c++17", "c++20"];
    check(&all, "darboux.h");
    check(&all, "mikktspace/mikktspace.h");
    check(&["c++17", "c++20"], "darboux.hpp");
}

#[test]
fn parts_of_a_program_may_have_different_standards() {
    if !has("g++") {
        return;
    }
    let object = |standard: &str| {
        let object = folder().join(format!("{standard}.o"));
        let include = dist().join("include");
        run(compiler(standard)
            .arg("-I")
            .arg(include)
            .arg("-c")
            .arg(source("standards.cpp"))
            .arg("-o")
            .arg(&object));
        object
    };
    let objects = ["c++17", "c++20"].map(object);
    let program = build("standards", "c++20", &objects, &["darboux"], Link::Shared);
    run(&mut Command::new(program));
}

#[test]
fn static_libraries_share_a_program() {
    if !has("gcc") {
        return;
    }
    let file = folder().join("both.c");
    let text = "#include \"darboux.h\"\n#include \"mikktspace.h\"\n\
        int main(void) { return genTangSpaceDefault(0) || darboux_version()[0] == 0; }\n";
    fs::write(&file, text).expect("a file");
    for link in [Link::Static, Link::Shared] {
        let program =
            build("both", "c99", std::slice::from_ref(&file), &["darboux", "darboux_mikktspace"], link);
        run(&mut Command::new(program));
    }
}

#[test]
fn libraries_show_their_functions_only() {
    if !cfg!(target_os = "linux") || !has("nm") {
        return;
    }
    for (library, start) in [("darboux", "darboux_"), ("darboux_mikktspace", "genTangSpace")] {
        let shared = dist().join(format!("lib/lib{library}.so"));
        let archive = dist().join(format!("lib/lib{library}.a"));
        let shared =
            run(Command::new("nm").args(["-D", "--defined-only", "--format=just-symbols"]).arg(shared));
        let archive =
            run(Command::new("nm").args(["-g", "--defined-only", "--format=just-symbols"]).arg(archive));
        for listed in [shared, archive] {
            let names = String::from_utf8(listed.stdout).expect("text");
            let mut functions = names.lines().filter(|line| !line.is_empty() && !line.ends_with(".o:"));
            assert!(functions.clone().count() > 1);
            assert_eq!(functions.find(|name| !name.starts_with(start)), None, "{library}");
        }
    }
}

#[test]
fn cmake_finds_the_package() {
    if !has("cmake") || !has("g++") {
        return;
    }
    let build = folder().join("cmake");
    let mut configure = Command::new("cmake");
    configure.arg("-S").arg(dist().join("examples")).arg("-B").arg(&build);
    run(configure.arg(format!("-DCMAKE_PREFIX_PATH={}", dist().display())));
    run(Command::new("cmake").arg("--build").arg(&build));
    for (program, expected) in [
        ("tangents_c", corners()),
        ("tangents_cpp", corners()),
        ("vertices_c", vertices()),
        ("vertices_cpp", vertices()),
    ] {
        assert_eq!(run(&mut Command::new(build.join(program))).stdout, expected.as_bytes());
    }
    run(&mut Command::new(build.join("mikktspace")));
}

#[test]
fn pkg_config_finds_the_library() {
    if !has("pkg-config") || !has("gcc") {
        return;
    }
    let ask = |options: &[&str]| {
        let mut ask = Command::new("pkg-config");
        ask.env("PKG_CONFIG_PATH", dist().join("lib/pkgconfig")).args(options).arg("darboux");
        String::from_utf8(run(&mut ask).stdout).expect("text")
    };
    let rpath = format!("-Wl,-rpath,{}", ask(&["--variable=libdir"]).trim());
    for options in [&["--cflags", "--libs"][..], &["--cflags", "--libs", "--static"]] {
        let (flags, program) = (ask(options), folder().join("pkg-config"));
        run(compiler("c99")
            .arg(example("tangents.c"))
            .args(flags.split_whitespace())
            .args([&rpath, "-o"])
            .arg(&program));
        assert_eq!(run(&mut Command::new(program)).stdout, corners().as_bytes());
    }
}

#[test]
fn allocator_gives_all_memory() {
    if !has("gcc") {
        return;
    }
    let program = build("allocator", "c99", &[source("allocator.c")], &["darboux"], Link::Shared);
    run(&mut Command::new(program));
}

#[test]
fn threads_are_asked_for() {
    if !cfg!(target_os = "linux") || !has("gcc") {
        return;
    }
    for link in [Link::Shared, Link::Static] {
        let program = build(&format!("threads-{link:?}"), "c99", &[source("threads.c")], &["darboux"], link);
        run(&mut Command::new(program));
    }
}

/// Checks every program but `grid.c`, which only measures, for memory errors and leaks.
#[test]
fn valgrind_finds_nothing() {
    if !has("valgrind") || !has("g++") {
        return;
    }
    let (plain, drop_in) = (["darboux"], ["darboux_mikktspace"]);
    let programs = [
        ("c99", example("tangents.c"), plain),
        ("c++17", example("tangents.cpp"), plain),
        ("c99", example("vertices.c"), plain),
        ("c++17", example("vertices.cpp"), plain),
        ("c++17", source("calls.cpp"), plain),
        ("c99", source("threads.c"), plain),
        ("c99", source("allocator.c"), plain),
        ("c99", example("mikktspace.c"), drop_in),
        ("c++17", source("callbacks.cpp"), drop_in),
        ("c99", source("drop_in.c"), drop_in),
    ];
    for (at, (standard, file, libraries)) in programs.into_iter().enumerate() {
        let program = build(&format!("valgrind-{at}"), standard, &[file], &libraries, Link::Static);
        let mut valgrind = Command::new("valgrind");
        valgrind.args(["--quiet", "--error-exitcode=1", "--leak-check=full"]);
        valgrind.args(["--show-leak-kinds=definite,indirect", "--errors-for-leak-kinds=definite,indirect"]);
        run_with_input(valgrind.arg(program), &a_few_meshes());
    }
}
