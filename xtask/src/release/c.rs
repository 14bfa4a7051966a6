//! The C archive: packed, unpacked elsewhere, compiled against and run.

use std::process::Command;

use super::work::{VERSION, empty_folder, print_size};
use crate::dist_c;
use crate::run::{Outcome, run};

/// Packs the folder of `cargo xtask dist-c`, and compiles and runs its examples from the unpacked archive.
pub fn check() -> Outcome {
    let made = dist_c::make_folder()?;
    let work = empty_folder("c")?;
    let archive =
        work.join(format!("darboux-{VERSION}-c-{}-{}.tar.gz", std::env::consts::OS, std::env::consts::ARCH));
    let around = made.parent().unwrap_or(&made);
    run(Command::new("tar").arg("czf").arg(&archive).arg("-C").arg(around).arg("darboux"))?;
    print_size(&archive);
    run(Command::new("tar").arg("xzf").arg(&archive).arg("-C").arg(&work))?;
    let (folder, out) = (work.join("darboux"), work.join("tangents"));
    let mut compiler = Command::new("cc");
    compiler
        .arg(folder.join("examples/tangents.c"))
        .arg("-I")
        .arg(folder.join("include"))
        .arg("-L")
        .arg(folder.join("lib"));
    compiler.arg("-ldarboux").arg(format!("-Wl,-rpath,{}", folder.join("lib").display()));
    run(compiler.arg("-o").arg(&out))?;
    run(&mut Command::new(out))?;
    let build = work.join("build");
    let mut cmake = Command::new("cmake");
    cmake.arg("-S").arg(folder.join("examples")).arg("-B").arg(&build).arg("--log-level=WARNING");
    run(cmake.arg(format!("-DCMAKE_PREFIX_PATH={}", folder.display())))?;
    run(Command::new("cmake").arg("--build").arg(&build))?;
    run(&mut Command::new(build.join("mikktspace")))
}
