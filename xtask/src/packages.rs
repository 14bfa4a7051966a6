//! What tests need beside Rust, from Debian and Ubuntu.

use crate::run::{Outcome, program, run, works};

/// A Vulkan adapter in software, a compiler of HLSL, a browser; what C users build and check with.
pub const FOR_TESTS: &str = "chromium cmake glslang-tools libvulkan1 mesa-vulkan-drivers pkg-config valgrind";

/// Compilers for 64-bit Arm, and an emulator of it.
pub const FOR_ARM: &str = "gcc-aarch64-linux-gnu g++-aarch64-linux-gnu qemu-user";

/// In continuous integration, installs what is missing, as root. Elsewhere the tests say what they skip or lack.
pub fn install(packages: &str) -> Outcome {
    let is_installed = || works(&mut program(&format!("dpkg --status {packages}")));
    if std::env::var_os("CI").is_none() || is_installed() {
        return Ok(());
    }
    run(&mut program("apt-get update --quiet --quiet"))?;
    let line = format!("apt-get install --yes --quiet --quiet --no-install-recommends {packages}");
    run(program(&line).env("DEBIAN_FRONTEND", "noninteractive"))
}
