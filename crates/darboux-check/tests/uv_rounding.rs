//! UVs that were rounded are named by what that turns, and those that lie on a grid by design are not.

mod support;

use darboux::Method;
use darboux_check::{Code, Finding, FixOptions, Severity, check_document, fix_document};
use support::models::{Model, healthy_models};
use support::table::without_maps;

/// A fine curved sheet, bent in UV space.
fn sheet() -> Model {
    let mut models = healthy_models().into_iter();
    let mut model = models.find(|model| model.name == "large wavy grid").expect("a model of this name");
    for uv in &mut model.uvs[model.uv_set] {
        let [x, y] = uv.map(|x| 0.5 + x);
        *uv = [(x * x - y * y) / 3.0, 2.0 * x * y / 3.0];
    }
    model.tangents = Some(model.computed(Method::default(), model.uv_set));
    model
}

/// The same with UVs in steps of 1 / `steps`, and with tangents of these.
fn rounded(model: &Model, steps: f32) -> Model {
    let mut rounded = model.clone();
    rounded.uvs[model.uv_set].iter_mut().for_each(|uv| *uv = uv.map(|x| (x * steps).round() / steps));
    rounded.tangents = Some(rounded.computed(Method::default(), model.uv_set));
    rounded
}

fn found(model: &Model) -> Option<Finding> {
    let findings = check_document(&model.document(), &without_maps()).expect("a valid document");
    findings.into_iter().find(|finding| finding.code == Code::UvRounded)
}

/// The largest angle between the tangents of two models that a part of the vertices exceeds, in degrees.
fn turned(a: &Model, b: &Model, part: f64) -> f64 {
    let tangents = |model: &Model| model.tangents.clone().expect("tangents");
    let pairs = tangents(a).into_iter().zip(tangents(b));
    let cosine = pairs.map(|(a, b)| (0..3).map(|i| f64::from(a[i]) * f64::from(b[i])).sum::<f64>());
    let mut angles: Vec<f64> = cosine.map(|cosine| cosine.clamp(-1.0, 1.0).acos().to_degrees()).collect();
    angles.sort_by(|a, b| b.total_cmp(a));
    angles[(part * angles.len() as f64) as usize]
}

#[test]
fn rounding_is_named_by_what_it_turns() {
    let sheet = sheet();
    assert_eq!(found(&sheet), None);
    for (steps, severity) in
        [(30.0, Some(Severity::Warning)), (100.0, Some(Severity::Info)), (1000.0, None), (65535.0, None)]
    {
        let rounded = rounded(&sheet, steps);
        let found = found(&rounded);
        assert_eq!(found.as_ref().map(|finding| finding.severity), severity, "{steps}: {found:#?}");
        let Some(found) = found else { continue };
        // The vertices average what half a step turns single triangles by.
        let (said, real) = (found.evidence[1].value, turned(&sheet, &rounded, 0.1));
        assert!((0.2..1.0).contains(&(real / said)), "{steps}: {said} degrees are said, {real} are real");
    }
}

/// What was computed before the rounding is right.
#[test]
fn tangents_that_are_older_than_the_rounding_do_not_suffer() {
    let sheet = sheet();
    let mut rounded = rounded(&sheet, 40.0);
    rounded.tangents = sheet.tangents;
    assert_eq!(found(&rounded), None);
    // New tangents would be worse than these.
    let mut document = rounded.document();
    let findings = check_document(&document, &without_maps()).expect("a valid document");
    assert!(findings.iter().all(|finding| finding.severity < Severity::Error), "{findings:#?}");
    let recipe = findings.iter().find(|finding| finding.code == Code::TangentOtherRecipe);
    assert!(recipe.is_some_and(|finding| !finding.is_fixable()), "{recipe:#?}");
    let options = FixOptions::default().with_check(without_maps());
    assert!(!fix_document(&mut document, findings, &options).expect("a repair").is_changed);
    rounded.tangents = None;
    assert!(found(&rounded).is_some());
}

/// Whole numbers of texels, rings of a sphere and rows of a plane.
#[test]
fn grids_by_design_are_healthy() {
    for healthy in healthy_models() {
        assert_eq!(found(&healthy), None, "{}", healthy.name);
        for steps in [64.0, 255.0, 4095.0] {
            let mut model = healthy.clone();
            let uvs = &mut model.uvs[model.uv_set];
            let mut values: Vec<f32> = uvs.iter().map(|uv| uv[1]).collect();
            values.sort_by(f32::total_cmp);
            values.dedup();
            // The rows of a plane are where they were, in steps.
            if values.len() < 24 {
                uvs.iter_mut().for_each(|uv| uv[1] = (uv[1] * steps).round() / steps);
                model.tangents = Some(model.computed(Method::default(), model.uv_set));
                assert_eq!(found(&model), None, "{}, {steps} steps", model.name);
            }
        }
    }
}
