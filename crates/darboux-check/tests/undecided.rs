//! What a map that nobody can judge means for the tangents: a repair of one half of what may be a pair could
//! make a right picture wrong.

mod support;

use std::collections::BTreeSet;

use darboux::Method;
use darboux_check::{
    AssumedMap, CheckOptions, Code, Finding, FixOptions, ReportedFinding, Severity, check_document,
    check_map_on_model, check_model_of_maps, diagnosis, fix_document,
};
use darboux_io::gltf::Document;
use darboux_io::{LoadOptions, MemoryLimit};
use serde_json::{Value, json};
use support::container::{with_json, with_vectors};
use support::mistakes::{MISTAKES, Mistake};
use support::models::{Model, healthy_models};

const AVIF: &[u8] = b"\0\0\0\x20ftypavif and more";

fn check(model: &Model) -> Vec<Finding> {
    check_document(&model.document(), &CheckOptions::default()).expect("a valid document")
}

/// The tangents of the first primitive.
fn tangents(document: &Document) -> Vec<[f32; 4]> {
    let accessor = document.meshes()[0].primitives[0].attributes["TANGENT"];
    document.vectors::<4>(accessor).expect("tangents").into_owned()
}

/// Flipped signs on a flat field of noise, an image in a format that is not read, and a broken one.
#[test]
fn flipped_signs_under_a_map_of_unknown_convention_are_left() {
    let mut model = healthy_models().remove(3);
    model.negate_signs();
    let noise = |i: usize| {
        let hash = (i as u32).wrapping_mul(2_654_435_769).wrapping_mul(0x85EB_CA6B) ^ (i as u32 >> 3);
        [120 + (hash >> 20 & 15) as u8, 120 + (hash >> 26 & 15) as u8, 254]
    };
    let noise = model.map.with_texels((0..model.map.texels.len()).map(noise).collect());
    for file in [noise.file, AVIF.to_vec(), b"no image".to_vec()] {
        model.map.file = file;
        let findings = check(&model);
        let flipped =
            findings.iter().find(|finding| finding.code == Code::TangentSignFlipped).expect("the finding");
        assert_eq!((flipped.severity, flipped.is_fixable()), (Severity::Warning, false), "{flipped:?}");
        let reason = flipped.left_because.as_deref().unwrap_or_default();
        assert!(reason.contains("images[0]") && reason.contains("--assume map=opengl"), "{reason}");
        let mut document = model.document();
        let fixed = fix_document(&mut document, findings, &FixOptions::default()).expect("a repair");
        assert!(!fixed.is_changed && !document.is_changed(), "{fixed:?}");
        // The user says that green is inverted, which nothing can repair: the two cancel.
        let inverted = CheckOptions::default().with_assumed_map(Some(AssumedMap::DirectX));
        let findings = check_document(&document, &inverted).expect("a valid document");
        let flipped = findings.iter().find(|finding| finding.code == Code::TangentSignFlipped);
        let reason = flipped.and_then(|flipped| flipped.left_because.as_deref()).unwrap_or_default();
        assert!(reason.contains("as was assumed") && !reason.contains("--assume"), "{reason}");
        // The user says that they are right.
        let assumed = CheckOptions::default().with_assumed_map(Some(AssumedMap::OpenGl));
        let options = FixOptions::default().with_check(assumed);
        let findings = check_document(&document, &options.check).expect("a valid document");
        let fixed = fix_document(&mut document, findings, &options).expect("a repair");
        let flipped = fixed.findings.iter().find(|fixed| fixed.finding.code == Code::TangentSignFlipped);
        assert!(flipped.is_some_and(|flipped| flipped.repaired), "{fixed:?}");
    }
}

/// Flipped signs that are left stay when another mistake makes all tangents be computed again.
#[test]
fn flipped_signs_that_are_left_survive_the_repair_of_other_mistakes() {
    for healthy in healthy_models().into_iter().filter(|model| model.name.contains("wavy")) {
        let mut model = healthy.clone();
        model.map.file = b"no image".to_vec();
        let is_rotated = |mistake: &&Mistake| mistake.code == Code::TangentRotated;
        let rotated = MISTAKES.iter().find(is_rotated).expect("the mistake");
        assert!((rotated.make)(&mut model));
        model.negate_signs();
        let findings = check(&model);
        let mut document = model.document();
        let fixed = fix_document(&mut document, findings, &FixOptions::default()).expect("a repair");
        assert!(fixed.is_changed, "{}: {fixed:#?}", model.name);
        let left = check_document(&document, &CheckOptions::default()).expect("a valid document");
        let is_flipped =
            |finding: &Finding| finding.code == Code::TangentSignFlipped && !finding.is_fixable();
        assert!(left.iter().any(is_flipped), "{}: {left:#?}", model.name);
        assert!(left.iter().all(|finding| finding.code != Code::TangentRotated), "{}: {left:#?}", model.name);
    }
}

#[test]
fn a_map_in_a_format_that_is_not_read_is_not_checked_and_no_error() {
    let mut model = healthy_models().remove(0);
    model.map.file = AVIF.to_vec();
    let findings = check(&model);
    let map = findings.iter().find(|finding| finding.code == Code::MapUnreadable).expect("the finding");
    assert_eq!(map.severity, Severity::NotChecked, "{}", map.text);
    assert!(map.severity < Severity::Info && map.text.contains("not checked"), "{}", map.text);
    assert!(findings.iter().all(|finding| finding.severity <= Severity::Info), "{findings:#?}");
    model.map.file = b"no image".to_vec();
    let broken = check(&model).into_iter().find(|finding| finding.code == Code::MapUnreadable);
    assert_eq!(broken.map(|finding| finding.severity), Some(Severity::Error));
}

/// Where MikkTSpace itself gives a triangle both signs, flipping all of them adds no other mistake: it would
/// keep the tangents from being repaired where the signs are left.
#[test]
fn triangles_with_both_signs_of_mikktspace_may_be_flipped() {
    for mut model in healthy_models() {
        // Two of a hundred faces lose their UV area, and take tangents from their neighbours.
        let vertices = model.indices.as_chunks::<3>().0.iter().skip(7).step_by(50);
        let collapsed: Vec<[u32; 3]> = vertices.copied().collect();
        for uvs in &mut model.uvs {
            for [a, b, c] in &collapsed {
                uvs[*b as usize] = uvs[*a as usize];
                uvs[*c as usize] = uvs[*a as usize];
            }
        }
        let set = model.uv_set;
        let computed = model.computed(Method::default(), set);
        model.tangents().copy_from_slice(&computed);
        let codes = |model: &Model| {
            let findings = check(model).into_iter();
            findings.filter(|finding| finding.code == Code::TangentSignMixed).count()
        };
        let before = codes(&model);
        model.negate_signs();
        assert_eq!(codes(&model), before, "{}", model.name);
    }
}

/// A GLB with another first image, in as many bytes as the one that it has.
fn with_image(glb: &[u8], image: &str) -> Vec<u8> {
    let start = glb.windows(10).position(|bytes| bytes == b"\"images\":[").expect("images") + 10;
    let length = glb[start..].iter().position(|&byte| byte == b']').expect("an end");
    let mut glb = glb.to_vec();
    glb[start..start + length].copy_from_slice(format!("{image:length$}").as_bytes());
    glb
}

#[test]
fn an_image_elsewhere_is_not_checked_and_one_that_is_absent_is_an_error() {
    let glb = healthy_models().remove(0).glb();
    for (uri, severity, cure) in [
        ("https://a.b/c.png", Severity::NotChecked, "None needed"),
        ("absent.png", Severity::Error, "Put the image where the model refers to it"),
    ] {
        let file = with_image(&glb, &format!("{{\"uri\":\"{uri}\"}}"));
        let document = Document::from_bytes("m.glb", file, None, &LoadOptions::default()).expect("a model");
        let findings = check_document(&document, &CheckOptions::default()).expect("a valid document");
        let map = findings.iter().find(|finding| finding.code == Code::MapUnreadable).expect("the finding");
        assert_eq!(map.severity, severity, "{}", map.text);
        assert!(map.cure.starts_with(cure) && map.evidence.is_empty(), "{map:?}");
        if severity == Severity::NotChecked {
            let reported: Vec<ReportedFinding> = findings.iter().cloned().map(Into::into).collect();
            let sentence = diagnosis(&reported, &CheckOptions::default());
            assert!(sentence.ends_with("1 normal map was not checked; its finding says why."), "{sentence}");
        }
        let others = findings.iter().filter(|finding| finding.code != Code::MapUnreadable);
        assert!(others.clone().all(|finding| finding.severity <= Severity::Info), "{findings:#?}");
    }
}

/// An image that is larger than the memory limit is not read, and no error of the model.
#[test]
fn an_image_beyond_the_memory_limit_is_not_checked() {
    let folder = tempfile::tempdir().expect("a folder");
    let image = folder.path().join("large.png");
    std::fs::File::create(&image).and_then(|file| file.set_len(1 << 30)).expect("a file");
    let path = folder.path().join("m.glb");
    let file = with_image(&healthy_models().remove(0).glb(), "{\"uri\":\"large.png\"}");
    std::fs::write(&path, file).expect("a file");
    let limit = MemoryLimit::bytes(64 << 20);
    let document = Document::open(&path, &LoadOptions::default().with_memory_limit(limit)).expect("a model");
    let options = CheckOptions::default().with_memory_limit(limit);
    let findings = check_document(&document, &options).expect("a valid document");
    let map = findings.iter().find(|finding| finding.code == Code::MapUnreadable).expect("the finding");
    assert_eq!(map.severity, Severity::NotChecked, "{}", map.text);
    assert!(map.text.contains("is so large that it needs"), "{}", map.text);
}

/// Two mistakes that cancel on the whole model make no picture wrong: one warning says so.
#[test]
fn mistakes_that_cancel_are_one_warning() {
    let mut model = healthy_models().remove(9);
    model.map = model.map.through(|[r, g, b]| [r, 1.0 - g, b]);
    model.negate_signs();
    let findings = check(&model);
    let severe: Vec<&Finding> = findings.iter().filter(|finding| finding.severity > Severity::Info).collect();
    let codes: Vec<(Code, Severity)> =
        severe.iter().map(|finding| (finding.code, finding.severity)).collect();
    assert_eq!(codes, [(Code::ConventionsCancel, Severity::Warning)], "{findings:#?}");
    assert!(
        severe[0].text.contains("two conventions cancel") && severe[0].is_fixable(),
        "{}",
        severe[0].text
    );
    // Without the texels, one of the two cannot be seen, and the other one is left.
    let mut unread = model.clone();
    unread.map.file = AVIF.to_vec();
    let assumed = CheckOptions::default().with_assumed_map(Some(AssumedMap::DirectX));
    let findings = check_document(&unread.document(), &assumed).expect("a valid document");
    assert!(findings.iter().all(|finding| !finding.is_fixable()), "{findings:#?}");
    // Both are repaired together.
    let (mut document, options) = (model.document(), FixOptions::default());
    let findings = check_document(&document, &options.check).expect("a valid document");
    let fixed = fix_document(&mut document, findings, &options).expect("a repair").findings;
    let [joint] = fixed.iter().filter(|fixed| fixed.repaired).collect::<Vec<_>>()[..] else {
        panic!("{fixed:#?}");
    };
    assert_eq!(joint.finding.code, Code::ConventionsCancel);
    let left = check_document(&document, &options.check).expect("a valid document");
    assert!(left.iter().all(|finding| finding.severity <= Severity::Info), "{left:#?}");
}

/// DDS files, and formats that nobody knows here, hide the convention of a map like an image that is not
/// read.
#[test]
fn flipped_signs_under_a_map_without_a_known_image_are_left() {
    let mut model = healthy_models().remove(9);
    model.negate_signs();
    for (texture, code) in [
        (json!({"extensions": {"MSFT_texture_dds": {"source": 0}}}), "images[0]"),
        (json!({"extensions": {"XYZ_texture": {"source": 0}}}), "materials[0]"),
    ] {
        model.map.file = b"DDS and more".to_vec();
        let glb = with_json(&model.glb(), |json| json["textures"][0] = texture.clone());
        let read = || Document::from_bytes("m.glb", glb.clone(), None, &LoadOptions::default());
        let mut document = read().expect("a model");
        let findings = check_document(&document, &CheckOptions::default()).expect("a valid document");
        let unread = findings.iter().find(|finding| finding.code == Code::MapUnreadable).expect("a finding");
        assert_eq!(unread.severity, Severity::NotChecked);
        assert!(unread.place.to_string().contains(code), "{unread:#?}");
        let flipped = findings.iter().find(|finding| finding.code == Code::TangentSignFlipped);
        let flipped = flipped.expect("the finding");
        assert!(!flipped.is_fixable() && flipped.severity == Severity::Warning, "{flipped:#?}");
        let fixed = fix_document(&mut document, findings, &FixOptions::default()).expect("a repair");
        assert!(!fixed.is_changed);
        // Who knows that the map is right says so.
        let right = CheckOptions::default().with_assumed_map(Some(AssumedMap::OpenGl));
        let mut document = read().expect("a model");
        let findings = check_document(&document, &right).expect("a valid document");
        let options = FixOptions::default().with_check(right);
        assert!(fix_document(&mut document, findings, &options).expect("a repair").is_changed);
    }
}

/// Two parts, one with flipped and one with right signs, whose materials have one texture of an unknown
/// format, or two.
fn flipped_and_right_parts(second_material: Option<usize>) -> Document {
    let mut model = healthy_models().remove(9);
    let right = model.tangents().to_vec();
    model.negate_signs();
    let (glb, accessor) = with_vectors(&model.glb(), &right, "VEC4");
    let glb = with_json(&glb, |json| {
        json["textures"] = json!([{"extensions": {"XYZ_texture": {}}}, {"extensions": {"XYZ_texture": {}}}]);
        let mut other = json["meshes"][0]["primitives"][0].clone();
        other["attributes"]["TANGENT"] = accessor.into();
        if let Some(texture) = second_material {
            let mut material = json["materials"][0].clone();
            material["normalTexture"]["index"] = texture.into();
            json["materials"].as_array_mut().expect("materials").push(material);
            other["material"] = 1.into();
        }
        json["meshes"][0]["primitives"].as_array_mut().expect("primitives").push(other);
    });
    Document::from_bytes("m.glb", glb, None, &LoadOptions::default()).expect("a model")
}

/// Where one map is on a part with flipped signs and on one with right ones, one of them looks wrong whatever
/// the map's convention is.
#[test]
fn right_signs_beside_flipped_ones_under_one_map_are_an_error() {
    for (second_material, severity) in
        [(None, Severity::Error), (Some(0), Severity::Error), (Some(1), Severity::Warning)]
    {
        let document = flipped_and_right_parts(second_material);
        let findings = check_document(&document, &CheckOptions::default()).expect("a valid document");
        let flipped = findings.iter().find(|finding| finding.code == Code::TangentSignFlipped);
        let flipped = flipped.expect("the finding");
        assert_eq!((flipped.severity, flipped.is_fixable()), (severity, false), "{second_material:?}");
    }
}

/// A model whose signs are flipped on all triangles but the first part of them.
fn flipped_but_one_in(parts: usize) -> Model {
    let mut model = healthy_models().remove(9);
    let kept: BTreeSet<u32> = model.indices.iter().take(model.indices.len() / parts).copied().collect();
    let flipped = (0u32..).zip(model.tangents().iter_mut()).filter(|(vertex, _)| !kept.contains(vertex));
    flipped.for_each(|(_, tangent)| tangent[3] *= -1.0);
    model
}

/// Where the signs of most triangles are flipped, a map of the other convention makes most of the picture
/// right. A part of it is wrong either way, which is an error.
#[test]
fn signs_of_most_triangles_that_a_map_may_cancel_are_left() {
    let most = flipped_but_one_in(5);
    let mut unread = most.clone();
    unread.map.file = AVIF.to_vec();
    for (model, is_left) in [(&most, false), (&unread, true)] {
        let findings = check(model);
        let partly = findings.iter().find(|finding| finding.code == Code::TangentSignPartlyFlipped);
        let partly = partly.expect("the finding");
        assert_eq!((partly.severity, partly.is_fixable()), (Severity::Error, !is_left), "{partly:?}");
        let mut document = model.document();
        fix_document(&mut document, findings, &FixOptions::default()).expect("a repair");
        let left = check_document(&document, &CheckOptions::default()).expect("a valid document");
        let is_flipped = |finding: &Finding| {
            matches!(finding.code, Code::TangentSignPartlyFlipped | Code::TangentSignFlipped)
        };
        assert_eq!(left.iter().any(is_flipped), is_left, "{left:#?}");
    }
}

/// So does a map that is read: the two are one finding, and are repaired together.
#[test]
fn signs_of_nearly_all_triangles_may_cancel() {
    let mut model = flipped_but_one_in(10);
    model.map = model.map.through(|[r, g, b]| [r, 1.0 - g, b]);
    let findings = check(&model);
    let (joint, others): (Vec<&Finding>, Vec<&Finding>) =
        findings.iter().partition(|finding| finding.code == Code::ConventionsCancel);
    assert!(others.iter().all(|finding| finding.severity < Severity::Error), "{findings:#?}");
    let [joint] = joint[..] else { panic!("{findings:#?}") };
    // On a tenth of the model nothing cancels the map.
    assert!(joint.severity == Severity::Error && joint.is_fixable());
    assert!(joint.text.contains("of nearly all of the area of"), "{joint:#?}");
    let is_half = |code: Code| matches!(code, Code::MapGreenFlipped | Code::TangentSignPartlyFlipped);
    assert!(!findings.iter().any(|finding| is_half(finding.code)), "{findings:#?}");
    let mut document = model.document();
    let fixed = fix_document(&mut document, findings.clone(), &FixOptions::default()).expect("a repair");
    assert!(fixed.findings.iter().filter(|fixed| fixed.finding.is_fixable()).all(|fixed| fixed.repaired));
    let left = check_document(&document, &CheckOptions::default()).expect("a valid document");
    assert!(left.iter().all(|finding| finding.severity <= Severity::Info), "{left:#?}");
    // One half alone is left.
    let (mut document, code) = (model.document(), Code::TangentSignPartlyFlipped);
    let options = FixOptions::default().with_codes([code]);
    let fixed = fix_document(&mut document, findings, &options).expect("a repair");
    assert!(!fixed.is_changed, "{fixed:#?}");
}

/// What other files of the program that made this one are like is told, and decides nothing.
#[test]
fn maps_of_models_from_sketchfab_are_said_to_cancel_mostly() {
    let mut model = healthy_models().remove(9);
    model.map.file = AVIF.to_vec();
    model.negate_signs();
    let reason = |asset: Value| {
        let glb = with_json(&model.glb(), |json| json["asset"] = asset.clone());
        let document = Document::from_bytes("m.glb", glb, None, &LoadOptions::default()).expect("a model");
        let findings = check_document(&document, &CheckOptions::default()).expect("a valid document");
        // The same map on the model, from a file of its own.
        let on_model = check_model_of_maps(&document).expect("a valid document");
        let on_model = check_map_on_model(AVIF, &on_model, &CheckOptions::default()).findings;
        // The repair of an image changes no model.
        assert!(on_model.iter().all(|finding| !finding.is_fixable()), "{on_model:#?}");
        [findings, on_model].map(|findings| {
            let flipped = findings.iter().find(|finding| finding.code == Code::TangentSignFlipped);
            flipped.and_then(|flipped| flipped.left_because.clone()).expect("a reason")
        })
    };
    let source = json!({"source": "https://sketchfab.com/3d-models/crate-1"});
    for (asset, is_told) in [
        (json!({"version": "2.0", "generator": "Sketchfab-12.68.0"}), true),
        (json!({"version": "2.0", "generator": "glTF-Transform v2.0.4", "extras": source}), true),
        (json!({"version": "2.0", "generator": "Khronos glTF Blender I/O v1.8.19"}), false),
    ] {
        for reason in reason(asset) {
            assert_eq!(reason.contains("20 of 24 maps of other models from Sketchfab"), is_told, "{reason}");
        }
    }
}

/// The method of the program that flipped the signs belongs to the same finding. Where nothing cancels, it is
/// a warning of its own.
#[test]
fn the_method_of_tangents_that_a_map_cancels_is_no_further_warning() {
    let healthy = healthy_models().remove(9);
    let by_area = healthy.computed(Method::Area, healthy.uv_set);
    for cancels in [true, false] {
        let mut model = healthy.clone();
        model.tangents().copy_from_slice(&by_area);
        if cancels {
            model.map = model.map.through(|[r, g, b]| [r, 1.0 - g, b]);
            model.negate_signs();
        }
        let findings = check(&model);
        let recipe = findings.iter().find(|finding| finding.code == Code::TangentOtherRecipe);
        let recipe = recipe.expect("the method");
        let expected = if cancels { Severity::Info } else { Severity::Warning };
        assert_eq!((recipe.severity, recipe.is_fixable()), (expected, false), "{findings:#?}");
        let severe: Vec<&Finding> =
            findings.iter().filter(|finding| finding.severity > Severity::Info).collect();
        assert_eq!(severe.len(), 1, "{findings:#?}");
        let names_method =
            severe[0].text.contains("by a program that computes tangents by averages weighted by area");
        assert_eq!(names_method, cancels, "{}", severe[0].text);
        // The pair is repaired, and the tangents are made again only where the user names their code.
        let repair = |document: &mut Document, options: &FixOptions| {
            let findings = check_document(document, &options.check).expect("a valid document");
            let fixed = fix_document(document, findings, options).expect("a repair");
            (fixed, check_document(document, &options.check).expect("a valid document"))
        };
        let (mut document, options) = (model.document(), FixOptions::default());
        let (fixed, left) = repair(&mut document, &options);
        // Once nothing cancels, the repair calls it what the next check does.
        let recipe = fixed.findings.iter().find(|fixed| fixed.finding.code == Code::TangentOtherRecipe);
        assert!(recipe.is_some_and(|left| left.finding.severity == Severity::Warning), "{fixed:#?}");
        let severe: Vec<&Finding> = left.iter().filter(|finding| finding.severity > Severity::Info).collect();
        assert!(severe.len() == 1 && severe[0].code == Code::TangentOtherRecipe, "{left:#?}");
        assert_eq!(tangents(&document), by_area);
        let (_, left) = repair(&mut document, &options.with_codes([Code::TangentOtherRecipe]));
        assert!(left.iter().all(|finding| finding.severity <= Severity::Info), "{left:#?}");
        assert_eq!(tangents(&document), healthy.tangents.clone().expect("tangents"));
    }
}

/// Inverted red and inverted green of a map that was not baked for the mesh look alike. Inverting the wrong
/// one would make the picture worse.
#[test]
fn a_channel_that_is_not_identified_is_left_unless_the_user_says_which() {
    let healthy = healthy_models().remove(9);
    for (inverts_red, assumed) in [(false, AssumedMap::DirectX), (true, AssumedMap::RedInverted)] {
        let mut model = healthy.clone();
        model.map =
            model.map.through(|[r, g, b]| if inverts_red { [1.0 - r, g, b] } else { [r, 1.0 - g, b] });
        let fix = |options: &FixOptions| {
            let mut document = model.document();
            let findings = check_document(&document, &options.check).expect("a valid document");
            let fixed = fix_document(&mut document, findings, options).expect("a repair");
            (document.image_bytes(0).expect("an image").into_owned(), fixed)
        };
        let (image, fixed) = fix(&FixOptions::default());
        assert!(!fixed.is_changed && image == model.map.file, "{fixed:#?}");
        let reasons: Vec<&str> =
            fixed.findings.iter().filter_map(|fixed| fixed.finding.left_because.as_deref()).collect();
        assert!(reasons.iter().any(|reason| reason.contains("--assume map=directx")), "{reasons:?}");
        let check = CheckOptions::default().with_assumed_map(Some(assumed));
        let (image, fixed) = fix(&FixOptions::default().with_check(check));
        assert!(fixed.is_changed, "{fixed:#?}");
        assert!(support::table::rgb(&image) == healthy.map.texels, "{assumed:?}");
        // What the texels show is not overruled.
        let findings = check_document(&healthy.document(), &check).expect("a valid document");
        assert!(findings.iter().all(|finding| finding.severity <= Severity::Info), "{findings:#?}");
    }
}

/// Bumps and dents look alike to the texels of a map that was not baked for the mesh: the user says which.
#[test]
fn both_channels_are_inverted_back_where_the_user_says_so() {
    let healthy = healthy_models().remove(9);
    let mut model = healthy.clone();
    model.map = model.map.through(|[r, g, b]| [1.0 - r, 1.0 - g, b]);
    let fix = |check: CheckOptions| {
        let mut document = model.document();
        let findings = check_document(&document, &check).expect("a valid document");
        let fixed = fix_document(&mut document, findings, &FixOptions::default().with_check(check));
        let fixed = fixed.expect("a repair");
        (support::table::rgb(&document.image_bytes(0).expect("an image")), fixed)
    };
    let (texels, _) = fix(CheckOptions::default());
    assert!(texels == model.map.texels, "nothing says that bumps are meant");
    let (texels, fixed) = fix(CheckOptions::default().with_assumed_map(Some(AssumedMap::BothInverted)));
    assert!(texels == healthy.map.texels, "{:#?}", fixed.findings);
    let codes = [Code::MapRedFlipped, Code::MapGreenFlipped];
    let of_channels = fixed.findings.iter().filter(|fixed| codes.contains(&fixed.finding.code));
    assert_eq!(of_channels.filter(|fixed| fixed.repaired).count(), 2, "{:#?}", fixed.findings);
}

/// Exchanged channels of which both are inverted, too: both are inverted back, or none.
#[test]
fn no_half_of_an_assumption_is_carried_out() {
    let models = healthy_models();
    for (number, signs) in (0..models.len()).flat_map(|number| [(number, false), (number, true)]) {
        let mut model = models[number].clone();
        if signs {
            model.negate_signs();
        }
        let damaged = model.map.texels.iter().map(|&[r, g, b]| [255 - g, 255 - r, b]).collect();
        model.map = model.map.with_texels(damaged);
        let check = CheckOptions::default().with_assumed_map(Some(AssumedMap::BothInverted));
        let mut document = model.document();
        let findings = check_document(&document, &check).expect("a valid document");
        let fixed = fix_document(&mut document, findings, &FixOptions::default().with_check(check));
        let fixed = fixed.expect("a repair").findings;
        let repaired = |code: Code| fixed.iter().any(|fixed| fixed.finding.code == code && fixed.repaired);
        assert_eq!(
            repaired(Code::MapRedFlipped),
            repaired(Code::MapGreenFlipped),
            "model {number}, flipped signs {signs}: {fixed:#?}"
        );
    }
}

/// A map whose red and green are exchanged does not say whether it cancels flipped signs, and says so once
/// they are exchanged back: the repair goes on with the signs.
#[test]
fn signs_wait_for_the_repair_of_their_map() {
    let healthy = healthy_models().remove(3);
    let mut model = healthy.clone();
    model.negate_signs();
    let exchanged = model.map.texels.iter().map(|&[r, g, b]| [g, r, b]).collect();
    model.map = model.map.with_texels(exchanged);
    let findings = check(&model);
    let flipped = findings.iter().find(|finding| finding.code == Code::TangentSignFlipped);
    assert!(flipped.is_some_and(|flipped| !flipped.is_fixable()), "{findings:#?}");
    let mut document = model.document();
    let fixed = fix_document(&mut document, findings, &FixOptions::default()).expect("a repair");
    let repaired: Vec<Code> =
        fixed.findings.iter().filter(|fixed| fixed.repaired).map(|fixed| fixed.finding.code).collect();
    assert_eq!(repaired, [Code::TangentSignFlipped, Code::MapChannelsSwapped], "{fixed:#?}");
    let left = check_document(&document, &CheckOptions::default()).expect("a valid document");
    assert!(left.iter().all(|finding| finding.severity <= Severity::Info), "{left:#?}");
    let signs = |document: &Document| -> Vec<f32> {
        let corners = document.corners().expect("valid indices");
        let tangents = corners[0].vectors::<4>("TANGENT").expect("valid data").expect("tangents");
        tangents.iter().map(|tangent| tangent[3]).collect()
    };
    assert_eq!(signs(&document), signs(&healthy.document()));
}

/// Two conventions that cancel and are left leave nothing else: the recipe of the tangents is repaired, and
/// their signs stay flipped.
#[test]
fn what_is_beside_a_pair_that_is_left_is_repaired() {
    let models = healthy_models().into_iter().filter(|model| model.name.contains("wavy"));
    for mut model in models {
        let by_faces = model.computed(Method::Face, model.uv_set);
        model.tangents().copy_from_slice(&by_faces);
        model.negate_signs();
        let inverted = model.map.texels.iter().map(|&[r, g, b]| [r, 255 - g, b]).collect();
        model.map = model.map.with_texels(inverted);
        let options = FixOptions::default().with_codes([Code::TangentOtherRecipe]);
        let findings = check(&model);
        let codes: Vec<Code> = findings.iter().map(|finding| finding.code).collect();
        assert!(codes.contains(&Code::ConventionsCancel), "{}: {findings:#?}", model.name);
        let mut document = model.document();
        let fixed = fix_document(&mut document, findings, &options).expect("a repair");
        let is_repaired =
            |code: Code| fixed.findings.iter().any(|fixed| fixed.repaired && fixed.finding.code == code);
        assert!(is_repaired(Code::TangentOtherRecipe), "{}: {fixed:#?}", model.name);
        let left = check_document(&document, &CheckOptions::default()).expect("a valid document");
        let left: Vec<Code> = left
            .iter()
            .filter(|finding| finding.severity > Severity::Info)
            .map(|finding| finding.code)
            .collect();
        assert_eq!(left, [Code::ConventionsCancel], "{}", model.name);
    }
}

/// Nothing shows which way tangents point under a flat map; tangents without a direction break normals, too.
#[test]
fn tangents_under_a_flat_map_make_no_picture_wrong() {
    let mut model = healthy_models().remove(3);
    model.map = model.map.with_texels(vec![[128, 128, 255]; model.map.texels.len()]);
    model.negate_signs();
    let findings = check(&model);
    let flipped = findings.iter().find(|finding| finding.code == Code::TangentSignFlipped);
    let flipped = flipped.expect("the finding");
    assert_eq!((flipped.severity, flipped.is_fixable()), (Severity::Info, true), "{flipped:?}");
    assert!(flipped.text.contains("images[0], its normal map, is flat"), "{}", flipped.text);
    let mut document = model.document();
    let fixed = fix_document(&mut document, findings, &FixOptions::default()).expect("a repair");
    assert!(fixed.is_changed, "{fixed:#?}");
    model.tangents()[0] = [0.0, 0.0, 0.0, 1.0];
    let zero = check(&model).into_iter().find(|finding| finding.code == Code::TangentZero);
    assert!(zero.is_some_and(|zero| zero.severity > Severity::Info));
}
