//! The program under test: where it is, and which subcommands and options it has.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::run::{program, root, run, target_folder};

/// A built `darboux`.
pub struct Program {
    pub path: PathBuf,
    /// The help of each subcommand that this build has.
    help: HashMap<String, String>,
}

impl Program {
    /// The program at `path`, or a release build of this repository, and which of some subcommands it has.
    /// Errors: it cannot be built or started.
    pub fn find<'a>(path: Option<&Path>, subcommands: impl Iterator<Item = &'a str>) -> Result<Self, String> {
        let path = match path {
            Some(path) => path.canonicalize().map_err(|error| format!("{}: {error}", path.display()))?,
            None => {
                run(&mut program("cargo build --release --package darboux-cli --features full"))?;
                target_folder()?.join("release/darboux")
            }
        };
        let mut help = HashMap::new();
        for subcommand in subcommands {
            let output = Command::new(&path)
                .args([subcommand, "--help"])
                .current_dir(root())
                .stdin(Stdio::null())
                .output()
                .map_err(|error| format!("{} cannot start: {error}", path.display()))?;
            if output.status.success() {
                help.insert(subcommand.to_owned(), String::from_utf8_lossy(&output.stdout).into_owned());
            }
        }
        Ok(Self { path, help })
    }

    /// Whether the subcommand exists and has this option. An empty option asks for the subcommand alone.
    pub fn has(&self, subcommand: &str, option: &str) -> bool {
        self.help.get(subcommand).is_some_and(|text| text.contains(option))
    }

    /// Whether `render` can draw: it is part of the build, and there is an adapter.
    pub fn can_render(&self) -> bool {
        let devices = Command::new(&self.path).args(["devices", "--json"]).stdin(Stdio::null()).output();
        self.has("render", "")
            && devices
                .is_ok_and(|output| String::from_utf8_lossy(&output.stdout).contains("\"problem\": null"))
    }
}
