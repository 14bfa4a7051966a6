//! `cargo xtask dist-c`: the folder for users of C and C++, with headers, libraries, CMake and pkg-config
//! files, and examples.
//!
//! The two libraries contain the core with different features, so they share nothing. They are built at the
//! same time, each in a target folder of its own.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;
use std::time::Instant;

use crate::progress::step;
use crate::run::{Outcome, output_of, program, root, run, target_folder, to_stderr};

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// A shipped library.
struct Library {
    package: &'static str,
    /// Its name in cargo's target folder.
    built: &'static str,
    /// Its name in the shipped folder.
    shipped: &'static str,
    /// A pattern for the names of its public functions.
    functions: &'static str,
}

const LIBRARIES: &[Library] = &[
    Library { package: "darboux-c", built: "darboux_c", shipped: "darboux", functions: "darboux_*" },
    Library {
        package: "darboux-mikktspace",
        built: "darboux_mikktspace",
        shipped: "darboux_mikktspace",
        functions: "genTangSpace*",
    },
];

/// Files that are copied unchanged: their paths in bindings/c and in the shipped folder.
const FILES: &[(&str, &str)] = &[
    ("include/darboux.h", "include/darboux.h"),
    ("include/darboux.hpp", "include/darboux.hpp"),
    // In a folder of its own, because programs may have another file of this name.
    ("include/mikktspace.h", "include/mikktspace/mikktspace.h"),
    ("cmake/darboux-config.cmake", "cmake/darboux-config.cmake"),
    ("examples/CMakeLists.txt", "examples/CMakeLists.txt"),
    ("examples/tangents.c", "examples/tangents.c"),
    ("examples/tangents.cpp", "examples/tangents.cpp"),
    ("examples/vertices.c", "examples/vertices.c"),
    ("examples/vertices.cpp", "examples/vertices.cpp"),
    ("examples/mikktspace.c", "examples/mikktspace.c"),
    ("../../LICENSE-APACHE", "LICENSE-APACHE"),
    ("../../LICENSE-MIT", "LICENSE-MIT"),
];

/// Files in which the version is filled in: their paths in bindings/c and in the shipped folder.
const TEMPLATES: &[(&str, &str)] = &[
    ("cmake/darboux-config-version.cmake.in", "cmake/darboux-config-version.cmake"),
    ("pkgconfig/darboux.pc.in", "lib/pkgconfig/darboux.pc"),
    ("pkgconfig/darboux_mikktspace.pc.in", "lib/pkgconfig/darboux_mikktspace.pc"),
];

/// `cargo xtask dist-c`: makes the folder, and prints its absolute path as the last line.
pub fn make() -> Outcome {
    println!("{}", make_folder()?.display());
    Ok(())
}

/// Makes the folder; gives its path. Progress goes to standard error.
pub fn make_folder() -> Result<PathBuf, String> {
    let start = Instant::now();
    if !matches!(std::env::consts::OS, "linux" | "macos") {
        return Err(format!(
            "dist-c makes the folder on Linux and macOS, not on {}; docs/c.md says how the libraries are \
             built elsewhere",
            std::env::consts::OS
        ));
    }
    let target = target_folder()?;
    let folder = target.join("dist-c/darboux");
    if folder.exists() {
        fs::remove_dir_all(&folder)
            .map_err(|error| format!("{} cannot be removed: {error}", folder.display()))?;
    }
    eprintln!("dist-c makes the folder for C and C++: {} libraries, each shared and static", LIBRARIES.len());
    thread::scope(|scope| {
        let put =
            |library| put_library(library, &target.join("dist-c").join(library.built), &folder.join("lib"));
        let threads: Vec<_> = LIBRARIES.iter().map(|library| scope.spawn(move || put(library))).collect();
        let results = threads.into_iter().map(|thread| thread.join().expect("building does not panic"));
        results.fold(Ok(()), Outcome::and)
    })?;
    let ours = root().join("bindings/c");
    FILES.iter().try_for_each(|(from, to)| copy(&ours.join(from), &folder.join(to)))?;
    TEMPLATES.iter().try_for_each(|(from, to)| fill_in(&ours.join(from), &folder.join(to)))?;
    eprintln!("dist-c: done after {:.1} s", start.elapsed().as_secs_f32());
    Ok(folder)
}

/// The part of the version that stays while programs need not be linked again: before 1.0 major and minor.
fn series() -> String {
    VERSION.split('.').take(2).collect::<Vec<_>>().join(".")
}

fn shared_name(library: &Library, version: &str) -> String {
    match (std::env::consts::OS, version) {
        ("macos", "") => format!("lib{}.dylib", library.shipped),
        ("macos", version) => format!("lib{}.{version}.dylib", library.shipped),
        (_, "") => format!("lib{}.so", library.shipped),
        (_, version) => format!("lib{}.so.{version}", library.shipped),
    }
}

/// Builds a library in a target folder and puts its shared and its static form into the shipped folder.
fn put_library(library: &Library, target: &Path, folder: &Path) -> Outcome {
    step(&format!("compile lib{}", library.shipped), || build(library, target))?;
    let built = target.join("dist").join(format!("lib{}", library.built));
    put_shared(library, &built, folder)?;
    put_static(library, &built, folder)
}

/// Builds the shared and the static library. The shared one carries the name that loaders look for.
fn build(library: &Library, target: &Path) -> Outcome {
    let name = shared_name(library, &series());
    let own_name = if cfg!(target_os = "macos") {
        format!("link-arg=-Wl,-install_name,@rpath/{name}")
    } else {
        format!("link-arg=-Wl,-soname,{name}")
    };
    let mut cargo =
        program("cargo rustc --quiet --profile dist --lib --crate-type cdylib,staticlib --target-dir");
    run(to_stderr(cargo.arg(target).args(["--package", library.package, "--", "-C", &own_name])))
}

/// Copies the shared library under its full name, and makes links under the names that loaders and linkers
/// look for.
fn put_shared(library: &Library, built: &Path, folder: &Path) -> Outcome {
    let extension = if cfg!(target_os = "macos") { "dylib" } else { "so" };
    let name = shared_name(library, VERSION);
    copy(&built.with_extension(extension), &folder.join(&name))?;
    for link in [shared_name(library, &series()), shared_name(library, "")] {
        link_to(&name, &folder.join(link))?;
    }
    Ok(())
}

#[cfg(unix)]
fn link_to(name: &str, link: &Path) -> Outcome {
    std::os::unix::fs::symlink(name, link)
        .map_err(|error| format!("{} cannot be made: {error}", link.display()))
}

#[cfg(not(unix))]
fn link_to(name: &str, link: &Path) -> Outcome {
    copy(&link.with_file_name(name), link)
}

/// Copies the static library. On Linux it becomes one object whose only global symbols are its public
/// functions. Otherwise two libraries that both contain Rust's standard library could not be linked into one
/// program.
fn put_static(library: &Library, built: &Path, folder: &Path) -> Outcome {
    let (archive, out) = (built.with_extension("a"), folder.join(format!("lib{}.a", library.shipped)));
    if !cfg!(target_os = "linux") {
        return copy(&archive, &out);
    }
    let object = built.with_extension("o");
    let mut link = Command::new("ld");
    link.args(["-r", "--gc-sections", "--force-group-allocation"]);
    for function in functions(&built.with_extension("so"))? {
        link.args(["-u", &function]);
    }
    run(link.arg("-o").args([&object, &archive]))?;
    let mut hide = Command::new("objcopy");
    hide.args(["--strip-debug", "--remove-section=.llvmbc", "--remove-section=.llvmcmd", "--wildcard"]);
    run(hide.arg(format!("--keep-global-symbol={}", library.functions)).arg(&object))?;
    run(Command::new("ar").arg("rcs").args([&out, &object]))
}

/// The names of a shared library's exported functions.
fn functions(library: &Path) -> Result<Vec<String>, String> {
    let listed =
        output_of(Command::new("nm").args(["-D", "--defined-only", "--format=just-symbols"]).arg(library))?;
    Ok(String::from_utf8_lossy(&listed).lines().map(str::to_owned).collect())
}

fn copy(from: &Path, to: &Path) -> Outcome {
    make_folder_of(to)?;
    fs::copy(from, to).map(|_| ()).map_err(|error| format!("{} cannot be copied: {error}", from.display()))
}

fn fill_in(from: &Path, to: &Path) -> Outcome {
    let system = if cfg!(target_os = "macos") { "" } else { "-lgcc_s -lpthread -lm -ldl" };
    let text =
        fs::read_to_string(from).map_err(|error| format!("{} cannot be read: {error}", from.display()))?;
    let text = text.replace("@VERSION@", VERSION).replace("@SERIES@", &series()).replace("@SYSTEM@", system);
    make_folder_of(to)?;
    fs::write(to, text).map_err(|error| format!("{} cannot be written: {error}", to.display()))
}

fn make_folder_of(file: &Path) -> Outcome {
    let Some(folder) = file.parent() else { return Ok(()) };
    fs::create_dir_all(folder).map_err(|error| format!("{} cannot be made: {error}", folder.display()))
}
