//! What findings say, and what is no finding.

mod support;

use darboux::{BitangentDirection, Method, TangentDirection};
use darboux_check::{
    CheckOptions, Code, Finding, FixOptions, Severity, check_document, check_map, check_map_on_model,
    check_model_of_maps, fix_document, fix_map, fix_map_on_model,
};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use serde_json::{Value, json};
use support::baked::baked_models;
use support::container::with_json;
use support::mistakes::MISTAKES;
use support::models::{Model, healthy_models};
use support::table::without_maps;

fn check(model: &Model) -> Vec<Finding> {
    check_document(&model.document(), &without_maps()).expect("a valid document")
}

fn find(findings: &[Finding], code: Code) -> Option<&Finding> {
    findings.iter().find(|finding| finding.code == code)
}

fn model(name: &str) -> Model {
    healthy_models().into_iter().find(|model| model.name == name).expect("a healthy model")
}

/// Where UVs have no area, MikkTSpace gives tangents that lean or whose signs differ. Only the UVs are named.
#[test]
fn tangents_that_mikktspace_itself_gives_are_no_mistake() {
    let mut model = model("wavy grid");
    let vertices = model.detach_first_face();
    let uv = model.uvs[model.uv_set][vertices[0]];
    vertices.into_iter().for_each(|vertex| model.uvs[model.uv_set][vertex] = uv);
    model.tangents = Some(model.computed(Method::default(), model.uv_set));
    // The tangent of a face without a direction is the x axis; this normal leans away from it by 60 degrees.
    let lean = [0.866_025_4, 0.0, 0.5];
    model.normals.iter_mut().for_each(|normals| normals[vertices[1]] = lean);
    model.tangents = Some(model.computed(Method::default(), model.uv_set));
    let [x, y, z, _] = model.tangents()[vertices[1]];
    let cosine = x * lean[0] + y * lean[1] + z * lean[2];
    assert!(cosine.abs() > 0.1, "MikkTSpace gives a tangent that is perpendicular: {cosine}");
    let findings = check(&model);
    assert!(find(&findings, Code::TangentNotPerpendicular).is_none(), "{findings:#?}");
    assert!(find(&findings, Code::UvDegenerate).is_some(), "{findings:#?}");

    // Another tangent that leans is one.
    let tangents = model.tangents();
    tangents[vertices[2]] = [0.0, 0.6, 0.8, 1.0];
    let findings = check(&model);
    assert_eq!(find(&findings, Code::TangentNotPerpendicular).map(|finding| finding.count), Some(1));
}

/// The sentence does not contradict the share of the corners.
#[test]
fn tangents_of_no_known_method_are_not_most_of_mikktspace() {
    for (noisy, is_most) in [(0.3, true), (0.8, false)] {
        let mut model = model("large wavy grid");
        let normals = model.normals.clone().expect("normals");
        let count = (noisy * normals.len() as f32) as usize;
        for (vertex, (tangent, n)) in model.tangents().iter_mut().zip(&normals).enumerate().take(count) {
            let [x, y, z, w] = *tangent;
            let across = [n[1] * z - n[2] * y, n[2] * x - n[0] * z, n[0] * y - n[1] * x];
            let (sin, cos) = (0.05 + 0.02 * (vertex % 7) as f32).sin_cos();
            *tangent = [cos * x + sin * across[0], cos * y + sin * across[1], cos * z + sin * across[2], w];
        }
        let findings = check(&model);
        let finding = find(&findings, Code::TangentOtherRecipe).expect("the finding");
        assert_eq!(finding.text.starts_with("most tangents are those of MikkTSpace"), is_most, "{finding:?}");
        assert!((finding.evidence[0].value > 50.0) == is_most, "{finding:?}");
    }
}

/// A tangent of length zero is one mistake, whatever its sign.
#[test]
fn the_sign_of_a_tangent_without_a_direction_says_nothing() {
    for sign in [1.0, -1.0] {
        let mut model = model("large wavy grid");
        model.tangents()[140] = [0.0, 0.0, 0.0, sign];
        let findings = check(&model);
        let severe: Vec<Code> = findings
            .iter()
            .filter(|finding| finding.severity > Severity::Info)
            .map(|finding| finding.code)
            .collect();
        assert_eq!(severe, [Code::TangentZero], "{findings:#?}");
    }
}

/// Tangents of a part that are 46 degrees from MikkTSpace's are an error; 11 degrees are a warning.
#[test]
fn tangents_far_from_mikktspace_are_an_error() {
    for (angle, severity) in [(0.8f32, Severity::Error), (0.2, Severity::Warning)] {
        let mut model = model("large wavy grid");
        let normals = model.normals.clone().expect("normals");
        let (sin, cos) = angle.sin_cos();
        for (tangent, n) in model.tangents().iter_mut().zip(&normals).take(normals.len() / 4) {
            let [x, y, z, w] = *tangent;
            let across = [n[1] * z - n[2] * y, n[2] * x - n[0] * z, n[0] * y - n[1] * x];
            *tangent = [cos * x + sin * across[0], cos * y + sin * across[1], cos * z + sin * across[2], w];
        }
        let findings = check(&model);
        let finding = find(&findings, Code::TangentOtherRecipe).expect("the finding");
        assert_eq!(finding.severity, severity, "{finding:?}");
        assert_eq!(finding.text.contains("wrong directions"), severity == Severity::Error);
    }
}

/// Single tangents that were turned are found in thin triangles, too, where the tangents of the others show
/// that the UVs were not rounded since.
#[test]
fn single_tangents_are_found_in_thin_triangles() {
    for name in ["wavy grid", "sphere", "mirrored fine wavy grid"] {
        let mut healthy = model(name);
        let set = healthy.uv_set;
        healthy.uvs[set].iter_mut().for_each(|uv| uv[1] *= 1e-4);
        healthy.tangents = Some(healthy.computed(Method::default(), set));
        let before = check(&healthy);
        assert!(before.iter().all(|finding| finding.severity == Severity::Info), "{name}: {before:#?}");
        let normals = healthy.normals.clone().expect("normals");
        for vertex in (0..normals.len()).step_by(23) {
            let ([x, y, z, w], n) = (healthy.tangents()[vertex], normals[vertex]);
            let across = [n[1] * z - n[2] * y, n[2] * x - n[0] * z, n[0] * y - n[1] * x, w];
            for (tangent, code) in [([-x, -y, -z, w], Code::TangentNegated), (across, Code::TangentRotated)] {
                let mut model = healthy.clone();
                model.tangents()[vertex] = tangent;
                let findings = check(&model);
                let found = find(&findings, code).map(|finding| finding.first.clone());
                assert_eq!(found, Some(vec![vertex]), "{name}, {vertex}: {findings:#?}");
                let other =
                    findings.iter().find(|other| other.severity > Severity::Info && other.code != code);
                assert_eq!(other, None, "{name}, {vertex}");
            }
        }
    }
}

/// Tangents of any recipe that are MikkTSpace's to a tenth of a degree are not called those of another
/// recipe.
#[test]
fn mikktspace_is_preferred_where_it_explains_all_tangents() {
    let mut cases = 0;
    for healthy in healthy_models() {
        for method in [Method::Average, Method::Area, Method::AngleArea, Method::Lengyel] {
            let mut model = healthy.clone();
            model.tangents = Some(model.computed(method, model.uv_set));
            let ours = model.computed(Method::default(), model.uv_set);
            let distance = |(a, b): (&[f32; 4], &[f32; 4])| {
                (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f32>().sqrt().to_degrees()
            };
            if model.tangents().iter().zip(&ours).map(distance).fold(0.0, f32::max) < 0.05 {
                cases += 1;
                let findings = check(&model);
                assert!(find(&findings, Code::TangentOtherRecipe).is_none(), "{}: {findings:#?}", model.name);
            }
        }
    }
    assert!(cases > 10, "{cases} cases");
}

/// One vertex that is far away does not decide in which axes the normals are.
#[test]
fn one_lost_vertex_does_not_turn_the_axes() {
    for name in ["wavy grid", "sphere", "wavy sphere", "fine sphere"] {
        for far in [[1e12, 0.0, 0.0], [0.0, -1e12, 1e11], [0.0, 0.0, 1e12]] {
            let mut model = model(name);
            let middle = model.positions.len() / 2;
            model.positions[middle] = far;
            let findings = check(&model);
            assert!(find(&findings, Code::NormalOtherAxes).is_none(), "{name}: {findings:#?}");
        }
    }
}

/// The tangent of a normal that is damaged is right, though it is not perpendicular to it.
#[test]
fn tangents_of_damaged_normals_are_no_further_mistake() {
    for (damaged, code) in [(0.7f32, Code::NormalNotUnit), (-1.0, Code::NormalAgainstWinding)] {
        let mut model = model("large wavy grid");
        let tangent = model.tangents()[40];
        let normal = &mut model.normals.as_mut().expect("normals")[40];
        *normal = [0, 1, 2].map(|i| damaged * (0.8 * normal[i] + 0.6 * tangent[i]));
        let findings = check(&model);
        assert!(find(&findings, code).is_some(), "{findings:#?}");
        assert!(find(&findings, Code::TangentNotPerpendicular).is_none(), "{findings:#?}");
    }
}

/// Where a position was lost, tangents cannot be computed again, and nothing is said of how they were.
#[test]
fn tangents_beside_lost_positions_are_not_judged() {
    let mut model = model("wavy grid");
    model.tangents = Some(model.computed(Method::default(), model.uv_set));
    model.positions[7][1] = f32::NAN;
    let findings = check(&model);
    assert!(find(&findings, Code::PositionNotFinite).is_some());
    assert!(find(&findings, Code::TangentOtherRecipe).is_none(), "{findings:#?}");
}

/// Scaled normals do not hide how the tangents were computed.
#[test]
fn recipes_show_through_scaled_normals() {
    for (method, name) in [(Method::default(), None), (Method::Area, Some("averages weighted by area"))] {
        let mut model = model("wavy grid");
        model.tangents = Some(model.computed(method, model.uv_set));
        for (vertex, normal) in model.normals.iter_mut().flatten().enumerate() {
            *normal = normal.map(|x| x * (1.0 + 0.3 * (vertex % 5) as f32));
        }
        let findings = check(&model);
        assert!(find(&findings, Code::NormalNotUnit).is_some());
        let found = find(&findings, Code::TangentOtherRecipe).map(|finding| finding.text.as_str());
        assert_eq!(found.is_some(), name.is_some(), "{found:?}");
        assert!(name.is_none_or(|name| found.is_some_and(|text| text.contains(name))), "{found:?}");
    }
}

/// What the cure says to keep, the repair keeps.
#[test]
fn tangents_of_quads_are_kept() {
    let mut model = model("wavy grid");
    model.tangents = Some(model.computed_on_quads());
    let findings = check(&model);
    let finding = find(&findings, Code::TangentOtherRecipe).expect("the finding");
    assert!(finding.text.contains("before quads were cut") && !finding.is_fixable(), "{finding:?}");
    assert_eq!(finding.cure, "None needed.");
    let mut document = model.document();
    let options = FixOptions::default().with_check(without_maps());
    fix_document(&mut document, findings, &options).expect("a valid document");
    assert!(!document.is_changed());
}

/// Flipped signs are negated, and the directions, which follow another recipe, keep their bits.
#[test]
fn flipped_signs_do_not_change_the_tangents_of_quads() {
    let mut model = model("wavy grid");
    model.tangents = Some(model.computed_on_quads());
    let healthy = model.tangents().to_vec();
    model.negate_signs();
    let mut document = model.document();
    let options = FixOptions::default().with_check(without_maps());
    let findings = check(&model);
    let fixed = fix_document(&mut document, findings, &options).expect("a valid document");
    let repaired = fixed.findings.iter().filter(|fixed| fixed.repaired).map(|fixed| fixed.finding.code);
    assert_eq!(repaired.collect::<Vec<_>>(), [Code::TangentSignFlipped]);
    let of = |document: &Document| -> Vec<[f32; 4]> {
        let corners = document.corners().expect("corners");
        corners[0].vectors("TANGENT").expect("valid data").expect("tangents")
    };
    let wanted: Vec<[f32; 4]> = model.indices.iter().map(|&vertex| healthy[vertex as usize]).collect();
    assert_eq!(of(&document), wanted);
}

/// So few mirrored corners may be slivers, and say nothing about the signs of the rest.
#[test]
fn a_few_mirrored_corners_decide_nothing() {
    let mut model = model("large wavy grid");
    let vertices = model.detach_first_face();
    let set = model.uv_set;
    vertices.into_iter().for_each(|vertex| model.uvs[set][vertex][0] *= -1.0);
    model.tangents = Some(model.computed(Method::default(), set));
    let sign = model.tangents()[0][3];
    assert_eq!(model.tangents()[vertices[0]][3], -sign, "the face is mirrored");
    assert!(check(&model).iter().all(|finding| finding.severity == Severity::Info));

    model.tangents().iter_mut().for_each(|tangent| tangent[3] = sign);
    let findings = check(&model);
    let partly = find(&findings, Code::TangentSignPartlyFlipped).expect("the finding");
    assert_eq!((partly.count, partly.severity), (1, Severity::Warning), "{findings:?}");

    model.tangents().iter_mut().for_each(|tangent| tangent[3] = -sign);
    let findings = check(&model);
    assert!(find(&findings, Code::TangentSignFlipped).is_some(), "{findings:?}");
}

/// The commonest colour of a texture may be that of a flat map that was encoded as sRGB.
#[test]
fn colour_textures_are_no_normal_maps() {
    for [red, green, blue] in [[188, 187, 180], [189, 186, 120], [54, 55, 60], [54, 55, 200]] {
        let side = 128;
        let texel = |i: usize| {
            let (x, y) = (i % side, i / side);
            // Planks: every fifth row of tiles has the one colour, the others are painted with it and noise.
            let noise = (i as u32).wrapping_mul(2_654_435_761) >> 24;
            let stripe = (x / 9 + y / 13) % 5;
            match stripe {
                0 => [red, green, blue],
                _ => [noise as u8 / 2 + 40 * stripe as u8 / 2, noise as u8 / 3, (255 - noise) as u8 / 3],
            }
        };
        let file = support::maps::png(&(0..side * side).map(texel).collect::<Vec<[u8; 3]>>());
        let findings = check_map(&file, &CheckOptions::default()).findings;
        let codes: Vec<Code> = findings.iter().map(|finding| finding.code).collect();
        assert_eq!(codes, [Code::MapNotNormal], "{red}, {green}, {blue}");
    }
}

/// With the model of a bare map, its faces tell inverted red from inverted green.
#[test]
fn bare_maps_are_compared_with_the_faces_of_their_model() {
    let options = CheckOptions::default();
    for model in baked_models().iter().take(4) {
        let on_model = check_model_of_maps(&model.document()).expect("a valid document");
        let errors = |texel: fn(&[u8; 3]) -> [u8; 3]| -> Vec<Code> {
            let file = model.map.with_texels(model.map.texels.iter().map(texel).collect()).file;
            let findings = check_map_on_model(&file, &on_model, &options).findings;
            let errors = findings.iter().filter(|finding| finding.severity == Severity::Error);
            errors.map(|finding| finding.code).collect()
        };
        assert_eq!(errors(|texel| *texel), [], "{}", model.name);
        assert_eq!(errors(|[r, g, b]| [255 - r, *g, *b]), [Code::MapRedFlipped], "{}", model.name);
        assert_eq!(errors(|[r, g, b]| [*r, 255 - g, *b]), [Code::MapGreenFlipped], "{}", model.name);
    }
}

/// What the texels and the faces say together is what is repaired, and what is said of the map as a whole.
#[test]
fn bare_maps_are_repaired_by_the_faces_of_their_model() {
    let damaged = [
        ([true, false], TangentDirection::Left, BitangentDirection::Up),
        ([false, true], TangentDirection::Right, BitangentDirection::Down),
        ([true, true], TangentDirection::Left, BitangentDirection::Down),
    ];
    for model in baked_models().iter().take(4) {
        let on_model = check_model_of_maps(&model.document()).expect("a valid document");
        for ([inverts_red, inverts_green], red, green) in damaged {
            let inverted = |code: u8, inverts: bool| if inverts { 255 - code } else { code };
            let texel = |&[r, g, b]: &[u8; 3]| [inverted(r, inverts_red), inverted(g, inverts_green), b];
            let file = model.map.with_texels(model.map.texels.iter().map(texel).collect()).file;
            let checked = check_map_on_model(&file, &on_model, &CheckOptions::default());
            let directions = checked.directions.expect("directions");
            assert_eq!((directions.red, directions.green), (red, green), "{}", model.name);
            let (loading, options) = (LoadOptions::default(), FixOptions::default());
            let fixed = fix_map_on_model("map", &file, &on_model, &loading, &options).expect("a map");
            let repaired = fixed.image.expect("a repaired map").to_bytes().expect("a PNG");
            assert!(support::table::rgb(&repaired) == model.map.texels, "{}", model.name);
            // Without the model, nothing says which of the two channels is inverted.
            let alone = fix_map("map", &file, &loading, &options).expect("a map");
            assert!(alone.image.is_none(), "{}: {:?}", model.name, alone.findings);
        }
    }
}

/// The faces show which channels of one map are inverted: those of another map of the model are likely the
/// same.
#[test]
fn maps_of_one_model_are_compared() {
    let mut model = baked_models().remove(0);
    let alien = healthy_models().remove(5).map;
    let alien = alien.with_texels(alien.texels.iter().map(|[r, g, b]| [*r, 255 - g, *b]).collect());
    for (inverts_red, inverts_green) in [(true, false), (false, true), (false, false)] {
        let invert = |code: u8, inverts: bool| if inverts { 255 - code } else { code };
        let texel = |&[r, g, b]: &[u8; 3]| [invert(r, inverts_red), invert(g, inverts_green), b];
        model.map = model.map.with_texels(model.map.texels.iter().map(texel).collect());
        let uri = format!("data:image/png;base64,{}", base64(&alien.file));
        let glb = with_json(&model.glb(), |json| {
            json["images"].as_array_mut().expect("images").push(json!({"uri": uri}));
            json["textures"].as_array_mut().expect("textures").push(json!({"source": 1}));
            let material = json!({"normalTexture": {"index": 1}});
            json["materials"].as_array_mut().expect("materials").push(material);
        });
        let document = Document::from_bytes("model", glb, None, &LoadOptions::default());
        let findings = check_document(&document.expect("a document"), &CheckOptions::default());
        let findings = findings.expect("a valid document");
        let is_alien =
            |finding: &&Finding| finding.code == Code::MapGreenFlipped && finding.place.image == Some(1);
        let green = findings.iter().find(is_alien).expect("the finding");
        // A program that inverts the green of one map does so with others.
        assert_eq!(green.is_fixable(), inverts_green, "{green:?}");
        assert_eq!(green.text.contains("images[0]"), inverts_red, "{green:?}");
        model = baked_models().remove(0);
    }
}

fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let letters = |three: &[u8]| {
        let byte = |i: usize| u32::from(three.get(i).copied().unwrap_or(0));
        let all = byte(0) << 16 | byte(1) << 8 | byte(2);
        let letter = |i: usize| char::from(LETTERS[(all >> (18 - 6 * i) & 63) as usize]);
        let letter_or_end = |i: usize| if i <= three.len() { letter(i) } else { '=' };
        [0, 1, 2, 3].map(letter_or_end)
    };
    bytes.chunks(3).flat_map(letters).collect()
}

/// A negative scale of the normal texture inverts both channels.
#[test]
fn negative_scales_of_normal_textures_are_named() {
    let mut model = model("grid");
    assert!(find(&check(&model), Code::MapScaleNegative).is_none());
    model.normal_scale = -0.5;
    let findings = check(&model);
    let found = find(&findings, Code::MapScaleNegative).expect("the finding");
    assert_eq!((found.severity, found.evidence[0].value), (Severity::Warning, -0.5));
}

/// The normal map of a clear coat is one, too, and the surfaces of all materials of a primitive's variants
/// vote.
#[test]
fn clear_coats_and_variants_are_checked() {
    let mut model = baked_models().remove(0);
    let texels = model.map.texels.iter().map(|[r, g, b]| [255 - r, *g, *b]).collect();
    model.map = model.map.with_texels(texels);
    let errors = |edit: fn(&mut Value)| -> Vec<(Code, Option<usize>)> {
        let glb = with_json(&model.glb(), edit);
        let document = Document::from_bytes("model", glb, None, &LoadOptions::default());
        let findings = check_document(&document.expect("a document"), &CheckOptions::default());
        let findings = findings.expect("a valid document").into_iter();
        let errors = findings.filter(|finding| finding.severity == Severity::Error);
        errors.map(|finding| (finding.code, finding.place.material)).collect()
    };
    let coat = |json: &mut Value| {
        let texture = json["materials"][0]["normalTexture"].take();
        json["materials"][0] =
            json!({"extensions": {"KHR_materials_clearcoat": {"clearcoatNormalTexture": texture}}});
    };
    assert_eq!(errors(coat), [(Code::MapRedFlipped, Some(0))]);
    let variant = |json: &mut Value| {
        let map = json["materials"][0].take();
        json["materials"] = json!([{}, map]);
        for primitive in json["meshes"][0]["primitives"].as_array_mut().expect("primitives") {
            primitive["extensions"] =
                json!({"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]}]}});
        }
    };
    assert_eq!(errors(variant), [(Code::MapRedFlipped, Some(1))]);
}

/// What a vertex on a mirrored seam damages is the side whose sign it does not have, whether or not the signs
/// of the whole surface are flipped.
#[test]
fn flipped_signs_damage_no_more_at_mirrored_seams() {
    let mistake = MISTAKES.iter().find(|mistake| mistake.code == Code::TangentSharedAcrossMirror);
    let mistake = mistake.expect("a mistake for every code");
    let damaged_percent = |model: &Model| {
        let findings = check_document(&model.document(), &without_maps()).expect("a valid document");
        let found = findings.iter().find(|finding| finding.code == Code::TangentSharedAcrossMirror);
        let evidence = &found.expect("the mistake is named").evidence;
        evidence.iter().find(|evidence| evidence.what.contains("looks wrong")).map(|evidence| evidence.value)
    };
    let mut count = 0;
    for mut model in healthy_models() {
        if !(mistake.make)(&mut model) {
            continue;
        }
        let unflipped = damaged_percent(&model).expect("a part of the area");
        model.negate_signs();
        let flipped = damaged_percent(&model).expect("a part of the area");
        assert!((unflipped - flipped).abs() < 1e-9, "{}: {unflipped} and {flipped}", model.name);
        count += 1;
    }
    assert!(count > 0);
}
