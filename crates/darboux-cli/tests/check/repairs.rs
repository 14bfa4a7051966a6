//! `--fix` on models.

use std::fs;

use crate::codes;
use crate::common::{asset, darboux, glb, glb_json, text};

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

/// Tangents of a known method are left unless their code is named, and the report says the one or the other.
#[test]
fn tangents_of_a_known_method_are_made_again_where_their_code_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let (model, out) = (asset("made/shield.glb"), folder.path().join("out.glb"));
    let code = "tangent-other-recipe";
    let run = |words: &[&str]| {
        let fix = ["check", text(&model), "--fix", "--force", "--fail-on", "never", "-o", text(&out)];
        darboux(&[&fix, words].concat()).exits(0).stderr
    };
    let left = format!("left {code}");
    for words in [&[][..], &["--dry-run"], &["--allow", "map-flat"]] {
        let printed = run(words);
        assert!(printed.contains(&left) && printed.contains(&format!("`--only {code}`")), "{printed}");
    }
    for (words, done) in [(&["--dry-run"][..], "would compute all tangents again"), (&[], "repaired")] {
        let printed = run(&[&["--only", code], words].concat());
        assert!(printed.contains(done) && !printed.contains(&left), "{printed}");
    }
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
    assert!(repair.stderr.contains("0 findings repaired, 1 that --fix leaves"), "{}", repair.stderr);
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
    assert!(again.stderr.contains("0 findings repaired, 1 that --fix leaves"), "{}", again.stderr);
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
