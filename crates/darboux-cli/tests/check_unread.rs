//! Maps that `darboux check` does not read: the report says which file and why.

mod common;

use common::{darboux, text};

const OBJ: &[u8] =
    b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl wall\nf 1/1 2/2 3/3\n";
const MTL: &[u8] = b"newmtl wall\nnorm wall_n.bmp\n";

/// A normal map that the reader left out is a finding of its material, in the text and in JSON.
#[test]
fn a_map_that_glb_cannot_hold_is_named() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, content) in [("a.obj", OBJ), ("a.mtl", MTL), ("wall_n.bmp", b"BM and so on")] {
        std::fs::write(folder.path().join(name), content).expect("a file");
    }
    let model = folder.path().join("a.obj");
    let report = darboux(&["check", text(&model), "--json"]).exits(0).json();
    let findings = report["files"][0]["findings"].as_array().expect("a list");
    let unread: Vec<_> = findings.iter().filter(|finding| finding["severity"] == "not-checked").collect();
    let [unread] = unread[..] else { panic!("{findings:#?}") };
    assert_eq!((&unread["code"], &unread["material"]), (&"map-unreadable".into(), &0.into()), "{unread}");
    let said = unread["text"].as_str().unwrap_or_default();
    assert!(said.contains("wall_n.bmp was not checked, because it is BMP"), "{said}");
    assert_eq!(report["totals"]["not_checked"], serde_json::json!({"map-unreadable": 1}));
    let printed = darboux(&["check", text(&model)]).exits(0).stdout;
    let printed = String::from_utf8_lossy(&printed);
    assert!(
        printed.lines().any(|line| line.starts_with("  not checked: ") && line.contains("wall_n.bmp")),
        "{printed}"
    );
}

/// A normal map that is not on the disk is named as one of a glTF, and the tangents are those of a surface
/// with a normal map: what is wrong with them is told.
#[test]
fn a_map_that_is_not_there_is_an_error_and_tangents_are_used() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, content) in [("a.obj", OBJ), ("a.mtl", MTL)] {
        std::fs::write(folder.path().join(name), content).expect("a file");
    }
    let model = folder.path().join("a.obj");
    let report = darboux(&["check", text(&model), "--json"]).exits(1).json();
    let findings = report["files"][0]["findings"].as_array().expect("a list");
    let unread: Vec<_> = findings.iter().filter(|finding| finding["code"] == "map-unreadable").collect();
    let [unread] = unread[..] else { panic!("{findings:#?}") };
    assert_eq!((&unread["severity"], &unread["material"]), (&"error".into(), &0.into()), "{unread}");
    assert_eq!(unread["text"], "its file wall_n.bmp is not in the model's folder");
    let cure = unread["cure"].as_str().unwrap_or_default();
    assert!(cure.starts_with("Put the image where the model refers to it"), "{cure}");
    assert!(findings.iter().any(|finding| finding["code"] == "tangent-missing"), "{findings:#?}");
}
