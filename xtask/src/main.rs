//! `cargo xtask <task>`: every check, generator, measurement and package that a person or CI runs.

mod api;
mod bake_pictures;
mod bench;
mod bench_files;
mod ci;
mod comments;
mod conformance;
mod default_build;
mod dist_c;
mod dist_js;
mod dist_viewer;
mod doc_blocks;
mod functions;
mod generated;
mod gpu;
mod layers;
mod lines;
mod npm;
mod packages;
mod progress;
mod python;
mod release;
mod run;
mod rust_code;
mod shaders;
mod site;
#[cfg(unix)]
mod soak;
mod validate;
mod wasm_c;

use std::process::ExitCode;

use crate::dist_js::Build;

const USAGE: &str = "\
usage: cargo xtask <task>

checks
  ci [--full]      run the checks that must pass before a change lands; --full adds those that take long
  layers           check which packages import which, and that the files of a package import each other without cycles
  links            check that pages of the documentation have titles, and that their links lead to files and headings that exist
  lines            print the lines of code of each part, without comments, blank lines and unit tests
  docs [PAGE ...]  run the code blocks of the documentation, twice
  validate         check the command's outputs for all models with independent tools (needs node and npm)
  soak [...]       run the command on damaged and hostile files (Unix); options: soak --help
  conformance [ADAPTER ...] | --wrong [ADAPTER ...] | --regenerate | --new A B [MESHES [SEED]]
                   judge every implementation that this machine can install (conformance/), and rebuild the table and the page;
                   run the same on wrong inputs and as wrong builds, which the suite must notice;
                   write the expected values of all cases; propose new cases from a differential run
  acos             compare the core's acos with the platform's on every float of [-1, 1]
  arm              run the tests of bits on emulated 64-bit Arm (Debian: needs gcc and g++ for aarch64-linux-gnu, qemu-user; rustup)

generated files
  gen              write them: command-line reference, man pages, completions, darboux.h, shaders, lists of the public API
  bake-pictures    draw the pictures of docs/bake.md (minutes; needs a Vulkan adapter)

measurements
  bench [...]      time every engine on every mesh; options: bench --help
  maps [...]       judge generated normal maps, and print how often the verdicts are right, and how sure they were; options: maps --help
  maps --real FOLDER ...
                   print the verdicts on the normal maps below folders, as they are and with green inverted
  bench --files [SIDE]
                   time tangents for a file of a grid, 708 quads per side by default, beside other tools (needs npm and GNU time)
  bench --gpu      time everything on every adapter: [--quick] [TRIANGLES ...]
  bench --bake SIZE THREADS [MODEL ...]
                   bake the same pairs with Blender's Cycles and with Darboux: errors in degrees and times (needs python3.11)
  gpu [...]        on a machine with a GPU: record its tests, report and times in benches/record/gpu:
                   [pack] [--out FOLDER] [devices] [tests] [command] [report] [times] [long] [options of bench --gpu]

packages (the path is the last line of the output)
  site [--test]    make the documentation's site (needs what dist-js needs); --test: and test it in Chromium
  dist-c           make the folder for users of C and C++ (Linux: needs ld, objcopy, nm and ar)
  dist-js [--release]
                   make the folder of the npm package (needs node, npm, rustup and, for FBX, clang)
  dist-viewer [--release]
                   make the viewer's page, which darboux view serves (needs what dist-js needs);
                   without --release both have only modules with SIMD, which are large and quick to compile,
                   and leave FBX out if clang is missing
  dist-python      build the Python wheel (needs python3 with venv, and the network)
  release          make the archive with the command and the viewer for this machine (needs what dist-viewer needs, and tar)
  release --check [--since TAG] [metadata] [msrv] [crates] [c] [python] [npm]
                   make all packages, install each into an empty folder and run its example;
                   TAG: compare the public API with that of an earlier release";

fn main() -> ExitCode {
    if std::env::var_os(api::AS_RUSTDOC).is_some() {
        return api::run_rustdoc();
    }
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let result = match arguments[..] {
        ["ci"] => ci::quick(),
        ["ci", "--full"] => ci::full(),
        ["gen"] => generated::write(),
        ["bake-pictures"] => bake_pictures::draw(),
        ["site"] => site::make(),
        ["site", "--test"] => site::test(),
        ["layers"] => layers::check(),
        ["lines"] => lines::print(),
        ["links"] => site::check(),
        ["release"] => release::archive::make(),
        ["release", "--check", ref words @ ..] => release::check(words),
        ["docs", ref pages @ ..] => doc_blocks::run(pages),
        ["validate"] => validate::all_models(validate::WithoutNpm::Fail),
        ["bench", "--files", ref words @ ..] => bench_files::bench(words),
        ["bench", "--gpu", ref options @ ..] => bench::bench_gpu(options),
        ["bench", "--bake", ref words @ ..] => bench::bench_bake(words),
        ["bench", ref options @ ..] => bench::bench(options),
        ["gpu", ref words @ ..] => gpu::Arguments::new(words).and_then(|arguments| gpu::record(&arguments)),
        ["maps", "--real", ref folders @ ..] => bench::judge_real_maps(folders),
        ["maps", ref options @ ..] => bench::judge_maps(options),
        ["dist-c"] => dist_c::make(),
        ["dist-js"] => dist_js::make(Build::Quick),
        ["dist-js", "--release"] => dist_js::make(Build::Release),
        ["dist-viewer"] => dist_viewer::make(Build::Quick),
        ["dist-viewer", "--release"] => dist_viewer::make(Build::Release),
        ["dist-python"] => python::dist(),
        #[cfg(unix)]
        ["soak", ref words @ ..] => soak::run(words),
        ["conformance", ref words @ ..] => conformance::task(words),
        ["acos"] => ci::acos(),
        ["arm"] => ci::arm(),
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("xtask: {message}");
            ExitCode::FAILURE
        }
    }
}
