//! Normals on the command line: alone, and before tangents.

mod common;

use std::path::Path;

use common::{asset, darboux, folder_with, text};
use serde_json::Value;

/// The first primitive of a model.
fn primitive(path: &Path) -> Value {
    darboux(&["inspect", "--json", text(path)]).exits(0).json()["files"][0]["primitives"][0].take()
}

fn has(primitive: &Value, attribute: &str) -> bool {
    primitive["attributes"].as_array().expect("a list").iter().any(|name| name == attribute)
}

#[test]
fn a_model_without_normals_gets_them_and_then_tangents() {
    let folder = folder_with(&["Fox/Fox.glb"]);
    let fox = folder.path().join("Fox.glb");
    let run = darboux(&["normals", text(&fox)]).exits(0);
    assert!(
        run.stderr.contains("meshes[0].primitives[0] \"fox1\": normals generated, 576 triangles"),
        "{}",
        run.stderr
    );
    let smooth = folder.path().join("Fox.normals.glb");
    assert!(has(&primitive(&smooth), "NORMAL") && !has(&primitive(&smooth), "TANGENT"));
    let (two_steps, one_step) = (folder.path().join("two.glb"), folder.path().join("one.glb"));
    darboux(&["tangents", text(&smooth), "-o", text(&two_steps)]).exits(0);
    darboux(&["tangents", text(&fox), "--normals", "smooth", "-o", text(&one_step)]).exits(0);
    let [two, one] = [&two_steps, &one_step].map(|path| primitive(path));
    assert!(has(&two, "TANGENT"));
    assert_eq!(two, one);
}

#[test]
fn the_shading_is_what_was_asked_for() {
    let folder = folder_with(&["Fox/Fox.glb"]);
    let (fox, out) = (folder.path().join("Fox.glb"), folder.path().join("out.glb"));
    let vertices = |options: &[&str]| {
        darboux(&[&["normals", text(&fox), "-o", text(&out), "--force"], options].concat()).exits(0);
        primitive(&out)["vertices"].as_u64().expect("a number")
    };
    // The Fox is unindexed: corners are vertices, whatever the shading.
    assert_eq!(vertices(&["--normals", "flat"]), 1728);
    let bytes = |options: &[&str]| {
        vertices(options);
        std::fs::read(&out).expect("the output")
    };
    let smooth = bytes(&["--normals", "smooth"]);
    assert!(smooth == bytes(&["--normals", "crease=180"]));
    assert!(smooth != bytes(&["--normals", "crease=30"]));
    assert!(smooth != bytes(&["--weight", "area"]));
    assert!(bytes(&["--respect-seams"]) == bytes(&["--normals", "flat"]));
}

#[test]
fn new_normals_take_old_tangents_with_them() {
    let folder = folder_with(&["TwoSidedPlane/TwoSidedPlane.gltf", "TwoSidedPlane/TwoSidedPlane.bin"]);
    let (plane, out) = (folder.path().join("TwoSidedPlane.gltf"), folder.path().join("out.glb"));
    darboux(&["normals", text(&plane), "-o", text(&out)]).exits(0);
    assert!(has(&primitive(&out), "TANGENT"), "normals that exist stay, and their tangents with them");
    let run = darboux(&["normals", text(&plane), "-o", text(&out), "--overwrite", "--force"]).exits(0);
    assert!(run.stderr.contains(", tangents removed"), "{}", run.stderr);
    assert!(
        run.stderr.contains("warning: ") && run.stderr.contains("run darboux tangents"),
        "{}",
        run.stderr
    );
    assert!(!has(&primitive(&out), "TANGENT"));
    for (more, outcome) in [(&["--json"][..], "kept"), (&["--json", "--overwrite"], "written")] {
        let arguments = ["tangents", text(&plane), "-o", text(&out), "--normals", "flat", "--force"];
        let report = darboux(&[&arguments[..], more].concat()).exits(0).json();
        assert_eq!(report["files"][0]["normals"][0]["outcome"], outcome);
        assert_eq!(report["files"][0]["primitives"][0]["outcome"], outcome);
        assert!(has(&primitive(&out), "TANGENT"));
    }
}

#[test]
fn nothing_to_do_is_a_copy() {
    let folder = folder_with(&["NormalTangentTest/NormalTangentTest.glb"]);
    let (model, out) = (folder.path().join("NormalTangentTest.glb"), folder.path().join("out.glb"));
    let report = darboux(&["normals", text(&model), "-o", text(&out), "--json"]).exits(0).json();
    assert_eq!(report["files"][0]["status"], "copied");
    let original = std::fs::read(asset("NormalTangentTest/NormalTangentTest.glb")).expect("the model");
    assert!(std::fs::read(&out).expect("the output") == original);
}
