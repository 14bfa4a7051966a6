//! Comparisons: what they find, what they draw, and their exit codes.

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use common::{asset, darboux, names_in, text};
use serde_json::Value;
use tempfile::TempDir;

const MODEL: &str = "NormalTangentTest/NormalTangentTest.glb";

/// The model with tangents by two methods.
fn two() -> (TempDir, PathBuf, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let written = |name: &str, method: &str| {
        let path = folder.path().join(name);
        darboux(&["tangents", text(&asset(MODEL)), "--method", method, "-o", text(&path)]).exits(0);
        path
    };
    let (first, second) = (written("first.glb", "mikktspace"), written("second.glb", "lengyel"));
    (folder, first, second)
}

fn report(first: &Path, second: &Path) -> Value {
    darboux(&["compare", text(first), text(second), "--json"]).exits(0).json()
}

#[test]
fn a_file_is_identical_to_itself_and_to_its_method() {
    let (_folder, first, _) = two();
    let itself = report(&first, &first);
    let method = darboux(&["compare", text(&first), "--method", "mikktspace", "--json"]).exits(0).json();
    assert_eq!(method["method"], "mikktspace");
    for report in [itself, method] {
        let totals = &report["totals"];
        assert_eq!(totals["identical"], totals["corners"]);
        assert_eq!(totals["max"].as_f64(), Some(0.0));
        assert_eq!(totals["sign_flips"], 0);
        assert_eq!(report["worst"], Value::Array(Vec::new()));
        assert_eq!((&report["verdict"], &totals["different"]), (&"identical".into(), &0.into()));
    }
}

#[test]
fn a_method_stands_for_the_file_that_it_would_write() {
    let (_folder, first, second) = two();
    let files = report(&first, &second);
    let method = darboux(&["compare", text(&first), "--method", "lengyel", "--json"]).exits(0).json();
    assert_eq!(files["totals"], method["totals"]);
    assert_eq!(files["worst"], method["worst"]);
    let totals = &files["totals"];
    let number = |name: &str| totals[name].as_f64().expect("a number");
    assert!(
        number("min") <= number("median")
            && number("median") <= number("p95")
            && number("p95") <= number("max")
    );
    assert!(number("area_weighted_mean") > 0.0 && number("area_weighted_mean") < number("max"));
    let bins = totals["histogram"].as_array().expect("bins").iter();
    assert_eq!(bins.map(|bin| bin["corners"].as_u64().expect("a count")).sum::<u64>(), 3 * 7774);
    let worst = &files["worst"][0];
    assert_eq!(worst["angle"], totals["max"]);
    assert_eq!(files["verdict"], "different");
}

#[test]
fn people_read_numbers_bars_and_places() {
    let (_folder, first, second) = two();
    let run = darboux(&["compare", text(&first), text(&second), "--worst", "2"]).exits(0);
    assert!(run.stderr.is_empty(), "{}", run.stderr);
    let said = String::from_utf8(run.stdout).expect("UTF-8");
    for part in [
        "23,322 corners: ",
        "weighted by area",
        " | ####",
        "the worst corners",
        ", triangle ",
        ", corner ",
        ", at (",
        "the tangents differ from those of the second file: 18,478 of 23,322 corners differ by more than 0.01 degrees or in the sign w, the other 4,844 agree\n",
    ] {
        assert!(said.contains(part), "{part:?} is not in {said}");
    }
    assert_eq!(said.lines().filter(|line| line.contains(", triangle ")).count(), 2);
    let itself = darboux(&["compare", text(&first), "--method", "mikktspace"]).exits(0).stdout;
    assert!(
        String::from_utf8_lossy(&itself)
            .ends_with("the tangents are identical to those of mikktspace, bit for bit\n")
    );
}

#[test]
fn the_exit_code_says_whether_all_is_within_the_tolerance() {
    let (folder, first, second) = two();
    let (first, second) = (text(&first), text(&second));
    darboux(&["compare", first, first, "--tolerance", "0", "--quiet"]).exits(0);
    darboux(&["compare", first, second, "--tolerance", "180"]).exits(0);
    let run = darboux(&["compare", first, second, "--tolerance", "0.1", "--quiet"]).exits(3);
    assert!(run.stdout.is_empty() && run.stderr.is_empty());
    let bare = asset(MODEL);
    darboux(&["compare", first, text(&bare), "--tolerance", "180"]).exits(1);
    for arguments in [
        &["compare", first][..],
        &["compare", first, second, "--method", "face"],
        &["compare", first, "-"],
        &["compare", first, second, "--tolerance", "-1"],
        &["compare", first, second, "--force"],
    ] {
        darboux(arguments).exits(2);
    }
    drop(folder);
}

#[test]
fn files_of_different_models_are_refused_in_one_sentence() {
    let (folder, first, _) = two();
    let plane = asset("TwoSidedPlane/TwoSidedPlane.gltf");
    let run = darboux(&["compare", text(&plane), text(&first)]).exits(1);
    assert!(run.stderr.contains("corners") || run.stderr.contains("meshes"), "{}", run.stderr);
    assert_eq!(run.stderr.lines().count(), 1);
    let run = darboux(&["compare", text(&asset(MODEL)), text(&asset(MODEL))]).exits(1);
    assert!(
        run.stderr
            .contains("NormalTangentTest.glb: has no tangents to compare; to add them: darboux tangents "),
        "{}",
        run.stderr
    );
    darboux(&["compare", text(&first), "missing.glb"]).exits(1);
    assert_eq!(names_in(folder.path()), ["first.glb", "second.glb"]);
}

#[test]
fn the_heat_map_is_a_picture_and_replaces_nothing_unasked() {
    let (folder, first, second) = two();
    let map = folder.path().join("map.png");
    let arguments = ["compare", text(&first), text(&second), "--heat-map", text(&map)];
    let run = darboux(&arguments).exits(0);
    let said = String::from_utf8(run.stdout).expect("UTF-8");
    assert!(said.contains("map.png: colours from violet"), "{said}");
    let image = darboux_io::image::PngImage::open(&map, &darboux_io::LoadOptions::default()).expect("a PNG");
    assert_eq!((image.size(), image.channels()), ([1024, 1062], "rgb"));
    let before = fs::read(&map).expect("the map");
    let run = darboux(&arguments).exits(1);
    assert!(run.stderr.contains("--force"), "{}", run.stderr);
    darboux(&[&arguments[..], &["--force", "--quiet"]].concat()).exits(0);
    assert!(fs::read(&map).expect("the map") == before);
}

#[test]
fn every_field_of_the_report_is_documented() {
    let documented = fs::read_to_string(asset("../docs/cli.md")).expect("docs/cli.md");
    let section = documented.split("### `darboux compare --json`").nth(1).expect("a section");
    let section = section.split("\n### ").next().expect("its text");
    let (_folder, first, second) = two();
    let mut waiting = vec![report(&first, &second)];
    while let Some(value) = waiting.pop() {
        match value {
            Value::Array(values) => waiting.extend(values),
            Value::Object(members) => {
                for (name, value) in members {
                    let is_there =
                        section.contains(&format!("{name}`")) || section.contains(&format!("{name}[]`"));
                    assert!(is_there, "{name}");
                    waiting.push(value);
                }
            }
            _ => {}
        }
    }
}

#[test]
fn a_heat_map_replaces_no_file_of_the_inputs() {
    const FILES: [&str; 3] = ["TwoSidedPlane.gltf", "TwoSidedPlane.bin", "TwoSidedPlane_Normal.png"];
    let folder =
        common::folder_with(&FILES.map(|name| format!("TwoSidedPlane/{name}")).each_ref().map(|s| &**s));
    let [plane, _, normal_map] = FILES.map(|name| folder.path().join(name));
    let before = fs::read(&normal_map).expect("the normal map");
    let other = folder.path().join(".").join(FILES[2]);
    for map in [&normal_map, &other] {
        let arguments = ["compare", text(&plane), "--method", "face", "--force", "--heat-map", text(map)];
        let run = darboux(&arguments).exits(1);
        assert!(run.stderr.contains("is used by") && run.stderr.lines().count() == 1, "{}", run.stderr);
    }
    assert!(fs::read(&normal_map).expect("the normal map") == before);
}

#[test]
fn zero_tangents_are_seen() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let made = |mode: &str| {
        let path = folder.path().join(format!("{mode}.glb"));
        darboux(&["tangents", text(&asset("made/degenerate.gltf")), "--mode", mode, "-o", text(&path)])
            .exits(0);
        path
    };
    let (zeros, repaired) = (made("reference"), made("repaired"));
    darboux(&["compare", text(&zeros), text(&zeros), "--tolerance", "0", "--quiet"]).exits(0);
    let run = darboux(&["compare", text(&zeros), text(&repaired), "--tolerance", "180", "--json"]).exits(3);
    let report = run.json();
    assert!(report["totals"]["unknown"].as_u64() > Some(0), "{report}");
    assert_eq!(report["totals"]["unknown"], report["totals"]["without_angle"]);
    assert!(report["worst"][0]["angle"].is_null() && report["worst"][0]["sign_flip"] == false, "{report}");
    let said = String::from_utf8(darboux(&["compare", text(&zeros), text(&repaired)]).exits(0).stdout)
        .expect("UTF-8");
    assert!(
        said.contains("corners without an angle\n") && said.contains("\n  no angle: meshes[0]"),
        "{said}"
    );
}

/// A file whose signs are all opposite, as other conventions of v have them.
#[test]
fn opposite_signs_everywhere_are_said_in_a_sentence() {
    let (folder, first, _) = two();
    let mut bytes = fs::read(&first).expect("a model");
    let json = common::glb_json(&bytes);
    let number = |value: &Value| value.as_u64().expect("a number") as usize;
    let accessor = &json["accessors"][number(&json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"])];
    let view = &json["bufferViews"][number(&accessor["bufferView"])];
    assert!(view["byteStride"].is_null());
    let json_length = u32::from_le_bytes(bytes[12..16].try_into().expect("four bytes")) as usize;
    let start = 20 + json_length + 8 + view["byteOffset"].as_u64().unwrap_or(0) as usize;
    for vertex in 0..number(&accessor["count"]) {
        bytes[start + vertex * 16 + 15] ^= 0x80;
    }
    let opposite = folder.path().join("opposite.glb");
    fs::write(&opposite, bytes).expect("a file");
    let run = darboux(&["compare", text(&opposite), "--method", "mikktspace"]).exits(0);
    let said = String::from_utf8(run.stdout).expect("UTF-8");
    let verdict = "the tangents differ from those of mikktspace: the sign w is opposite at all 23,322 corners and the directions agree to 0.01 \
                   degrees, as for UVs whose v axis is inverted; to replace them: darboux tangents --overwrite --method mikktspace ";
    assert!(said.contains(verdict), "{said}");
}

/// A grid of quads, a few of which have a triangle that is mirrored in UV space.
fn grid_of_quads() -> String {
    let mut text = String::new();
    for (x, y) in (0..49).map(|at| (f64::from(at % 7), f64::from(at / 7))) {
        let [du, dv] = [0.0, 2.0].map(|phase| 0.7 * (5.0 * x + 11.0 * y + phase).sin());
        text += &format!("v {x} {y} {}\nvt {} {}\nvn 0 0 1\n", 0.2 * (x * y).sin(), x + du, y + dv);
    }
    for corner in (1..43).filter(|at| at % 7 != 0) {
        let face = [corner, corner + 1, corner + 8, corner + 7].map(|at| format!("{at}/{at}/{at}")).join(" ");
        text += &format!("f {face}\n");
    }
    text
}

#[test]
fn tangents_that_may_be_those_of_quads_are_not_called_wrong() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [model, made] = ["grid.obj", "made.glb"].map(|name| folder.path().join(name));
    fs::write(&model, grid_of_quads()).expect("writing");
    let compared = |method: &str| {
        darboux(&["tangents", text(&model), "--method", method, "-o", text(&made), "--force"]).exits(0);
        let run = darboux(&["compare", text(&made), "--method", "mikktspace"]).exits(0);
        String::from_utf8(run.stdout).expect("UTF-8")
    };
    let of_quads = compared("mikktspace");
    assert!(of_quads.contains("computed on quads before these were cut"), "{of_quads}");
    let others = compared("lengyel-per-vertex");
    assert!(others.contains("to replace them: ") && !others.contains("on quads"), "{others}");
}
