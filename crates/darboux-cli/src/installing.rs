//! The command line that installs what this build lacks.

use clap::builder::{Resettable, StyledStr};

/// The parts of the command that a build may lack, and whether this one has them.
const PARTS: [(&str, bool); 7] = [
    ("darboux bake", cfg!(feature = "bake")),
    ("darboux render", cfg!(feature = "gpu")),
    ("darboux view", cfg!(feature = "view")),
    ("darboux devices", cfg!(feature = "gpu")),
    ("GPUs", cfg!(feature = "gpu")),
    ("models in FBX", cfg!(feature = "fbx")),
    ("maps in KTX 2", cfg!(feature = "ktx2")),
];

/// The parts that this build lacks and how to install them, for the end of the help; none if it has all.
pub fn left_out() -> Resettable<StyledStr> {
    let missing: Vec<&str> = PARTS.iter().filter(|(_, is_here)| !is_here).map(|(name, _)| *name).collect();
    let sentence =
        || format!("Not in this build: {}. To install all: {}", missing.join(", "), install_with("full"));
    (!missing.is_empty()).then(|| sentence().into()).into()
}

/// The command line that installs the command with a feature.
pub fn install_with(feature: &str) -> String {
    format!("cargo install --locked {} --features {feature}", package(env!("CARGO_MANIFEST_DIR")))
}

/// What `cargo install` is told to build. `folder`: where the sources of this build were. The folder of a
/// package from a registry ends with its version; cargo keeps what `cargo install --git` builds in a folder
/// of its own, of which a user knows only the address.
fn package(folder: &str) -> &'static str {
    let is_checkout = folder.ends_with("darboux-cli");
    let is_of_git = folder.contains("/git/checkouts/") || folder.contains(r"\git\checkouts\");
    match (is_checkout, is_of_git) {
        (true, true) => "--git ADDRESS darboux-cli",
        (true, false) => "--path crates/darboux-cli",
        (false, _) => "darboux-cli",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_installs_from_where_this_build_came() {
        assert_eq!(package("/home/a/darboux/crates/darboux-cli"), "--path crates/darboux-cli");
        assert_eq!(package(r"C:\darboux\crates\darboux-cli"), "--path crates/darboux-cli");
        assert_eq!(
            package("/home/a/.cargo/registry/src/index.crates.io-1949cf8c6b5b557f/darboux-cli-0.1.0"),
            "darboux-cli"
        );
        assert_eq!(
            package("/home/a/.cargo/git/checkouts/darboux-5af0e1/2f1aa36/crates/darboux-cli"),
            "--git ADDRESS darboux-cli"
        );
    }
}
