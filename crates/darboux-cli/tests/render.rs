//! `darboux render`: what it writes and what it refuses.

mod common;

use std::fs;
use std::path::Path;

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
    draw(&["--view", "angle", "--tangents", "mikktspace", "--against", "lengyel", "--force"]).exits(0);
    assert!(fs::read(&output).expect("a picture") != first);
    assert_eq!(names_in(folder.path()), ["picture.png"]);
}

#[test]
fn the_angle_of_equal_sources_is_least_everywhere() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let (model, output) = (asset(MODEL), folder.path().join("heat.png"));
    // Black behind it, so that edges are darker, never lighter.
    let all = ["--view", "angle", "--tangents", "lengyel", "--size", "80x60", "--background", "000000"];
    let draw = |against: &str| {
        let last = ["--against", against, "--force", "--quiet"];
        darboux(&[&["render", text(&model), "-o", text(&output)], &all[..], &last].concat()).exits(0);
        pixels_of(&output).iter().map(|pixel| pixel[1]).max()
    };
    // Green grows along the scale, from 1.
    assert_eq!(draw("lengyel"), Some(1));
    assert!(draw("mikktspace") > Some(60));
}

/// The colours of a PNG, row after row.
fn pixels_of(path: &Path) -> Vec<[u8; 3]> {
    let file = std::io::BufReader::new(fs::File::open(path).expect("a picture"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
    reader.next_frame(&mut bytes).expect("pixels");
    bytes.as_chunks::<3>().0.to_vec()
}

/// Draws the sample, whose file has one tangent per vertex at a mirrored seam.
fn sample(folder: &Path, size: &str, more: &[&str]) -> Vec<[u8; 3]> {
    let (model, output) = (asset("made/shield.glb"), folder.join("a.png"));
    let all = ["render", text(&model), "-o", text(&output), "--size", size, "--force", "--quiet"];
    darboux(&[&all, more].concat()).exits(0);
    pixels_of(&output)
}

/// How many pixels of some columns differ, in pictures of 240 columns.
fn differing(a: &[[u8; 3]], b: &[[u8; 3]], columns: std::ops::Range<usize>) -> usize {
    let is_in = |at: usize| columns.contains(&(at % 240));
    a.iter().zip(b).enumerate().filter(|(at, (a, b))| is_in(*at) && a != b).count()
}

#[test]
fn a_split_shows_two_sources_and_mistakes_on_the_right() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let draw = |more: &[&str]| {
        sample(folder.path(), "240x180", &[&["--no-legend", "--camera", "0,0"], more].concat())
    };
    let [file, fresh] = ["file", "mikktspace"].map(|source| draw(&["--tangents", source]));
    assert!(differing(&file, &fresh, 0..240) > 50);
    let split = draw(&["--tangents", "file", "--against", "mikktspace", "--split", "50"]);
    assert_eq!((differing(&split, &file, 0..120), differing(&split, &fresh, 120..240)), (0, 0));
    for mistake in ["green", "w", "v"] {
        let wrong = draw(&["--tangents", "mikktspace", "--mistakes", mistake]);
        assert!(differing(&wrong, &fresh, 0..240) > 1000, "{mistake}");
        let beside = draw(&["--tangents", "mikktspace", "--mistakes", mistake, "--split", "25"]);
        assert_eq!((differing(&beside, &fresh, 0..60), differing(&beside, &wrong, 60..240)), (0, 0));
    }
    let of_frames = [
        "columns",
        "sign-noise",
        "no-guard",
        "both-negated",
        "uv-not-inverted",
        "edge-twice",
        "without-w",
        "normal-matrix",
        "race",
        "no-bounds-check",
        "adjacency-offsets",
        "long-normals",
        "one-tangent",
        "last-corner",
    ];
    let mut pictures = vec![fresh.clone()];
    for mistake in of_frames {
        let wrong = draw(&["--tangents", "mikktspace", "--mistakes", mistake]);
        assert!(pictures.iter().all(|other| differing(&wrong, other, 0..240) > 20), "{mistake}");
        pictures.push(wrong);
    }
    let beside = draw(&["--tangents", "mikktspace", "--mistakes", "last-corner", "--split", "25"]);
    let wrong = pictures.last().expect("a picture");
    assert_eq!((differing(&beside, &fresh, 0..60), differing(&beside, wrong, 60..240)), (0, 0));
    let derived = draw(&["--tangents", "derivatives"]);
    assert!(differing(&derived, &fresh, 0..240) > 1000);
}

#[test]
fn lines_seams_and_layouts_are_drawn_over_the_surface() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let draw = |more: &[&str]| {
        sample(folder.path(), "240x180", &[&["--no-legend", "--view", "normal"], more].concat())
    };
    let plain = draw(&[]);
    let counts = [
        &["--lines", "tangent"][..],
        &["--lines", "bitangent,normal"],
        &["--seams", "--tangents", "mikktspace"],
        &["--layout", "corner"],
        &["--layout", "alone"],
    ];
    for more in counts {
        assert!(differing(&draw(more), &plain, 0..240) > 100, "{more:?}");
    }
    let longer =
        ["2", "8"].map(|length| differing(&draw(&["--lines", "normal", "--length", length]), &plain, 0..240));
    assert!(longer[1] > longer[0] + 200, "{longer:?}");
}

#[test]
fn legends_are_below_and_hide_nothing() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let view = ["--view", "angle", "--tangents", "file", "--against", "mikktspace"];
    let with = sample(folder.path(), "480x240", &view);
    let bare = sample(folder.path(), "480x240", &[&view[..], &["--no-legend"]].concat());
    assert_eq!((with.len(), bare.len()), (480 * 240, 480 * 240));
    // The scale's ends, and the red of signs that differ: the last rows have them, and otherwise the
    // background.
    let below = &with[480 * 203..];
    let background = [0xec, 0xef, 0xf1];
    for color in [[68, 1, 84], [253, 231, 37], [230, 40, 40], [0, 0, 0], background] {
        assert!(below.contains(&color), "{color:?}");
    }
    assert!(bare[480 * 203..].iter().filter(|pixel| **pixel == [0, 0, 0]).count() == 0);
    // Too small for it.
    let [small, bare] =
        [&[][..], &["--no-legend"]].map(|more| sample(folder.path(), "100x60", &[&view[..], more].concat()));
    assert!(small == bare);
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
    for none in ["2", "-1", "Sleeve", ""] {
        let refused = draw(&[none]).exits(1).stderr;
        assert!(refused.contains("has no mesh") && refused.contains("sleeve, other"), "{none}: {refused}");
    }
}

/// A PNG of one colour.
fn png_of(color: [u8; 3]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, 4, 4);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().expect("a PNG");
    writer.write_image_data(&color.repeat(16)).expect("pixels");
    drop(writer);
    file
}

const QUAD: &str = "mtllib quad.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n\
usemtl plane\nf 1/1/1 2/2/1 3/3/1 4/4/1\n";

#[test]
fn an_obj_is_drawn_with_its_materials() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    fs::write(at("quad.obj"), QUAD).expect("a file");
    // Leans up the image, towards the light.
    fs::write(at("normal map.png"), png_of([128, 220, 200])).expect("a file");
    fs::write(at("heights.png"), png_of([90; 3])).expect("a file");
    let draw = |library: &str, more: &[&str]| {
        fs::write(at("quad.mtl"), format!("newmtl plane\nKd 0.7 0.7 0.7\n{library}\n")).expect("a file");
        let all = [
            "render",
            text(&at("quad.obj")),
            "-o",
            text(&at("a.png")),
            "--size",
            "32x32",
            "--force",
            "--json",
        ]
        .map(str::to_owned);
        let all: Vec<&str> =
            all.iter().map(String::as_str).chain(["--camera", "0,0"]).chain(more.iter().copied()).collect();
        let report = darboux(&all).exits(0).json();
        let middle = pixels_of(&at("a.png"))[16 * 32 + 16].map(u32::from).iter().sum::<u32>();
        (middle, report["warnings"].to_string())
    };
    let (leaning, warnings) = draw("norm normal map.png", &[]);
    assert_eq!(warnings, "[]");
    for statement in
        ["map_Bump normal map.png", "bump -bm 1 normal map.png", "map_bump heights.png\nnorm normal map.png"]
    {
        assert_eq!(draw(statement, &[]), (leaning, "[]".to_owned()), "{statement}");
    }
    assert!(draw("norm normal map.png", &["--mistakes", "green"]).0 + 60 < leaning);
    let (_, warnings) = draw("map_Bump heights.png", &[]);
    assert!(warnings.contains("the bump map of plane is grey, so it holds heights"), "{warnings}");
    let (_, warnings) = draw("map_Kd lost.png", &[]);
    assert!(
        warnings.contains("lost.png\\\" is not in the model's folder; the texture is left out"),
        "{warnings}"
    );
    // Its tangents are along u, and v is up.
    draw("", &["--view", "tangent", "--no-legend"]);
    assert_eq!(pixels_of(&at("a.png"))[16 * 32 + 16], [255, 128, 128]);
    draw("", &["--view", "bitangent", "--no-legend"]);
    assert_eq!(pixels_of(&at("a.png"))[16 * 32 + 16], [128, 255, 128]);
}

#[test]
fn bad_objs_are_sentences() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let cases = [
        ("", "is empty"),
        ("v 0 0 0\nf 1 2 3\n", "line 2: refers to position 2, but there are 1"),
        ("v 0 0\nf 1 1 1\n", "line 1: is a position with fewer than three numbers"),
        ("v 0 0 0\nf 1 a 1\n", "line 2: has \"a\", which is no corner of a face"),
    ];
    for (file, said) in cases {
        fs::write(at("a.obj"), file).expect("a file");
        let failed = darboux(&["render", text(&at("a.obj")), "-o", text(&at("a.png"))]).exits(1);
        assert!(failed.stderr.contains(said) && failed.stderr.contains("a.obj"), "{file}: {}", failed.stderr);
    }
    let failed = darboux(&["render", text(&at("b.obj")), "-o", text(&at("a.png"))]).exits(1);
    assert!(failed.stderr.contains("b.obj: cannot be read"), "{}", failed.stderr);
    assert_eq!(names_in(folder.path()), ["a.obj"]);
}

#[test]
fn bad_arguments_are_usage() {
    let wrong = [
        (&["--size", "100"][..], "a size of at least 1x1"),
        (&["--size", "0x-1"], "a size of at least 1x1"),
        (&["--size", "0x0"], "a size of at least 1x1"),
        (&["--camera", "30"], "expected two or three numbers"),
        (&["--camera", "30,100"], "-90 to 90"),
        (&["--camera", "30,NaN"], "-90 to 90"),
        (&["--camera", "30,20,0"], "0.01 to 1000"),
        (&["--background", "+12345"], "six hexadecimal digits"),
        (&["--tangents", "best"], "expected file, derivatives or a method"),
        (&["--view", "angle"], "--against"),
        (&["--against", "lengyel"], "--against needs --view angle or --split"),
        (&["--split", "50"], "--split needs --against or --mistakes"),
        (&["--view", "angle", "--against", "lengyel", "--split", "50"], "remove --split"),
        (&["--ground", "--view", "sign"], "--ground stands below a lit model"),
        (&["--ground", "--layout", "alone"], "--ground stands below a lit model"),
        (&["--split", "101"], "expected a number from 0 to 100"),
        (&["--length", "NaN"], "expected a number from 0 to 100"),
        (&["--length", "3"], "--lines <VECTORS>"),
        (&["--lines", "tangent,up"], "possible values"),
        (&["--mistakes", "u"], "possible values"),
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
        ("lost.gltf", "a.png", "nodes[0].mesh: mesh 3 does not exist"),
        ("none.gltf", "a.png", "nodes[0].children[0]: node 7 does not exist"),
        ("NormalTangentTest.glb", "a.jpg", "must end in .png"),
        ("missing.glb", "a.png", "cannot be read"),
    ];
    for (model, output, problem) in cases {
        let failed = darboux(&["render", text(&at(model)), "-o", text(&at(output))]).exits(1);
        assert!(failed.stderr.contains(problem), "{model}: {}", failed.stderr);
    }
    let of_file = ["--tangents", "file"];
    let all = ["render", text(&at("NormalTangentTest.glb")), "-o", text(&at("a.png"))].map(str::to_owned);
    let all: Vec<&str> = all.iter().map(String::as_str).chain(of_file).collect();
    assert!(darboux(&all).exits(1).stderr.contains("has no tangents; choose a method"));
    assert_eq!(names_in(folder.path()), before);
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "drivers are found by environment variables on Linux only")]
fn without_an_adapter_nothing_is_drawn() {
    let folder = tempfile::tempdir().expect("a folder");
    let (model, output) = (asset(MODEL), folder.path().join("a.png"));
    let failed = darboux_without_adapters(&["render", text(&model), "-o", text(&output)]).exits(1);
    assert!(failed.stderr.contains("no graphics adapter was found"), "{}", failed.stderr);
    assert!(names_in(folder.path()).is_empty());
}
