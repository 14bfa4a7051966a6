//! The options for reading a model: which files may be read, and how much memory reading may use.

use std::path::Path;

use clap::Args;
use darboux::Choice;
use darboux_io::gltf::Document;
use darboux_io::source::PolygonRule;
use darboux_io::{Error, LoadOptions, MemoryLimit, OptionNames};

use crate::memory;
use crate::options::choice::choice;

/// How a model is read.
#[derive(Args, Clone, Copy, Debug, Default)]
pub struct ReadOptions {
    /// Allow a glTF's buffers and images outside its folder
    #[arg(long)]
    pub allow_outside: bool,

    /// The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the
    /// file, and at most what the process may use
    #[arg(long, value_name = "MIB")]
    pub memory_limit: Option<u32>,

    /// How faces of five and more corners are cut, in formats that have them
    #[arg(long, value_name = "RULE", value_parser = choice::<PolygonRule>(), default_value = PolygonRule::default().name())]
    pub polygons: PolygonRule,
}

impl ReadOptions {
    /// The options of the reader.
    pub fn load_options(&self) -> LoadOptions {
        let chosen = self.memory_limit.map(|mebibytes| MemoryLimit::bytes(u64::from(mebibytes) << 20));
        let limit = chosen.unwrap_or_else(|| MemoryLimit::of_process(memory::of_process()));
        LoadOptions::default()
            .with_allow_outside(self.allow_outside)
            .with_memory_limit(limit)
            .with_polygon_rule(self.polygons)
            .with_option_names(option_names())
    }

    /// Opens a document, with large files mapped into memory.
    #[expect(unsafe_code, reason = "mapping a file needs a promise about other processes")]
    pub fn open(&self, path: &Path) -> Result<Document, Error> {
        // SAFETY: `open_mapped` requires that no process writes into the files or shortens them while the
        // document exists. This process does not: it writes outputs to temporary files and renames
        // them. The command cannot lock files against other processes, so it leaves that part to its
        // user (docs/security.md says so). If a process does it anyway, changed bytes give a wrong result or
        // an error, because JSON is copied before it is parsed and every other number is checked
        // where it is used; a shortened file ends this process by SIGBUS before an output has its
        // name.
        unsafe { Document::open_mapped(path, &self.load_options()) }
    }
}

/// What to do about a file whose reader is a feature that this build lacks.
#[cfg(not(feature = "fbx"))]
pub fn missing_reader() -> &'static str {
    static ADVICE: std::sync::LazyLock<String> = std::sync::LazyLock::new(|| {
        let install = crate::installing::install_with("fbx");
        format!("install a darboux that does with `{install}`, or export the model as .glb")
    });
    &ADVICE
}

/// What to do about a file that no build reads.
#[cfg(feature = "fbx")]
pub fn missing_reader() -> &'static str {
    "export the model as .glb"
}

/// The names of this command's options in the library's messages.
fn option_names() -> OptionNames {
    OptionNames::default()
        .with_memory_limit("--memory-limit")
        .with_allow_outside("--allow-outside")
        .with_apply_texture_transform("--apply-texture-transform")
        .with_missing_reader(missing_reader())
}
