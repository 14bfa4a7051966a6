//! The examples and other programs, built every way that users build them.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use darboux::{Mesh, TangentOptions, generate_tangents, split_vertices};

use crate::support::{Link, build, compiler, dist, folder, has, run, source};

fn example(name: &str) -> PathBuf {
    dist().join("examples").join(name)
}

/// What `examples/tangents` prints, as the core computes it.
fn expected() -> String {
    let positions: Vec<[f32; 3]> = (0..6).map(|v| [(v % 3) as f32 - 1.0, (v / 3) as f32, 0.0]).collect();
    let normals = [[0.0, 0.0, 1.0]; 6];
    let uvs: Vec<[f32; 2]> = positions.iter().map(|[x, y, _]| [x.abs(), *y]).collect();
    let indices = [0u16, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4];
    let mesh = Mesh::triangles(&positions, &normals, &uvs, &indices).expect("a mesh");
    let tangents = generate_tangents(&mesh, &TangentOptions::default());
    let split = split_vertices(&mesh, &tangents.corners).expect("its tangents");
    let mut text = format!("6 vertices became {}\n", split.source_of_vertex.len());
    for (&old, [a, b, c, d]) in split.source_of_vertex.iter().zip(&split.tangent_of_vertex) {
        let [x, y, z] = positions[old as usize];
        text += &format!("{x} {y} {z}: tangent {a} {b} {c} {d}\n");
    }
    text
}

#[test]
fn examples_print_what_rust_computes() {
    if !has("gcc") || !has("g++") {
        return;
    }
    for (standard, file) in [("c99", "tangents.c"), ("c++17", "tangents.cpp"), ("c++20", "tangents.cpp")] {
        for link in [Link::Shared, Link::Static] {
            let name = format!("example-{standard}-{link:?}");
            let program = build(&name, standard, &[example(file)], &["darboux"], link);
            let printed = String::from_utf8(run(&mut Command::new(program)).stdout).expect("text");
            assert_eq!(printed, expected(), "{name}");
        }
    }
    let program =
        build("example-mikktspace", "c99", &[example("mikktspace.c")], &["darboux_mikktspace"], Link::Static);
    assert_eq!(run(&mut Command::new(program)).stdout, "1 0 0 1\n".repeat(4).as_bytes());
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
    for program in ["tangents_c", "tangents_cpp"] {
        assert_eq!(run(&mut Command::new(build.join(program))).stdout, expected().as_bytes());
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
        assert_eq!(run(&mut Command::new(program)).stdout, expected().as_bytes());
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

/// Memory errors and leaks, in every program that there is.
#[test]
fn valgrind_finds_nothing() {
    if !has("valgrind") || !has("g++") {
        return;
    }
    let programs = [
        build("valgrind-c", "c99", &[example("tangents.c")], &["darboux"], Link::Static),
        build("valgrind-cpp", "c++17", &[example("tangents.cpp")], &["darboux"], Link::Static),
        build("valgrind-calls", "c++17", &[source("calls.cpp")], &["darboux"], Link::Static),
        build("valgrind-threads", "c99", &[source("threads.c")], &["darboux"], Link::Static),
        build("valgrind-allocator", "c99", &[source("allocator.c")], &["darboux"], Link::Static),
        build(
            "valgrind-callbacks",
            "c++17",
            &[source("callbacks.cpp")],
            &["darboux_mikktspace"],
            Link::Static,
        ),
    ];
    for program in programs {
        let mut valgrind = Command::new("valgrind");
        valgrind.args([
            "--quiet",
            "--error-exitcode=1",
            "--leak-check=full",
            "--show-leak-kinds=definite,indirect",
        ]);
        run(valgrind.arg("--errors-for-leak-kinds=definite,indirect").arg(program));
    }
}
