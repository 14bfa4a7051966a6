//! The part of a surface whose signs are flipped is told by area and not by the number of triangles: an
//! ornament has many small ones.

mod support;

use darboux::Method;
use darboux_check::{CheckOptions, Code, Finding, FixOptions, Severity, check_document, fix_document};
use support::models::{Model, healthy_models};

/// A model whose triangles are an ornament, each 0.003 times as long as it was, but the first `large` ones.
fn with_ornament(large: usize) -> Model {
    let mut model = healthy_models().remove(2);
    assert_eq!(model.name, "unindexed grid");
    for triangle in model.positions.as_chunks_mut::<3>().0.iter_mut().skip(large) {
        let [first, others @ ..] = triangle;
        for position in others {
            *position = std::array::from_fn(|i| first[i] + 0.003 * (position[i] - first[i]));
        }
    }
    model.tangents = Some(model.computed(Method::default(), model.uv_set));
    model
}

/// Flips the signs of the ornament, or of the large triangles.
fn flip(model: &mut Model, large: usize, is_ornament: bool) {
    for (vertex, tangent) in model.tangents().iter_mut().enumerate() {
        if (vertex / 3 >= large) == is_ornament {
            tangent[3] = -tangent[3];
        }
    }
}

fn check(model: &Model) -> Vec<Finding> {
    check_document(&model.document(), &CheckOptions::default()).expect("a valid document")
}

fn find(findings: &[Finding], code: Code) -> Option<&Finding> {
    findings.iter().find(|finding| finding.code == code)
}

#[test]
fn inverted_green_looks_right_where_the_signs_of_nearly_all_of_the_area_are_flipped() {
    for (large, is_ornament) in [(8, true), (8, false), (2, true), (2, false)] {
        let mut model = with_ornament(large);
        assert!(check(&model).iter().all(|finding| finding.severity <= Severity::Warning));
        flip(&mut model, large, is_ornament);
        model.map = model.map.through(|[r, g, b]| [r, 1.0 - g, b]);
        let findings = check(&model);
        let pair = find(&findings, Code::ConventionsCancel);
        assert_eq!(pair.is_none(), is_ornament, "{large}: {findings:#?}");
        // On the ornament nothing cancels the map, but that is too small to be an error.
        assert!(pair.is_none_or(|pair| pair.severity == Severity::Warning), "{findings:#?}");
        let green = find(&findings, Code::MapGreenFlipped);
        assert_eq!(green.is_some(), is_ornament, "{large}: {findings:#?}");
        let mut document = model.document();
        fix_document(&mut document, findings, &FixOptions::default()).expect("a repair");
        assert_eq!(document.is_changed(), !is_ornament, "what is not identified is left");
    }
}

#[test]
fn flipped_signs_of_an_ornament_are_no_error() {
    for large in [8, 2] {
        for is_ornament in [true, false] {
            let mut model = with_ornament(large);
            flip(&mut model, large, is_ornament);
            let findings = check(&model);
            assert!(find(&findings, Code::TangentSignFlipped).is_none(), "{findings:#?}");
            let flipped = find(&findings, Code::TangentSignPartlyFlipped).expect("the finding");
            let expected = if is_ornament { Severity::Warning } else { Severity::Error };
            assert_eq!(flipped.severity, expected, "{large}, {is_ornament}: {flipped:#?}");
            // Whichever way its green points, the picture is right on nearly all of the area.
            model.map.file = b"\0\0\0\x20ftypavif and more".to_vec();
            let findings = check(&model);
            let flipped = find(&findings, Code::TangentSignPartlyFlipped).expect("the finding");
            assert_eq!(flipped.severity, Severity::Warning, "{large}, {is_ornament}: {flipped:#?}");
        }
    }
}
