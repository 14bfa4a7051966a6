//! The C compiler of the WebAssembly modules that read FBX: ufbx, the reader, is C code.

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::process::Command;

use crate::run::{program, root, works};

/// The names of clang, as Debian's packages, Homebrew and Windows have them.
const CLANGS: [&str; 9] =
    ["clang", "clang-14", "clang-15", "clang-16", "clang-17", "clang-18", "clang-19", "clang-20", "clang-21"];

/// A clang that compiles for WebAssembly, which Apple's does not.
pub struct Clang(&'static str);

impl Clang {
    /// Errors: there is none.
    pub fn find() -> Result<Self, String> {
        let compiles = |name: &&str| {
            let line = format!("{name} --target=wasm32-unknown-unknown -x c -S -o - -");
            works(&mut program(&line))
        };
        CLANGS.into_iter().find(compiles).map(Self).ok_or_else(|| {
            "clang for WebAssembly is missing, which compiles the reader of FBX; install it (Debian: apt \
             install clang)"
                .into()
        })
    }

    /// As [`Clang::find`]; without one, says that a quick build goes on without FBX.
    pub fn find_or_say() -> Option<Self> {
        Self::find().inspect_err(|missing| eprintln!("  without the reader of FBX: {missing}")).ok()
    }

    /// Lets a build of Cargo compile ufbx for WebAssembly, without a C library.
    pub fn compile_ufbx(&self, cargo: &mut Command) {
        let header = root().join("crates/darboux-io/wasm/ufbx_config.h");
        // The last level of optimisation counts. The code is a tenth smaller than with `-O3`, which Cargo
        // asks for.
        let flags = format!("-nostdlibinc -Os '-DUFBX_CONFIG_HEADER=\"{}\"'", header.display());
        // Cargo notices other flags, and no other header.
        let mut hasher = DefaultHasher::new();
        fs::read(&header).unwrap_or_default().hash(&mut hasher);
        let flags = format!("{flags} -DDARBOUX_HASH_OF_CONFIG_HEADER={}", hasher.finish());
        cargo.env("CC_wasm32_unknown_unknown", self.0).env("CFLAGS_wasm32_unknown_unknown", flags);
        // Lets a path have spaces.
        cargo.env("CC_SHELL_ESCAPED_FLAGS", "1");
        // Any archiver does: rustc lists the functions again.
        cargo.env("AR_wasm32_unknown_unknown", "ar");
    }
}
