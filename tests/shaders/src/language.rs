//! The three languages: their files, and compiling them.

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

/// The themes of the library, each after those that it needs.
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

/// All files of a language in one text; `derivatives`, which only fragment shaders can have, on demand.
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
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Wgsl, Self::Glsl, Self::Hlsl];

    /// The folder's name, and the files' ending.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wgsl => "wgsl",
            Self::Glsl => "glsl",
            Self::Hlsl => "hlsl",
        }
    }

    /// A whole shader, entry point `main`, as wgpu takes it; none where the compiler is not there.
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

/// True where `glslangValidator` is installed. Where it is not, says so once, and fails in continuous integration.
pub fn glslang_is_there() -> bool {
    static IS_THERE: OnceLock<bool> = OnceLock::new();
    *IS_THERE.get_or_init(|| {
        let mut command = Command::new("glslangValidator");
        let is_there =
            command.arg("--version").stdout(Stdio::null()).status().is_ok_and(|status| status.success());
        if !is_there {
            cannot_run("glslangValidator is not installed (Debian: glslang-tools)");
        }
        is_there
    })
}

/// Compiles a text with glslangValidator, to SPIR-V if the options ask for it. Errors: what the compiler says.
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

/// Says on standard output that something is skipped, and why; in continuous integration that is a failure.
pub(crate) fn cannot_run(why: &str) {
    assert!(std::env::var_os("CI").is_none(), "{why}");
    writeln!(std::io::stdout(), "skipped: {why}").expect("standard output");
}
