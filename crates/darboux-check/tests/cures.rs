//! The cure of a finding fits what the repair says, and touches what the finding is about.

mod support;

use darboux::{BitangentDirection, Choice};
use darboux_check::{
    AssumedMap, CheckOptions, Code, Finding, FixOptions, Severity, check_document, fix_document,
};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use serde_json::json;
use support::container::{with_json, with_vectors};
use support::maps::Map;
use support::models::{Model, healthy_models};
use support::table::rgb;

fn model(name: &str) -> Model {
    healthy_models().into_iter().find(|model| model.name == name).expect("a healthy model")
}

fn open(glb: Vec<u8>) -> Document {
    Document::from_bytes("model.glb", glb, None, &LoadOptions::default()).expect("a valid GLB")
}

fn check(document: &Document) -> Vec<Finding> {
    check_document(document, &CheckOptions::default()).expect("a valid document")
}

fn find(findings: &[Finding], code: Code) -> &Finding {
    findings.iter().find(|finding| finding.code == code).expect("the finding")
}

/// A model of two parts with the same positions: the normals of the second one are stored as x, -z, y.
fn with_turned_part(healthy: &Model) -> Vec<u8> {
    let normals = healthy.normals.as_ref().expect("normals");
    let turned: Vec<[f32; 3]> = normals.iter().map(|&[x, y, z]| [x, -z, y]).collect();
    let (glb, accessor) = with_vectors(&healthy.glb(), &turned, "VEC3");
    with_json(&glb, |json| {
        let mut part = json["meshes"][0]["primitives"][0].clone();
        part["attributes"]["NORMAL"] = accessor.into();
        json["meshes"][0]["primitives"].as_array_mut().expect("primitives").push(part);
    })
}

/// The normals of a primitive of the first mesh.
fn normals(document: &Document, primitive: usize) -> Vec<[f32; 3]> {
    let accessor = document.meshes()[0].primitives[primitive].attributes["NORMAL"];
    document.vectors::<3>(accessor).expect("normals").into_owned()
}

#[test]
fn normals_in_other_axes_are_turned_back_alone() {
    let mut healthy = model("wavy sphere");
    (healthy.tangents, healthy.has_normal_map) = (None, false);
    let mut document = open(with_turned_part(&healthy));
    let findings = check(&document);
    let turned = find(&findings, Code::NormalOtherAxes);
    assert!(turned.is_fixable() && turned.cure.contains("and no others"), "{turned:?}");
    assert_eq!(turned.place.primitive.as_ref().map(|name| name.primitive), Some(1));
    assert!(!turned.code.looks_like().contains("whole model"), "one part of two");
    let fixed = fix_document(&mut document, findings, &FixOptions::default()).expect("a repair");
    assert!(fixed.is_changed, "{fixed:#?}");
    let wanted = healthy.normals.clone().expect("normals");
    assert_eq!([0, 1].map(|primitive| normals(&document, primitive) == wanted), [true; 2]);
    assert!(check(&document).iter().all(|finding| finding.severity <= Severity::Info));
}

/// What turned the normals may have turned the tangents: both are left, and the cure says what it touches.
#[test]
fn turned_normals_of_models_with_tangents_are_left() {
    let document = open(with_turned_part(&model("wavy sphere")));
    let findings = check(&document);
    let turned = find(&findings, Code::NormalOtherAxes);
    assert!(turned.left_because.is_some() && !turned.cure.contains("--fix"), "{turned:?}");
    assert!(turned.cure.contains("for all parts of the model"), "{}", turned.cure);
}

/// A model with a map in WebP, which is read and never written.
fn with_webp(model: &Model) -> Document {
    let side = model.map.texels.len().isqrt() as u32;
    let mut file = Vec::new();
    let encoder = image_webp::WebPEncoder::new(&mut file);
    encoder
        .encode(model.map.texels.as_flattened(), side, side, image_webp::ColorType::Rgb8)
        .expect("an image");
    let model = Model { map: Map { file, ..model.map.clone() }, ..model.clone() };
    open(with_json(&model.glb(), |json| {
        json["images"][0]["mimeType"] = "image/webp".into();
        json["extensionsUsed"] = json!(["EXT_texture_webp"]);
        json["textures"][0] = json!({"extensions": {"EXT_texture_webp": {"source": 0}}});
    }))
}

#[test]
fn cures_do_not_name_a_repair_that_is_left() {
    let mut inverted = healthy_models().remove(9);
    inverted.map = inverted.map.through(|[r, g, b]| [r, 1.0 - g, b]);
    let mut both = inverted.clone();
    both.negate_signs();
    let mut short = healthy_models().remove(9);
    short.map = short.map.through(|texel| texel.map(|x| 0.5 + 0.6 * (x - 0.5)));
    for (model, code) in
        [(inverted, Code::MapGreenFlipped), (both, Code::ConventionsCancel), (short, Code::MapNotUnit)]
    {
        let findings = check(&with_webp(&model));
        let found = find(&findings, code);
        let reason = found.left_because.as_deref().unwrap_or_default();
        assert!(reason.contains("PNG"), "{code}: {reason}");
        assert!(!found.cure.contains("--fix"), "{code}: {}", found.cure);
        let findings = check(&model.document());
        assert!(find(&findings, code).cure.contains("--fix"), "{code}, as a PNG");
    }
}

/// Exchanged channels of an image within a model, of which one was inverted before or none: one command
/// repairs them, and it fits the convention that is wanted.
#[test]
fn exchanged_channels_within_a_model_are_repaired() {
    use AssumedMap::{BothInverted, DirectX, OpenGl, RedInverted};
    let inverted: [fn([u8; 3]) -> [u8; 3]; 3] =
        [|texel| texel, |[r, g, b]| [r, 255 - g, b], |[r, g, b]| [255 - r, g, b]];
    let [green_up, green_down] = [inverted[0], inverted[1]];
    for (wanted, of_wanted, assumptions) in [
        (BitangentDirection::Up, green_up, [None, Some(DirectX), Some(RedInverted)]),
        (BitangentDirection::Down, green_down, [None, Some(OpenGl), Some(BothInverted)]),
    ] {
        let mut model = healthy_models().remove(9);
        let right: Vec<[u8; 3]> = model.map.texels.iter().copied().map(of_wanted).collect();
        for (inverted, assumed) in inverted.iter().zip(assumptions) {
            let exchanged = right.iter().copied().map(inverted).map(|[r, g, b]| [g, r, b]);
            model.map = model.map.with_texels(exchanged.collect());
            let mut document = model.document();
            let options = CheckOptions::default().with_green(wanted);
            let findings = check_document(&document, &options).expect("a valid document");
            let found = find(&findings, Code::MapChannelsSwapped);
            let said = format!("{} {}", found.cure, found.left_because.as_deref().unwrap_or_default());
            let command = assumed.map_or("`darboux check FILE --fix`".to_owned(), |assumed| {
                format!("`--assume map={}`", assumed.name())
            });
            assert!(said.contains(&command), "{wanted:?}, {assumed:?}: {said}");
            assert_eq!(found.is_fixable(), assumed.is_none(), "{wanted:?}: {said}");
            let options = FixOptions::default().with_check(options.with_assumed_map(assumed));
            let findings = check_document(&document, &options.check).expect("a valid document");
            let fixed = fix_document(&mut document, findings, &options).expect("a repair");
            assert!(fixed.is_changed, "{fixed:#?}");
            let texels = rgb(&document.image_bytes(0).expect("an image"));
            assert_eq!(texels, right, "{wanted:?}, {assumed:?}");
        }
    }
}

/// A file that Git LFS has not fetched is no damaged image.
#[test]
fn pointers_of_git_lfs_say_how_to_fetch_the_image() {
    let mut model = healthy_models().remove(9);
    model.map.file = b"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 1\n".to_vec();
    let findings = check(&model.document());
    let found = find(&findings, Code::MapUnreadable);
    assert!(
        found.text.contains("is a pointer of Git LFS") && found.cure.contains("`git lfs pull`"),
        "{found:?}"
    );
}

/// Evidence of a probability is rounded down, as sentences are: nothing is 100 % sure.
#[test]
fn confidence_has_one_decimal() {
    let mut model = healthy_models().remove(9);
    model.map = model.map.through(|[r, g, b]| [r, 1.0 - g, b]);
    let findings = check(&model.document());
    let found = find(&findings, Code::MapGreenFlipped);
    let value =
        found.evidence.iter().find(|evidence| evidence.what.starts_with("confidence")).expect("it").value;
    assert!(value < 100.0 && (10.0 * value - (10.0 * value).round()).abs() < 1e-9, "{value}");
}
