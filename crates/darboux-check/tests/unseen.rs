//! What nothing shows is no error, and what stands beside a model makes its mistakes no smaller.

mod support;

use darboux_check::{CheckOptions, Code, Finding, Severity, check_document};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use serde_json::{Value, json};
use support::container::with_json;
use support::models::{Model, healthy_models};

/// A model with one node, whose signs are flipped.
fn flipped_model() -> Model {
    let mut models = healthy_models().into_iter();
    let mut model = models
        .find(|model| model.name.contains("wavy") && !model.is_skinned && model.copies == 1)
        .expect("a model");
    model.negate_signs();
    model
}

/// The same with a broken map.
fn wrong_model() -> Model {
    let mut model = flipped_model();
    model.map.file.truncate(200);
    model
}

fn findings(glb: &[u8], edit: impl FnOnce(&mut Value)) -> Vec<Finding> {
    let glb = with_json(glb, edit);
    let document = Document::from_bytes("m.glb", glb, None, &LoadOptions::default()).expect("a model");
    check_document(&document, &CheckOptions::default()).expect("a valid document")
}

fn severity(findings: &[Finding], code: Code) -> Option<Severity> {
    findings.iter().filter(|finding| finding.code == code).map(|finding| finding.severity).max()
}

#[test]
fn what_no_material_shows_is_worth_knowing_only() {
    let glb = wrong_model().glb();
    let all = findings(&glb, |_| {});
    assert_eq!(severity(&all, Code::MapUnreadable), Some(Severity::Error), "{all:#?}");
    type Edit = fn(&mut Value);
    let edits: [(&str, Edit); 4] = [
        ("scale 0", |json| json["materials"][0]["normalTexture"]["scale"] = json!(0)),
        ("unlit", |json| json["materials"][0]["extensions"] = json!({"KHR_materials_unlit": {}})),
        ("no primitive", |json| {
            json["meshes"][0]["primitives"][0].as_object_mut().expect("a primitive").remove("material");
        }),
        ("not in the scene", |json| {
            let other = json["meshes"][0].clone();
            json["meshes"].as_array_mut().expect("meshes").push(other);
            json["meshes"][1]["primitives"][0].as_object_mut().expect("a primitive").remove("material");
            json["nodes"] = json!([{"mesh": 1}]);
        }),
    ];
    for (name, edit) in edits {
        let all = findings(&glb, edit);
        let wrong = all.iter().filter(|finding| {
            !matches!(finding.code, Code::MapScaleZero) && finding.severity > Severity::Info
        });
        assert_eq!(wrong.count(), 0, "{name}: {all:#?}");
        assert_eq!(severity(&all, Code::MapUnreadable), Some(Severity::Info), "{name}: {all:#?}");
    }
    // A second material shows it.
    let all = findings(&glb, |json| {
        let mut unlit = json["materials"][0].clone();
        unlit["extensions"] = json!({"KHR_materials_unlit": {}});
        json["materials"].as_array_mut().expect("materials").push(unlit);
        let mut other = json["meshes"][0]["primitives"][0].clone();
        other["material"] = json!(1);
        json["meshes"][0]["primitives"].as_array_mut().expect("primitives").push(other);
    });
    assert_eq!(severity(&all, Code::MapUnreadable), Some(Severity::Error), "{all:#?}");
}

/// A large ground without a normal map.
#[test]
fn a_plain_ground_makes_flipped_signs_no_smaller() {
    let glb = flipped_model().glb();
    let alone = findings(&glb, |_| {});
    assert_eq!(severity(&alone, Code::TangentSignFlipped), Some(Severity::Error), "{alone:#?}");
    let beside = findings(&glb, |json| {
        let mut ground = json["meshes"][0].clone();
        ground["primitives"][0].as_object_mut().expect("a primitive").remove("material");
        json["meshes"].as_array_mut().expect("meshes").push(ground);
        let nodes = json["nodes"].as_array_mut().expect("nodes");
        nodes.push(json!({"mesh": 1, "scale": [1000, 1000, 1000]}));
    });
    assert_eq!(severity(&beside, Code::TangentSignFlipped), Some(Severity::Error), "{beside:#?}");
}
