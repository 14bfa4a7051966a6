//! Semantic versioning: the committed API lists of an earlier release against those of today.
//!
//! A line that is removed or changed is a breaking change. Before 1.0 it needs a new minor version, from then on a new major version. A
//! new line needs no more than a new patch version before 1.0, and a new minor version from then on.

use std::collections::BTreeSet;
use std::fs;

use super::work::VERSION;
use crate::api;
use crate::run::{Outcome, output_of, program, root};

/// The least part of the version that a change raises.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Change {
    Patch,
    Minor,
    Major,
}

/// Errors: the API has changed by more than the version says; the tag is missing or has no lists.
pub fn check(tag: &str) -> Outcome {
    let old_version =
        version_in(&shown(tag, "Cargo.toml")?).ok_or(format!("Cargo.toml at {tag} names no version"))?;
    let raised = raised(&old_version, VERSION);
    let mut faults = Vec::new();
    for package in api::PACKAGES {
        let name = format!("{}/{package}.txt", api::FOLDER);
        let new = fs::read_to_string(root().join(&name))
            .map_err(|error| format!("{name} cannot be read: {error}"))?;
        let old = shown(tag, &name)?;
        let removed = lines_missing(&old, &new);
        let added = lines_missing(&new, &old);
        println!(
            "{package}: {} lines removed or changed, {} added since {old_version}",
            removed.len(),
            added.len()
        );
        let needed = needed(&old_version, !removed.is_empty(), !added.is_empty());
        if raised < needed {
            faults
                .push(format!("{package} needs a new {needed:?} version after {old_version}").to_lowercase());
            removed.iter().for_each(|line| println!("- {line}"));
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults.join("; ")) }
}

/// A file at a tag.
fn shown(tag: &str, name: &str) -> Result<String, String> {
    let text = output_of(program("git show").arg(format!("{tag}:{name}")))?;
    Ok(String::from_utf8_lossy(&text).into_owned())
}

fn version_in(manifest: &str) -> Option<String> {
    manifest.lines().find_map(|line| line.strip_prefix("version = \"")?.strip_suffix('"')).map(str::to_owned)
}

/// The lines of one list that another lacks, comments left out.
fn lines_missing<'a>(from: &'a str, other: &str) -> Vec<&'a str> {
    let other: BTreeSet<&str> = other.lines().collect();
    from.lines().filter(|line| !line.starts_with("# ") && !other.contains(line)).collect()
}

/// The first part of the version that differs.
fn raised(old: &str, new: &str) -> Change {
    let parts =
        |version: &str| -> Vec<u32> { version.split('.').map_while(|part| part.parse().ok()).collect() };
    let (old, new) = (parts(old), parts(new));
    match (0..2).find(|&part| old.get(part) != new.get(part)) {
        Some(0) => Change::Major,
        Some(_) => Change::Minor,
        None => Change::Patch,
    }
}

fn needed(old: &str, removed: bool, added: bool) -> Change {
    match (old.starts_with("0."), removed, added) {
        (true, true, _) | (false, false, true) => Change::Minor,
        (false, true, _) => Change::Major,
        _ => Change::Patch,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_need_versions() {
        assert_eq!(needed("0.3.1", true, true), Change::Minor);
        assert_eq!(needed("0.3.1", false, true), Change::Patch);
        assert_eq!(needed("1.3.1", true, false), Change::Major);
        assert_eq!(needed("1.3.1", false, true), Change::Minor);
        assert_eq!(raised("0.3.1", "0.3.2"), Change::Patch);
        assert_eq!(raised("0.3.1", "0.4.0"), Change::Minor);
        assert_eq!(raised("0.3.1", "1.0.0"), Change::Major);
    }

    #[test]
    fn a_changed_line_is_removed_and_added() {
        let (old, new) =
            ("# head\npub fn a::f()\npub fn a::g()\n", "# other\npub fn a::f(x: u8)\npub fn a::g()\n");
        assert_eq!(lines_missing(old, new), ["pub fn a::f()"]);
        assert_eq!(lines_missing(new, old), ["pub fn a::f(x: u8)"]);
    }
}
