//! The command line that installs what this build lacks.

/// The command line that installs the command with a feature.
#[cfg(not(all(feature = "bake", feature = "fbx", feature = "gpu", feature = "view")))]
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
