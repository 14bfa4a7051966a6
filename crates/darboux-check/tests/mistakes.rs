//! Every mistake, made alone on healthy models, is named, and no other error is.

mod support;

use std::collections::BTreeSet;

use darboux_check::{CheckOptions, Code, Finding, Severity, check_document, check_map};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use darboux_tests::maps::table::Truth;
use support::{Model, healthy_map, healthy_models, png};

/// The codes of a model's findings of some severities.
fn codes(findings: &[Finding], is_wanted: impl Fn(Severity) -> bool) -> BTreeSet<Code> {
    findings.iter().filter(|finding| is_wanted(finding.severity)).map(|finding| finding.code).collect()
}

fn check(model: &Model) -> Vec<Finding> {
    check_document(&mut model.document(), &CheckOptions::default()).expect("a valid document")
}

#[test]
fn healthy_models_have_no_error_and_no_warning() {
    for model in healthy_models() {
        let findings = check(&model);
        assert_eq!(
            codes(&findings, |severity| severity > Severity::Info),
            BTreeSet::new(),
            "{}: {findings:#?}",
            model.name
        );
    }
}

/// Changes a healthy model; returns false where the mistake cannot be made on it.
type Mistake = fn(&mut Model) -> bool;

/// All mistakes in geometry and materials. Those in maps are below.
const MISTAKES: &[(Code, Mistake)] = &[
    (Code::TangentNotFinite, |model| {
        model.tangents()[1][0] = f32::NAN;
        true
    }),
    (Code::TangentZero, |model| {
        model.tangents()[1] = [0.0, 0.0, 0.0, 1.0];
        true
    }),
    (Code::TangentNotUnit, |model| {
        model.tangents().iter_mut().for_each(|tangent| (0..3).for_each(|i| tangent[i] *= 1.5));
        true
    }),
    (Code::TangentNotPerpendicular, |model| {
        let normals = model.normals.clone().unwrap_or_default();
        for (tangent, normal) in model.tangents().iter_mut().zip(normals) {
            (0..3).for_each(|i| tangent[i] = 0.8 * tangent[i] + 0.6 * normal[i]);
        }
        true
    }),
    (Code::TangentSignNotOne, |model| {
        model.tangents().iter_mut().for_each(|tangent| tangent[3] *= 0.5);
        true
    }),
    (Code::TangentSharedAcrossMirror, |model| {
        let Some((positions, normals, uvs, tangents, indices)) = model.unsplit.clone() else { return false };
        model.positions = positions;
        model.normals = Some(normals);
        model.uvs = vec![uvs];
        model.tangents = Some(tangents);
        model.indices = indices;
        true
    }),
    (Code::TangentSignFlipped, |model| {
        model.tangents().iter_mut().for_each(|tangent| tangent[3] = -tangent[3]);
        true
    }),
    (Code::TangentSignFlippedWhereMirrored, |model| {
        model.tangents().iter_mut().for_each(|tangent| tangent[3] = 1.0);
        model.unsplit.is_some()
    }),
    (Code::TangentRotated, |model| {
        let normals = model.normals.clone().unwrap_or_default();
        for (tangent, [a, b, c]) in model.tangents().iter_mut().zip(normals) {
            let [x, y, z, w] = *tangent;
            *tangent = [w * (b * z - c * y), w * (c * x - a * z), w * (a * y - b * x), w];
        }
        true
    }),
    (Code::TangentNegated, |model| {
        model.tangents().iter_mut().for_each(|tangent| (0..3).for_each(|i| tangent[i] = -tangent[i]));
        true
    }),
    (Code::TangentOtherUvSet, |model| {
        if model.unsplit.is_some() {
            return false;
        }
        // The texture uses a second set, turned by 40 degrees; the tangents follow the first.
        let turned = |[u, v]: &[f32; 2]| [0.766 * u - 0.643 * v, 0.643 * u + 0.766 * v];
        let second = model.uvs[0].iter().map(turned).collect();
        model.uvs.push(second);
        model.uv_set = 1;
        true
    }),
    (Code::TangentMissing, |model| {
        model.tangents = None;
        true
    }),
    (Code::TangentUnused, |model| {
        model.has_normal_map = false;
        true
    }),
    (Code::NormalMissing, |model| {
        model.normals = None;
        true
    }),
    (Code::NormalNotFinite, |model| {
        model.normals.iter_mut().for_each(|normals| normals[1][2] = f32::INFINITY);
        true
    }),
    (Code::NormalNotUnit, |model| {
        model.normals.iter_mut().flatten().for_each(|normal| *normal = normal.map(|x| 0.5 * x));
        true
    }),
    (Code::NormalAgainstWinding, |model| {
        model.indices.as_chunks_mut::<3>().0.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        true
    }),
    (Code::UvMissing, |model| {
        model.uv_set = 3;
        true
    }),
    (Code::UvDegenerate, |model| {
        let vertices: Vec<usize> = model.indices[..3].iter().map(|&vertex| vertex as usize).collect();
        let uv = model.uvs[0][vertices[0]];
        vertices.into_iter().for_each(|vertex| model.uvs[0][vertex] = uv);
        true
    }),
    (Code::TransformMirrors, |model| {
        model.transform = Some([1.0, -1.0]);
        true
    }),
];

#[test]
fn every_mistake_is_named_and_no_other_error() {
    let models = healthy_models();
    assert!(models.len() >= 10, "{} models", models.len());
    for (code, make) in MISTAKES {
        let mut made = 0;
        for model in &models {
            let mut model = model.clone();
            if !make(&mut model) {
                continue;
            }
            made += 1;
            let findings = check(&model);
            let all = codes(&findings, |_| true);
            assert!(all.contains(code), "{code} on {}: {findings:#?}", model.name);
            let errors = codes(&findings, |severity| severity == Severity::Error);
            let others: Vec<&Code> = errors.iter().filter(|other| *other != code).collect();
            assert!(others.is_empty(), "{code} on {} also gives {others:?}: {findings:#?}", model.name);
        }
        println!("{code}: named on {made} models");
        assert!(made > 0, "{code}");
    }
}

/// Each mistake in maps, as a change of the texels, and the codes that may come with it.
#[test]
fn every_mistake_in_maps_is_named_and_no_other_error() {
    let (case, map) = healthy_map();
    let side = case.side as u32;
    let through = |function: fn([f32; 3]) -> [f32; 3]| -> Vec<[u8; 3]> {
        let change = |texel: &[u8; 3]| {
            function(texel.map(|byte| f32::from(byte) / 255.0)).map(|x| (255.0 * x).round() as u8)
        };
        map.iter().map(change).collect()
    };
    let specks = || {
        let mut texels = map.clone();
        texels.iter_mut().step_by(900).for_each(|texel| texel[2] = 60);
        texels
    };
    let photograph = || -> Vec<[u8; 3]> {
        (0..map.len()).map(|i| [(i % 251) as u8 / 3, (i / 7 % 241) as u8 / 2, (i / 256) as u8 / 2]).collect()
    };
    let maps: Vec<(Code, Vec<[u8; 3]>)> = vec![
        (Code::MapGreenFlipped, through(|[r, g, b]| [r, 1.0 - g, b])),
        (Code::MapChannelsSwapped, through(|[r, g, b]| [g, r, b])),
        (Code::MapSrgb, through(|texel| texel.map(|x| x.powf(1.0 / 2.2)))),
        (Code::MapSrgb, through(|texel| texel.map(|x| x.powf(2.2)))),
        (Code::MapHeight, through(|[r, ..]| [r; 3])),
        (Code::MapObjectSpace, Truth::ObjectSpace.texels(&case)),
        (Code::MapNotNormal, photograph()),
        (Code::MapTwoChannel, through(|[r, g, _]| [r, g, 0.0])),
        (Code::MapTwoChannel, through(|[r, g, _]| [r, g, 1.0])),
        (Code::MapNotUnit, through(|texel| texel.map(|x| 0.5 + 0.8 * (x - 0.5)))),
        (Code::MapNegativeZ, specks()),
        (Code::MapFlatOff, through(|[r, g, b]| [r - 4.0 / 255.0, g, b])),
        (Code::MapFlat, vec![[128, 128, 255]; map.len()]),
    ];
    for (code, texels) in maps {
        let findings = check_map(&png(side, &texels), &CheckOptions::default()).findings;
        assert!(codes(&findings, |_| true).contains(&code), "{code}: {findings:#?}");
        let errors = codes(&findings, |severity| severity == Severity::Error);
        assert!(errors.iter().all(|other| *other == code), "{code}: {findings:#?}");
    }
    let mut file = png(side, &map);
    assert_eq!(check_map(&file, &CheckOptions::default()).findings, []);
    file.truncate(file.len() / 2);
    for broken in [file, Vec::new(), b"no image".to_vec()] {
        let findings = check_map(&broken, &CheckOptions::default()).findings;
        assert_eq!(codes(&findings, |_| true), BTreeSet::from([Code::MapUnreadable]));
    }
}

/// Primitives without positions are not drawn.
#[test]
fn primitives_without_positions_are_left_out() {
    let json = r#"{"asset": {"version": "2.0"},
        "meshes": [{"primitives": [{"attributes": {"NORMAL": 0}, "indices": 1}]}],
        "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3"},
            {"componentType": 5125, "count": 3, "type": "SCALAR"}]}"#;
    let document = Document::from_bytes("normals", json.into(), None, &LoadOptions::default());
    let findings = check_document(&mut document.expect("a valid document"), &CheckOptions::default());
    assert_eq!(findings.expect("a valid document"), []);
}

#[test]
fn instances_with_the_same_data_are_reported_once() {
    let mut model = healthy_models().remove(0);
    model.tangents = None;
    model.copies = 3;
    let findings = check(&model);
    let missing: Vec<&Finding> =
        findings.iter().filter(|finding| finding.code == Code::TangentMissing).collect();
    assert_eq!(missing.len(), 1, "{findings:#?}");
    assert_eq!(missing[0].place.same_as, 2);
}

#[test]
fn names_are_distinct_and_parse() {
    let names: BTreeSet<&str> = Code::ALL.iter().map(|code| code.name()).collect();
    assert_eq!(names.len(), Code::ALL.len());
    assert!(Code::ALL.iter().all(|code| code.name().parse() == Ok(*code)));
    assert!("tangent".parse::<Code>().is_err());
    let made: BTreeSet<Code> = MISTAKES.iter().map(|(code, _)| *code).collect();
    let in_maps = |code: &&Code| !code.name().starts_with("map-");
    // Mirrored UVs are no mistake; the other two need other tangents than those of the list.
    let rest = [Code::UvMirrored, Code::TangentOtherRecipe, Code::TangentSignMixed];
    let without: Vec<&Code> = Code::ALL.iter().filter(in_maps).filter(|code| !made.contains(code)).collect();
    assert!(without.iter().all(|code| rest.contains(code)), "{without:?}");
}
