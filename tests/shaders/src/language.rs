//! The three languages of the library: reads their files and compiles them.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;
use std::{fs, process};

use wgpu::ShaderSource;
use wgpu::naga;

/// A language of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// WGSL, compiled by naga.
    Wgsl,
    /// GLSL 4.50, compiled by naga.
    Glsl,
    /// HLSL, compiled by glslang.
    Hlsl,
}

/// The stage of a shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// A compute shader.
    Compute,
    /// A fragment shader.
    Fragment,
}

/// The files of the library, each after the files that it requires.
const THEMES: &[&str] = &[
    "frame",
    "encodings",
    "transform",
    "normal_map",
    "anisotropy",
    "triplanar",
    "parallax",
    "displacement",
    "derivatives",
];

/// All files of a language, concatenated. Only fragment shaders can have `derivatives`.
pub fn library(language: Language, stage: Stage) -> String {
    let of_stage = |theme: &&str| stage == Stage::Fragment || *theme != "derivatives";
    let files = THEMES.iter().copied().filter(|theme| of_stage(theme));
    files.map(|theme| file(language, theme)).collect()
}

fn file(language: Language, theme: &str) -> String {
    let path = folder().join(language.name()).join(format!("{theme}.{}", language.name()));
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shaders")
}

impl Language {
    /// All languages.
    pub const ALL: [Self; 3] = [Self::Wgsl, Self::Glsl, Self::Hlsl];

    /// The name of the folder, and the extension of its files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wgsl => "wgsl",
            Self::Glsl => "glsl",
            Self::Hlsl => "hlsl",
        }
    }

    /// The source of a shader with the entry point `main`; none if its compiler is not installed.
    pub fn source(self, stage: Stage, text: &str) -> Option<ShaderSource<'static>> {
        match self {
            Self::Wgsl => Some(ShaderSource::Wgsl(text.to_owned().into())),
            Self::Glsl => {
                let stage = match stage {
                    Stage::Compute => naga::ShaderStage::Compute,
                    Stage::Fragment => naga::ShaderStage::Fragment,
                };
                Some(ShaderSource::Glsl { shader: text.to_owned().into(), stage, defines: &[] })
            }
            Self::Hlsl => glslang_is_there().then(|| {
                let code = glslang(stage, &["-D", "-V", "-e", "main"], text)
                    .unwrap_or_else(|log| panic!("{log}\n{text}"));
                let words = code.as_chunks().0.iter().map(|bytes| u32::from_le_bytes(*bytes));
                ShaderSource::SpirV(words.collect::<Vec<_>>().into())
            }),
        }
    }
}

/// Whether `glslangValidator` is installed. If it is not, prints once that tests are skipped, or fails in
/// continuous integration.
pub fn glslang_is_there() -> bool {
    static IS_THERE: OnceLock<bool> = OnceLock::new();
    *IS_THERE.get_or_init(|| {
        let mut command = Command::new("glslangValidator");
        let is_there =
            command.arg("--version").stdout(Stdio::null()).status().is_ok_and(|status| status.success());
        if !is_there {
            skip_tests("glslangValidator is not installed (Debian: glslang-tools)");
        }
        is_there
    })
}

/// Compiles a shader with glslangValidator, to SPIR-V with the option -V. Errors: the messages of the
/// compiler.
pub fn glslang(stage: Stage, options: &[&str], text: &str) -> Result<Vec<u8>, String> {
    let compile = || -> std::io::Result<(process::Output, Vec<u8>)> {
        let folder = tempfile::tempdir()?;
        let (source, code) = (folder.path().join("shader"), folder.path().join("shader.spv"));
        fs::write(&source, text)?;
        let stage = if stage == Stage::Compute { "comp" } else { "frag" };
        let mut command = Command::new("glslangValidator");
        command.args(options).args(["-S", stage]).arg(&source);
        if options.contains(&"-V") {
            command.arg("-o").arg(&code);
        }
        Ok((command.output()?, fs::read(&code).unwrap_or_default()))
    };
    let (output, code) = compile().map_err(|error| error.to_string())?;
    if output.status.success() { Ok(code) } else { Err(String::from_utf8_lossy(&output.stdout).into_owned()) }
}

/// Prints that tests are skipped. Panics in continuous integration.
pub(crate) fn skip_tests(reason: &str) {
    assert!(std::env::var_os("CI").is_none(), "{reason}");
    writeln!(std::io::stdout(), "skipped: {reason}").expect("standard output");
}
