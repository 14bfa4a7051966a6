//! What the command says: for people on standard error, for programs on standard output.

mod common;

use std::fs;
use std::process::{Command, Stdio};

use common::{asset, darboux, folder_with, text};
use darboux_io::LoadOptions;
use darboux_io::gltf::{Document, PrimitiveName};
use serde_json::Value;

const SEAM: &str = "made/skinned-morphed-mirrored.gltf";
const MODES: &str = "made/strips-fans-lines-points.gltf";

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().expect("an object").keys().map(String::as_str).collect()
}

#[test]
fn the_tangents_report_has_the_documented_fields() {
    let folder = folder_with(&[SEAM, MODES]);
    let run = darboux(&["tangents", text(folder.path()), "--json", "--quiet"]).exits(0);
    assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
    let report = run.json();
    assert_eq!(keys(&report), ["command", "version", "files", "totals"]);
    assert_eq!(keys(&report["totals"]), ["files", "written", "copied", "untouched", "up_to_date", "failed"]);
    let file = &report["files"][0];
    assert_eq!(
        keys(file),
        [
            "input",
            "output",
            "status",
            "error",
            "files_written",
            "primitives",
            "warnings",
            "totals",
            "normals",
            "device",
            "source"
        ]
    );
    assert_eq!(
        keys(&file["totals"]),
        ["written", "kept", "skipped", "without_normals", "triangles", "vertices_before", "vertices_after"]
    );
    assert_eq!(keys(&file["device"]), ["kind", "adapter", "corners", "cpu_corners"]);
    let written = &file["primitives"][0];
    let counts = [
        "triangles",
        "degenerate_triangles",
        "uv_degenerate_triangles",
        "non_finite_corners",
        "repaired_corners",
        "mixed_sign_triangles",
        "mirrored_edges",
        "split_vertices",
        "merged_vertices",
    ];
    let mut expected = vec!["mesh", "mesh_name", "primitive", "outcome", "uv_set", "uv_reason", "replaced"];
    expected.extend([
        "sharing_primitives",
        "vertices_before",
        "vertices_after",
        "morph_targets",
        "regrouped_corners",
        "conflicting_corners",
    ]);
    expected.extend(counts);
    assert_eq!(keys(written), expected);
    assert_eq!(written["outcome"], "written");
    assert_eq!(written["mesh_name"], "sleeve");
    assert_eq!(written["mirrored_edges"], 2);
    assert_eq!(written["split_vertices"], 3);
    let skipped = &report["files"][1]["primitives"][3];
    assert_eq!(keys(skipped), ["mesh", "mesh_name", "primitive", "outcome", "reason"]);
    assert_eq!(skipped["outcome"], "skipped");
}

#[test]
fn every_documented_field_is_there_and_every_field_is_documented() {
    let documented = std::fs::read_to_string(asset("../docs/cli.md")).expect("docs/cli.md");
    let folder = folder_with(&[SEAM, MODES]);
    let tangents = darboux(&["tangents", text(folder.path()), "--json", "-q"]).exits(0).json();
    let normals = darboux(&["normals", text(folder.path()), "--json", "-q", "--overwrite"]).exits(0).json();
    let inspected = darboux(&["inspect", text(&asset(SEAM)), "--json"]).exits(0).json();
    let mut waiting = vec![tangents, normals, inspected];
    while let Some(value) = waiting.pop() {
        match value {
            Value::Array(values) => waiting.extend(values),
            Value::Object(members) => {
                for (name, value) in members {
                    let mention = |prefix: &str| documented.contains(&format!("{prefix}{name}`"));
                    assert!(
                        mention("`") || mention(".") || documented.contains(&format!("{name}[]")),
                        "{name}"
                    );
                    waiting.push(value);
                }
            }
            _ => {}
        }
    }
}

#[test]
fn people_read_what_was_done_to_each_primitive() {
    let folder = folder_with(&[MODES]);
    let run = darboux(&["tangents", text(folder.path())]).exits(0);
    assert!(run.stdout.is_empty());
    for part in [
        "strips-fans-lines-points.tangents.gltf",
        "meshes[0].primitives[1]: TEXCOORD_0 (normalTexture of materials[0]), 8 triangles, 10 vertices became 12",
        "meshes[0].primitives[3]: skipped: its mode is LINE_STRIP",
        "3 primitives got tangents, 0 kept, 3 skipped in 1 file",
    ] {
        assert!(run.stderr.contains(part), "{part:?} is not in {}", run.stderr);
    }
}

#[test]
fn a_method_that_breaks_seams_says_how_many() {
    let output = tempfile::tempdir().expect("a temporary folder");
    let output = output.path().join("out.glb");
    let model = asset(SEAM);
    let run = darboux(&["tangents", text(&model), "-o", text(&output), "--method", "lengyel-per-vertex"]);
    assert!(run.stderr.contains(", 3 mirrored seam vertices not split"), "{}", run.stderr);
    assert!(run.stderr.contains("warning: "), "{}", run.stderr);
}

#[test]
fn inspect_shows_a_line_per_primitive() {
    let run = darboux(&["inspect", text(&asset(MODES)), text(&asset("Fox/Fox.glb"))]).exits(0);
    let table = String::from_utf8(run.stdout).expect("UTF-8");
    assert!(run.stderr.is_empty());
    let rows: Vec<Vec<&str>> = table
        .lines()
        .filter(|line| line.starts_with("0."))
        .map(|line| line.split_whitespace().collect())
        .collect();
    assert_eq!(rows.len(), 7);
    assert_eq!(rows[1], ["0.1", "10", "8", "strip", "0", "1", "0", "2", "needed"]);
    assert!(table.contains("\n     \"fox1\" "), "{table}");
    assert!(table.contains("\n     no tangents: it has no NORMAL"), "{table}");
    let widest = table.lines().map(|line| line.chars().count()).max();
    assert!(widest <= Some(80), "{table}");
}

/// Which method and mode made the tangents of a file, and how well they are explained.
#[test]
fn inspect_names_the_method_that_made_the_tangents() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let model = asset("made/shield.glb");
    for (options, line) in [
        (&["--method", "mikktspace"][..], "tangents made by mikktspace, mode repaired: all bits are equal"),
        (&["--method", "area"], "tangents made by area: all bits are equal"),
        (&["--encoding", "snorm8x4"], "tangents made by mikktspace, mode repaired, rounded to 8 bits: "),
    ] {
        let output = folder.path().join("out.glb");
        darboux(
            &[&["tangents", text(&model), "-o", text(&output), "--overwrite", "--force"], options].concat(),
        )
        .exits(0);
        let run = darboux(&["inspect", text(&output)]).exits(0);
        let table = String::from_utf8(run.stdout).expect("UTF-8");
        assert!(table.contains(line), "{table}");
        let report = darboux(&["inspect", text(&output), "--json"]).exits(0).json();
        let made_by = &report["files"][0]["primitives"][0]["made_by"];
        assert_eq!(made_by["method"].as_str(), line.split([' ', ',', ':']).nth(3), "{made_by}");
        assert!(made_by["close"] == made_by["corners"] && made_by["corners"].as_u64() > Some(0), "{made_by}");
    }
    // Flipped signs do not hide it, as in `darboux check`.
    let output = folder.path().join("out.glb");
    let file = fs::read(&output).expect("a model");
    let mut document = Document::from_bytes("out.glb", file, None, &LoadOptions::default()).expect("a model");
    let accessor = document.meshes()[0].primitives[0].attributes["TANGENT"];
    let flip = |&[x, y, z, w]: &[f32; 4]| [x, y, z, -w];
    let flipped: Vec<_> = document.vectors::<4>(accessor).expect("tangents").iter().map(flip).collect();
    let name = PrimitiveName::new(0, &document.meshes()[0], 0);
    document.set_tangents(&[name], &flipped).expect("as many tangents");
    fs::write(&output, document.to_glb().expect("a model")).expect("a file");
    let table = String::from_utf8(darboux(&["inspect", text(&output)]).exits(0).stdout).expect("UTF-8");
    assert!(table.contains("mikktspace, mode repaired, all signs w flipped"), "{table}");
    let report = darboux(&["inspect", text(&asset(SEAM)), "--json"]).exits(0).json();
    assert_eq!(report["files"][0]["primitives"][0]["made_by"], Value::Null);
}

#[test]
fn inspect_reports_the_same_as_json() {
    let report = darboux(&["inspect", text(&asset(SEAM)), "--json"]).exits(0).json();
    assert_eq!(keys(&report), ["command", "version", "files"]);
    assert_eq!(keys(&report["files"][0]), ["input", "error", "warnings", "primitives"]);
    let primitive = &report["files"][0]["primitives"][0];
    assert_eq!(primitive["mode"], "TRIANGLES");
    assert_eq!(primitive["vertices"], 15);
    assert_eq!(primitive["triangles"], 16);
    assert_eq!(primitive["morph_targets"], 2);
    assert_eq!(primitive["has_tangents"], false);
    assert_eq!(primitive["needs_tangents"], true);
    assert_eq!(primitive["mirrored_triangles"], 8);
}

#[test]
fn quiet_inspection_says_what_is_wrong_alone() {
    let run = darboux(&["inspect", text(&asset(SEAM)), "none.glb", "--quiet"]).exits(1);
    assert!(run.stdout.is_empty());
    assert!(run.stderr.starts_with("error: none.glb: ") && run.stderr.lines().count() == 1, "{}", run.stderr);
}

#[test]
fn nothing_is_coloured_in_a_pipe() {
    let run = darboux(&["tangents", "no-such-file.glb"]).exits(1);
    assert!(!run.stderr.contains('\u{1b}'), "{:?}", run.stderr);
}

#[test]
fn a_reader_that_stops_early_is_no_fault() {
    for arguments in [&["inspect", "--json"][..], &["inspect"], &["tangents", "-o", "-"]] {
        let (read_end, write_end) = std::io::pipe().expect("a pipe");
        drop(read_end);
        let output = Command::new(env!("CARGO_BIN_EXE_darboux"))
            .args(arguments)
            .arg(asset(SEAM))
            .stdin(Stdio::null())
            .stdout(write_end)
            .stderr(Stdio::piped())
            .output()
            .expect("the command runs");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {stderr}");
        assert!(!stderr.contains("panicked") && !stderr.contains("error"), "{stderr}");
    }
}

/// The names of outputs in messages, in their order.
fn outputs_in(stderr: &str) -> Vec<&str> {
    stderr.lines().filter_map(|line| line.split_once(" -> ")?.1.split(':').next()).collect()
}

#[test]
fn many_files_get_one_line_each_in_the_order_of_their_names() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let names: Vec<String> = (0..11).map(|number| format!("{number:02}.gltf")).collect();
    for name in &names {
        std::fs::copy(asset(MODES), folder.path().join(name)).expect("a copy");
    }
    let run = |more: &[&str]| {
        darboux(&[&["tangents", text(folder.path()), "--force"], more].concat()).exits(0).stderr
    };
    let brief = run(&["--jobs", "4"]);
    assert_eq!(brief.lines().count(), 12, "{brief}");
    let expected: Vec<String> =
        names.iter().map(|name| text(&folder.path().join(name)).replace(".gltf", ".tangents.gltf")).collect();
    assert_eq!(outputs_in(&brief), expected);
    assert!(
        brief
            .lines()
            .next()
            .is_some_and(|line| line.contains(": 3 primitives got tangents, 0 kept, 3 skipped"))
    );
    let all = run(&["--verbose"]);
    assert!(
        all.contains("meshes[0].primitives[3]: skipped: its mode is LINE_STRIP") && all.lines().count() > 60
    );
    let quiet = run(&["--quiet"]);
    assert!(quiet.starts_with("33 primitives got tangents, 0 kept, 33 skipped in 11 files; "), "{quiet}");
    assert_eq!(quiet.lines().count(), 1);
}

#[test]
#[cfg(unix)]
fn names_from_files_cannot_forge_messages() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| folder.path().join(name);
    std::fs::copy(asset(SEAM), at("a\u{1b}[31m\nerror: b.gltf")).expect("a copy");
    std::fs::write(
        at("mode.gltf"),
        r#"{"asset":{"version":"2.0"},"accessors":[{"type":"\u001b]0;x\u0007\nerror: y"}]}"#,
    )
    .expect("a file");
    let bare = at("-it's $bare.glb");
    std::fs::copy(asset("NormalTangentTest/NormalTangentTest.glb"), &bare).expect("a copy");
    let inspected = darboux(&["inspect", text(folder.path())]).exits(1);
    let forged = at("a\u{1b}[31m\nerror: b.gltf");
    let compared = darboux(&["compare", text(&forged), text(&forged)]).exits(1);
    let refused = darboux(&["tangents", "--mode", "a\u{1b}[31m\nerror: b"]).exits(2);
    let said = [
        String::from_utf8_lossy(&inspected.stdout).into_owned(),
        inspected.stderr,
        compared.stderr,
        refused.stderr,
    ];
    for said in &said {
        assert!(!said.contains(['\u{1b}', '\u{7}']) && !said.contains("\nerror: "), "{said:?}");
    }
    assert!(
        said[0].contains(r"a\u{1b}[31m\nerror: b.gltf") && said[3].contains(r"\u{1b}[31m\nerror: b"),
        "{said:?}"
    );
    let suggested = std::process::Command::new(env!("CARGO_BIN_EXE_darboux"))
        .args(["compare", "--", "-it's $bare.glb", "-it's $bare.glb"])
        .current_dir(folder.path())
        .output()
        .expect("the command runs");
    let suggested = String::from_utf8_lossy(&suggested.stderr).into_owned();
    assert!(suggested.ends_with("to add them: darboux tangents -- '-it'\\''s $bare.glb'\n"), "{suggested}");
}

/// A primitive without splits of its own says why its number of vertices changes.
#[test]
fn vertices_that_primitives_share_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out.glb");
    let model = asset("made/shared-vertices-two-uv-sets.gltf");
    let run = darboux(&["tangents", text(&model), "-o", text(&out)]).exits(0);
    let sharing = "27 vertices shared by 3 primitives became 36";
    assert_eq!(run.stderr.matches(sharing).count(), 3, "{}", run.stderr);
}

#[test]
fn completions_complete_every_subcommand() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = String::from_utf8(darboux(&["completions", shell]).exits(0).stdout).expect("UTF-8");
        for subcommand in
            ["tangents", "normals", "convert", "compare", "inspect", "render", "view", "methods", "devices"]
        {
            assert!(script.contains(subcommand), "{shell}: {subcommand}");
        }
    }
    darboux(&["completions", "tcsh"]).exits(2);
}
