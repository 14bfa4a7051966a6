//! Every mistake, made alone on healthy models, is named, no other error is, and the repair makes the healthy
//! model of it.

mod support;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use darboux_check::{
    CheckOptions, Code, Finding, FixOptions, Severity, check_document, check_map, fix_document,
};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use support::baked::{self, BAKED_MISTAKES, baked_models};
use support::flips::{FLIPS, named};
use support::maps::MAP_MISTAKES;
use support::mistakes::MISTAKES;
use support::models::{Model, healthy_models};
use support::page::{PAIRS, page};
use support::table::{Row, codes, repaired_model, table, without_maps};

fn check(model: &Model) -> Vec<Finding> {
    check_document(&model.document(), &CheckOptions::default()).expect("a valid document")
}

#[test]
fn healthy_models_have_no_error_and_no_warning() {
    for model in healthy_models() {
        let findings = check(&model);
        let bad = codes(&findings, |severity| severity > Severity::Info);
        assert_eq!(bad, BTreeSet::new(), "{}: {findings:#?}", model.name);
    }
}

/// Maps that were baked for their models have no error, and the facets of a model say nothing about other
/// maps.
#[test]
fn baked_maps_have_no_error() {
    for model in baked_models() {
        let findings = check(&model);
        let bad = codes(&findings, |severity| severity == Severity::Error);
        assert_eq!(bad, BTreeSet::new(), "{}: {findings:#?}", model.name);
    }
}

#[test]
fn every_mistake_is_named_alone_and_repaired() {
    let rows: Vec<Row> = table().into_iter().chain(baked::rows()).collect();
    let failures: Vec<&String> = rows.iter().flat_map(|row| &row.failures).collect();
    assert!(failures.is_empty(), "{failures:#?}");
    for row in &rows {
        assert!(row.models >= 10, "{}, {}: {} models", row.code, row.how, row.models);
        assert_eq!((row.named, row.with_other_errors), (row.models, 0), "{}", row.code);
        assert!(row.repaired.is_none_or(|repaired| repaired == row.models), "{}", row.code);
    }
    let (path, page) = (Path::new(env!("CARGO_MANIFEST_DIR")).join(PAGE), page(&rows));
    let committed = fs::read_to_string(&path).unwrap_or_default();
    let (mistakes, pairs) = committed.split_once(PAIRS).unwrap_or_default();
    if std::env::var_os("WRITE_PAGES").is_some() {
        fs::write(&path, format!("{page}{PAIRS}{pairs}")).expect("the page can be written");
    } else {
        assert!(mistakes == page, "{PAGE} is not what is found now; write it again with WRITE_PAGES=1");
    }
}

/// Nothing says whether the map was baked with the method that made the tangents: only the user who names the
/// code has them made again.
#[test]
fn tangents_of_a_known_method_are_left_unless_their_code_is_named() {
    let code = Code::TangentOtherRecipe;
    let mistake = MISTAKES.iter().find(|mistake| mistake.code == code).expect("the mistake");
    let mut count = 0;
    for healthy in healthy_models() {
        let mut model = healthy.clone();
        if !(mistake.make)(&mut model) {
            continue;
        }
        count += 1;
        let findings = check_document(&model.document(), &without_maps()).expect("a valid document");
        let left = findings.iter().find(|finding| finding.code == code).expect("the finding");
        let reason = left.left_because.as_deref().unwrap_or_default();
        assert!(reason.contains("--only tangent-other-recipe"), "{}: {reason}", model.name);
        assert!(left.cure.contains("--fix --only tangent-other-recipe"), "{}: {}", model.name, left.cure);
        let options = FixOptions::default().with_check(without_maps());
        for left in [options.clone(), options.clone().without_codes([Code::MapFlat])] {
            let mut document = model.document();
            let fixed = fix_document(&mut document, findings.clone(), &left).expect("a repair");
            assert!(!fixed.is_changed && !document.is_changed(), "{}: {fixed:#?}", model.name);
            assert!(findings.iter().all(|finding| !finding.is_fixable()), "{}: {findings:#?}", model.name);
        }
        let named = options.with_codes([code]);
        let fixed = fix_document(&mut model.document(), findings.clone(), &named).expect("a repair");
        let repaired = fixed.findings.iter().find(|fixed| fixed.finding.code == code).expect("the finding");
        assert!(repaired.repaired && repaired.finding.left_because.is_none(), "{repaired:#?}");
        assert!(
            repaired.was_fixable() && named.with_reasons(findings.clone()).iter().any(Finding::is_fixable)
        );
        assert_eq!(repaired_model(&model, findings, &healthy, &named), Ok(()), "{}", model.name);
    }
    assert_eq!(count, 17);
}

/// The page of the table.
const PAGE: &str = "../../docs/check-mistakes.md";

/// Each of the six flips of handedness is named in its own way, except that the UV origin looks like the sign
/// w.
#[test]
fn flips_of_handedness_are_told_apart() {
    for healthy in healthy_models().iter().step_by(5) {
        for flip in FLIPS {
            let expected: BTreeSet<Code> = flip.codes.iter().copied().collect();
            assert_eq!(named(flip, healthy), expected, "{} on {}", flip.name, healthy.name);
        }
    }
    let mut distinct: Vec<&[Code]> = FLIPS.iter().map(|flip| flip.codes).collect();
    distinct.sort_unstable();
    distinct.dedup();
    assert_eq!(distinct.len(), FLIPS.len() - 1);
}

/// Half of the faces are reversed, so that no majority shows it.
#[test]
fn reversed_parts_are_named() {
    for healthy in healthy_models() {
        let mut model = healthy.clone();
        model.add_reversed_copy();
        let findings = check_document(&model.document(), &without_maps()).expect("a valid document");
        let errors = codes(&findings, |severity| severity > Severity::Info);
        assert_eq!(errors, BTreeSet::from([Code::NormalAgainstWinding]), "{}: {findings:#?}", model.name);
        let found = findings.iter().find(|finding| finding.code == Code::NormalAgainstWinding);
        let found = found.expect("the finding");
        assert_eq!((found.count, found.severity), (healthy.indices.len() / 3, Severity::Error));
        assert!(found.text.contains("connected part") && !found.is_fixable(), "{}", found.text);
    }
}

/// Normals of a part of a smooth surface, or of scattered vertices, which are in triangles with normals on
/// both sides.
#[test]
fn reversed_normals_of_some_vertices_are_named() {
    for healthy in healthy_models() {
        let count = healthy.positions.len();
        let chosen: [fn(usize, usize) -> bool; 3] = [
            |vertex, count| 3 * vertex < count,
            |vertex, _| vertex % 5 == 0,
            |vertex, count| vertex == count / 2,
        ];
        for is_chosen in chosen {
            let mut model = healthy.clone();
            let normals = model.normals.as_mut().expect("normals");
            let is_at = |other: usize| {
                (0..count).any(|vertex| {
                    is_chosen(vertex, count) && healthy.positions[vertex] == healthy.positions[other]
                })
            };
            let reversed: Vec<bool> = (0..count).map(is_at).collect();
            // Most of a model of few vertices is its majority.
            if 2 * reversed.iter().filter(|reversed| **reversed).count() >= count {
                continue;
            }
            let of_vertices = normals.iter_mut().zip(&reversed).filter(|(_, reversed)| **reversed);
            of_vertices.for_each(|(normal, _)| *normal = normal.map(|x| -x));
            let findings = check_document(&model.document(), &without_maps()).expect("a valid document");
            let bad = codes(&findings, |severity| severity > Severity::Info);
            assert_eq!(bad, BTreeSet::from([Code::NormalAgainstWinding]), "{}: {findings:#?}", model.name);
            let triangles = healthy.indices.as_chunks::<3>().0.iter();
            let expected =
                triangles.filter(|triangle| triangle.iter().any(|&vertex| reversed[vertex as usize]));
            let found = findings
                .iter()
                .find(|finding| finding.code == Code::NormalAgainstWinding)
                .expect("the finding");
            assert_eq!(found.count, expected.count(), "{}: {}", model.name, found.text);
            assert!(!found.is_fixable(), "{}", found.text);
        }
    }
}

#[test]
fn broken_images_are_named() {
    let mut file = healthy_models().remove(0).map.file;
    assert_eq!(check_map(&file, &CheckOptions::default()).findings, []);
    file.truncate(file.len() / 2);
    for broken in [file, Vec::new(), b"no image".to_vec()] {
        let findings = check_map(&broken, &CheckOptions::default()).findings;
        assert_eq!(codes(&findings, |_| true), BTreeSet::from([Code::MapUnreadable]));
        assert_eq!(
            (findings[0].evidence[0].value, findings[0].evidence[0].unit),
            (broken.len() as f64, "bytes")
        );
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
    let findings = check_document(&document.expect("a valid document"), &CheckOptions::default());
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
fn names_are_distinct_and_parse_and_every_mistake_is_in_the_table() {
    let names: BTreeSet<&str> = Code::ALL.iter().map(|code| code.name()).collect();
    assert_eq!(names.len(), Code::ALL.len());
    assert!(Code::ALL.iter().all(|code| code.name().parse() == Ok(*code)));
    assert!("tangent".parse::<Code>().is_err());
    let in_models = MISTAKES.iter().map(|mistake| mistake.code);
    let in_maps = MAP_MISTAKES.iter().map(|mistake| mistake.code);
    let in_baked_maps = BAKED_MISTAKES.iter().map(|mistake| mistake.code);
    let made: BTreeSet<Code> = in_models.chain(in_maps).chain(in_baked_maps).collect();
    // Mirrored UVs are no mistake, and a broken file is none in a map's texels. Two conventions that cancel
    // are made in undecided.rs, other layouts in layouts.rs, detail of another convention in maps.rs, and
    // reliefs on faces in reliefs.rs.
    let made_elsewhere =
        [Code::ConventionsCancel, Code::MapOtherLayout, Code::MapDetailFlipped, Code::MapMayBeDents];
    let rest = [Code::UvMirrored, Code::UvOverlapping, Code::MapUnreadable];
    let without: Vec<&Code> = Code::ALL.iter().filter(|code| !made.contains(code)).collect();
    assert!(without.iter().all(|code| rest.contains(code) || made_elsewhere.contains(code)), "{without:?}");
}

/// Rounding can flip the u direction of a triangle that is thin in UV space. Its tangents are right, or as
/// good as any.
#[test]
fn slivers_do_not_make_tangents_wrong() {
    let mut model = healthy_models().remove(1);
    let vertices = model.detach_first_face();
    let uvs = &mut model.uvs[model.uv_set];
    let [least, largest] = [f32::min, f32::max]
        .map(|choose| vertices.iter().map(|&vertex| uvs[vertex][0]).reduce(choose).expect("three vertices"));
    for vertex in vertices {
        let is_largest = uvs[vertex][0] == largest;
        uvs[vertex][0] = if is_largest { least - 0.001 * (largest - least) } else { least };
    }
    let findings = check(&model);
    assert!(findings.iter().all(|finding| finding.code != Code::TangentNegated), "{findings:#?}");
}
