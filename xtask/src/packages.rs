//! Packages of Debian and Ubuntu that tests need.

use crate::run::{Outcome, program, run, works};

/// A software Vulkan adapter, a compiler for HLSL, a browser, tools that build and check C programs, and the
/// C compiler of WebAssembly (some 50 MB to download).
pub const FOR_TESTS: &str =
    "chromium clang cmake glslang-tools libvulkan1 mesa-vulkan-drivers pkg-config valgrind";

/// Compilers and an emulator for 64-bit Arm.
pub const FOR_ARM: &str = "gcc-aarch64-linux-gnu g++-aarch64-linux-gnu qemu-user";

/// In CI, installs missing packages as root. Elsewhere tests print what they skip.
pub fn install(packages: &str) -> Outcome {
    let is_installed = || works(&mut program(&format!("dpkg --status {packages}")));
    if std::env::var_os("CI").is_none() || is_installed() {
        return Ok(());
    }
    run(&mut program("apt-get update --quiet --quiet"))?;
    let line = format!("apt-get install --yes --quiet --quiet --no-install-recommends {packages}");
    run(program(&line).env("DEBIAN_FRONTEND", "noninteractive"))
}
