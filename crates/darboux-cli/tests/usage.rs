//! Wrong usage: exit code 2, one message, no output, decided before any work.

mod common;

use std::fs;
use std::path::Path;

use common::{darboux, folder_with, names_in, text};

const MODEL: &str = "made/skinned-morphed-mirrored.gltf";

#[test]
fn without_arguments_the_help_says_what_there_is() {
    let run = darboux::<&str>(&[]).exits(2);
    assert!(run.stderr.contains("Usage: darboux"), "{}", run.stderr);
}

#[test]
fn help_and_version_succeed() {
    for arguments in [&["--help"][..], &["--version"], &["tangents", "--help"], &["inspect", "-h"]] {
        let run = darboux(arguments).exits(0);
        assert!(!run.stdout.is_empty() && run.stderr.is_empty());
    }
}

#[test]
fn what_does_not_fit_together_is_refused() {
    let folder = folder_with(&[MODEL, "made/degenerate.gltf"]);
    let (a, b) = (folder.path().join("skinned-morphed-mirrored.gltf"), folder.path().join("degenerate.gltf"));
    let (a, b, dir) = (text(&a), text(&b), text(folder.path()));
    let cases: &[&[&str]] = &[
        &["tangents"],
        &["tangents", a, "--mode", "fast"],
        &["tangents", a, "--threshold", "nan"],
        &["tangents", a, "--threshold", "wide"],
        &["tangents", a, "--threshold", "-5"],
        &["tangents", a, "--threshold", "400"],
        &["tangents", a, "--threshold", "90", "--method", "face"],
        &["tangents", a, "--method", "best"],
        &["tangents", a, "--encoding", "octahedral"],
        &["tangents", a, "-o", "x.glb", "--out-dir", dir],
        &["tangents", a, "-o", "x.glb", "--in-place"],
        &["tangents", a, b, "-o", "x.glb"],
        &["tangents", dir, "-o", "x.glb"],
        &["tangents", a, "-o", dir],
        &["tangents", a, "-o", "x.fbx"],
        &["tangents", a, "-o", "mistyped/x.glb"],
        &["tangents", a, "--jobs", "0"],
        &["compare", a],
        &["compare", a, b, "--method", "area"],
        &["tangents", a, "-o", a],
        &["tangents", a, "--out-dir", b],
        &["tangents", a, "-o", "-", "--json"],
        &["tangents", "-", "--json"],
        &["tangents", "-", "--in-place"],
        &["tangents", "-", "--out-dir", dir],
        &["tangents", "-", a],
        &["tangents", dir, "--out-dir", dir],
        &["tangents", a, "--normals", "sharp"],
        &["normals", a, "--normals", "keep"],
        &["normals", a, "--normals", "crease=-1"],
        &["normals", a, "--normals", "crease=nan"],
        &["normals", a, "-o", a],
        &["inspect"],
        &["inspect", "-", a],
    ];
    for arguments in cases {
        let run = darboux(arguments).exits(2);
        assert!(run.stdout.is_empty(), "{arguments:?}");
        assert!(run.stderr.starts_with("error: "), "{arguments:?}: {}", run.stderr);
    }
    assert_eq!(names_in(folder.path()), ["degenerate.gltf", "skinned-morphed-mirrored.gltf"]);
}

/// Each thing that would do is named, not the first alone.
#[test]
fn comparing_one_file_asks_for_another_or_a_method() {
    let run = darboux(&["compare", "a.glb"]).exits(2);
    assert!(run.stderr.contains("<B|--method <NAME>>"), "{}", run.stderr);
}

#[test]
fn encodings_without_a_place_in_gltf_are_refused_by_naming_those_with_one() {
    for encoding in ["snorm10", "octahedral", "diamond", "quaternion"] {
        let run = darboux(&["tangents", "a.glb", "--encoding", encoding]).exits(2);
        assert!(run.stderr.contains("it can hold f32x4, snorm16x4 and snorm8x4"), "{}", run.stderr);
    }
}

#[test]
fn methods_explains_every_method_that_there_is() {
    let explained = String::from_utf8(darboux(&["methods"]).exits(0).stdout).expect("UTF-8");
    assert_eq!(explained.lines().count(), 11);
    let help = String::from_utf8(darboux(&["tangents", "--help"]).exits(0).stdout).expect("UTF-8");
    let listed = help.split("--method <NAME>").nth(1).and_then(|rest| rest.split("[default").next());
    let names = listed.expect("the list").lines().filter_map(|line| line.trim().strip_prefix("- "));
    let names: Vec<&str> = names.filter_map(|line| line.split(':').next()).collect();
    assert_eq!(names.len(), 9);
    for name in names {
        assert!(explained.contains(&format!("  {name} ")), "{name}");
    }
}

#[test]
fn equal_names_that_would_collide_are_refused_before_any_work() {
    let (first, second) = (folder_with(&["Fox/Fox.glb"]), folder_with(&["Fox/Fox.glb"]));
    let out = tempfile::tempdir().expect("a temporary folder");
    let out_dir = out.path().join("out");
    let run =
        darboux(&["tangents", text(first.path()), text(second.path()), "--out-dir", text(&out_dir)]).exits(2);
    for part in [text(first.path()), text(second.path()), "Fox.glb"] {
        assert!(run.stderr.contains(part), "{}", run.stderr);
    }
    assert!(!out_dir.exists());
}

#[test]
fn an_output_that_is_another_input_is_refused() {
    let folder = folder_with(&["Fox/Fox.glb"]);
    let fox = folder.path().join("Fox.glb");
    fs::create_dir(folder.path().join("sub")).expect("a folder");
    fs::copy(&fox, folder.path().join("sub/Fox.glb")).expect("a copy");
    let before = fs::read(&fox).expect("the model");
    let inner = folder.path().join("sub/Fox.glb");
    darboux(&["tangents", text(&fox), text(&inner), "--out-dir", text(folder.path()), "--force"]).exits(2);
    darboux(&["tangents", text(&inner), text(&fox), "--out-dir", text(folder.path()), "--force"]).exits(2);
    assert_eq!(fs::read(&fox).expect("the model"), before);
}

#[test]
fn the_same_file_named_twice_is_done_once() {
    let folder = folder_with(&["Fox/Fox.glb"]);
    let fox = folder.path().join("Fox.glb");
    let run = darboux(&["tangents", text(&fox), text(folder.path()), "--json"]).exits(0);
    assert_eq!(run.json()["files"].as_array().map(Vec::len), Some(1));
}

/// The reference lists them, and README.md names what the first install lacks.
#[test]
fn every_feature_is_in_the_list() {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |path: &str| fs::read_to_string(manifest.join(path)).expect("a file of the repository");
    let (cargo, list, readme) = (read("Cargo.toml"), read("src/installation.txt"), read("../../README.md"));
    let features =
        cargo.split("[features]").nth(1).expect("features").split("\n[").next().expect("their end");
    let lines = features.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
    let names: Vec<&str> = lines.filter_map(|line| line.split(" = ").next()).collect();
    assert!(names.contains(&"full") && names.len() > 4, "{names:?}");
    for name in names.iter().filter(|name| **name != "default") {
        assert!(list.contains(&format!("| `{name}` |")), "{name}");
    }
    let first_install = readme.split("It leaves out ").nth(1).expect("what the first install lacks");
    let sentence = first_install.split("adds them all").next().expect("its end");
    for part in ["`darboux bake`", "`darboux render`", "`darboux view`", "GPUs", "FBX", "KTX 2"] {
        assert!(sentence.contains(part), "{part}");
    }
}
