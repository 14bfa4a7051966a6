//! Where outputs go, what they replace, and what they leave alone.

mod common;

use std::fs;
use std::path::Path;

use common::{asset, darboux, darboux_reading, folder_with, glb_json, names_in, text};
use serde_json::Value;

const QUANTISED: &str = "made/quantised-sparse.glb";

/// Whether the first primitive of a model has tangents.
fn has_tangents(path: &Path) -> bool {
    let report = darboux(&["inspect", "--json", text(path)]).exits(0).json();
    report["files"][0]["primitives"][0]["has_tangents"] == true
}

#[test]
fn an_output_lies_beside_its_input_under_a_name_that_says_so() {
    let folder = folder_with(&[QUANTISED]);
    let input = folder.path().join("quantised-sparse.glb");
    let before = fs::read(&input).expect("the input");
    darboux(&["tangents", text(&input)]).exits(0);
    assert_eq!(names_in(folder.path()), ["quantised-sparse.glb", "quantised-sparse.tangents.glb"]);
    assert!(has_tangents(&folder.path().join("quantised-sparse.tangents.glb")));
    assert_eq!(fs::read(&input).expect("the input"), before);
}

#[test]
fn a_folder_does_not_take_up_its_own_outputs() {
    let folder = folder_with(&[QUANTISED]);
    darboux(&["tangents", text(folder.path())]).exits(0);
    let names = names_in(folder.path());
    let run = darboux(&["tangents", text(folder.path()), "--force", "--json"]).exits(0);
    assert_eq!(run.json()["totals"]["files"], 1);
    let skipped = folder.path().join("quantised-sparse.tangents.glb");
    assert!(run.stderr.contains(&format!("{} skipped: named like", text(&skipped))), "{}", run.stderr);
    assert_eq!(names_in(folder.path()), names);
}

#[test]
fn an_existing_output_is_replaced_only_by_force() {
    let folder = folder_with(&[QUANTISED]);
    let (input, output) = (folder.path().join("quantised-sparse.glb"), folder.path().join("out.glb"));
    fs::write(&output, b"precious").expect("a file");
    let run = darboux(&["tangents", text(&input), "-o", text(&output)]).exits(1);
    assert!(run.stderr.contains("--force"), "{}", run.stderr);
    assert_eq!(fs::read(&output).expect("the output"), b"precious");
    darboux(&["tangents", text(&input), "-o", text(&output), "--force"]).exits(0);
    assert!(has_tangents(&output));
}

#[test]
fn in_place_replaces_what_changes_and_touches_nothing_else() {
    let folder = folder_with(&[QUANTISED, "Fox/Fox.glb"]);
    let (changed, fox) = (folder.path().join("quantised-sparse.glb"), folder.path().join("Fox.glb"));
    let modified = || fs::metadata(&fox).and_then(|file| file.modified()).expect("a time");
    let before = modified();
    let run = darboux(&["tangents", text(folder.path()), "--in-place", "--json"]).exits(0);
    assert!(has_tangents(&changed));
    assert_eq!(modified(), before);
    assert_eq!(names_in(folder.path()), ["Fox.glb", "quantised-sparse.glb"]);
    let report = run.json();
    let statuses: Vec<&Value> =
        report["files"].as_array().expect("files").iter().map(|file| &file["status"]).collect();
    assert_eq!(statuses, ["untouched", "written"]);
}

#[test]
fn the_structure_of_folders_is_kept_below_out_dir() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for place in ["a", "b/c"] {
        fs::create_dir_all(folder.path().join(place)).expect("a folder");
        fs::copy(asset(QUANTISED), folder.path().join(place).join("model.glb")).expect("a copy");
    }
    let out = folder.path().join("out");
    for _ in 0..2 {
        let run = darboux(&["tangents", text(folder.path()), "--out-dir", text(&out), "--force", "--json"])
            .exits(0);
        assert_eq!(run.json()["totals"]["written"], 2, "the folder of outputs is not searched");
    }
    assert_eq!(names_in(&out), ["a", "b"]);
    assert!(has_tangents(&out.join("a/model.glb")) && has_tangents(&out.join("b/c/model.glb")));
}

#[test]
fn the_extension_of_the_output_decides_the_container() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let plane = asset("TwoSidedPlane/TwoSidedPlane.gltf");
    let (glb, gltf) = (folder.path().join("plane.glb"), folder.path().join("again/plane.gltf"));
    fs::create_dir(folder.path().join("again")).expect("a folder");
    darboux(&["tangents", text(&plane), "-o", text(&glb), "--overwrite"]).exits(0);
    let json = glb_json(&fs::read(&glb).expect("the GLB"));
    let embedded =
        |list: &str| json[list].as_array().expect("a list").iter().all(|item| item["uri"].is_null());
    assert!(embedded("buffers") && embedded("images"));
    let run = darboux(&["tangents", text(&plane), "-o", text(&gltf), "--overwrite", "--json"]).exits(0);
    let images =
        ["TwoSidedPlane_BaseColor.png", "TwoSidedPlane_MetallicRoughness.png", "TwoSidedPlane_Normal.png"];
    let folder = gltf.parent().expect("a folder");
    for image in images {
        let original = fs::read(asset("TwoSidedPlane").join(image)).expect("the image");
        assert_eq!(fs::read(folder.join(image)).expect("its copy"), original);
    }
    let report = run.json();
    let written = report["files"][0]["files_written"].as_array().expect("a list");
    assert_eq!(written.len(), names_in(folder).len());
    assert_eq!(written.last(), Some(&Value::from(text(&gltf))));
}

#[test]
fn a_pipe_gives_the_bytes_that_a_file_gets() {
    let folder = folder_with(&[QUANTISED]);
    let input = folder.path().join("quantised-sparse.glb");
    darboux(&["tangents", text(&input)]).exits(0);
    let file = fs::read(folder.path().join("quantised-sparse.tangents.glb")).expect("the output");
    let bytes = fs::read(&input).expect("the input");
    assert!(darboux_reading(&["tangents", "-"], &bytes).exits(0).stdout == file);
    assert!(darboux(&["tangents", text(&input), "-o", "-"]).exits(0).stdout == file);
    let named = folder.path().join("named.glb");
    darboux_reading(&["tangents", "-", "-o", text(&named)], &bytes).exits(0);
    assert!(fs::read(&named).expect("the output") == file);
}

#[test]
fn nothing_to_do_is_a_copy_and_a_success() {
    let folder = folder_with(&["Fox/Fox.glb"]);
    let (fox, copy) = (folder.path().join("Fox.glb"), folder.path().join("copy.glb"));
    let run = darboux(&["tangents", text(&fox), "-o", text(&copy)]).exits(0);
    assert!(fs::read(&fox).ok() == fs::read(&copy).ok());
    assert!(
        run.stderr.contains("meshes[0].primitives[0] \"fox1\": skipped: it has no NORMAL"),
        "{}",
        run.stderr
    );
    assert!(run.stderr.contains("Fox.glb -> ") && run.stderr.contains("copy.glb: unchanged copy\n"));
    assert!(run.stderr.contains("1 primitive has no normals, which tangents need; --normals smooth "));
}

#[test]
fn options_reach_the_tangents() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let output = folder.path().join("out.glb");
    let bytes_with = |input: &Path, options: &[&str]| {
        darboux(&[&["tangents", text(input), "-o", text(&output), "--force"], options].concat()).exits(0);
        fs::read(&output).expect("the output")
    };
    let curved = asset("NormalTangentTest/NormalTangentTest.glb");
    let usual = bytes_with(&curved, &[]);
    assert!(usual == bytes_with(&curved, &["--mode", "repaired", "--threshold", "180"]));
    assert!(usual != bytes_with(&curved, &["--threshold", "5"]));
    assert!(usual == bytes_with(&curved, &["--method", "mikktspace", "--encoding", "f32x4"]));
    assert!(usual != bytes_with(&curved, &["--method", "angle-area"]));
    assert!(usual.len() > bytes_with(&curved, &["--encoding", "snorm8x4"]).len());
    let turned = asset("made/shared-vertices-two-uv-sets.gltf");
    assert!(bytes_with(&turned, &[]) != bytes_with(&turned, &["--apply-texture-transform"]));
    let degenerate = asset("made/degenerate.gltf");
    assert!(bytes_with(&degenerate, &[]) != bytes_with(&degenerate, &["--mode", "reference"]));
    let morphing = asset("Morphing/morphing.gltf");
    assert!(bytes_with(&morphing, &[]) != bytes_with(&morphing, &["--overwrite"]));
    assert!(bytes_with(&morphing, &[]) == bytes_with(&morphing, &["--overwrite", "--only-needed"]));
}

#[test]
fn read_only_files_are_not_replaced() {
    let folder = folder_with(&[QUANTISED]);
    let [input, output] = ["quantised-sparse.glb", "out.glb"].map(|name| folder.path().join(name));
    fs::write(&output, b"precious").expect("a file");
    let before = fs::read(&input).expect("the input");
    for path in [&input, &output] {
        let mut permissions = fs::metadata(path).expect("a file").permissions();
        permissions.set_readonly(true);
        fs::set_permissions(path, permissions).expect("a read-only file");
    }
    for (words, file) in [(&["--in-place"][..], &input), (&["--force", "-o", text(&output)], &output)] {
        let run = darboux(&[&["tangents", text(&input)], words].concat()).exits(1);
        let sentence =
            format!("error: {}: is read-only; make it writable, or name another output\n", file.display());
        assert_eq!(run.stderr, sentence);
    }
    assert_eq!(fs::read(&input).expect("the input"), before);
    assert_eq!(fs::read(&output).expect("the output"), b"precious");
    darboux(&["tangents", text(&input)]).exits(0);
}

/// By SIGTERM, as batch systems end what takes too long; ignored signals, as `nohup` and scripts leave them,
/// do not matter.
#[test]
#[cfg(target_os = "linux")]
fn a_file_that_is_being_written_is_finished_or_withdrawn() {
    use std::process::{Command, Stdio};

    let models = tempfile::tempdir().expect("a temporary folder");
    for number in 0..8 {
        let copy = models.path().join(format!("{number}.glb"));
        fs::copy(asset("NormalTangentTest/NormalTangentTest.glb"), copy).expect("a copy");
    }
    let hidden = |folder: &Path| names_in(folder).iter().any(|name| name.starts_with(".darboux-"));
    // A run may be done before it is told to end.
    let was_stopped = (0..50).any(|_| {
        let out = tempfile::tempdir().expect("a temporary folder");
        let mut run = Command::new("env")
            .args(["--default-signal=TERM", "--ignore-signal=HUP,INT", env!("CARGO_BIN_EXE_darboux")])
            .args(["tangents", "--jobs", "1", text(models.path()), "--out-dir", text(out.path())])
            .stderr(Stdio::null())
            .spawn()
            .expect("the command starts");
        while run.try_wait().expect("a status").is_none() {
            if hidden(out.path()) {
                let _may_be_done = Command::new("kill").args(["-TERM", &run.id().to_string()]).status();
                break;
            }
        }
        let ended = run.wait().expect("it ends");
        assert!(!hidden(out.path()));
        ended.code() != Some(0) && {
            assert_eq!(std::os::unix::process::ExitStatusExt::signal(&ended), Some(15), "{ended}");
            true
        }
    });
    assert!(was_stopped);
}

/// Not even its time, so that nothing downstream is built again.
#[test]
fn a_second_run_in_place_changes_nothing() {
    let folder = folder_with(&["made/shield.glb"]);
    let model = folder.path().join("shield.glb");
    let run = || darboux(&["tangents", "--overwrite", "--in-place", text(&model)]).exits(0).stderr;
    let state =
        || (fs::read(&model).expect("the model"), fs::metadata(&model).and_then(|file| file.modified()).ok());
    assert!(run().contains("425 vertices became 450"));
    let first = state();
    let again = run();
    assert!(again.contains("shield.glb: unchanged, not written\n"));
    assert!(again.contains("0 primitives got tangents, 1 unchanged, 0 kept"), "{again}");
    assert!(state() == first);
}

/// A triangle with UVs and normals.
const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\n";

/// A folder is searched for all formats that are read; where names would collide, converted models keep their
/// ending.
#[test]
fn folders_have_models_of_all_formats() {
    let folder =
        folder_with(&["blender/scene.ply", "blender/scene.stl", "blender/scene.glb", "blender/scene.fbx"]);
    fs::create_dir(folder.path().join("sub")).expect("a folder");
    fs::write(folder.path().join("sub/chair.obj"), TRIANGLE).expect("a file");
    fs::write(folder.path().join("chair.OBJ"), TRIANGLE).expect("a file");
    fs::write(folder.path().join("notes.txt"), "no model").expect("a file");
    let out = tempfile::tempdir().expect("a temporary folder");
    let out_dir = out.path().join("out");
    let arguments = ["tangents", text(folder.path()), "--out-dir", text(&out_dir), "--json"];
    let run = darboux(&arguments).exits(0);
    assert_eq!(run.json()["totals"]["files"], 6);
    let names = ["chair.glb", "scene.fbx.glb", "scene.glb", "scene.ply.glb", "scene.stl.glb", "sub"];
    assert_eq!(names_in(&out_dir), names);
    assert_eq!(names_in(&out_dir.join("sub")), ["chair.glb"]);
    assert!(has_tangents(&out_dir.join("chair.glb")) && has_tangents(&out_dir.join("scene.fbx.glb")));
    // Beside their inputs, and not again in the next run.
    darboux(&["tangents", text(folder.path())]).exits(0);
    let names = names_in(folder.path());
    for name in
        ["chair.tangents.glb", "scene.tangents.glb", "scene.fbx.tangents.glb", "scene.ply.tangents.glb"]
    {
        assert!(names.iter().any(|found| found == name), "{names:?}");
    }
    let again = darboux(&["tangents", text(folder.path()), "--force", "--json"]).exits(0);
    assert_eq!(again.json()["totals"]["files"], 6);
    for command in ["inspect", "check"] {
        let run = darboux(&[command, text(folder.path()), "--json"]);
        let report = run.json();
        let files = report["files"].as_array().expect("files");
        let has = |name: &str| {
            files.iter().any(|file| file["input"].as_str().is_some_and(|input| input.ends_with(name)))
        };
        assert!(files.len() == 12 && has("scene.fbx") && has("chair.obj") && has("scene.stl"), "{command}");
    }
}

/// Two models of other formats with one name, and a name that is taken even so.
#[test]
fn converted_models_with_one_name_keep_their_endings() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("a.obj"), TRIANGLE).expect("a file");
    fs::copy(asset("blender/scene.ply"), folder.path().join("a.ply")).expect("a copy");
    let out = tempfile::tempdir().expect("a temporary folder");
    let out_dir = out.path().join("out");
    darboux(&["tangents", text(folder.path()), "--out-dir", text(&out_dir)]).exits(0);
    assert_eq!(names_in(&out_dir), ["a.obj.glb", "a.ply.glb"]);
    for name in ["a.glb", "a.obj.glb"] {
        fs::copy(asset("made/quantised-sparse.glb"), folder.path().join(name)).expect("a copy");
    }
    let other = out.path().join("other");
    let run = darboux(&["tangents", text(folder.path()), "--out-dir", text(&other)]).exits(2);
    assert!(run.stderr.contains("would both be written to"), "{}", run.stderr);
}

/// In place, only glTF is edited, and the others are counted.
#[test]
fn in_place_leaves_other_formats_alone() {
    let folder = folder_with(&[QUANTISED, "blender/scene.ply"]);
    let ply = folder.path().join("scene.ply");
    let before = fs::read(&ply).expect("the model");
    for name in ["stage.usdz", "a.blend", "b.blend", "C.DAE"] {
        fs::write(folder.path().join(name), "PK").expect("a file");
    }
    let run = darboux(&["tangents", text(folder.path()), "--in-place"]).exits(0);
    for sentence in [
        "1 PLY file is skipped: only glTF is edited in place, so name an output folder with --out-dir",
        "1 USD file is skipped: darboux.usd in Python reads USD",
        "2 Blender files are skipped: its format is not read; export the models as .glb or .fbx",
        "1 COLLADA file is skipped: its format is not read",
    ] {
        assert!(run.stderr.contains(sentence), "{}", run.stderr);
    }
    assert_eq!(fs::read(&ply).expect("the model"), before);
    assert!(has_tangents(&folder.path().join("quantised-sparse.glb")));
}

#[test]
fn formats_that_are_not_written_are_refused_in_one_sentence() {
    let folder = folder_with(&[QUANTISED]);
    let input = folder.path().join("quantised-sparse.glb");
    for (name, sentence) in [
        (
            "a.fbx",
            "is named as FBX, which is not written; end its name in one of .gltf, .glb, .vrm, .obj, .ply",
        ),
        ("a.STL", "is named as STL, which is not written"),
        ("a.usdz", "is named as USD, which is not written here"),
        ("a.usd", "or use darboux.usd in Python"),
        ("a", "has no ending of a model; end its name in one of .gltf"),
    ] {
        let output = folder.path().join(name);
        for command in ["tangents", "normals"] {
            let run = darboux(&[command, text(&input), "-o", text(&output)]).exits(2);
            assert!(run.stderr.contains(sentence), "{}", run.stderr);
            assert_eq!(run.stderr.trim_end().lines().count(), 1, "{}", run.stderr);
        }
        assert!(!output.exists());
    }
}
