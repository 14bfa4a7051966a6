//! `cargo xtask release --check [--since TAG]`: whether this state of the repository can be published.
//!
//! Everything that is published is packaged, installed into an empty folder from its package alone, and its
//! example run. Nothing is uploaded. `--since TAG` compares the public API with that of an earlier release.
//!
//! `cargo xtask release` makes the archive with the command (`archive.rs`).

pub mod archive;
mod c;
mod crates;
mod metadata;
mod npm;
mod python;
mod semver;
mod work;

use std::time::Instant;

use crate::run::Outcome;

type Step = (&'static str, &'static str, fn() -> Outcome);

/// Names, what a step does, and the step.
const STEPS: &[Step] = &[
    ("metadata", "descriptions, keywords, licences, READMEs and the changelog are complete", metadata::check),
    (
        "msrv",
        "the libraries and the command compile with the oldest supported compiler, without and with all \
         features",
        crates::check_rust_version,
    ),
    (
        "crates",
        "every crate is packaged and built from its package; an example and the command run",
        crates::check,
    ),
    ("c", "the C archive is unpacked; its example is compiled and run", c::check),
    ("python", "the source archive and the wheel are installed; the example is run with each", python::check),
    ("npm", "the npm archive is installed; the README's first example is run", npm::check),
];

/// Runs the named steps, or all. Errors: the API or a step is not fit for a release, or a step has no such
/// name.
pub fn check(words: &[&str]) -> Outcome {
    let (since, names) = match words {
        ["--since", tag, names @ ..] => (Some(*tag), names),
        names => (None, names),
    };
    if let Some(unknown) = names.iter().find(|name| STEPS.iter().all(|step| step.0 != **name)) {
        let all: Vec<&str> = STEPS.iter().map(|step| step.0).collect();
        return Err(format!("{unknown} is not a step of release --check; the steps are {}", all.join(", ")));
    }
    if let Some(tag) = since {
        println!("--- semver: the API against {tag}");
        semver::check(tag)?;
    }
    for (name, does, step) in STEPS.iter().filter(|step| names.is_empty() || names.contains(&step.0)) {
        println!("--- {name}: {does}");
        let start = Instant::now();
        step().map_err(|message| format!("{name}: {message}"))?;
        println!("--- {name}: ok, {:.1} s\n", start.elapsed().as_secs_f32());
    }
    Ok(())
}
