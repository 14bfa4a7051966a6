//! `cargo xtask <task>`: everything a person or CI runs.

mod api;
mod bench;
mod ci;
mod default_build;
mod dist_c;
mod dist_js;
mod dist_viewer;
mod doc_blocks;
mod generated;
mod gpu;
mod layers;
mod npm;
mod packages;
mod progress;
mod python;
mod release;
mod run;
mod rust_code;
mod shaders;
mod validate;

use std::process::ExitCode;

const USAGE: &str = "\
usage: cargo xtask <task>

  ci [--full]   what must hold before a change lands; --full adds what is long
  gen           write the generated files (command-line reference, man pages, completions, darboux.h, shaders)
  layers        check which packages import which, and that files import each other without cycles
  docs [PAGE]   run every code block of the documentation twice
  validate      check the command's outputs for all models with independent tools (needs node and npm)
  bench [...]   time every engine on every mesh; see bench --help
  bench --gpu   time everything on every adapter: [--quick] [TRIANGLES ...]
  gpu [...]     on a machine with a GPU: its tests, report and times, recorded in benches/record/gpu: [pack] [--out FOLDER]
                [devices] [tests] [command] [report] [times] [long] [options of bench --gpu]
  dist-c        make the folder for users of C and C++; its path is the last line (Linux: needs ld, objcopy, nm and ar)
  dist-js       make the folder of the npm package; its path is the last line (needs node, npm and rustup)
  dist-viewer   make the viewer's page, which darboux view serves; its folder is the last line (needs what dist-js needs)
  dist-python   build the Python wheel; its folder is the last line (needs python3 with venv, and the network)
  acos          compare acos with the platform's on every float of [-1, 1]
  arm           the tests of bits on 64-bit Arm, emulated (Debian: needs gcc and g++ for aarch64-linux-gnu, qemu-user; rustup)";

fn main() -> ExitCode {
    if let Some(folder) = std::env::var_os(api::EXPAND_INTO) {
        return api::wrap_compiler(&folder);
    }
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let result = match arguments[..] {
        ["ci"] => ci::quick(),
        ["ci", "--full"] => ci::full(),
        ["gen"] => generated::write(),
        ["layers"] => layers::check(),
        ["release", "--check", ref words @ ..] => release::check(words),
        ["docs", ref pages @ ..] => doc_blocks::run(pages),
        ["validate"] => validate::all_models(validate::WithoutNpm::Fail),
        ["bench", "--gpu", ref options @ ..] => bench::bench_gpu(options),
        ["bench", ref options @ ..] => bench::bench(options),
        ["gpu", ref words @ ..] => gpu::Wanted::new(words).and_then(|wanted| gpu::record(&wanted)),
        ["dist-c"] => dist_c::make(),
        ["dist-js"] => dist_js::make(),
        ["dist-viewer"] => dist_viewer::make(),
        ["dist-python"] => python::dist(),
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
