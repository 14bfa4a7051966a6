//! Conventions on the command line: images and models there and back, and what is refused.

mod common;

use std::fs;
use std::path::Path;

use common::{Run, asset, darboux, darboux_reading, folder_with, glb_json, names_in, text};
use darboux::Convention;
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use darboux_io::image::{Channels, PngImage, convert_normal_map};
use serde_json::Value;

const IMAGE: &str = "TwoSidedPlane/TwoSidedPlane_Normal.png";
const MODEL: &str = "NormalTangentTest/NormalTangentTest.glb";

fn convert(input: &Path, from: &str, to: &str, more: &[&str]) -> Run {
    darboux(&[&["convert", text(input), "--from", from, "--to", to], more].concat())
}

fn names() -> impl Iterator<Item = &'static str> {
    Convention::PRESETS.into_iter().map(|(name, _)| name)
}

/// The texels of a PNG, whatever its compression: they are written anew, inverted.
fn texels(path: &Path) -> Vec<u8> {
    let mut image = PngImage::open(path, &LoadOptions::default()).expect("an image");
    let conversion = Convention::GLTF.to(Convention::UNREAL);
    convert_normal_map(&mut image, &conversion, Channels::RGB, Channels::RGB).expect("a conversion");
    image.to_bytes().expect("a file")
}

#[test]
fn an_image_comes_back_from_every_preset() {
    let folder = folder_with(&[IMAGE]);
    let image = folder.path().join("TwoSidedPlane_Normal.png");
    let original = fs::read(&image).expect("the image");
    for name in names() {
        let there = folder.path().join(format!("TwoSidedPlane_Normal.{name}.png"));
        convert(&image, "gltf", name, &[]).exits(0);
        let back = folder.path().join(format!("back.{name}.png"));
        convert(&there, name, "gltf", &["-o", text(&back)]).exits(0);
        assert!(texels(&back) == texels(&image), "{name}");
        let is_same = name != "directx" && name != "unreal" && name != "3dsmax";
        assert_eq!(fs::read(&there).expect("the output") == original, is_same, "{name}");
    }
}

/// Without conventions, a model is written in another format and is what its reader makes of it.
#[test]
fn models_change_their_format_alone() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [glb, gltf, obj, same, png] =
        ["a.glb", "a.gltf", "b.obj", "same.glb", "n.png"].map(|name| folder.path().join(name));
    let source = asset("blender/polygons.obj");
    darboux(&["convert", text(&source), "-o", text(&glb)]).exits(0);
    darboux(&["convert", text(&glb), "-o", text(&gltf)]).exits(0);
    darboux(&["convert", text(&glb), "-o", text(&obj)]).exits(0);
    let out = folder.path().join("out");
    fs::create_dir(&out).expect("a folder");
    darboux(&["convert", text(&source), "--out-dir", text(&out)]).exits(0);
    assert_eq!(names_in(&out), ["polygons.glb"]);
    let models = folder.path().join("models");
    fs::create_dir(&models).expect("a folder");
    fs::copy(&source, models.join("inside.obj")).expect("a copy");
    darboux(&["convert", text(&models), "--out-dir", text(&out)]).exits(0);
    assert_eq!(names_in(&out), ["inside.glb", "polygons.glb"]);
    assert!(fs::read(&glb).expect("a file") == fs::read(out.join("polygons.glb")).expect("a file"));
    let open = |path: &Path| Document::open(path, &LoadOptions::default()).expect("a model");
    assert!(fs::read(&glb).expect("a file") == open(&source).to_glb().expect("a file"));
    let corners = |path: &Path| {
        let document = open(path);
        let primitives = document.meshes().iter().flat_map(|mesh| &mesh.primitives);
        let corners = primitives.flat_map(|primitive| {
            let positions = document.vectors::<3>(primitive.attributes["POSITION"]).expect("positions");
            let indices = document.indices(primitive.indices.expect("indices")).expect("indices").into_u32();
            indices.into_iter().map(|index| positions[index as usize]).collect::<Vec<_>>()
        });
        corners.collect::<Vec<_>>()
    };
    assert_eq!(corners(&gltf), corners(&glb));
    assert_eq!(corners(&obj), corners(&glb));
    let option = darboux(&["convert", text(&asset(IMAGE)), "--to-layout", "ag", "-o", text(&png)]).exits(2);
    assert!(option.stderr.contains("--to-layout needs conventions"), "{}", option.stderr);
    let refused = darboux(&["convert", text(&glb), "-o", text(&same)]).exits(2);
    assert!(refused.stderr.contains("nothing would change"), "{}", refused.stderr);
    let refused = darboux(&["convert", text(&asset(IMAGE)), "-o", text(&png)]).exits(2);
    assert!(refused.stderr.contains("(--from and --to)"), "{}", refused.stderr);
    let one = darboux(&["convert", text(&glb), "--from", "unity", "-o", text(&obj)]).exits(2);
    assert!(one.stderr.contains("--to"), "{}", one.stderr);
    let own = darboux(&["convert", text(&obj), "--from", "gltf", "--to", "gltf", "-o", text(&obj)]).exits(2);
    assert!(own.stderr.ends_with("would be replaced by its own output; name another output\n"));
}

#[test]
fn a_model_comes_back_from_every_preset() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (start, there, back) =
        (folder.path().join("start.glb"), folder.path().join("there.glb"), folder.path().join("back.glb"));
    darboux(&["tangents", text(&asset(MODEL)), "-o", text(&start)]).exits(0);
    let inspected = |path: &Path| {
        let mut report = darboux(&["inspect", "--json", text(path)]).exits(0).json();
        report["files"][0]["primitives"].take()
    };
    for name in names() {
        convert(&start, "gltf", name, &["--raw", "--force", "-o", text(&there)]).exits(0);
        let said = glb_json(&fs::read(&there).expect("the output"))["asset"]["extras"].take();
        assert_eq!(said.is_null(), name == "gltf", "{name}");
        convert(&there, name, "gltf", &["--force", "-o", text(&back)]).exits(0);
        assert_eq!(inspected(&back), inspected(&start), "{name}");
        let [first, last] =
            [&start, &back].map(|path| glb_json(&fs::read(path).expect("a model"))["asset"].take());
        assert_eq!(first, last, "{name}");
    }
}

/// Nodes that mirror, a skin and an animation.
#[test]
fn a_scene_comes_back_in_other_axes() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (there, back) = (folder.path().join("there.glb"), folder.path().join("back.glb"));
    for model in
        ["made/shared-vertices-two-uv-sets.gltf", "made/skinned-morphed-mirrored.gltf", "Fox/Fox.glb"]
    {
        let model = asset(model);
        convert(&model, "gltf", "unreal", &["--raw", "--force", "-o", text(&there)]).exits(0);
        let run = convert(&there, "unreal", "gltf", &["--force", "-o", text(&back), "--json"]).exits(0);
        assert_eq!(run.json()["files"][0]["model"]["axes_changed"], true);
        let inspected = |path: &Path| {
            let mut report = darboux(&["inspect", "--json", text(path)]).exits(0).json();
            report["files"][0]["primitives"].take()
        };
        assert_eq!(inspected(&back), inspected(&model));
    }
}

#[test]
fn a_model_leaves_gltfs_convention_only_when_told_and_says_so() {
    let folder = folder_with(&[MODEL]);
    let (model, out) = (folder.path().join("NormalTangentTest.glb"), folder.path().join("out.glb"));
    let before = names_in(folder.path());
    let run = convert(&model, "gltf", "unity", &[]).exits(1);
    assert!(run.stderr.contains("--raw"), "{}", run.stderr);
    assert_eq!(names_in(folder.path()), before);
    let run = convert(&model, "gltf", "unity", &["--raw", "-o", text(&out)]).exits(0);
    assert!(run.stderr.contains("warning: ") && run.stderr.contains("no viewer of glTF"), "{}", run.stderr);
    for command in ["tangents", "normals", "inspect"] {
        let run = darboux(&[command, text(&out)]).exits(1);
        assert!(run.stderr.contains("darboux convert --from unity --to gltf "), "{}", run.stderr);
    }
    let run = convert(&out, "unreal", "gltf", &[]).exits(1);
    assert!(run.stderr.contains("is \"unity\"; convert from that convention"), "{}", run.stderr);
}

#[test]
fn conventions_that_have_no_name_are_spelled() {
    let folder = folder_with(&[MODEL, IMAGE]);
    let [model, image] =
        ["NormalTangentTest.glb", "TwoSidedPlane_Normal.png"].map(|name| folder.path().join(name));
    convert(&image, "gltf", "gltf,green=down", &[]).exits(0);
    assert!(folder.path().join("TwoSidedPlane_Normal.converted.png").is_file());
    let out = folder.path().join("out.glb");
    convert(&model, "gltf", "maya,fronts=cw", &["--raw", "-o", text(&out)]).exits(0);
    let run = darboux(&["inspect", text(&out)]).exits(1);
    assert!(run.stderr.contains("--from gltf,fronts=cw,v0=bottom --to gltf "), "{}", run.stderr);
    convert(&model, "gltf", "maya", &["--raw", "--force", "-o", text(&out)]).exits(0);
    let run = darboux(&["inspect", text(&out)]).exits(1);
    assert!(run.stderr.contains("opengl (also called threejs, maya)"), "{}", run.stderr);
    let run = convert(&model, "gltf", "gltf,green=left", &[]).exits(2);
    assert!(run.stderr.contains("green cannot be"), "{}", run.stderr);
}

#[test]
fn what_changes_nothing_is_called_a_copy_and_what_is_no_normal_map_is_warned_of() {
    let folder = folder_with(&[MODEL, "TwoSidedPlane/TwoSidedPlane_BaseColor.png", IMAGE]);
    let path = |name: &str| folder.path().join(name);
    let run = convert(&path("NormalTangentTest.glb"), "gltf", "gltf", &[]).exits(0);
    assert!(run.stderr.contains("NormalTangentTest.gltf.glb: unchanged copy\n"), "{}", run.stderr);
    assert!(run.stderr.contains("0 primitives changed: the conventions do not differ"), "{}", run.stderr);
    let run = convert(&path("TwoSidedPlane_BaseColor.png"), "gltf", "directx", &[]).exits(0);
    assert!(run.stderr.contains("does not look like a normal map"), "{}", run.stderr);
    let run = convert(&path("TwoSidedPlane_Normal.png"), "gltf", "directx", &[]).exits(0);
    assert!(!run.stderr.contains("warning"), "{}", run.stderr);
}

#[test]
fn what_is_no_normal_map_is_refused_before_anything_is_written() {
    let folder = folder_with(&[IMAGE, MODEL]);
    let image = folder.path().join("TwoSidedPlane_Normal.png");
    for (name, content) in
        [("a.png", &b"GIF89a"[..]), ("b.jpg", b"\xff\xd8"), ("c.png", b""), ("d.glb", b"glTF")]
    {
        fs::write(folder.path().join(name), content).expect("a file");
    }
    let before = names_in(folder.path());
    for (name, part) in [
        ("a.png", "not a PNG"),
        ("b.jpg", "only PNG"),
        ("c.png", "not a PNG"),
        ("d.glb", "d.glb"),
        ("e.png", "cannot be read"),
    ] {
        let run = convert(&folder.path().join(name), "opengl", "directx", &[]).exits(1);
        assert!(run.stderr.contains(part), "{}", run.stderr);
    }
    let run = convert(&image, "opengl", "directx", &["-o", text(&folder.path().join("x.glb"))]).exits(1);
    assert!(run.stderr.contains("must end in .png"), "{}", run.stderr);
    let run = convert(&image, "opengl", "directx", &["--layout", "la"]).exits(1);
    assert!(run.stderr.contains("not la"), "{}", run.stderr);
    convert(folder.path(), "opengl", "directx", &[]).exits(2);
    convert(&image, "opengl", "quake", &[]).exits(2);
    convert(&image, "opengl", "directx", &["--layout", "rgbq"]).exits(2);
    darboux(&["convert", text(&image), "--from", "opengl"]).exits(2);
    assert_eq!(names_in(folder.path()), before);
}

#[test]
fn outputs_are_replaced_only_by_force_and_in_place_when_told() {
    let folder = folder_with(&[IMAGE]);
    let image = folder.path().join("TwoSidedPlane_Normal.png");
    let original = fs::read(&image).expect("the image");
    convert(&image, "opengl", "directx", &[]).exits(0);
    let run = convert(&image, "opengl", "directx", &[]).exits(1);
    assert!(run.stderr.contains("exists"), "{}", run.stderr);
    let report = convert(&image, "opengl", "gltf", &["--in-place", "--json"]).exits(0).json();
    assert_eq!(report["files"][0]["status"], "untouched");
    assert!(fs::read(&image).expect("the image") == original);
    let report = convert(&image, "opengl", "directx", &["--in-place", "--json"]).exits(0).json();
    assert_eq!(report["files"][0]["status"], "written");
    assert_eq!(report["files"][0]["image"]["green_inverted"], true);
    let beside = fs::read(folder.path().join("TwoSidedPlane_Normal.directx.png")).expect("the output");
    assert!(fs::read(&image).expect("the image") == beside);
    let piped = darboux_reading(&["convert", "-", "--from", "opengl", "--to", "directx"], &original).exits(0);
    assert!(piped.stdout == beside);
}

#[test]
fn every_field_of_the_report_is_documented() {
    let folder = folder_with(&[IMAGE, MODEL]);
    let documented = fs::read_to_string(asset("../docs/cli.md")).expect("docs/cli.md");
    let section = documented.split("### `darboux convert --json`").nth(1).expect("a section");
    let section = section.split("\n### ").next().expect("its text");
    let inputs = ["TwoSidedPlane_Normal.png", "NormalTangentTest.glb"].map(|name| folder.path().join(name));
    let report = darboux(&[
        "convert",
        text(&inputs[0]),
        text(&inputs[1]),
        "--from",
        "unreal",
        "--to",
        "gltf",
        "--json",
    ]);
    let report = report.json();
    for file in report["files"].as_array().expect("files") {
        for part in ["image", "model"] {
            assert!(section.contains(&format!(".{part}`")));
            let members =
                file[part].as_object().into_iter().flatten().map(|(name, _): (&String, &Value)| name);
            members.for_each(|name| assert!(section.contains(&format!("{name}`")), "{name}"));
        }
    }
}

/// Readers turn v.
#[test]
fn what_a_reader_has_turned_is_not_turned_again_without_a_word() {
    let folder = folder_with(&["blender/scene.ply", "blender/scene.stl"]);
    let warned = |name: &str, from: &str| {
        let output = folder.path().join("out.glb");
        let run = convert(&folder.path().join(name), from, "gltf", &["--force", "-o", text(&output)]);
        run.exits(0).stderr.contains("turns it again")
    };
    assert!(warned("scene.ply", "blender"));
    assert!(!warned("scene.ply", "blender,v0=top"));
    assert!(!warned("scene.stl", "blender"), "it has no UVs");
}
