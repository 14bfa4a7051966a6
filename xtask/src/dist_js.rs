//! `cargo xtask dist-js [--release]`: the folder of the npm package `darboux`.
//!
//! ```text
//! at the same time:  compile the WebAssembly modules
//!                    install the npm packages that bundling needs
//! then (build.mjs):  shrink each module (wasm-opt; only for a release), compress it, bundle it with the TypeScript side
//! ```
//!
//! A [`Build`] says which forms of the modules are made, and how much time goes into their size.
//!
//! Modules are compiled without function names in the end, but the names say which functions take the time:
//! see [`SIZE_FLAG`].

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::thread;
use std::time::SystemTime;

use wasmparser::{KnownCustom, Name, Parser, Payload};

use crate::npm;
use crate::progress::step;
use crate::run::{Outcome, files_below, program, root, run, target_folder, to_stderr, works};
use crate::validate::WithoutNpm;
use crate::wasm_c::Clang;

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The crate of the modules.
const PACKAGE: &str = "darboux-js";

/// WebAssembly without an operating system.
pub const TRIPLE: &str = "wasm32-unknown-unknown";

/// How the modules of a package are compiled.
#[derive(Clone, Copy, PartialEq)]
pub enum Build {
    /// For a first look: with SIMD only, quick to compile, several times as large.
    Quick,
    /// What is published: with and without SIMD, optimised across crates, shrunk.
    Release,
}

/// A form of a module: its name and its compiler flags.
type Form = (&'static str, &'static str);

const SIMD: Form = ("simd", "-Ctarget-feature=+simd128");
const SCALAR: Form = ("scalar", "");

impl Build {
    /// The name that `build.mjs` knows the build by, and the folder of its files.
    pub fn name(self) -> &'static str {
        match self {
            Build::Quick => "quick",
            Build::Release => "release",
        }
    }

    fn forms(self) -> &'static [Form] {
        match self {
            Build::Quick => &[SIMD],
            Build::Release => &[SIMD, SCALAR],
        }
    }

    /// The number of modules that are compiled at the same time. Quick ones share a target folder, which
    /// Cargo locks.
    fn threads(self) -> usize {
        match self {
            Build::Quick => 1,
            Build::Release => thread::available_parallelism().map_or(1, usize::from),
        }
    }
}

/// Compiles a package quickly in the target folder that all quick modules share, with SIMD. `clang`: where it
/// reads FBX. Returns the folder of the module.
pub fn compile_quickly(package: &str, features: &[&str], clang: Option<&Clang>) -> Result<PathBuf, String> {
    let target = target_folder()?.join("quick-modules");
    let mut cargo = program("cargo build --quiet --profile quick --package");
    cargo.args([package, "--target", TRIPLE]).args(features);
    cargo.env("CARGO_TARGET_DIR", &target).env("RUSTFLAGS", SIMD.1);
    clang.iter().for_each(|clang| clang.compile_ufbx(&mut cargo));
    run(to_stderr(&mut cargo))?;
    Ok(target.join(TRIPLE).join("quick"))
}

/// Flags of most modules: functions with several callers are not inlined, and loops of unknown length are not
/// unrolled. The modules are an eighth smaller for it and as fast. Optimisation levels for size would lose
/// vectorisation.
const FLAGS: &str = "-Cllvm-args=-inline-threshold=0 -Cllvm-args=-inlinehint-threshold=30 \
    -Cllvm-args=-unroll-runtime=false -Cllvm-args=-unroll-allow-partial=false";

/// A module: the entry of the npm package that embeds it, the features of `darboux-js`, compiler flags,
/// whether size matters more than speed outside the hot functions, and whether it reads files of models.
#[derive(Clone, Copy)]
pub struct Module {
    entry: &'static str,
    features: &'static str,
    flags: &'static str,
    is_small: bool,
    reads_models: bool,
}

impl Module {
    /// Features of `darboux-js`; with the reader of FBX where its compiler is there.
    fn all_features(self, clang: Option<&Clang>) -> String {
        let fbx = if self.reads_models && clang.is_some() { ",fbx" } else { "" };
        format!("{}{fbx}", self.features)
    }
}

/// The module of `darboux`.
pub const FULL: Module =
    Module { entry: "darboux", features: "full", flags: FLAGS, is_small: false, reads_models: false };

/// The module of `darboux/tangents`.
const SMALL: Module =
    Module { entry: "tangents", features: "", flags: FLAGS, is_small: true, reads_models: false };

/// The module of `darboux/check`.
pub const CHECK: Module =
    Module { entry: "check", features: "check", flags: FLAGS, is_small: false, reads_models: true };

/// The module of `darboux/bake`, without the flags: its rays call small functions in their innermost loops.
pub const BAKE: Module =
    Module { entry: "bake", features: "bake", flags: "", is_small: false, reads_models: true };

/// The modules of the whole package.
const ALL: [Module; 4] = [FULL, SMALL, CHECK, BAKE];

/// Optimises every function for size. The hot functions are excluded by name.
const SIZE_FLAG: &str = "-Cllvm-args=-force-attribute=optsize";

/// Part of the mangled name of every hot function: `Width::run`, which runs a kernel (`exec/simd.rs` of the
/// core).
const HOT_FUNCTION: &str = "5Width3run";

/// Makes the folder and runs the tests of the package.
pub fn test(without: WithoutNpm) -> Outcome {
    let has_tools = || works(&mut program("npm --version")) && Clang::find().is_ok();
    if matches!(without, WithoutNpm::Skip) && !has_tools() {
        println!("skipped: the npm package needs node, npm and clang");
        return Ok(());
    }
    make_folder(&folder()?, &ALL, Build::Release)?;
    run(program("npm test").current_dir(root().join("bindings/js")))
}

/// Makes the folder and prints its absolute path as the last line.
pub fn make(build: Build) -> Outcome {
    let count = ALL.len() * build.forms().len();
    eprintln!("dist-js makes the npm package: {count} WebAssembly modules, bundled with TypeScript");
    let folder = folder()?;
    make_folder(&folder, &ALL, build)?;
    println!("{}", folder.display());
    Ok(())
}

/// The path of the package.
pub fn folder() -> Result<PathBuf, String> {
    Ok(target_folder()?.join("dist-js/darboux"))
}

/// Makes the package with the entries of some modules.
pub fn make_folder(folder: &Path, modules: &[Module], build: Build) -> Outcome {
    run(to_stderr(&mut program(&format!("rustup target add {TRIPLE}"))))?;
    let clang = match build {
        Build::Quick => Clang::find_or_say(),
        Build::Release => Some(Clang::find()?),
    };
    let package = root().join("bindings/js");
    let compiled = target_folder()?.join("dist-js/modules").join(build.name());
    fs::create_dir_all(&compiled)
        .map_err(|error| format!("{} cannot be made: {error}", compiled.display()))?;
    let jobs: Vec<_> =
        modules.iter().flat_map(|module| build.forms().iter().map(|form| (*module, *form))).collect();
    let threads = build.threads().min(jobs.len());
    let queue = Mutex::new(jobs.into_iter());
    let next = || queue.lock().ok().and_then(|mut queue| queue.next());
    let compile_all = || {
        while let Some((module, form)) = next() {
            compile(module, form, build, clang.as_ref(), &compiled)?;
        }
        Ok(())
    };
    thread::scope(|scope| {
        let mut others = vec![scope.spawn(|| npm::install("bindings/js", &package))];
        others.extend((1..threads).map(|_| scope.spawn(compile_all)));
        let mine = compile_all();
        let others = others.into_iter().map(|thread| thread.join().expect("compiling does not panic"));
        others.fold(mine, Outcome::and)
    })?;
    let mut bundle = program("node build.mjs");
    bundle
        .args([&compiled, folder])
        .args([VERSION, build.name()])
        .args(modules.iter().map(|module| module.entry));
    run(to_stderr(bundle.current_dir(&package)))
}

/// Compiles one form of a module to `FOLDER/ENTRY.FORM.wasm`.
fn compile(module: Module, form: Form, build: Build, clang: Option<&Clang>, folder: &Path) -> Outcome {
    let features = module.all_features(clang);
    let built = match build {
        Build::Quick => step(&format!("compile the module of {}", module.entry), || {
            compile_quickly(PACKAGE, &["--no-default-features", "--features", &features], clang)
        })?,
        Build::Release => compile_for_release(module, form, &features, clang)?,
    };
    let (built, out) =
        (built.join("darboux_js.wasm"), folder.join(format!("{}.{}.wasm", module.entry, form.0)));
    fs::copy(&built, &out)
        .map(|_| ())
        .map_err(|error| format!("{} cannot be copied to {}: {error}", built.display(), out.display()))
}

/// Compiles one form of a module as it is published. Returns the folder of the module.
fn compile_for_release(
    module: Module,
    (form, form_flags): Form,
    features: &str,
    clang: Option<&Clang>,
) -> Result<PathBuf, String> {
    let Module { entry, flags, is_small, .. } = module;
    let target = target_folder()?.join("dist-js").join(format!("{entry}-{form}"));
    let hot = if is_small { hot_functions(&target)? } else { BTreeSet::new() };
    let size = if is_small { format!(" {SIZE_FLAG}{}", excluded(&hot)) } else { String::new() };
    step(&format!("compile the module of {entry} ({form})"), || {
        let mut cargo = cargo_build(PACKAGE, &target);
        cargo.args(["--no-default-features", "--features", features]);
        clang.iter().for_each(|clang| clang.compile_ufbx(&mut cargo));
        run(to_stderr(cargo.env("RUSTFLAGS", format!("{form_flags} {flags}{size}"))))
    })?;
    let built = target.join(TRIPLE).join("dist");
    if is_small {
        check_hot_functions(&built.join("darboux_js.wasm"), &hot)?;
    }
    Ok(built)
}

fn cargo_build(package: &str, target: &Path) -> std::process::Command {
    let mut cargo = program("cargo build --quiet --profile dist --package");
    cargo.args([package, "--target", TRIPLE]).env("CARGO_TARGET_DIR", target);
    // Names are needed to find functions; `build.mjs` strips them. The setting is part of the mangled names,
    // too.
    cargo.env("CARGO_PROFILE_DIST_STRIP", "none");
    cargo
}

/// The mangled names of the hot functions, from the core's LLVM IR before optimisation, which takes seconds
/// to make. Compiler flags are no part of mangled names.
fn hot_functions(target: &Path) -> Result<BTreeSet<String>, String> {
    let target = target.join("names");
    let mut cargo = cargo_build("darboux", &target);
    cargo.env("RUSTFLAGS", "-Cno-prepopulate-passes --emit=llvm-ir");
    step("list the hot functions of the core", || run(to_stderr(&mut cargo)))?;
    let files = files_below(&target.join(TRIPLE).join("dist/deps"))?.into_iter();
    let newest =
        files.filter(|path| path.extension().is_some_and(|extension| extension == "ll")).max_by_key(|path| {
            path.metadata().and_then(|data| data.modified()).unwrap_or(SystemTime::UNIX_EPOCH)
        });
    let path = newest.ok_or_else(|| format!("{} has no LLVM IR of the core", target.display()))?;
    let text =
        fs::read_to_string(&path).map_err(|error| format!("{} cannot be read: {error}", path.display()))?;
    let defined = text.lines().filter(|line| line.starts_with("define ")).filter_map(|line| {
        let (_, rest) = line.split_once('@')?;
        rest.split_once('(').map(|(name, _)| name.trim_matches('"'))
    });
    Ok(defined.filter(|name| name.contains(HOT_FUNCTION)).map(str::to_owned).collect())
}

/// Flags that exclude functions from [`SIZE_FLAG`].
fn excluded(functions: &BTreeSet<String>) -> String {
    functions.iter().map(|name| format!(" -Cllvm-args=-force-remove-attribute={name}:optsize")).collect()
}

/// Errors: the module has hot functions that were not excluded from [`SIZE_FLAG`], or none at all.
fn check_hot_functions(module: &Path, excluded: &BTreeSet<String>) -> Outcome {
    let read = fs::read(module).map_err(|error| format!("{} cannot be read: {error}", module.display()))?;
    let names = names(&read).map_err(|error| format!("{} has no names: {error}", module.display()))?;
    let found: BTreeSet<&str> = names.into_iter().filter(|name| name.contains(HOT_FUNCTION)).collect();
    if found.is_empty() || found.iter().any(|name| !excluded.contains(*name)) {
        return Err(format!(
            "{}: a hot function (*{HOT_FUNCTION}*) was optimised for size and is slow",
            module.display()
        ));
    }
    Ok(())
}

/// The functions of a module, as the compiler names them.
fn names(module: &[u8]) -> wasmparser::Result<Vec<&str>> {
    let mut names = Vec::new();
    for payload in Parser::new(0).parse_all(module) {
        let Payload::CustomSection(section) = payload? else { continue };
        let KnownCustom::Name(parts) = section.as_known() else { continue };
        for part in parts {
            if let Name::Function(functions) = part? {
                for function in functions {
                    names.push(function?.name);
                }
            }
        }
    }
    Ok(names)
}
