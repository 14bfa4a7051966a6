//! What tests need beside Rust: a Vulkan adapter in software, a compiler of HLSL, a browser; what C users build and check with.

use crate::run::{Outcome, program, run, works};

const PACKAGES: &str = "chromium cmake glslang-tools libvulkan1 mesa-vulkan-drivers pkg-config valgrind";

/// In continuous integration, installs what is missing (Debian and Ubuntu, as root). Elsewhere the tests say what they skip.
pub fn install() -> Outcome {
    let is_installed = || works(&mut program(&format!("dpkg --status {PACKAGES}")));
    if std::env::var_os("CI").is_none() || is_installed() {
        return Ok(());
    }
    run(&mut program("apt-get update --quiet --quiet"))?;
    let line = format!("apt-get install --yes --quiet --quiet --no-install-recommends {PACKAGES}");
    run(program(&line).env("DEBIAN_FRONTEND", "noninteractive"))
}
