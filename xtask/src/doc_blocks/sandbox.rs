//! Folders with sample files, programs on the search path, and one runner per language.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::blocks::{Block, Page, at_their_lines, with_exit_statuses};
use crate::python;
use crate::run::{Outcome, files_below, program, root, run, shown, target_folder, works};

/// The files that pages use as if they were the reader's, and the assets that stand for them.
const SAMPLES: &[(&str, &str)] = &[
    ("model.glb", "assets/made/shield.glb"),
    ("baked.glb", "assets/made/shield.glb"),
    ("shipped.glb", "assets/made/shield.glb"),
    ("before.glb", "assets/made/shield.glb"),
    ("after.glb", "assets/made/shield.glb"),
    ("part.glb", "assets/Fox/Fox.glb"),
    ("models/one.glb", "assets/NormalTangentTest/NormalTangentTest.glb"),
    ("models/fox.glb", "assets/Fox/Fox.glb"),
    ("brick_n.png", "assets/TwoSidedPlane/TwoSidedPlane_Normal.png"),
    ("map.png", "assets/TwoSidedPlane/TwoSidedPlane_Normal.png"),
];

/// The command. `darboux compare` exits with 3 where files differ, which does not make a page fail. `darboux
/// view` does not end.
const DARBOUX: &str = r#"#!/bin/sh
if [ "$1" = view ]; then echo "darboux view does not end: mark this block as not run" >&2; exit 1; fi
'@PROGRAM@' "$@"
status=$?
if [ $status = 3 ]; then exit 0; fi
exit $status
"#;

/// `cargo run` starts the command that is built already, with the features that the line asks for. `cargo
/// xtask dist-c` runs; other tasks take too long. All other commands run the real cargo.
const CARGO: &str = r#"#!/bin/sh
case "$1 $2" in
"xtask dist-c") exec '@XTASK@' dist-c ;;
xtask*) echo "cargo $* takes long: mark this block as not run" >&2; exit 1 ;;
run*)
  line="cargo $*"
  program='@DEFAULT@'
  while [ $# -gt 0 ] && [ "$1" != -- ]; do
    case "$1" in
    run | --release | --quiet) ;;
    --features) shift; if [ "$1" = full ]; then program='@FULL@'; else program=; fi ;;
    *) program= ;;
    esac
    shift
  done
  if [ $# = 0 ] || [ -z "$program" ]; then
    echo "$line: only cargo run [--release] [--features full] -- ... is run here; change the line, or mark this block as not run" >&2
    exit 1
  fi
  shift
  exec "$program" "$@" ;;
esac
cd '@ROOT@' && exec '@CARGO@' "$@"
"#;

/// The command as pages call it, with all features.
const FULL: &str = "programs/darboux";

/// The command with its default features, which only `cargo run` starts.
const DEFAULT: &str = "darboux-with-default-features";

/// Where pages run.
pub struct Sandbox {
    folder: PathBuf,
    target: PathBuf,
}

impl Sandbox {
    /// Builds the command with its default features and with all, and makes an empty folder.
    pub fn new() -> Result<Self, String> {
        let target = target_folder()?;
        let folder = target.join("docs");
        if folder.exists() {
            fs::remove_dir_all(&folder)
                .map_err(|error| format!("{} cannot be removed: {error}", folder.display()))?;
        }
        let programs = folder.join("programs");
        make(&programs)?;
        for (name, features) in [(DEFAULT, ""), (FULL, "--all-features")] {
            run(&mut program(&format!("cargo build --quiet --package darboux-cli {features}")))?;
            let built = folder.join("built").join(name);
            copy(&target.join("debug/darboux"), &built)?;
            script(&folder.join(name), &DARBOUX.replace("@PROGRAM@", &built.display().to_string()))?;
        }
        let own = std::env::current_exe().map_err(|error| format!("this program is not found: {error}"))?;
        let cargo = CARGO
            .replace("@XTASK@", &own.display().to_string())
            .replace("@DEFAULT@", &folder.join(DEFAULT).display().to_string())
            .replace("@FULL@", &folder.join(FULL).display().to_string())
            .replace("@ROOT@", &root().display().to_string())
            .replace("@CARGO@", &std::env::var("CARGO").unwrap_or_else(|_| "cargo".into()));
        script(&programs.join("cargo"), &cargo)?;
        Ok(Self { folder, target })
    }

    /// Makes a page's folder: the samples, the assets, and the repository beside it as `../darboux`.
    pub fn page_folder(&self, page: &str) -> Result<PathBuf, String> {
        let around = self.folder.join(page.replace(['/', '.'], "-"));
        let folder = around.join("work");
        make(&folder)?;
        #[cfg(unix)]
        std::os::unix::fs::symlink(root(), around.join("darboux"))
            .map_err(|error| format!("{} cannot be made: {error}", around.join("darboux").display()))?;
        for asset in files_below(&root().join("assets"))? {
            copy(&asset, &folder.join(asset.strip_prefix(root()).unwrap_or(&asset)))?;
        }
        for (name, asset) in SAMPLES {
            copy(&root().join(asset), &folder.join(name))?;
        }
        Ok(folder)
    }

    /// Runs shell blocks as one script, so that variables of one block are there in the next.
    pub fn shell(&self, page: &Page, blocks: &[&Block], folder: &Path) -> Outcome {
        if blocks.is_empty() {
            return Ok(());
        }
        let path = folder.with_file_name("page.sh");
        let start =
            format!("set -euo pipefail; trap 'echo \"{}:$LINENO: this command failed\"' ERR", page.name);
        // The first line of a page is never code.
        write(&path, &(start + &with_exit_statuses(&at_their_lines(blocks))))?;
        let own = self.folder.join("programs");
        let search = match std::env::var_os("PATH") {
            Some(others) => format!("{}:{}", own.display(), others.to_string_lossy()),
            None => own.display().to_string(),
        };
        let mut bash = Command::new("bash");
        bash.arg(&path).current_dir(folder).env("PATH", search).stdin(Stdio::null());
        quietly(&mut bash)
    }

    /// Compiles C or C++ blocks against the headers and runs them. Blocks without `main` become its body;
    /// hidden ones with `#include` and blocks with `main` stay outside of it.
    pub fn c_program(&self, page: &Page, blocks: &[&Block], language: &str, folder: &Path) -> Outcome {
        if blocks.is_empty() {
            return Ok(());
        }
        run(&mut program("cargo rustc --quiet --package darboux-c --lib --crate-type cdylib"))?;
        let is_outside = |block: &&&Block| block.text.contains("#include") || block.text.contains("int main");
        let line = |block: &&Block| format!("#line {} \"{}\"\n{}", block.line, page.name, block.text);
        let mut text: String = blocks.iter().filter(is_outside).map(line).collect();
        if !text.contains("int main") {
            let body: String = blocks.iter().filter(|block| !is_outside(block)).map(line).collect();
            text += &format!("int main() {{\n{body}return 0;\n}}\n");
        }
        let source = folder.with_file_name(format!("page.{language}"));
        write(&source, &text)?;
        let mut compiler = match language {
            "c" => Command::new("cc"),
            _ => Command::new("c++"),
        };
        compiler.arg(if language == "c" { "-std=c99" } else { "-std=c++17" });
        compiler
            .args(["-Wall", "-Wextra", "-Wno-unused", "-Werror", "-I"])
            .arg(root().join("bindings/c/include"));
        let libraries = self.target.join("debug");
        let out = folder.with_file_name("page.out");
        compiler.arg(&source).arg("-L").arg(&libraries).args(["-ldarboux_c", "-o"]).arg(&out);
        quietly(compiler.arg(format!("-Wl,-rpath,{}", libraries.display())))?;
        quietly(Command::new(out).current_dir(folder))
    }

    /// Runs Python blocks as one program, with the package installed.
    pub fn python(&self, page: &Page, blocks: &[&Block], folder: &Path) -> Outcome {
        if blocks.is_empty() {
            return Ok(());
        }
        let Some(interpreter) = python::with_package()? else {
            println!("skipped: the Python blocks of {} need python3 with venv", page.name);
            return Ok(());
        };
        let path = folder.with_file_name(page.name.replace('/', "-") + ".py");
        write(&path, &at_their_lines(blocks))?;
        quietly(Command::new(interpreter).arg(path).current_dir(folder))
    }

    /// Runs JavaScript blocks as one module of Node.js.
    pub fn javascript(&self, page: &Page, blocks: &[&Block], folder: &Path) -> Outcome {
        if blocks.is_empty() {
            return Ok(());
        }
        if !works(program("node --version").stdout(Stdio::null())) {
            println!("skipped: the JavaScript blocks of {} need node", page.name);
            return Ok(());
        }
        let path = folder.with_file_name(page.name.replace('/', "-") + ".mjs");
        write(&path, &at_their_lines(blocks))?;
        quietly(Command::new("node").arg(path).current_dir(folder))
    }

    /// Has cargo read a TOML block, beside an empty library. A block without `[package]` gets one.
    pub fn manifest(&self, page: &Page, block: &Block, folder: &Path) -> Outcome {
        let folder = folder.join("manifest");
        make(&folder.join("src"))?;
        write(&folder.join("src/lib.rs"), "")?;
        let package = "[package]\nname = \"example\"\nedition = \"2024\"\n[workspace]\n";
        let is_complete = block.text.contains("[package]");
        write(
            &folder.join("Cargo.toml"),
            &(if is_complete { "" } else { package }.to_owned() + &block.text),
        )?;
        let mut cargo = program("cargo metadata --quiet --format-version 1 --no-deps");
        cargo.current_dir(&folder);
        if works(&mut cargo) {
            Ok(())
        } else {
            Err(format!("{}:{}: cargo rejects this manifest", page.name, block.line))
        }
    }
}

/// Runs a program; what it prints is shown only if it fails.
fn quietly(command: &mut Command) -> Outcome {
    let output = command.output().map_err(|error| format!("{} cannot start: {error}", shown(command)))?;
    if output.status.success() {
        return Ok(());
    }
    let text = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    Err(text.concat().trim_end().to_owned())
}

/// Writes a program in sh.
fn script(path: &Path, text: &str) -> Outcome {
    write(path, text)?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(path, fs::Permissions::from_mode(0o755))
            .map_err(|error| format!("{} cannot be made executable: {error}", path.display()))?;
    }
    Ok(())
}

fn copy(from: &Path, to: &Path) -> Outcome {
    make(to.parent().unwrap_or(to))?;
    fs::copy(from, to).map(|_| ()).map_err(|error| format!("{} cannot be copied: {error}", from.display()))
}

fn make(folder: &Path) -> Outcome {
    fs::create_dir_all(folder).map_err(|error| format!("{} cannot be made: {error}", folder.display()))
}

fn write(path: &Path, text: &str) -> Outcome {
    fs::write(path, text).map_err(|error| format!("{} cannot be written: {error}", path.display()))
}
