//! The repair of single tangents leaves all others as they are, bit for bit, whatever recipe they come from.

mod support;

use darboux::{Choice, Method};
use darboux_check::{
    CheckOptions, Code, Finding, FixOptions, FixedFinding, Severity, check_document, fix_document,
};
use darboux_io::gltf::Document;
use support::mistakes::{MISTAKES, Mistake};
use support::models::{Model, healthy_models};
use support::table::without_maps;

/// Spoils a tangent.
type Damage = fn(&mut [f32; 4]);

/// Mistakes in one tangent. The last two leave its direction.
const DAMAGE: [(Code, Damage); 4] = [
    (Code::TangentNotFinite, |tangent| tangent[0] = f32::NAN),
    (Code::TangentZero, |tangent| tangent[..3].fill(0.0)),
    (Code::TangentSignNotOne, |tangent| tangent[3] = 0.0),
    (Code::TangentNotUnit, |tangent| tangent[..3].iter_mut().for_each(|x| *x *= 1.5)),
];

fn named(name: &str) -> Model {
    healthy_models().into_iter().find(|model| model.name == name).expect("a healthy model of that name")
}

fn fixed(document: &mut Document, codes: impl IntoIterator<Item = Code>) -> Vec<FixedFinding> {
    let findings = check_document(document, &CheckOptions::default()).expect("a valid document");
    let options = FixOptions::default().with_check(without_maps()).with_codes(codes);
    fix_document(document, findings, &options).expect("a valid document").findings
}

/// All codes but the one that keeps the recipe.
fn without_recipe() -> impl Iterator<Item = Code> {
    Code::ALL.iter().copied().filter(|code| *code != Code::TangentOtherRecipe)
}

/// The tangents of corners.
fn tangents(document: &Document) -> Vec<[f32; 4]> {
    let corners = document.corners().expect("valid indices");
    let of =
        |corners: &darboux_io::gltf::PrimitiveCorners<'_>| corners.vectors::<4>("TANGENT").expect("tangents");
    corners.iter().flat_map(|corners| of(corners).unwrap_or_default()).collect()
}

fn distance(a: [f32; 4], b: [f32; 4]) -> f32 {
    (0..4).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max)
}

#[test]
fn only_the_wrong_tangents_of_another_recipe_change() {
    let healthy = named("wavy sphere");
    let recipes = [
        ("averages by area", healthy.computed(Method::Area, healthy.uv_set)),
        ("MikkTSpace", healthy.tangents.clone().expect("tangents")),
    ];
    for (recipe, tangents_of_recipe) in recipes {
        let of_recipe = Model { tangents: Some(tangents_of_recipe), ..healthy.clone() };
        let before = tangents(&of_recipe.document());
        for (code, damage) in DAMAGE {
            let mut model = of_recipe.clone();
            let wrong: Vec<usize> = (0..5).map(|i| 7 + 11 * i).collect();
            wrong.iter().for_each(|&vertex| damage(&mut model.tangents()[vertex]));
            let mut document = model.document();
            let findings = fixed(&mut document, without_recipe());
            let repaired = findings.iter().any(|fixed| fixed.finding.code == code && fixed.repaired);
            assert!(repaired, "{recipe}, {code}: {findings:#?}");
            let after = tangents(&document);
            for (corner, (old, new)) in before.iter().zip(&after).enumerate() {
                let is_wrong = wrong.contains(&(model.indices[corner] as usize));
                let is_same = old.map(f32::to_bits) == new.map(f32::to_bits);
                assert!(is_same || is_wrong, "{recipe}, {code}: corner {corner} changed");
                // The recipe is recognised, so that the new ones are those that were there before, up to
                // rounding.
                assert!(is_same || distance(*old, *new) < 1e-5, "{recipe}, {code}: corner {corner}");
            }
        }
    }
}

/// The mistakes whose repair tells how the other tangents were made.
fn is_corrected(mistake: &Mistake) -> bool {
    let others = [
        Code::TangentOtherRecipe,
        Code::TangentOtherUvSet,
        Code::TangentRotated,
        Code::TangentMissing,
        Code::TangentUnused,
        // It brings MikkTSpace's tangents with it.
        Code::TangentSharedAcrossMirror,
    ];
    mistake.code.is_about_tangents() && !others.contains(&mistake.code)
}

/// The map may have been baked with the known method of tangents: the repair of every other mistake keeps it,
/// and nothing that is called fixable is left.
#[test]
fn the_repair_of_other_mistakes_keeps_a_known_method() {
    let (mut count, options) = (0, FixOptions::default().with_check(without_maps()));
    for method in [Method::Area, Method::AngleEdge, Method::Lengyel, Method::LengyelPerVertex] {
        for healthy in healthy_models() {
            let of_method =
                Model { tangents: Some(healthy.computed(method, healthy.uv_set)), ..healthy.clone() };
            let findings = check_document(&of_method.document(), &options.check).expect("a valid document");
            let severe: Vec<Code> = findings
                .iter()
                .filter(|finding| finding.severity > Severity::Info)
                .map(|finding| finding.code)
                .collect();
            if severe != [Code::TangentOtherRecipe] {
                continue;
            }
            let before = tangents(&of_method.document());
            for mistake in MISTAKES.iter().filter(|mistake| is_corrected(mistake)) {
                let mut model = of_method.clone();
                if !(mistake.make)(&mut model) {
                    continue;
                }
                count += 1;
                let what = format!("{} on {} of {}", mistake.how, model.name, method.name());
                let mut document = model.document();
                let findings = check_document(&document, &options.check).expect("a valid document");
                fix_document(&mut document, findings, &options).expect("a repair");
                let left = check_document(&document, &options.check).expect("a valid document");
                let fixable: Vec<_> = left.iter().filter(|finding| finding.is_fixable()).collect();
                assert!(fixable.is_empty(), "{what}: {fixable:#?}");
                let is_left = |finding: &&Finding| finding.code == Code::TangentOtherRecipe;
                let reason = left.iter().find(is_left).and_then(|finding| finding.left_because.as_deref());
                assert!(reason.is_some_and(|reason| reason.contains("--only")), "{what}: {left:#?}");
                // At a pole, the method's own tangent may point against MikkTSpace's; a tenth of a degree is
                // the tolerance of recipes.
                let after = tangents(&document);
                let far = before.iter().zip(&after).filter(|(old, new)| distance(**old, **new) > 0.002);
                assert!(200 * far.count() <= before.len(), "{what}");
            }
        }
    }
    assert!(count > 300, "{count} mistakes");
}

/// Turns a tangent around its normal.
fn turn(model: &mut Model, vertex: usize, degrees: f32) {
    let n = model.normals.as_ref().expect("normals")[vertex];
    let [x, y, z, w] = model.tangents()[vertex];
    let across = [n[1] * z - n[2] * y, n[2] * x - n[0] * z, n[0] * y - n[1] * x];
    let (sin, cos) = degrees.to_radians().sin_cos();
    let turned = [cos * x + sin * across[0], cos * y + sin * across[1], cos * z + sin * across[2], w];
    model.tangents()[vertex] = turned;
}

/// No method makes a tangent outside the range of the u directions around it, and one such tangent is enough.
#[test]
fn single_rotated_tangents_among_those_of_a_known_method_are_computed_by_it_again() {
    let options = FixOptions::default().with_check(without_maps());
    for method in [Method::Area, Method::AngleEdge, Method::Lengyel, Method::Average] {
        let healthy = named("large wavy grid");
        let of_method = Model { tangents: Some(healthy.computed(method, healthy.uv_set)), ..healthy.clone() };
        let before = tangents(&of_method.document());
        for degrees in [90.0, -90.0, 45.0, 135.0] {
            let mut model = of_method.clone();
            let vertices = [40, 77, 150];
            vertices.iter().for_each(|&vertex| turn(&mut model, vertex, degrees));
            let what = format!("{degrees} degrees, {}", method.name());
            let mut document = model.document();
            let findings = check_document(&document, &options.check).expect("a valid document");
            let fixable = findings.iter().filter(|finding| finding.is_fixable());
            let named: Vec<(&str, usize)> = fixable.map(|found| (&*found.text, found.count)).collect();
            let are_these = !named.is_empty() && named.iter().all(|(_, count)| *count == 3);
            assert!(are_these, "{what}: {named:#?}");
            fix_document(&mut document, findings, &options).expect("a repair");
            for (corner, (old, new)) in before.iter().zip(tangents(&document)).enumerate() {
                let is_turned = vertices.contains(&(model.indices[corner] as usize));
                assert!(*old == new || is_turned && distance(*old, new) < 1e-5, "{what}: corner {corner}");
            }
        }
    }
}

/// Smaller differences may be those of another version of the method: they are told, and left.
#[test]
fn small_differences_to_a_known_method_are_told_and_left() {
    let healthy = named("large wavy grid");
    let of_method = healthy.computed(Method::Average, healthy.uv_set);
    let mut model = Model { tangents: Some(of_method), ..healthy };
    (0..model.positions.len()).step_by(20).for_each(|vertex| turn(&mut model, vertex, 15.0));
    let mut document = model.document();
    let findings = check_document(&document, &without_maps()).expect("a valid document");
    let found = findings.iter().find(|finding| finding.code == Code::TangentOtherRecipe);
    let found = found.expect("the finding");
    assert!(found.text.contains("(Maya), but some differ") && !found.is_fixable(), "{found:#?}");
    let largest = found.evidence.iter().find(|evidence| evidence.what == "largest angle to that method");
    assert!(largest.is_some_and(|largest| (largest.value - 15.0).abs() < 0.2), "{largest:?}");
    let options = FixOptions::default().with_check(without_maps());
    fix_document(&mut document, findings, &options).expect("a repair");
    assert!(!document.is_changed());
}

/// The map may have been baked with tangents of no known method, unless many of them point to wrong
/// directions; what other parts of the model look like does not decide that.
#[test]
fn tangents_of_no_known_method_are_left_unless_many_are_far() {
    let options = FixOptions::default().with_check(without_maps());
    for (degrees, severity) in [(17.0, Severity::Warning), (60.0, Severity::Error)] {
        let mut model = named("large wavy grid");
        for vertex in 0..model.positions.len() {
            turn(&mut model, vertex, degrees * (vertex as f32).sin());
        }
        let mut document = model.document();
        let findings = check_document(&document, &options.check).expect("a valid document");
        let found = findings.iter().find(|finding| finding.code == Code::TangentOtherRecipe);
        let found = found.expect("the finding");
        let is_repaired = severity == Severity::Error;
        assert_eq!((found.severity, found.is_fixable()), (severity, is_repaired), "{found:#?}");
        assert_eq!(found.cure.starts_with("Keep them"), !is_repaired, "{}", found.cure);
        fix_document(&mut document, findings, &options).expect("a repair");
        assert_eq!(document.is_changed(), is_repaired);
    }
}

/// Tangents of a method that were written through an index list are those of the method again.
#[test]
fn a_known_method_is_kept_where_vertices_are_split() {
    let healthy = named("mirrored sheared wavy grid");
    let of_method = healthy.computed(Method::Area, healthy.uv_set);
    let expected = tangents(&Model { tangents: Some(of_method), ..healthy.clone() }.document());
    let mut model = healthy;
    let (positions, normals, uvs, _, indices) = model.unsplit.clone().expect("an unsplit mesh");
    (model.positions, model.normals, model.uvs) = (positions, Some(normals), uvs);
    (model.indices, model.tangents) = (indices, None);
    model.tangents = Some(model.computed(Method::Area, model.uv_set));
    let mut document = model.document();
    let options = FixOptions::default().with_check(without_maps());
    let findings = check_document(&document, &options.check).expect("a valid document");
    let fixed = fix_document(&mut document, findings, &options).expect("a repair");
    let shared = fixed.findings.iter().find(|fixed| fixed.finding.code == Code::TangentSharedAcrossMirror);
    assert!(shared.is_some_and(|shared| shared.repaired), "{fixed:#?}");
    let after = tangents(&document);
    assert!(expected.iter().zip(&after).all(|(old, new)| distance(*old, *new) < 1e-5));
}

/// A part of the signs, on tangents that no recipe explains.
#[test]
fn signs_of_a_part_are_negated_and_directions_kept() {
    let mut model = named("wavy sphere");
    for vertex in 0..model.positions.len() {
        turn(&mut model, vertex, 17.0 * (vertex as f32).sin());
    }
    let before = tangents(&model.document());
    let count = model.positions.len() / 3;
    model.tangents()[..count].iter_mut().for_each(|tangent| tangent[3] = -tangent[3]);
    let mut document = model.document();
    let findings = fixed(&mut document, without_recipe());
    assert!(findings.iter().any(|fixed| fixed.repaired), "{findings:#?}");
    let bits =
        |tangents: Vec<[f32; 4]>| tangents.into_iter().map(|t| t.map(f32::to_bits)).collect::<Vec<_>>();
    assert!(bits(tangents(&document)) == bits(before));
}

/// One vertex for both sides of a seam becomes two; nothing else changes.
#[test]
fn a_shared_vertex_is_split_and_the_rest_kept() {
    let mut model = named("mirrored sheared wavy grid");
    let (positions, normals, uvs, of_vertex, indices) = model.unsplit.clone().expect("an unsplit mesh");
    (model.positions, model.normals, model.uvs) = (positions, Some(normals), uvs);
    (model.tangents, model.indices) = (Some(of_vertex), indices);
    // Of another recipe: MikkTSpace's, turned by 3 degrees.
    (0..model.positions.len()).for_each(|vertex| turn(&mut model, vertex, 3.0));
    let before = tangents(&model.document());
    let vertices = model.positions.len();
    let mut document = model.document();
    let findings = fixed(&mut document, without_recipe());
    let shared = findings.iter().find(|fixed| fixed.finding.code == Code::TangentSharedAcrossMirror);
    let shared = shared.expect("the finding");
    assert!(shared.repaired, "{findings:#?}");
    let after = tangents(&document);
    let changed = before.iter().zip(&after).filter(|(old, new)| old != new);
    // Only on the side that the old tangent did not serve.
    assert!(changed.clone().count() > 0 && changed.clone().all(|(old, new)| old[3] != new[3]));
    let position = document.meshes()[0].primitives[0].attributes["POSITION"];
    assert_eq!(document.accessors()[position].count, vertices + shared.finding.count);
}

/// What no repair was promised for is not called left, and what is gone is not called left either.
#[test]
fn outcomes_say_whether_a_repair_was_promised() {
    let mut model = named("wavy sphere");
    let vertices = model.detach_first_face();
    let uv = model.uvs[model.uv_set][vertices[0]];
    vertices.into_iter().for_each(|vertex| model.uvs[model.uv_set][vertex] = uv);
    let vertex = model.indices[30] as usize;
    model.tangents()[vertex][0] = f32::NAN;
    let outcome = |findings: &[FixedFinding], code| {
        let fixed = findings.iter().find(|fixed| fixed.finding.code == code).expect("the finding");
        (fixed.repaired, fixed.was_fixable())
    };
    let findings = fixed(&mut model.document(), Code::ALL.iter().copied());
    assert_eq!(outcome(&findings, Code::TangentNotFinite), (true, true));
    assert_eq!(outcome(&findings, Code::UvDegenerate), (false, false));
    let findings = fixed(&mut model.document(), [Code::UvDegenerate]);
    assert_eq!(outcome(&findings, Code::TangentNotFinite), (false, true));
    assert_eq!(outcome(&findings, Code::UvDegenerate), (false, false));
}
