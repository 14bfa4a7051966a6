//! The command as a newcomer builds it: the README's first command in a build folder of its own, and the
//! messages about missing features.

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use crate::run::{Outcome, output_of, program, run, shown, target_folder};

const MODEL: &str = "assets/NormalTangentTest/NormalTangentTest.glb";
/// What the command prints about a subcommand or option that this build lacks.
const INSTALL: &str = "cargo install --locked --path crates/darboux-cli --features full";
/// Command lines that need other features.
const MISSING: [&str; 4] = [
    "render a.glb -o a.png --view tangent",
    "view --no-open",
    "devices --json",
    "tangents a.glb --device gpu",
];

/// Builds the command without optional features, writes tangents with it, and prints how long both took.
///
/// Errors: a warning; a failed run; a message that does not say how to install the missing feature.
pub fn check() -> Outcome {
    run(&mut program("cargo clippy --quiet --package darboux-cli -- -D warnings"))?;
    let folder = target_folder()?.join("default-build");
    let start = Instant::now();
    let mut first = program("cargo run --quiet --release --target-dir");
    first.arg(&folder).args(["--", "tangents", MODEL, "--force", "-o"]).arg(folder.join("model.glb"));
    run(&mut first)?;
    println!("built and ran in {:.0} s", start.elapsed().as_secs_f32());
    let darboux = folder.join("release/darboux");
    MISSING.iter().try_for_each(|line| refuses(&darboux, line))?;
    says_what_it_lacks(&darboux)?;
    names_fbx(&darboux)?;
    completes_no_missing_subcommand(&darboux)
}

/// Errors: the help does not name what the build lacks, or how to install it.
fn says_what_it_lacks(darboux: &Path) -> Outcome {
    for option in ["-h", "--help"] {
        let help = output_of(Command::new(darboux).arg(option))?;
        // The help is wrapped.
        let words = String::from_utf8_lossy(&help).split_whitespace().collect::<Vec<_>>().join(" ");
        if let Some(part) =
            ["darboux bake,", "models in FBX,", INSTALL].iter().find(|part| !words.contains(**part))
        {
            return Err(format!("darboux {option} of the default build must name {part}"));
        }
    }
    Ok(())
}

/// Errors: the command does not say that a file is FBX, and how to install what reads it; or the help lists
/// the ending of a format that is not read.
fn names_fbx(darboux: &Path) -> Outcome {
    let install = "cargo install --locked --path crates/darboux-cli --features fbx";
    let file = "assets/blender/scene.fbx";
    for arguments in [&["check", file][..], &["inspect", "assets/blender"]] {
        let mut command = Command::new(darboux);
        command.args(arguments);
        let output =
            command.output().map_err(|error| format!("{} cannot start: {error}", shown(&command)))?;
        let message = String::from_utf8_lossy(&output.stderr);
        if !message.contains("FBX") || !message.contains(install) {
            return Err(format!(
                "{} must say how to install the reader of FBX; it prints: {message}",
                shown(&command)
            ));
        }
    }
    let help = output_of(Command::new(darboux).args(["tangents", "--help"]))?;
    match String::from_utf8_lossy(&help).contains(".fbx,") || String::from_utf8_lossy(&help).contains(".fbx)")
    {
        true => Err("the help of the default build lists .fbx among what is read".into()),
        false => Ok(()),
    }
}

/// Errors: the completions offer a subcommand that this build lacks.
fn completes_no_missing_subcommand(darboux: &Path) -> Outcome {
    let script = output_of(Command::new(darboux).args(["completions", "bash"]))?;
    let script = String::from_utf8_lossy(&script);
    match ["render", "view", "devices"]
        .iter()
        .find(|name| script.contains(&format!("darboux__subcmd__{name}")))
    {
        Some(name) => Err(format!("the completions of the default build offer darboux {name}")),
        None if script.contains("darboux__subcmd__tangents") => Ok(()),
        None => Err("the completions do not offer darboux tangents".into()),
    }
}

/// Errors: the command does not end with exit code 2 and one line that contains [`INSTALL`].
fn refuses(darboux: &Path, line: &str) -> Outcome {
    let mut command = Command::new(darboux);
    command.args(line.split(' '));
    let output = command.output().map_err(|error| format!("{} cannot start: {error}", shown(&command)))?;
    let message = String::from_utf8_lossy(&output.stderr);
    if output.status.code() == Some(2) && message.lines().count() == 1 && message.contains(INSTALL) {
        return Ok(());
    }
    Err(format!("{} must say how to install the feature; it prints: {message}", shown(&command)))
}
