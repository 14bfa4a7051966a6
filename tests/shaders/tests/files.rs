//! Compiles every file of the library for every supported version of its language.

use std::collections::BTreeSet;
use std::fs;

use darboux_shader_tests::{Language, Stage, glslang, glslang_is_there, library};
use wgpu::naga::front::{glsl, wgsl};
use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};
use wgpu::naga::{Module, ShaderStage};

const STAGES: [Stage; 2] = [Stage::Compute, Stage::Fragment];

fn validate(module: &Module) {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    validator.validate(module).unwrap_or_else(|error| panic!("{error:?}"));
}

#[test]
fn naga_takes_wgsl() {
    for stage in STAGES {
        validate(&wgsl::parse_str(&library(Language::Wgsl, stage)).unwrap_or_else(|error| panic!("{error}")));
    }
}

#[test]
fn naga_takes_glsl() {
    for (stage, naga_stage) in STAGES.into_iter().zip([ShaderStage::Compute, ShaderStage::Fragment]) {
        let text = format!("#version 450\n{}void main() {{}}\n", library(Language::Glsl, stage));
        let module = glsl::Frontend::default().parse(&glsl::Options::from(naga_stage), &text);
        validate(&module.unwrap_or_else(|error| panic!("{error:?}")));
    }
}

#[test]
fn glslang_takes_glsl_and_hlsl() {
    if !glslang_is_there() {
        return;
    }
    let [compute, fragment] = STAGES;
    let shaders = [
        (fragment, Language::Glsl, "#version 300 es", "void main() {}", &[][..]),
        (compute, Language::Glsl, "#version 310 es", "void main() {}", &[]),
        (fragment, Language::Glsl, "#version 330 core", "void main() {}", &[]),
        (fragment, Language::Glsl, "#version 450 core", "void main() {}", &[]),
        (compute, Language::Glsl, "#version 450 core", "void main() {}", &[]),
        (
            fragment,
            Language::Hlsl,
            "",
            "float4 main() : SV_Target { return 0; }",
            &["-D", "-V", "-e", "main"],
        ),
        (compute, Language::Hlsl, "", "[numthreads(1, 1, 1)] void main() {}", &["-D", "-V", "-e", "main"]),
    ];
    for (stage, language, head, tail, options) in shaders {
        let text = format!("{head}\n{}{tail}\n", library(language, stage));
        glslang(stage, options, &text).unwrap_or_else(|log| panic!("{head} {stage:?}: {log}"));
    }
}

/// The names of the functions and structures that a file defines, in order.
fn defined(text: &str, language: Language) -> Vec<String> {
    let starts_definition = |line: &&str| match language {
        Language::Wgsl => line.starts_with("fn ") || line.starts_with("struct "),
        _ => line.starts_with(char::is_alphabetic) && line.ends_with('{'),
    };
    let name = |line: &str| {
        let words = line.split('(').next().unwrap_or_default().trim_end_matches(" {");
        words.rsplit(' ').next().unwrap_or_default().to_owned()
    };
    text.lines().filter(starts_definition).map(name).collect()
}

#[test]
fn names_are_the_same_in_all_languages_and_unique() {
    let [wgsl, glsl, hlsl] =
        Language::ALL.map(|language| defined(&library(language, Stage::Fragment), language));
    assert!(wgsl.len() > 10);
    assert_eq!(wgsl.iter().collect::<BTreeSet<_>>().len(), wgsl.len());
    assert_eq!(wgsl, glsl);
    assert_eq!(wgsl, hlsl);
}

#[test]
fn no_file_is_left_out() {
    for language in Language::ALL {
        let folder = format!("{}/../../shaders/{}", env!("CARGO_MANIFEST_DIR"), language.name());
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let text = fs::read_to_string(&path).expect("a text");
            assert!(library(language, Stage::Fragment).contains(&text), "{} is not tested", path.display());
        }
    }
}

/// A test calls it, or a function that a test calls does.
#[test]
fn every_function_is_executed() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests");
    let tests = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let tests: String = tests.map(|path| fs::read_to_string(path).expect("a text")).collect();
    let library = library(Language::Wgsl, Stage::Fragment);
    for name in library.lines().filter_map(|line| line.strip_prefix("fn ")?.split('(').next()) {
        let call = format!("{name}(");
        assert!(tests.contains(&call) || library.matches(&call).count() > 1, "no test calls {name}");
    }
}
