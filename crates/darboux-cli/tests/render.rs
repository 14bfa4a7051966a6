//! `darboux render`: what it writes and what it refuses.

mod common;

use std::fs;

use serde_json::Value;

use common::{asset, darboux, darboux_without_adapters, folder_with, has_adapter, names_in, text};

const MODEL: &str = "NormalTangentTest/NormalTangentTest.glb";

#[test]
fn a_picture_is_written_and_not_replaced_unasked() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let (model, output) = (asset(MODEL), folder.path().join("picture.png"));
    let draw = |more: &[&str]| {
        let all = ["render", text(&model), "-o", text(&output), "--size", "120x90"];
        darboux(&[&all, more].concat())
    };
    let report = draw(&["--json"]).exits(0).json();
    assert_eq!(
        (&report["view"], &report["size"][0], &report["triangles"]),
        (&"shaded".into(), &120.into(), &7774.into())
    );
    let first = fs::read(&output).expect("a picture");
    assert!(first.starts_with(b"\x89PNG"));
    assert!(draw(&["--view", "tangent"]).exits(1).stderr.contains("exists; use --force"));
    assert!(fs::read(&output).expect("a picture") == first);
    draw(&["--view", "heat", "--tangents", "mikktspace", "--against", "lengyel", "--force"]).exits(0);
    assert!(fs::read(&output).expect("a picture") != first);
    assert_eq!(names_in(folder.path()), ["picture.png"]);
}

#[test]
fn the_heat_of_equal_sources_is_least_everywhere() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let (model, output) = (asset(MODEL), folder.path().join("heat.png"));
    // Black behind it, so that edges are darker, never lighter.
    let all = ["--view", "heat", "--tangents", "lengyel", "--size", "80x60", "--background", "000000"];
    let draw = |against: &str| {
        let last = ["--against", against, "--force", "--quiet"];
        darboux(&[&["render", text(&model), "-o", text(&output)], &all[..], &last].concat()).exits(0);
        let image = fs::read(&output).expect("a picture");
        let mut reader = png::Decoder::new(std::io::Cursor::new(image)).read_info().expect("a PNG");
        let mut pixels = vec![0; 80 * 60 * 3];
        reader.next_frame(&mut pixels).expect("pixels");
        pixels.as_chunks::<3>().0.iter().map(|pixel| pixel[1]).max()
    };
    // Green grows along the scale, from 1.
    assert_eq!(draw("lengyel"), Some(1));
    assert!(draw("mikktspace") > Some(60));
}

#[test]
fn meshes_are_chosen_by_name_or_index() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let (model, output) = (folder.path().join("two.gltf"), folder.path().join("a.png"));
    let text_of = fs::read_to_string(asset("made/skinned-morphed-mirrored.gltf")).expect("a model");
    let mut json: Value = serde_json::from_str(&text_of).expect("JSON");
    let mut other = json["meshes"][0].clone();
    other["name"] = "other".into();
    json["meshes"].as_array_mut().expect("a list").push(other);
    json["nodes"].as_array_mut().expect("a list").push(serde_json::json!({ "mesh": 1 }));
    json["scenes"][0]["nodes"].as_array_mut().expect("a list").push(3.into());
    fs::write(&model, json.to_string()).expect("a file");
    let draw = |meshes: &[&str]| {
        let all = ["render", text(&model), "-o", text(&output), "--size", "32x32", "--force", "--json"];
        let chosen = meshes.iter().flat_map(|mesh| ["--mesh", mesh]);
        darboux(&all.into_iter().chain(chosen).collect::<Vec<_>>())
    };
    let triangles = |meshes: &[&str]| draw(meshes).exits(0).json()["triangles"].as_u64();
    assert_eq!([triangles(&[]), triangles(&["sleeve", "1"])], [Some(32); 2]);
    assert_eq!([triangles(&["sleeve"]), triangles(&["other"]), triangles(&["0", "sleeve"])], [Some(16); 3]);
    // What is not drawn is not spoken of.
    let tells_of_skin =
        |mesh: &str| draw(&[mesh]).exits(0).json()["warnings"].to_string().contains("without its skin");
    assert_eq!([tells_of_skin("sleeve"), tells_of_skin("other")], [true, false]);
    for none in ["2", "-1", "Sleeve", ""] {
        let refused = draw(&[none]).exits(1).stderr;
        assert!(refused.contains("has no mesh") && refused.contains("sleeve, other"), "{none}: {refused}");
    }
}

#[test]
fn bad_arguments_are_usage() {
    let wrong = [
        (&["--size", "100"][..], "not a size"),
        (&["--size", "0x-1"], "not a size"),
        (&["--camera", "30"], "not two or three numbers"),
        (&["--camera", "30,100"], "-90 to 90"),
        (&["--camera", "30,NaN"], "-90 to 90"),
        (&["--camera", "30,20,0"], "0.01 to 1000"),
        (&["--background", "+12345"], "six hexadecimal digits"),
        (&["--tangents", "best"], "neither file nor a method"),
        (&["--view", "heat"], "--against"),
        (&["--view", "sideways"], "possible values"),
    ];
    for (arguments, problem) in wrong {
        let refused = darboux(&[&["render", "a.glb", "-o", "a.png"], arguments].concat()).exits(2);
        assert!(refused.stderr.contains(problem), "{arguments:?}: {}", refused.stderr);
    }
}

#[test]
fn bad_inputs_are_sentences_and_leave_nothing() {
    let folder = folder_with(&[MODEL]);
    let at = |name: &str| folder.path().join(name);
    fs::write(at("cut.glb"), &fs::read(asset(MODEL)).expect("a model")[..5000]).expect("a file");
    let nodes = |nodes: &str| {
        format!(r#"{{"asset":{{"version":"2.0"}},"nodes":{nodes},"scenes":[{{"nodes":[0]}}]}}"#)
    };
    fs::write(at("circle.gltf"), nodes(r#"[{"children":[1]},{"children":[0]}]"#)).expect("a file");
    fs::write(at("lost.gltf"), nodes(r#"[{"mesh":3}]"#)).expect("a file");
    fs::write(at("none.gltf"), nodes(r#"[{"children":[7]}]"#)).expect("a file");
    let before = names_in(folder.path());
    let cases = [
        ("cut.glb", "a.png", "cut.glb: "),
        ("circle.gltf", "a.png", "nodes[0]: is in the scene twice"),
        ("lost.gltf", "a.png", "nodes[0]: mesh 3 does not exist"),
        ("none.gltf", "a.png", "nodes[7]: does not exist"),
        ("NormalTangentTest.glb", "a.jpg", "name it .png"),
        ("missing.glb", "a.png", "cannot be read"),
    ];
    for (model, output, problem) in cases {
        let failed = darboux(&["render", text(&at(model)), "-o", text(&at(output))]).exits(1);
        assert!(failed.stderr.contains(problem), "{model}: {}", failed.stderr);
    }
    let of_file = ["--tangents", "file"];
    let all = ["render", text(&at("NormalTangentTest.glb")), "-o", text(&at("a.png"))].map(str::to_owned);
    let all: Vec<&str> = all.iter().map(String::as_str).chain(of_file).collect();
    assert!(darboux(&all).exits(1).stderr.contains("has no tangents; name a method"));
    assert_eq!(names_in(folder.path()), before);
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "drivers are found by environment variables on Linux only")]
fn without_an_adapter_nothing_is_drawn() {
    let folder = tempfile::tempdir().expect("a folder");
    let (model, output) = (asset(MODEL), folder.path().join("a.png"));
    let failed = darboux_without_adapters(&["render", text(&model), "-o", text(&output)]).exits(1);
    assert!(failed.stderr.contains("no adapter was found to draw with"), "{}", failed.stderr);
    assert!(names_in(folder.path()).is_empty());
}
