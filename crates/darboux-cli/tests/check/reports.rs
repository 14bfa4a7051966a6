//! What is found, how it is printed, and which arguments are refused.

use std::fs;

use darboux_check::Code;

use crate::common::{asset, darboux, folder_with, text};
use crate::maps::bumps;

#[test]
fn healthy_models_pass() {
    let models = [
        "NormalTangentTest/NormalTangentTest.glb",
        "Fox/Fox.glb",
        "Morphing/morphing.gltf",
        "made/draco.glb",
        "made/meshopt.glb",
        "made/skinned-morphed-mirrored.gltf",
        "made/strips-fans-lines-points.gltf",
    ];
    for model in models {
        let report = darboux(&["check", text(&asset(model)), "--json"]).exits(0).json();
        assert_eq!(
            (report["command"].as_str(), report["files"][0]["error"].is_null()),
            (Some("check"), true),
            "{model}"
        );
        let findings = report["files"][0]["findings"].as_array().expect("a list");
        assert!(findings.iter().all(|finding| finding["severity"] != "error"), "{model}: {findings:#?}");
    }
}

/// The shield has per-vertex tangents on mirrored UVs. The plane has w = 1, and its UVs are mirrored.
#[test]
fn wrong_models_are_named() {
    let models = [
        ("made/shield.glb", "tangent-shared-across-mirror"),
        ("TwoSidedPlane/TwoSidedPlane.gltf", "tangent-sign-flipped"),
    ];
    for (model, code) in models {
        let report = darboux(&["check", text(&asset(model)), "--json"]).exits(1).json();
        let findings = report["files"][0]["findings"].as_array().expect("a list");
        let errors = findings.iter().filter(|finding| finding["severity"] == "error");
        let codes: Vec<_> = errors.map(|finding| finding["code"].as_str().unwrap_or_default()).collect();
        assert_eq!(codes, [code], "{model}");
    }
}

/// The commands that are told can be typed as they stand.
#[test]
fn commands_have_the_name_of_the_file() {
    let folder = folder_with(&[]);
    let model = folder.path().join("a shield.glb");
    let shield = asset("made/shield.glb");
    let method = ["tangents", text(&shield), "--method", "average", "--overwrite", "-o", text(&model)];
    darboux(&method).exits(0);
    let printed = darboux(&["check", text(&model)]).exits(0).stdout;
    let printed = String::from_utf8_lossy(&printed);
    let command = format!("`darboux check '{}' --fix --only tangent-other-recipe`", text(&model));
    assert!(printed.matches(&command).count() == 2 && !printed.contains("FILE"), "{printed}");
}

/// Several files end with a total by code.
#[test]
fn several_files_have_a_total() {
    let [shield, healthy] = [asset("made/shield.glb"), asset("NormalTangentTest/NormalTangentTest.glb")];
    let report = darboux(&["check", text(&shield), text(&healthy), "--json"]).exits(1).json();
    let totals = &report["totals"];
    assert_eq!((totals["files"].as_u64(), totals["with_errors"].as_u64()), (Some(2), Some(1)), "{totals}");
    assert_eq!(totals["errors"], serde_json::json!({"tangent-shared-across-mirror": 1}));
    let printed = darboux(&["check", text(&shield), text(&healthy)]).exits(1).stdout;
    let printed = String::from_utf8_lossy(&printed);
    let total = printed.lines().position(|line| line.starts_with("2 files: 1 with errors")).expect("a total");
    let errors: Vec<&str> = printed.lines().skip(total + 1).take(1).collect();
    assert_eq!(errors, ["  error       tangent-shared-across-mirror 1 in 1 file"], "{printed}");
    let alone = darboux(&["check", text(&shield)]).exits(1).stdout;
    let alone = String::from_utf8_lossy(&alone);
    assert!(!alone.contains("1 file:"), "{alone}");
}

/// Findings are chosen by code, and the exit code by severity.
#[test]
fn options_choose_findings_and_the_exit_code() {
    let model = asset("NormalTangentTest/NormalTangentTest.glb");
    let model = text(&model);
    let all = darboux(&["check", model, "--json", "--fail-on", "never"]).exits(0).json();
    let findings = all["files"][0]["findings"].as_array().expect("a list").clone();
    let code = findings[0]["code"].as_str().expect("a code").to_owned();
    for field in
        ["severity", "count", "first", "evidence", "text", "looks_like", "cure", "same_as", "fixable"]
    {
        assert!(!findings[0][field].is_null(), "{field}: {}", findings[0]);
    }
    let only = darboux(&["check", model, "--json", "--only", &code]).json();
    let only = only["files"][0]["findings"].as_array().expect("a list").clone();
    assert!(!only.is_empty() && only.iter().all(|finding| finding["code"] == code.as_str()));
    let allowed = darboux(&["check", model, "--json", "--allow", &code]).json();
    let allowed = allowed["files"][0]["findings"].as_array().expect("a list").clone();
    assert!(allowed.iter().all(|finding| finding["code"] != code.as_str()));
    let printed = darboux(&["check", model]);
    assert!(String::from_utf8_lossy(&printed.stdout).contains(&code));
}

#[test]
fn a_code_is_not_both_reported_and_allowed() {
    let run =
        darboux(&["check", "model.glb", "--only", "tangent-zero,map-flat", "--allow", "map-flat"]).exits(2);
    assert!(run.stderr.contains("--only and --allow both name map-flat"), "{}", run.stderr);
    assert_eq!(run.stderr.trim().lines().count(), 1, "{}", run.stderr);
}

/// A bump map that is not there may be one of heights: no finding names it, and a warning does.
#[test]
fn textures_that_an_obj_lacks_are_warned_of() {
    let folder = folder_with(&["blender/scene.obj", "blender/scene.mtl"]);
    let run = darboux(&["check", text(&folder.path().join("scene.obj"))]).exits(0);
    let is_named = |line: &str| line.starts_with("warning: ") && line.contains("scene_normal.png");
    assert!(run.stderr.lines().any(is_named), "{}", run.stderr);
    let printed = String::from_utf8(run.stdout).expect("text");
    assert!(printed.contains("The warnings say what was lost when it was read."), "{printed}");
    let report = darboux(&["check", "--json", text(&folder.path().join("scene.obj"))]).exits(0).json();
    let warnings = report["files"][0]["warnings"].as_array().expect("a list");
    assert!(
        warnings.iter().any(|warning| warning.as_str().expect("a sentence").contains("scene_normal.png"))
    );
}

/// No more of a file's JSON is read for names than is kept in memory beside other files.
#[cfg(target_os = "linux")]
#[test]
fn a_huge_json_is_not_read_for_names() {
    let folder = folder_with(&["made/shield.glb"]);
    fs::write(folder.path().join("brick_normal.png"), "").expect("a file");
    let huge = folder.path().join("huge.glb");
    let length = 1u32 << 30;
    let word = |number: u32| number.to_le_bytes();
    fs::write(&huge, [b"glTF", &word(2)[..], &word(20 + length), &word(length), b"JSON"].concat())
        .expect("a file");
    let file = fs::File::options().write(true).open(&huge);
    file.and_then(|file| file.set_len(u64::from(20 + length))).expect("a file");
    let arguments = ["check", text(folder.path()), "--fail-on", "never", "--jobs", "1", "--json"];
    let run = crate::common::darboux_with_addresses(512 << 20, &arguments).exits(1);
    let report = run.json();
    let errors: Vec<bool> =
        report["files"].as_array().expect("files").iter().map(|file| file["error"].is_null()).collect();
    assert_eq!(errors, [false, true], "{}", run.stderr);
}

#[test]
fn codes_are_explained() {
    for code in Code::ALL {
        let explained = darboux(&["check", "--explain", code.name()]).exits(0);
        let explained = String::from_utf8(explained.stdout).expect("text");
        assert!(explained.contains(code.name()) && explained.contains(code.cure()), "{code}");
    }
    let unknown = darboux(&["check", "--explain", "tangent-blue"]).exits(2);
    assert!(unknown.stderr.contains("tangent-blue"), "{}", unknown.stderr);
    darboux(&["check"]).exits(2);
    darboux(&["check", "a.glb", "--only", "nothing"]).exits(2);
}

#[test]
fn several_files_are_reported_in_order_and_a_bad_one_does_not_end_the_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let bad = folder.path().join("bad.glb");
    fs::write(&bad, "no model").expect("a file");
    let good = asset("made/shield.glb");
    let report =
        darboux(&["check", text(&bad), text(&good), text(&bad), "--json", "--jobs", "3"]).exits(1).json();
    let errors: Vec<bool> =
        report["files"].as_array().expect("a list").iter().map(|file| !file["error"].is_null()).collect();
    assert_eq!(errors, [true, false, true]);
}

/// `--model` is for images, and a mistyped code gets a suggestion.
#[test]
fn wrong_arguments_are_refused_with_what_to_do() {
    let folder = tempfile::tempdir().expect("a folder");
    let map = folder.path().join("map.png");
    bumps(1.0).save(&map).expect("an image");
    let plane = asset("TwoSidedPlane/TwoSidedPlane.gltf");
    let refused = darboux(&["check", text(&map), text(&plane), "--model", text(&plane)]).exits(2);
    assert!(refused.stderr.contains("is no image"), "{}", refused.stderr);
    let mistyped = darboux(&["check", text(&map), "--only", "tangent-sing-flipped"]).exits(2);
    assert!(mistyped.stderr.contains("'tangent-sign-flipped'"), "{}", mistyped.stderr);
}

/// With `--quiet` there is one line per finding that makes the exit code 1, and nothing else.
#[test]
fn quiet_runs_print_what_fails_only() {
    let shield = asset("made/shield.glb");
    let printed = darboux(&["check", text(&shield), "--quiet"]).exits(1);
    let printed = String::from_utf8(printed.stdout).expect("text");
    assert_eq!(printed.lines().count(), 1, "{printed}");
    assert!(
        printed.contains("shield.glb: ") && printed.contains(": tangent-shared-across-mirror: "),
        "{printed}"
    );
    let healthy = asset("NormalTangentTest/NormalTangentTest.glb");
    let healthy = darboux(&["check", text(&healthy), "--quiet"]).exits(0);
    assert_eq!((healthy.stdout.as_slice(), healthy.stderr.as_str()), (&b""[..], ""));
    let all = darboux(&["check", text(&shield), "--quiet", "--fail-on", "warning"]).exits(1);
    assert!(all.stdout.len() > printed.len(), "{}", String::from_utf8_lossy(&all.stdout));

    let folder = tempfile::tempdir().expect("a folder");
    let map = folder.path().join("map.png");
    bumps(-1.0).save(&map).expect("an image");
    let left = darboux(&["check", text(&map), "--fix", "--quiet"]).exits(1);
    assert!(left.stderr.contains("error: ") && left.stderr.contains("map-green-flipped"), "{}", left.stderr);
}

/// The words of the source lead to the surface in the program that made it.
#[test]
fn places_are_named_as_the_source_has_them() {
    for (name, code, place) in [
        ("scene.fbx", 0, "\n  Body in your FBX, meshes[1].primitives[0] \"Sheet\": "),
        ("scene.obj", 0, "\n  o Body in your OBJ, meshes[0].primitives[0] \"Body\": "),
        ("scene.ply", 1, "\n  your PLY, meshes[0].primitives[0] \"\": "),
    ] {
        let run = darboux(&["check", text(&asset(&format!("blender/{name}")))]).exits(code);
        let printed = String::from_utf8(run.stdout).expect("text");
        assert!(printed.contains(place), "{printed}");
    }
}
