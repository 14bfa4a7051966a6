//! Many files: what is printed, and the progress bar.

#[cfg(target_os = "linux")]
use std::ffi::OsStr;
use std::fs;
#[cfg(target_os = "linux")]
use std::io::Write;
#[cfg(target_os = "linux")]
use std::path::Path;
#[cfg(target_os = "linux")]
use std::process::Command;

use crate::common::{asset, darboux, folder_with, glb, glb_json, text};
use darboux_io::image::PngImage;

fn flat(side: usize) -> Vec<u8> {
    let image = PngImage::from_rgb("map", [side as u32; 2], &vec![[128u8, 128, 255]; side * side]);
    image.expect("an image").to_bytes().expect("a file")
}

/// Healthy models are counted, the others have a line each, and images have their verdict.
#[test]
fn more_than_ten_files_have_one_line_each_and_healthy_models_none() {
    let folder = tempfile::tempdir().expect("a folder");
    let healthy = asset("made/strips-fans-lines-points.gltf");
    for file in ["strips-fans-lines-points.gltf", "shield.glb"] {
        fs::copy(asset("made").join(file), folder.path().join(file)).expect("a copy");
    }
    let healthy = fs::read(healthy).expect("a model");
    for index in 0..9 {
        fs::write(folder.path().join(format!("healthy{index}.gltf")), &healthy).expect("a file");
    }
    let map = folder.path().join("map.png");
    fs::write(&map, flat(64)).expect("a file");
    let models = text(folder.path());
    let run = |arguments: &[&str]| {
        let printed = darboux(&[&["check", models], arguments].concat()).exits(1).stdout;
        String::from_utf8(printed).expect("text")
    };
    let brief = run(&[text(&map)]);
    let lines: Vec<&str> = brief.lines().collect();
    let shield = folder.path().join("shield.glb");
    let expected = format!(
        "{}: 1 error (tangent-shared-across-mirror), 2 warnings (tangent-sign-mixed, tangent-other-recipe)",
        text(&shield)
    );
    assert_eq!(lines[0], expected, "{brief}");
    assert_eq!(lines[1], format!("{}: all its texels have one colour", text(&map)), "{brief}");
    assert_eq!(lines[2], "12 files: 1 with errors, 0 with warnings only, 11 without", "{brief}");
    assert_eq!(lines[3], "  error       tangent-shared-across-mirror 1 in 1 file", "{brief}");
    assert!(brief.ends_with("  -v prints what each of these means, what it looks like and what to type\n"));
    let verbose = run(&["-v"]);
    assert!(verbose.contains("healthy3.gltf\n  Nothing is wrong."), "{verbose}");
    assert!(verbose.contains("looks like: ") && !verbose.contains("-v prints"), "{verbose}");
}

/// What a command prints on a terminal that `script` makes; none without that program.
#[cfg(target_os = "linux")]
fn on_a_terminal(arguments: &[&str]) -> Option<String> {
    let moved = std::env::var_os("DARBOUX_PROGRAM");
    let program = moved.unwrap_or_else(|| env!("CARGO_BIN_EXE_darboux").into());
    let line = format!("{} {}", text(Path::new(&program)), arguments.join(" "));
    let output = Command::new("script")
        .args(["-q", "-e", "-c", &line, "/dev/null"].map(OsStr::new))
        .env("TERM", "xterm")
        .output();
    let Ok(output) = output else {
        writeln!(std::io::stdout(), "skipped: no script (Debian: bsdutils)").expect("standard output");
        return None;
    };
    Some(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// The bar appears after 0.7 s.
#[cfg(target_os = "linux")]
#[test]
fn a_long_check_has_a_progress_bar_on_a_terminal_only() {
    let folder = tempfile::tempdir().expect("a folder");
    let maps: Vec<String> = (0..4).map(|index| format!("{}/{index}.png", text(folder.path()))).collect();
    let map = flat(3200);
    maps.iter().for_each(|path| fs::write(path, &map).expect("a file"));
    let maps: Vec<&str> = maps.iter().map(String::as_str).collect();
    let arguments = |more: &[&'static str]| [&["check", "--jobs", "1"], more, &maps].concat();
    if let Some(shown) = on_a_terminal(&arguments(&[])) {
        assert!(shown.contains("50 % ") && shown.contains("2.png "), "{shown:?}");
        assert!(shown.contains("4 files: 0 with errors"), "{shown:?}");
        let quiet = on_a_terminal(&arguments(&["--quiet"])).expect("the program is there");
        assert_eq!(quiet, "");
    }
    assert_eq!(darboux(&arguments(&[])).exits(0).stderr, "");
}

/// The maps of an OBJ are named in its library.
#[test]
fn normal_maps_of_an_obj_are_used() {
    let folder = folder_with(&["blender/scene.obj", "blender/scene.mtl", "blender/scene_normal.png"]);
    let run = darboux(&["check", text(folder.path()), "--fail-on", "never"]).exits(0);
    assert!(!run.stderr.contains("used by no model"), "{}", run.stderr);
    // As the reader finds it: in other letters' case.
    if cfg!(target_os = "linux") {
        let library = fs::read_to_string(folder.path().join("scene.mtl")).expect("a library");
        let shouted = library.replace("scene_normal.png", "Scene_NORMAL.PNG");
        fs::write(folder.path().join("scene.mtl"), shouted).expect("a library");
        let run = darboux(&["check", text(folder.path()), "--fail-on", "never"]).exits(0);
        assert!(!run.stderr.contains("used by no model"), "{}", run.stderr);
    }
    fs::rename(folder.path().join("scene_normal.png"), folder.path().join("other_normal.png"))
        .expect("a name");
    let run = darboux(&["check", text(folder.path()), "--fail-on", "never"]).exits(0);
    assert!(run.stderr.contains("is used by no model there"), "{}", run.stderr);
}

/// Images in a folder are not checked, and those that look like normal maps and that no model uses are named.
#[test]
fn unused_normal_maps_of_a_folder_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let plane = asset("TwoSidedPlane");
    for entry in fs::read_dir(&plane).expect("files").flatten() {
        fs::copy(entry.path(), folder.path().join(entry.file_name())).expect("a copy");
    }
    let run = darboux(&["check", text(folder.path()), "--fail-on", "never"]).exits(0);
    assert!(!run.stderr.contains("used by no model"), "{}", run.stderr);
    fs::copy(plane.join("TwoSidedPlane_Normal.png"), folder.path().join("Brick_Normal.png")).expect("a copy");
    let run = darboux(&["check", text(folder.path()), "--fail-on", "never"]).exits(0);
    let sentence = "1 image named like a normal map is used by no model there";
    assert!(run.stderr.contains(sentence) && run.stderr.contains("Brick_Normal.png"), "{}", run.stderr);
}

/// A model whose JSON is longer than what is read of it for names may use every image.
#[test]
fn models_with_long_json_may_use_all_maps() {
    let folder = folder_with(&["made/shield.glb"]);
    fs::write(folder.path().join("brick_normal.png"), "").expect("a file");
    let run = || darboux(&["check", text(folder.path()), "--fail-on", "never"]).exits(0);
    assert!(run().stderr.contains("is used by no model there"));
    let mut json = glb_json(&fs::read(asset("made/shield.glb")).expect("a model"));
    json["buffers"] = serde_json::json!([]);
    let members = ["accessors", "bufferViews", "meshes", "nodes", "scenes", "scene", "images", "materials"];
    members.iter().for_each(|member| drop(json.as_object_mut().expect("an object").remove(*member)));
    json["extras"] = " ".repeat(4 << 20).into();
    json["images"] = serde_json::json!([{ "uri": "brick_normal.png" }]);
    fs::write(folder.path().join("long.glb"), glb(&json, &[])).expect("a file");
    let stderr = run().stderr;
    assert!(!stderr.contains("used by no model"), "{stderr}");
}
