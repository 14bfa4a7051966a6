//! `darboux check`.

mod common;

use std::fs;
use std::path::Path;

use common::{asset, darboux, darboux_reading, folder_with, glb, glb_json, text};
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
    assert_eq!(errors, ["  error       tangent-shared-across-mirror 1"], "{printed}");
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

/// No finding can name what did not come into the document, so a warning does.
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
    let run = common::darboux_with_addresses(512 << 20, &arguments).exits(1);
    let report = run.json();
    let errors: Vec<bool> =
        report["files"].as_array().expect("files").iter().map(|file| file["error"].is_null()).collect();
    assert_eq!(errors, [false, true], "{}", run.stderr);
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

    // Without its model, the map may as well have inverted red.
    let before = fs::read(&down).expect("a file");
    let left = darboux(&["check", text(&down), "--fix", "--in-place"]).exits(1);
    assert!(
        left.stderr.contains("--model") && left.stderr.contains("--assume map=directx"),
        "{}",
        left.stderr
    );
    assert_eq!(fs::read(&down).expect("a file"), before);
    let box_model = asset("made/strips-fans-lines-points.gltf");
    // Its faces do not decide that, and the user does.
    let left = darboux(&["check", text(&down), "--model", text(&box_model), "--fix", "--in-place"]).exits(1);
    assert!(left.stderr.contains("--assume map=directx"), "{}", left.stderr);
    let model = ["--model", text(&box_model), "--assume", "map=directx"];
    let fixed = folder.path().join("fixed.png");
    let arguments = ["check", text(&down), "--fix", "-o", text(&fixed), "--json"];
    let repair = darboux(&[&arguments[..], &model].concat()).exits(0).json();
    assert_eq!(codes(&repair, |finding| finding["repaired"] == true), ["map-green-flipped"]);
    assert_eq!(verdict(&fixed, &[], 0).as_deref(), Some("opengl"));
    darboux(&[&["check", text(&down), "--fix", "--in-place"], &model[..]].concat()).exits(0);
    assert_eq!(fs::read(&down).expect("a file"), fs::read(&fixed).expect("a file"));

    // The plane's signs w are flipped, so that a map with green down looks right on it.
    let plane = asset("TwoSidedPlane/TwoSidedPlane.gltf");
    let arguments = ["check", text(&up), "--model", text(&plane), "--json"];
    let on_model = darboux(&arguments).exits(1).json();
    assert_eq!(codes(&on_model, |finding| finding["severity"] == "error"), ["tangent-sign-flipped"]);
    let down_again = map("down.png", -1.0);
    let arguments = ["check", text(&down_again), "--model", text(&plane)];
    let printed = darboux(&arguments).exits(0);
    assert!(String::from_utf8_lossy(&printed.stdout).contains("two conventions cancel"));
    darboux(&["check", text(&up), "--model", "nothing.glb"]).exits(1);

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

/// The codes of a report's findings that fulfil a condition.
fn codes(report: &serde_json::Value, condition: impl Fn(&serde_json::Value) -> bool) -> Vec<String> {
    let findings = report["files"][0]["findings"].as_array().expect("a list").iter();
    let code = |finding: &serde_json::Value| finding["code"].as_str().unwrap_or_default().to_owned();
    findings.filter(|finding| condition(finding)).map(code).collect()
}

/// A repaired model has nothing left that can be repaired, and a second repair copies it.
#[test]
fn models_are_repaired() {
    let folder = tempfile::tempdir().expect("a folder");
    let models = ["made/shield.glb", "TwoSidedPlane/TwoSidedPlane.gltf", "made/draco.glb"];
    for (number, model) in models.iter().enumerate() {
        let out = folder.path().join(format!("{number}.glb"));
        let input = asset(model);
        let before = darboux(&["check", text(&input), "--json", "--fail-on", "never"]).exits(0).json();
        let fixable = codes(&before, |finding| finding["fixable"] == true);
        let repair = ["check", text(&input), "--fix", "-o", text(&out), "--json"];
        let report = darboux(&repair).exits(0).json();
        assert_eq!(codes(&report, |finding| finding["repaired"] == true), fixable, "{model}");
        let after = darboux(&["check", text(&out), "--json", "--fail-on", "never"]).exits(0).json();
        assert_eq!(codes(&after, |finding| finding["fixable"] == true), Vec::<String>::new(), "{model}");
        let again = folder.path().join(format!("{number}.again.glb"));
        darboux(&["check", text(&out), "--fix", "-o", text(&again)]).exits(0);
        assert_eq!(fs::read(&out).expect("a file"), fs::read(&again).expect("a file"), "{model}");
        let written = fs::metadata(&out).and_then(|metadata| metadata.modified()).expect("a time");
        let report = darboux(&["check", text(&out), "--fix", "--in-place", "--json"]).exits(0).json();
        assert_eq!(report["files"][0]["status"], "untouched", "{model}");
        assert_eq!(fs::metadata(&out).and_then(|metadata| metadata.modified()).expect("a time"), written);
    }
}

/// A compressed model without anything to repair stays compressed.
#[test]
fn healthy_models_are_copied() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out.glb");
    let model = asset("made/draco.glb");
    let repair = ["check", text(&model), "--fix", "-o", text(&out), "--only", "tangent-zero", "--json"];
    let report = darboux(&repair).exits(0).json();
    assert_eq!(report["files"][0]["status"], "copied");
    assert_eq!(fs::read(&model).expect("a file"), fs::read(&out).expect("a file"));
    let folder = asset("made");
    let names = || fs::read_dir(&folder).expect("a folder").count();
    let before = names();
    darboux(&["check", text(&model), "-o", "out.glb"]).exits(2);
    darboux(&["check", text(&model), "--method", "face"]).exits(2);
    assert_eq!(names(), before);
}

/// What cannot be repaired makes the exit code 1, and the reason is printed.
#[test]
fn what_is_left_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let grey = folder.path().join("grey.png");
    let mut encoder = png::Encoder::new(fs::File::create(&grey).expect("a file"), 64, 64);
    encoder.set_color(png::ColorType::Rgb);
    let texels: Vec<u8> = (0..64 * 64u32).flat_map(|i| [(i % 97) as u8; 3]).collect();
    encoder.write_header().and_then(|mut writer| writer.write_image_data(&texels)).expect("a PNG");
    let repair = darboux(&["check", text(&grey), "--fix"]).exits(1);
    assert!(repair.stderr.contains("left map-height"), "{}", repair.stderr);
    assert!(repair.stderr.contains("0 findings repaired, 1 that --fix cannot repair"), "{}", repair.stderr);
    assert!(!folder.path().join("grey.fixed.png").exists());
    let copy = folder.path().join("copy.png");
    darboux(&["check", text(&grey), "--fix", "-o", text(&copy)]).exits(1);
    assert_eq!(fs::read(&copy).expect("a copy"), fs::read(&grey).expect("a file"));
}

/// The last line counts every finding once.
#[test]
fn totals_add_up_to_the_findings() {
    for model in ["made/shield.glb", "TwoSidedPlane/TwoSidedPlane.gltf", "made/strips-fans-lines-points.gltf"]
    {
        let folder = tempfile::tempdir().expect("a folder");
        for only in
            [&[][..], &["--only", "tangent-sign-flipped,tangent-other-recipe,uv-overlapping,uv-mirrored"]]
        {
            let (model, out) = (asset(model), folder.path().join("out.glb"));
            let run =
                [&["check", text(&model), "--fix", "--force", "--fail-on", "never", "-o", text(&out)], only];
            let report = darboux(&[&run.concat()[..], &["--json"]].concat()).exits(0).json();
            let printed = darboux(&run.concat()).exits(0).stderr;
            let total = printed.lines().rfind(|line| line.contains("worth knowing")).expect("a total");
            let words = total.split("worth knowing").next().unwrap_or_default().split_whitespace();
            let sum: usize = words.filter_map(|word| word.parse::<usize>().ok()).sum();
            assert_eq!(sum, codes(&report, |_| true).len(), "{total}");
        }
    }
}

/// A file of an earlier run that differs in the data of an extension alone is not what would be written.
#[test]
fn data_of_extensions_is_compared() {
    let folder = tempfile::tempdir().expect("a folder");
    let shield = fs::read(asset("made/shield.glb")).expect("a model");
    let length = u32::from_le_bytes(shield[12..16].try_into().expect("four bytes")) as usize;
    let mut json = glb_json(&shield);
    let mut binary = shield[28 + length..].to_vec();
    let views = json["bufferViews"].as_array_mut().expect("views");
    views.push(serde_json::json!({"buffer": 0, "byteOffset": binary.len(), "byteLength": 8}));
    json["extensions"] = serde_json::json!({"VENDOR_data": {"bufferView": views.len() - 1}});
    json["extensionsUsed"] = serde_json::json!(["VENDOR_data"]);
    binary.extend(b"ORIGINAL");
    json["buffers"][0]["byteLength"] = binary.len().into();
    let model = folder.path().join("model.glb");
    fs::write(&model, glb(&json, &binary)).expect("a file");
    let run = ["check", text(&model), "--fix", "--fail-on", "never"];
    darboux(&run).exits(0);
    darboux(&run).exits(0);
    let fixed = folder.path().join("model.fixed.glb");
    let mut other = fs::read(&fixed).expect("the repaired file");
    let at = other.windows(8).position(|bytes| bytes == b"ORIGINAL").expect("the data");
    other[at] = b'X';
    fs::write(&fixed, other).expect("a file");
    let refused = darboux(&run).exits(1);
    assert!(refused.stderr.contains("other data would be written"), "{}", refused.stderr);
}

/// A palette is expanded where the map is repaired.
#[test]
fn maps_with_a_palette_are_repaired() {
    let folder = tempfile::tempdir().expect("a folder");
    let image = bumps(-1.0);
    let mut palette: Vec<[u8; 3]> = image.pixels().map(|pixel| pixel.0).collect();
    palette.sort_unstable();
    palette.dedup();
    // The nearest of 256 colours.
    let step = palette.len().div_ceil(256);
    let palette: Vec<[u8; 3]> = palette.into_iter().step_by(step).collect();
    let distance =
        |a: [u8; 3], b: [u8; 3]| (0..3).map(|i| u32::from(a[i].abs_diff(b[i])).pow(2)).sum::<u32>();
    let nearest = |colour: [u8; 3]| {
        (0..palette.len()).min_by_key(|&index| distance(palette[index], colour)).unwrap_or_default() as u8
    };
    let indices: Vec<u8> = image.pixels().map(|pixel| nearest(pixel.0)).collect();
    let path = folder.path().join("down.png");
    let mut encoder =
        png::Encoder::new(fs::File::create(&path).expect("a file"), image.width(), image.height());
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_palette(palette.concat());
    encoder.write_header().and_then(|mut writer| writer.write_image_data(&indices)).expect("a PNG");
    let report =
        darboux(&["check", text(&path), "--assume", "map=directx", "--fix", "--json", "--fail-on", "never"])
            .exits(0)
            .json();
    let repaired = codes(&report, |finding| finding["repaired"] == true);
    assert!(repaired.contains(&"map-green-flipped".to_owned()), "{report}");
    let fixed = image::open(folder.path().join("down.fixed.png")).expect("the repaired map").to_rgb8();
    let expected = indices.iter().map(|&index| palette[usize::from(index)]).map(|[r, g, b]| [r, 255 - g, b]);
    assert!(fixed.pixels().map(|pixel| pixel.0).eq(expected));
}

/// Files in which nothing is repaired are not copied, and a second run over a folder changes nothing and
/// fails on nothing.
#[test]
fn a_folder_can_be_repaired_twice() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    for (model, name) in [("made/shield.glb", "bad.glb"), ("Fox/Fox.glb", "good.glb")] {
        fs::copy(asset(model), path(name)).expect("a copy");
    }
    darboux(&[
        "convert",
        text(&path("bad.glb")),
        "--from",
        "gltf",
        "--to",
        "gltf",
        "-o",
        text(&path("text.gltf")),
    ])
    .exits(0);
    let run = || {
        let run =
            darboux(&["check", text(folder.path()), "--fix", "--no-maps", "--fail-on", "never"]).exits(0);
        let mut files: Vec<_> = fs::read_dir(folder.path()).expect("files").flatten().collect();
        files.sort_by_key(fs::DirEntry::file_name);
        let of = |file: &fs::DirEntry| (file.file_name(), fs::read(file.path()).expect("a file"));
        (run.stderr, files.iter().map(of).collect::<Vec<_>>())
    };
    let (first, files) = run();
    assert!(!path("good.fixed.glb").exists() && path("bad.fixed.glb").exists(), "{first}");
    assert!(path("text.fixed.gltf").exists(), "{first}");
    let (second, again) = run();
    assert!(files == again, "{second}");
    assert_eq!(second.matches("up to date, not written").count(), 2, "{second}");
    // An output of another content is not replaced.
    fs::copy(path("good.glb"), path("bad.fixed.glb")).expect("a copy");
    let third = darboux(&["check", text(&path("bad.glb")), "--fix", "--no-maps"]).exits(1);
    assert!(third.stderr.contains("--force"), "{}", third.stderr);
}

/// A normal map of bumps; `up` is 1 for OpenGL and -1 for DirectX.
fn bumps(up: f32) -> image::RgbImage {
    image::RgbImage::from_fn(128, 128, |x, y| {
        let (x, y) = (x as f32 / 5.0, y as f32 / 5.0);
        let normal = [-x.cos() * y.sin() / 5.0, up * x.sin() * y.cos() / 5.0, 1.0];
        let length = normal.iter().map(|x| x * x).sum::<f32>().sqrt();
        image::Rgb(normal.map(|x| (127.5 + 127.5 * x / length).round() as u8))
    })
}

/// Writes a TGA: rows from top to bottom, blue first.
fn save_tga(path: &Path, image: &image::RgbImage) {
    let [width, height] = [image.width(), image.height()].map(|side| (side as u16).to_le_bytes());
    let header = [&[0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0][..], &width, &height, &[24, 0x20]].concat();
    let texels = image.pixels().flat_map(|&image::Rgb([r, g, b])| [b, g, r]);
    fs::write(path, header.into_iter().chain(texels).collect::<Vec<u8>>()).expect("a file");
}

/// A JPEG and a TGA are repaired into a PNG, a WebP is left, and a healthy image is not written.
#[test]
fn images_that_are_no_png() {
    let folder = tempfile::tempdir().expect("a folder");
    let save = |name: &str, up: f32| {
        let path = folder.path().join(name);
        bumps(up).save(&path).expect("an image");
        path
    };
    let [jpeg, webp] = ["down.jpg", "flipped.webp"].map(|name| save(name, -1.0));
    let tga = folder.path().join("truevision.TGA");
    save_tga(&tga, &bumps(-1.0));
    let strip = asset("made/strips-fans-lines-points.gltf");
    for (path, fixable, code) in [(&jpeg, true, 0), (&webp, false, 1), (&tga, true, 0)] {
        let on_model = ["check", text(path), "--model", text(&strip), "--assume", "map=directx", "--json"];
        let report = darboux(&on_model).exits(1).json();
        let named = |finding: &serde_json::Value| {
            finding["fixable"] == fixable && finding["code"] == "map-green-flipped"
        };
        assert_eq!(codes(&report, named), ["map-green-flipped"], "{report}");
        let report = darboux(&[&on_model[..], &["--fix"]].concat()).exits(code).json();
        assert_eq!(
            codes(&report, |finding| finding["repaired"] == fixable),
            ["map-green-flipped"],
            "{report}"
        );
    }
    for name in ["down.fixed.png", "truevision.fixed.png"] {
        darboux(&["check", text(&folder.path().join(name))]).exits(0);
    }
    let repaired = image::open(folder.path().join("truevision.fixed.png")).expect("a PNG").into_rgb8();
    let inverted = bumps(-1.0).pixels().map(|texel| 255 - texel[1]).collect::<Vec<_>>();
    assert_eq!(repaired.pixels().map(|texel| texel[1]).collect::<Vec<_>>(), inverted);
    let before = fs::read(&jpeg).expect("a file");
    let refused = darboux(&["check", text(&jpeg), "--assume", "map=directx", "--fix", "--in-place"]).exits(1);
    assert!(refused.stderr.contains("use -o FILE.png"), "{}", refused.stderr);
    assert_eq!(fs::read(&jpeg).expect("a file"), before);

    let count = || fs::read_dir(&folder).expect("a folder").count();
    for name in ["up.jpg", "up.webp"] {
        let path = save(name, 1.0);
        let files = count();
        for arguments in [&[][..], &["--in-place"]] {
            let report =
                darboux(&[&["check", text(&path), "--fix", "--json"], arguments].concat()).exits(0).json();
            assert_eq!(report["files"][0]["status"], "untouched", "{name}");
        }
        assert_eq!(count(), files, "{name}");
    }
    fs::write(folder.path().join("up.fixed.png"), "older").expect("a file");
    let warned = darboux(&["check", text(&folder.path().join("up.jpg")), "--fix"]).exits(0);
    assert!(warned.stderr.contains("up.fixed.png exists and was not written"), "{}", warned.stderr);
    let broken = folder.path().join("broken.png");
    fs::write(&broken, "no image").expect("a file");
    let found = |arguments: &[&str]| {
        let report = darboux(&[&["check", text(&broken), "--json"], arguments].concat()).exits(1).json();
        report["files"][0]["findings"][0]["text"].clone()
    };
    assert_eq!(found(&[]), found(&["--fix"]));
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

/// The exit code of a run that resumes another one is that of the whole work.
#[test]
fn findings_that_an_earlier_run_left_count() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    // The UV set of its normal texture is missing, which no repair makes up for.
    let model = folder.path().join("model.gltf");
    let json = fs::read_to_string(asset("Morphing/morphing.gltf")).expect("a model");
    let mut json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    json["materials"] = serde_json::json!([{"normalTexture": {"index": 0, "texCoord": 7}}]);
    json["textures"] = serde_json::json!([{"source": 0}]);
    json["images"] = serde_json::json!([{"uri": "data:image/png;base64,"}]);
    for primitive in json["meshes"][0]["primitives"].as_array_mut().expect("primitives") {
        primitive["material"] = serde_json::json!(0);
    }
    fs::write(&model, json.to_string()).expect("a file");
    for name in fs::read_dir(asset("Morphing")).expect("a folder").filter_map(Result::ok) {
        if name.path().extension().is_some_and(|extension| extension == "bin") {
            fs::copy(name.path(), folder.path().join(name.file_name())).expect("a copy");
        }
    }
    let run = ["check", text(&model), "--fix", "--out-dir", text(&out), "--resume", "--only", "uv-missing"];
    let first = darboux(&run).exits(1);
    assert!(first.stderr.contains("left uv-missing"), "{}", first.stderr);
    let again = darboux(&run).exits(1);
    assert!(again.stderr.contains("up to date, 1 finding left"), "{}", again.stderr);
    assert!(again.stderr.contains("0 findings repaired, 1 that --fix cannot repair"), "{}", again.stderr);
    darboux(&[&run[..], &["--fail-on", "never"]].concat()).exits(0);
}

/// A model that takes its own place is no further file, however its path is written.
#[test]
fn a_replaced_input_is_not_also_written() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("sub")).expect("a folder");
    let model = folder.path().join("shield.glb");
    for path in [model.clone(), folder.path().join("sub/../shield.glb")] {
        fs::copy(asset("made/shield.glb"), &model).expect("a copy");
        let repair = darboux(&["check", text(&path), "--fix", "--in-place"]).exits(0);
        assert!(repair.stderr.contains("repaired"), "{}", repair.stderr);
        assert!(!repair.stderr.contains("also written"), "{}", repair.stderr);
    }
}

/// A line names the repair, and the files that were written beside the output.
#[test]
fn repairs_and_files_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let plane = asset("TwoSidedPlane/TwoSidedPlane.gltf");
    let out = folder.path().join("plane.gltf");
    let repair = darboux(&["check", text(&plane), "--fix", "-o", text(&out)]).exits(0);
    let lines = &repair.stderr;
    assert!(
        lines.contains("repaired tangent-sign-flipped: all signs w are flipped; the signs are negated"),
        "{lines}"
    );
    assert!(lines.contains("also written: ") && lines.contains("plane.bin"), "{lines}");
    let checked = darboux(&["check", text(&out)]).exits(0);
    let checked = String::from_utf8_lossy(&checked.stdout).into_owned();
    assert!(!checked.contains("info") || checked.contains("cure: "), "{checked}");
}

/// An image that was cut off is not judged, whether a row or only the end is missing.
#[test]
fn truncated_images_are_unreadable() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["whole.jpg", "whole.png", "whole.webp"] {
        let whole = folder.path().join(name);
        bumps(1.0).save(&whole).expect("an image");
        darboux(&["check", text(&whole)]).exits(0);
        let bytes = fs::read(&whole).expect("a file");
        let cut = folder.path().join(format!("cut-{name}"));
        for length in [bytes.len() / 4, bytes.len() / 2, bytes.len() * 9 / 10, bytes.len() - 2] {
            fs::write(&cut, &bytes[..length]).expect("a file");
            let report = darboux(&["check", text(&cut), "--json"]).json();
            // The last bytes of a PNG and of a WebP hold no texels.
            if name == "whole.jpg" || length < bytes.len() - 2 {
                assert_eq!(codes(&report, |_| true), ["map-unreadable"], "{name}, {length}: {report}");
            }
        }
    }
    // What follows the end of an image is not part of it.
    let jpeg = folder.path().join("whole.jpg");
    let longer = [fs::read(&jpeg).expect("a file"), b"more".to_vec()].concat();
    fs::write(&jpeg, longer).expect("a file");
    darboux(&["check", text(&jpeg)]).exits(0);
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

/// Images are recognised on standard input, too.
#[test]
fn images_are_read_from_standard_input() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["up.png", "up.jpg", "up.webp"] {
        let path = folder.path().join(name);
        bumps(1.0).save(&path).expect("an image");
        let file = fs::read(&path).expect("a file");
        let report = darboux_reading(&["check", "-", "--json"], &file).exits(0).json();
        assert_eq!(report["files"][0]["map"]["verdict"], "opengl", "{name}");
    }
    let path = folder.path().join("down.png");
    bumps(-1.0).save(&path).expect("an image");
    let file = fs::read(&path).expect("a file");
    let fixed = darboux_reading(&["check", "-", "--assume", "map=directx", "--fix"], &file).exits(0);
    let report = darboux_reading(&["check", "-", "--json"], &fixed.stdout).exits(0).json();
    assert_eq!(report["files"][0]["map"]["verdict"], "opengl");
}

/// Why there is no verdict on a small map.
#[test]
fn small_maps_are_told_why_they_stay_undecided() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("small.png");
    image::imageops::crop_imm(&bumps(1.0), 0, 0, 4, 4).to_image().save(&path).expect("an image");
    let printed = darboux(&["check", text(&path)]).exits(0);
    let printed = String::from_utf8(printed.stdout).expect("text");
    assert!(printed.contains("too few of them"), "{printed}");
}

/// A folder of textures says what to call, and formats without a decoder say what to do.
#[test]
fn folders_of_images_and_other_formats_say_what_to_do() {
    let folder = tempfile::tempdir().expect("a folder");
    let map = folder.path().join("brick_normal.png");
    fs::write(folder.path().join("brick_color.jpg"), b"a picture").expect("a file");
    fs::write(&map, b"a map").expect("a file");
    let run = darboux(&["check", text(folder.path())]).exits(1);
    let advice = format!(
        "it has 2 images (.png, .jpg, .webp, .tga): name those that are normal maps, as in `darboux check {}`",
        text(&map)
    );
    assert!(run.stderr.contains(&advice), "{}", run.stderr);
    for extension in ["BMP", "dds", "exr", "tif"] {
        let image = folder.path().join(format!("map.{extension}"));
        fs::write(&image, b"an image").expect("a file");
        let run = darboux(&["check", text(&image)]).exits(1);
        assert!(run.stderr.contains("save it as .png"), "{}", run.stderr);
    }
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
