//! What a repair changes, and what it leaves alone.

mod support;

use std::collections::BTreeSet;
use std::fs;

use darboux::{Method, TangentOptions};
use darboux_check::{
    CheckOptions, Code, FixOptions, FixedFinding, FixedMap, Severity, check_document, check_map,
    check_model_of_maps, fix_document, fix_map, fix_map_on_model,
};
use darboux_io::gltf::Document;
use darboux_io::image::PngImage;
use darboux_io::{LoadOptions, SaveOptions};
use serde_json::json;
use support::baked::baked_models;
use support::container::with_json;
use support::models::{Model, healthy_models};
use support::table::{assuming_directx, codes};

fn read(glb: Vec<u8>) -> Document {
    Document::from_bytes("model", glb, None, &LoadOptions::default()).expect("a valid GLB")
}

fn fixed(document: &mut Document, findings_of: &mut Document, options: &FixOptions) -> Vec<FixedFinding> {
    let findings = check_document(findings_of, &options.check).expect("a valid document");
    fix_document(document, findings, options).expect("a valid document").findings
}

/// The bytes of a model's embedded image, from the JSON of a GLB on.
fn image(document: &Document) -> Vec<u8> {
    document.image_bytes(0).expect("an image").into_owned()
}

/// Makes a mistake.
type Damage = fn(&mut Model);

fn damaged() -> Model {
    let mut model = healthy_models().remove(3);
    model.negate_signs();
    model
}

#[test]
fn untouched_images_keep_their_bytes_and_geometry_its_accessors() {
    let model = damaged();
    let mut document = model.document();
    let findings = fixed(&mut document, &mut model.document(), &FixOptions::default());
    assert!(findings.iter().any(|fixed| fixed.repaired && fixed.finding.code == Code::TangentSignFlipped));
    let repaired = read(document.to_glb().expect("a GLB"));
    assert_eq!(image(&repaired), model.map.file);

    let mut model = healthy_models().remove(0);
    let inverted = model.map.texels.iter().map(|[r, g, b]| [*r, 255 - g, *b]).collect();
    model.map = model.map.with_texels(inverted);
    let mut document = model.document();
    let findings = fixed(&mut document, &mut model.document(), &assuming_directx());
    assert!(findings.iter().any(|fixed| fixed.repaired && fixed.finding.code == Code::MapGreenFlipped));
    let glb = document.to_glb().expect("a GLB");
    // The old image is gone, and the new one is the healthy one again.
    let repaired = read(glb.clone());
    let healthy = healthy_models().remove(0);
    assert_eq!(support::table::rgb(&image(&repaired)), healthy.map.texels);
    assert!(glb.len() < model.glb().len() + 4096, "{} for {}", glb.len(), model.glb().len());
    let accessors = |document: &Document| -> Vec<Vec<u8>> {
        let count = document.accessors().len();
        (0..count).map(|index| document.elements(index).expect("elements").bytes).collect()
    };
    assert_eq!(accessors(&repaired), accessors(&model.document()));
}

#[test]
fn only_the_chosen_codes_are_repaired() {
    let model = damaged();
    let mut document = model.document();
    let options = FixOptions::default().with_codes([Code::TangentZero]);
    let findings = fixed(&mut document, &mut model.document(), &options);
    assert!(findings.iter().all(|fixed| !fixed.repaired), "{findings:?}");
    assert!(!document.is_changed());
}

/// Mistakes that cancel are one finding: a code of one of them alone repairs nothing.
fn assert_repaired_together(model: &Model, codes: &[Code]) {
    for &code in codes {
        let mut document = model.document();
        let options = FixOptions::default().with_codes([code]);
        let findings = fixed(&mut document, &mut model.document(), &options);
        assert!(findings.iter().all(|fixed| !fixed.repaired), "{code:?}: {findings:#?}");
        assert!(!document.is_changed(), "{code:?}");
    }
    for options in [FixOptions::default(), FixOptions::default().with_codes([Code::ConventionsCancel])] {
        let findings = fixed(&mut model.document(), &mut model.document(), &options);
        let repaired = findings.iter().filter(|fixed| fixed.repaired).map(|fixed| fixed.finding.code);
        assert_eq!(repaired.collect::<Vec<_>>(), [Code::ConventionsCancel], "{findings:#?}");
    }
}

/// Flipped signs and flipped green look right together. One of them alone would be wrong.
#[test]
fn half_of_a_pair_that_cancels_is_left() {
    let mut model = damaged();
    let inverted = model.map.texels.iter().map(|[r, g, b]| [*r, 255 - g, *b]).collect();
    model.map = model.map.with_texels(inverted);
    assert_repaired_together(&model, &[Code::TangentSignFlipped, Code::MapGreenFlipped]);
}

/// So do inverted red, negated tangents and flipped signs.
#[test]
fn a_part_of_three_mistakes_that_cancel_is_left() {
    let mut model = baked_models().remove(0);
    model.map = model.map.through(|[r, g, b]| [1.0 - r, g, b]);
    model.tangents().iter_mut().for_each(|tangent| (0..4).for_each(|i| tangent[i] = -tangent[i]));
    let codes = [Code::TangentSignFlipped, Code::TangentNegated, Code::MapRedFlipped];
    assert_repaired_together(&model, &codes);
}

/// A map with both channels inverted under a scale of -1 gives the right picture, which a repair of the map
/// alone would flip.
#[test]
fn channels_that_a_negative_scale_inverts_are_left() {
    let mut model = baked_models().remove(0);
    model.map = model.map.through(|[r, g, b]| [1.0 - r, 1.0 - g, b]);
    let with_scale = |scale: f64| {
        let glb =
            with_json(&model.glb(), |json| json["materials"][0]["normalTexture"]["scale"] = scale.into());
        read(glb)
    };
    let inverted = [Code::MapGreenFlipped, Code::MapRedFlipped];
    for (scale, is_repaired) in [(1.0, true), (-1.0, false)] {
        let mut document = with_scale(scale);
        let findings = fixed(&mut document, &mut with_scale(scale), &FixOptions::default());
        let of_channels = || findings.iter().filter(|fixed| inverted.contains(&fixed.finding.code));
        assert_eq!(of_channels().count(), 2, "{findings:#?}");
        assert!(of_channels().all(|fixed| fixed.repaired == is_repaired), "{findings:#?}");
    }
}

#[test]
fn all_instances_are_repaired() {
    let mut model = damaged();
    model.copies = 3;
    let mut document = model.document();
    fixed(&mut document, &mut model.document(), &FixOptions::default());
    let left = check_document(&document, &CheckOptions::default()).expect("a valid document");
    assert!(left.iter().all(|finding| finding.code != Code::TangentSignFlipped), "{left:?}");
}

/// A model and its files in a folder, repaired into another folder and in place.
#[test]
fn image_files_get_new_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut model = healthy_models().remove(0);
    let inverted = model.map.texels.iter().map(|[r, g, b]| [*r, 255 - g, *b]).collect();
    model.map = model.map.with_texels(inverted);
    let glb = folder.path().join("embedded.glb");
    fs::write(&glb, model.glb()).expect("a file");
    // A .gltf with its image in a file of a subfolder.
    let text = String::from_utf8_lossy(&model.glb()).into_owned();
    let json = &text[text.find('{').expect("JSON")..=text.rfind("}]}").expect("the end of the JSON") + 2];
    let mut json: serde_json::Value = serde_json::from_str(json).expect("JSON");
    let view = json["images"][0]["bufferView"].as_u64().expect("a view") as usize;
    let end = json["bufferViews"][view]["byteOffset"].as_u64().expect("an offset") as usize;
    json["images"] = serde_json::json!([{"uri": "maps/n%20m.png", "name": "N"}]);
    json["buffers"] = serde_json::json!([{"byteLength": end, "uri": "data.bin"}]);
    json["bufferViews"].as_array_mut().expect("views").truncate(view);
    let glb = model.glb();
    let binary = glb.windows(4).position(|four| four == b"BIN\0").expect("a binary chunk") + 4;
    fs::create_dir(folder.path().join("maps")).expect("a folder");
    fs::write(folder.path().join("maps/n m.png"), &model.map.file).expect("a file");
    fs::write(folder.path().join("data.bin"), &glb[binary..binary + end]).expect("a file");
    let input = folder.path().join("model.gltf");
    fs::write(&input, json.to_string()).expect("a file");

    let open = |path: &std::path::Path| Document::open(path, &LoadOptions::default()).expect("a valid file");
    let mut document = open(&input);
    let findings = fixed(&mut document, &mut open(&input), &assuming_directx());
    assert!(findings.iter().any(|fixed| fixed.repaired), "{findings:?}");
    let elsewhere = folder.path().join("out/model.gltf");
    document.save(&elsewhere, &SaveOptions::default()).expect("written");
    let written = fs::read(folder.path().join("out/maps/n m.png")).expect("the map, under its name");
    assert_eq!(support::table::rgb(&written), healthy_models().remove(0).map.texels);
    assert_eq!(fs::read(folder.path().join("maps/n m.png")).expect("the old map"), model.map.file);
    let glb = folder.path().join("all.glb");
    document.save(&glb, &SaveOptions::default()).expect("written");
    assert_eq!(image(&open(&glb)), written);

    document.save_in_place().expect("written");
    let left = check_document(&open(&input), &CheckOptions::default()).expect("a valid document");
    assert!(left.iter().all(|finding| finding.code != Code::MapGreenFlipped), "{left:?}");
    assert_eq!(fs::read(folder.path().join("maps/n m.png")).expect("the old map"), model.map.file);
    assert_eq!(image(&open(&input)), written);
}

/// A map with 16 bits keeps them: green is inverted exactly.
#[test]
fn maps_keep_their_bit_depth() {
    let model = healthy_models().remove(0);
    let map = &model.map;
    let side = map.texels.len().isqrt() as u32;
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, side, side);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Sixteen);
    let words = |[r, g, b]: [u8; 3]| [r, r ^ 0x35, 255 - g, g ^ 0x35, b, b ^ 0x35];
    let bytes: Vec<u8> = map.texels.iter().flat_map(|texel| words(*texel)).collect();
    encoder.write_header().and_then(|mut writer| writer.write_image_data(&bytes)).expect("a PNG");
    let on = check_model_of_maps(&model.document()).expect("a valid document");
    let (loading, options) = (LoadOptions::default(), assuming_directx());
    let fixed = fix_map_on_model("map.png", &file, &on, &loading, &options).expect("a map");
    let fixed = fixed.image.expect("a repaired map");
    assert_eq!((fixed.bits(), fixed.size()), (16, [side; 2]));
    let mut reader =
        png::Decoder::new(std::io::Cursor::new(fixed.to_bytes().expect("a PNG"))).read_info().expect("a PNG");
    let mut repaired = vec![0; bytes.len()];
    reader.next_frame(&mut repaired).expect("texels");
    for (before, after) in bytes.as_chunks::<6>().0.iter().zip(repaired.as_chunks::<6>().0) {
        let [r, r2, g, g2, b, b2] = *before;
        assert_eq!(*after, [r, r2, 255 - g, 255 - g2, b, b2]);
    }
}

/// Both mistakes are repaired where one hides the other.
#[test]
fn a_repair_goes_on_with_what_it_reveals() {
    let model = healthy_models().remove(0);
    let texels = model.map.texels.iter().map(|[r, g, _]| [*r, 255 - g, 0]).collect();
    let file = model.map.with_texels(texels).file;
    let on = check_model_of_maps(&model.document()).expect("a valid document");
    let (loading, options) = (LoadOptions::default(), FixOptions::default());
    let repaired = |fixed: FixedMap| -> BTreeSet<Code> {
        assert!(fixed.image.is_some());
        fixed.findings.iter().filter(|fixed| fixed.repaired).map(|fixed| fixed.finding.code).collect()
    };
    let on_model = fix_map_on_model("map.png", &file, &on, &loading, &assuming_directx()).expect("a map");
    assert_eq!(repaired(on_model), BTreeSet::from([Code::MapTwoChannel, Code::MapGreenFlipped]));
    // Without the model, inverted green may as well be inverted red.
    let alone = fix_map("map.png", &file, &loading, &options).expect("a map");
    let green = alone.findings.iter().find(|fixed| fixed.finding.code == Code::MapGreenFlipped);
    let reason = green.and_then(|fixed| fixed.finding.left_because.clone()).expect("a reason");
    assert!(reason.contains("--model"), "{reason}");
    assert_eq!(repaired(alone), BTreeSet::from([Code::MapTwoChannel]));
}

/// Vertices that no triangle uses are not seen.
#[test]
fn unused_vertices_are_not_counted() {
    let mut model = healthy_models().remove(0);
    model.positions.push([0.0; 3]);
    model.normals.iter_mut().for_each(|normals| normals.push([0.0; 3]));
    model.tangents.iter_mut().for_each(|tangents| tangents.push([f32::NAN, 0.0, 0.0, 0.5]));
    model.uvs.iter_mut().for_each(|uvs| uvs.push([0.0; 2]));
    let findings = check_document(&model.document(), &CheckOptions::default()).expect("a valid document");
    assert!(findings.iter().all(|finding| finding.severity == Severity::Info), "{findings:?}");
}

/// The encoding leaves blue at 255 everywhere, as if the map had two channels.
#[test]
fn a_nearly_flat_map_that_was_encoded_as_srgb_is_repaired() {
    let slopes = (0..256u32 * 256).map(|i| {
        let (x, y) = (f64::from(i % 256) / 9.0, f64::from(i / 256) / 7.0);
        [-x.cos() * y.sin(), x.sin() * y.cos()]
    });
    let codes: Vec<[f64; 3]> = slopes
        .map(|[x, y]| [x, y].map(|slope| (188.0 + 6.0 * slope).round()))
        .map(|[r, g]| [r, g, 255.0])
        .collect();
    let texels: Vec<[u8; 3]> = codes.iter().map(|texel| texel.map(|code| code as u8)).collect();
    let file =
        PngImage::from_rgb("map", [256; 2], &texels).and_then(|image| image.to_bytes()).expect("a PNG");
    let found = check_map(&file, &CheckOptions::default()).findings;
    assert!(found.iter().any(|finding| finding.code == Code::MapSrgb), "{found:?}");
    let fixed = fix_map("map", &file, &LoadOptions::default(), &FixOptions::default()).expect("a map");
    assert!(fixed.findings.iter().any(|fixed| fixed.repaired && fixed.finding.code == Code::MapSrgb));
    let repaired = fixed.image.expect("a repaired map").to_bytes().expect("a PNG");
    let left = check_map(&repaired, &CheckOptions::default()).findings;
    assert!(left.iter().all(|finding| finding.severity < Severity::Error), "{left:?}");
    for (decoded, encoded) in support::table::rgb(&repaired).iter().zip(&codes) {
        let expected = encoded.map(|code| 255.0 * ((code / 255.0 + 0.055) / 1.055).powf(2.4));
        assert_eq!(decoded.map(f64::from), expected.map(f64::round));
    }
}

/// Two mistakes: only one may be repaired, and its repair would reveal the other.
#[test]
fn a_repair_that_makes_a_map_worse_is_not_kept() {
    let map = healthy_models().remove(0).map;
    let texels = map.texels.iter().map(|[r, g, _]| [*g, *r, 0]).collect();
    let options = FixOptions::default().with_codes([Code::MapTwoChannel]);
    let file = map.with_texels(texels).file;
    let fixed = fix_map("map.png", &file, &LoadOptions::default(), &options).expect("a map");
    assert!(fixed.image.is_none(), "{:?}", fixed.findings);
    let left =
        fixed.findings.iter().find(|fixed| fixed.finding.code == Code::MapTwoChannel).expect("the finding");
    let reason = left.finding.left_because.as_deref().unwrap_or_default();
    assert!(!left.repaired && reason.contains("would end in map-channels-swapped"), "{reason}");
}

/// Half of the vectors point below the surface and are too long: with length 1, the map would be called one
/// in object space. Green is inverted in the others, and inverted back.
#[test]
fn only_the_repair_that_makes_a_map_worse_is_left() {
    let map = healthy_models().remove(0).map;
    let texel = |(index, [r, g, b]): (usize, &[u8; 3])| match index * 100 / map.texels.len() {
        0..12 => [27, 27, 121],
        12..24 => [228, 228, 121],
        24..36 => [27, 228, 121],
        36..48 => [228, 27, 121],
        48..56 => [128, 128, 200],
        _ => [*r, 255 - *g, *b],
    };
    let texels = map.texels.iter().enumerate().map(texel).collect();
    let file = map.with_texels(texels).file;
    let fixed = fix_map("map.png", &file, &LoadOptions::default(), &assuming_directx()).expect("a map");
    let outcomes: Vec<_> = fixed.findings.iter().map(|fixed| (fixed.finding.code, fixed.repaired)).collect();
    assert!(outcomes.contains(&(Code::MapGreenFlipped, true)), "{outcomes:?}");
    assert!(outcomes.contains(&(Code::MapNotUnit, false)), "{outcomes:?}");
    assert!(fixed.image.is_some());
}

/// Black background of two channels becomes (-1, -1, 0) once z is computed: no vectors, which are neither
/// below the surface nor of another length, and stay as they are.
#[test]
fn background_without_z_is_no_normal() {
    let map = healthy_models().remove(0).map;
    let texel = |(index, [r, g, b]): (usize, &[u8; 3])| match index % map.texels.len().isqrt() {
        column if 3 * column < map.texels.len().isqrt() => [0, 0, 126],
        _ => [*r, 255 - *g, *b],
    };
    let texels: Vec<[u8; 3]> = map.texels.iter().enumerate().map(texel).collect();
    let file = map.with_texels(texels).file;
    let found = check_map(&file, &CheckOptions::default()).findings;
    let codes: Vec<Code> = found.iter().map(|finding| finding.code).collect();
    assert!(!codes.contains(&Code::MapNotUnit) && !codes.contains(&Code::MapNegativeZ), "{codes:?}");
    assert!(codes.contains(&Code::MapGreenFlipped), "{codes:?}");
}

/// Later mistakes are compared with the faces, too, which tell inverted red from inverted green.
#[test]
fn a_chain_of_repairs_keeps_the_evidence_of_the_mesh() {
    for healthy in support::baked::baked_models().into_iter().take(4) {
        let damage: [fn([u8; 3]) -> [u8; 3]; 2] = [|[r, g, _]| [255 - r, g, 0], |[r, g, _]| [g, 255 - r, 0]];
        for damage in damage {
            let map = healthy.map.with_texels(healthy.map.texels.iter().copied().map(damage).collect());
            let model = Model { map, ..healthy.clone() };
            let mut document = model.document();
            fixed(&mut document, &mut model.document(), &FixOptions::default());
            let repaired = read(document.to_glb().expect("a GLB"));
            let left = check_document(&repaired, &CheckOptions::default()).expect("a valid document");
            let errors: Vec<_> = left.iter().filter(|found| found.severity == Severity::Error).collect();
            assert!(errors.is_empty(), "{}: {errors:?}", healthy.name);
            let texels = support::table::rgb(&image(&repaired));
            let pairs = || texels.iter().zip(&healthy.map.texels);
            let largest = pairs().flat_map(|(a, b)| [a[0].abs_diff(b[0]), a[1].abs_diff(b[1])]).max();
            assert!(largest <= Some(2), "{}: {largest:?}", healthy.name);
        }
    }
}

/// Negated normals lean against all texels, and say nothing about the map.
/// Triangles without an area, and normals without a direction, show no side, and hide none.
#[test]
fn reversed_faces_are_found_among_triangles_that_show_no_side() {
    let mut model = healthy_models().into_iter().find(|model| model.name == "sphere").expect("a sphere");
    let triangles = model.indices.len() / 3;
    model.turn_faces();
    let degenerate: Vec<u32> =
        model.indices.as_chunks::<3>().0.iter().flat_map(|&[a, b, _]| [a, b, b, a, a, b]).collect();
    model.indices.extend(degenerate);
    let mut document = model.document();
    let findings = check_document(&document, &CheckOptions::default()).expect("a valid document");
    let reversed = findings.iter().find(|finding| finding.code == Code::NormalAgainstWinding);
    assert!(reversed.is_some_and(|found| found.is_fixable() && found.count <= triangles), "{findings:#?}");
    let fixed = fix_document(&mut document, findings, &FixOptions::default()).expect("a repair");
    let is_reversed = |fixed: &&FixedFinding| fixed.finding.code == Code::NormalAgainstWinding;
    assert!(fixed.findings.iter().filter(is_reversed).all(|fixed| fixed.repaired));
}

#[test]
fn reversed_normals_leave_the_map_alone() {
    for mut model in support::baked::baked_models().into_iter().take(4) {
        let before = image(&model.document());
        model.negate_normals();
        let mut document = model.document();
        let findings = fixed(&mut document, &mut model.document(), &FixOptions::default());
        let about_maps: Vec<_> = findings
            .iter()
            .filter(|fixed| fixed.finding.severity == Severity::Error && fixed.finding.place.image.is_some())
            .collect();
        assert!(about_maps.is_empty(), "{}: {about_maps:?}", model.name);
        assert!(image(&document) == before, "{}", model.name);
    }
}

/// Flat parts of a relief may lean so that they have the colour of a flat texel that was encoded as sRGB.
#[test]
fn leaning_facets_are_not_encoded() {
    let map = healthy_models().remove(0).map;
    let facet = [188, 188, 255 - 37];
    let texels = map.texels.iter().enumerate().map(|(i, &texel)| if i % 128 < 12 { facet } else { texel });
    let file = map.with_texels(texels.collect()).file;
    let found = check_map(&file, &CheckOptions::default()).findings;
    assert!(found.iter().all(|finding| finding.code != Code::MapSrgb), "{found:?}");
}

/// An image that is also a colour, and one that cannot be rewritten, are left, with the reason.
#[test]
fn maps_that_must_not_change_are_left() {
    let mut model = healthy_models().remove(0);
    let inverted = model.map.texels.iter().map(|[r, g, b]| [*r, 255 - g, *b]).collect();
    model.map = model.map.with_texels(inverted);
    let bytes = with_json(&model.glb(), |json| json["materials"][0]["emissiveTexture"] = json!({"index": 0}));
    let mut document = read(bytes.clone());
    let findings = fixed(&mut document, &mut read(bytes), &FixOptions::default());
    let left =
        findings.iter().find(|fixed| fixed.finding.code == Code::MapGreenFlipped).expect("the finding");
    let reason = left.finding.left_because.as_deref().unwrap_or_default();
    assert!(!left.repaired && reason.contains("another texture"), "{reason}");
    assert!(!document.is_changed());
}

#[test]
fn images_of_other_kinds_are_recognised() {
    assert!(PngImage::obstacle(b"no image").is_some());
    assert!(PngImage::obstacle(&healthy_models().remove(0).map.file).is_none());
}

/// Tangents of another method than MikkTSpace that were asked for are written once: the finding stays, and a
/// second repair changes nothing.
#[test]
fn another_method_is_not_called_a_repair() {
    let mut model = healthy_models().remove(1);
    model.tangents = Some(model.computed(Method::Face, model.uv_set));
    let options = FixOptions::default().with_tangents(TangentOptions::from(Method::Area));
    let repair = |document: &mut Document, again: &mut Document| {
        let findings = check_document(again, &CheckOptions::default()).expect("a valid document");
        fix_document(document, findings, &options).expect("a valid document")
    };
    let mut document = model.document();
    let first = repair(&mut document, &mut model.document());
    let recipe = first.findings.iter().find(|fixed| fixed.finding.code == Code::TangentOtherRecipe);
    let recipe = recipe.expect("the finding");
    assert!(first.is_changed && !recipe.repaired);
    assert!(recipe.finding.left_because.as_deref().is_some_and(|reason| reason.contains("asked for")));
    let glb = document.to_glb().expect("a GLB");
    let mut document = read(glb.clone());
    let second = repair(&mut document, &mut read(glb));
    assert!(!second.is_changed && !document.is_changed(), "{:?}", second.findings);
}

/// A repair that ends in an error that was not there is taken back; that of another primitive of the file is
/// kept.
#[test]
fn repairs_add_no_errors() {
    for damage in [
        |model: &mut Model| model.positions[1][0] = f32::NAN,
        |model: &mut Model| {
            model.uvs[model.uv_set][1][0] = f32::NAN;
        },
    ] {
        for healthy in healthy_models() {
            let mut model = healthy.clone();
            damage(&mut model);
            model.tangents = None;
            let errors = |document: &mut Document| {
                let findings = check_document(document, &CheckOptions::default()).expect("a valid document");
                codes(&findings, |severity| severity == Severity::Error)
            };
            let before = errors(&mut model.document());
            let mut document = model.document();
            fixed(&mut document, &mut model.document(), &FixOptions::default());
            let after = errors(&mut document);
            assert!(after.is_subset(&before), "{}: {after:?} after {before:?}", model.name);
        }
    }
}

/// Both leave the same file, and its tangents side with the normals.
#[test]
fn reversed_faces_of_open_surfaces_are_left() {
    let healthy =
        healthy_models().into_iter().find(|model| model.name == "wavy grid").expect("an open model");
    let damage: [Damage; 2] = [Model::turn_faces, |model| {
        model.negate_normals();
        model.negate_signs();
    }];
    for damage in damage {
        let mut model = healthy.clone();
        damage(&mut model);
        let mut document = model.document();
        let findings = fixed(&mut document, &mut model.document(), &FixOptions::default());
        let left = findings.iter().find(|fixed| fixed.finding.code == Code::NormalAgainstWinding);
        let left = left.expect("the finding");
        let reason = left.finding.left_because.as_deref().unwrap_or_default();
        assert!(!left.repaired && reason.contains("both its normals and the signs w"), "{reason}");
        assert!(!document.is_changed());
        // New tangents would side with the faces, and so decide what nothing decides.
        model.tangents().iter_mut().for_each(|tangent| tangent[3] *= 0.5);
        let mut document = model.document();
        fixed(&mut document, &mut model.document(), &FixOptions::default());
        assert!(!document.is_changed());
    }
}

/// The volume decides, also where faces are missing, and the text says what is flipped and why.
#[test]
fn the_volume_of_a_nearly_closed_surface_decides() {
    let mut healthy =
        healthy_models().into_iter().find(|model| model.name == "fine sphere").expect("a closed model");
    healthy.indices.truncate(healthy.indices.len() / 3 * 98 / 100 * 3);
    let normals_and_signs = |model: &mut Model| {
        model.negate_normals();
        model.negate_signs();
    };
    let mistakes: [(Damage, &str); 3] = [
        (Model::turn_faces, "its faces are reversed, because they enclose a negative volume"),
        (Model::negate_normals, "its normals are reversed, because its faces enclose a positive volume"),
        (normals_and_signs, "its normals are reversed, because its faces enclose a positive volume"),
    ];
    for (damage, clause) in mistakes {
        let mut model = healthy.clone();
        damage(&mut model);
        let mut document = model.document();
        let findings = fixed(&mut document, &mut model.document(), &FixOptions::default());
        let first = &findings[0];
        assert_eq!((first.finding.code, first.repaired), (Code::NormalAgainstWinding, true), "{findings:?}");
        assert!(first.finding.text.ends_with(clause), "{}", first.finding.text);
        let vectors = |document: &Document, name| {
            let corners = document.corners().expect("valid indices");
            let all = corners.iter().flat_map(|corners| corners.vectors::<3>(name).expect("vectors"));
            all.flatten().collect::<Vec<[f32; 3]>>()
        };
        let mut healthy = healthy.document();
        for name in ["POSITION", "NORMAL"] {
            assert_eq!(vectors(&document, name), vectors(&healthy, name), "{clause}");
        }
        let [left, before] = [&mut document, &mut healthy].map(|document| {
            let findings = check_document(document, &CheckOptions::default()).expect("a valid document");
            codes(&findings, |_| true)
        });
        assert_eq!(left, before);
    }
}

/// Causes come first, and what follows from them is left out or is no error.
#[test]
fn what_follows_from_a_mistake_is_no_further_mistake() {
    for healthy in healthy_models().iter().filter(|model| model.positions.len() > 100) {
        let named = |model: &Model| {
            let findings = check_document(&model.document(), &support::table::without_maps());
            let findings = findings.expect("a valid document");
            let named = findings.iter().filter(|finding| finding.severity > Severity::Info);
            named.map(|finding| (finding.code, finding.severity)).collect::<Vec<_>>()
        };
        let mut model = healthy.clone();
        model.negate_normals();
        let mut expected = vec![(Code::NormalAgainstWinding, Severity::Error)];
        if !model.is_closed() {
            expected.push((Code::TangentSignFlipped, Severity::Warning));
        }
        assert_eq!(named(&model), expected, "{}", model.name);
        let mut model = healthy.clone();
        model.tangents().iter_mut().for_each(|tangent| tangent[3] = 0.0);
        assert_eq!(named(&model), [(Code::TangentSignNotOne, Severity::Error)], "{}", model.name);
    }
}

/// Primitives that shared their indices share those of the faces that were flipped.
#[test]
fn turned_faces_stay_shared() {
    let mut model =
        healthy_models().into_iter().find(|model| model.name == "sphere").expect("a closed model");
    model.turn_faces();
    model.copies = 3;
    let mut document = model.document();
    let findings = fixed(&mut document, &mut model.document(), &FixOptions::default());
    assert!(findings.iter().any(|fixed| fixed.repaired && fixed.finding.code == Code::NormalAgainstWinding));
    let indices = |document: &Document| -> BTreeSet<Option<usize>> {
        document
            .meshes()
            .iter()
            .flat_map(|mesh| &mesh.primitives)
            .map(|primitive| primitive.indices)
            .collect()
    };
    assert_eq!(indices(&document).len(), 1);
}

/// Blue of one value alone does not make a map of two channels: red and green have to be the slopes of a
/// surface.
#[test]
fn blue_is_computed_only_for_slopes() {
    let map = healthy_models().remove(0).map;
    let code_of = |texels: Vec<[u8; 3]>| {
        let file = map.with_texels(texels).file;
        let options = FixOptions::default();
        let FixedMap { image, findings, .. } =
            fix_map("map", &file, &LoadOptions::default(), &options).expect("an image");
        (findings.iter().map(|fixed| fixed.finding.code).collect::<Vec<_>>(), image.is_some())
    };
    let slopes = map.texels.iter().map(|[r, g, _]| [*r, *g, 0]).collect();
    assert_eq!(code_of(slopes), (vec![Code::MapTwoChannel], true));
    let occlusion = map.texels.iter().map(|[r, g, _]| [255 - r / 4, *g, 0]).collect();
    assert_eq!(code_of(occlusion), (vec![Code::MapNotNormal], false));
}

/// Once exchanged channels are back in their places, a channel that was inverted, too, may be either of them.
#[test]
fn exchanged_and_inverted_channels_are_left() {
    let map = healthy_models().remove(0).map;
    let file = map.with_texels(map.texels.iter().map(|[r, g, b]| [*g, 255 - r, *b]).collect()).file;
    let made = fix_map("map", &file, &LoadOptions::default(), &FixOptions::default()).expect("an image");
    let is_left = |fixed: &FixedFinding| {
        let reason = fixed.finding.left_because.as_deref().unwrap_or_default();
        !fixed.repaired && reason.contains("`--assume map=directx` says that green is")
    };
    assert!(made.image.is_none() && made.findings.iter().any(is_left), "{:?}", made.findings);
}
