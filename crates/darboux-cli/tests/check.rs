//! `darboux check`.

mod common;

use std::fs;

use common::{asset, darboux, text};
use darboux_check::Code;

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

/// Findings are chosen by code, and the exit code by severity.
#[test]
fn options_choose_findings_and_the_exit_code() {
    let model = asset("NormalTangentTest/NormalTangentTest.glb");
    let model = text(&model);
    let all = darboux(&["check", model, "--json", "--fail-on", "never"]).exits(0).json();
    let findings = all["files"][0]["findings"].as_array().expect("a list").clone();
    let code = findings[0]["code"].as_str().expect("a code").to_owned();
    for field in ["severity", "count", "first", "evidence", "text", "looks_like", "cure", "same_as"] {
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
fn maps_are_judged_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let side = 128u32;
    let bump = |i: u32, up: f32| {
        let (x, y) = ((i % side) as f32 / 5.0, (i / side) as f32 / 5.0);
        let normal = [-x.cos() * y.sin() / 5.0, up * x.sin() * y.cos() / 5.0, 1.0];
        let length = normal.iter().map(|x| x * x).sum::<f32>().sqrt();
        normal.map(|x| (127.5 + 127.5 * x / length).round() as u8)
    };
    let map = |name: &str, up: f32| {
        let path = folder.path().join(name);
        let mut encoder = png::Encoder::new(fs::File::create(&path).expect("a file"), side, side);
        encoder.set_color(png::ColorType::Rgb);
        let texels: Vec<u8> = (0..side * side).flat_map(|i| bump(i, up)).collect();
        encoder.write_header().and_then(|mut writer| writer.write_image_data(&texels)).expect("a PNG");
        path
    };
    let (up, down) = (map("up.png", 1.0), map("down.png", -1.0));
    let verdict = |path, arguments: &[&str], code| {
        let report = darboux(&[&["check", text(path), "--json"], arguments].concat()).exits(code).json();
        report["files"][0]["map"]["verdict"].as_str().map(str::to_owned)
    };
    assert_eq!(verdict(&up, &[], 0).as_deref(), Some("opengl"));
    assert_eq!(verdict(&down, &[], 1).as_deref(), Some("directx"));
    assert_eq!(verdict(&down, &["--convention", "directx"], 0).as_deref(), Some("directx"));
    assert_eq!(verdict(&up, &["--convention", "directx"], 1).as_deref(), Some("opengl"));
    let printed = darboux(&["check", text(&down)]).exits(1);
    let printed = String::from_utf8_lossy(&printed.stdout).into_owned();
    assert!(printed.contains("DirectX") && printed.contains("map-green-flipped"), "{printed}");

    let broken = folder.path().join("broken.png");
    fs::write(&broken, &fs::read(&up).expect("a file")[..200]).expect("a file");
    let report = darboux(&["check", text(&broken), "--json"]).exits(1).json();
    assert_eq!(report["files"][0]["findings"][0]["code"], "map-unreadable");
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
