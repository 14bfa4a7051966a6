//! Where most tangents are right, whatever recipe they come from, a repair changes those that are wrong and
//! no others.

mod support;

use std::collections::BTreeSet;

use darboux_check::{Change, CheckOptions, Code, FixOptions, FixedFinding, check_document, fix_document};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use support::container::{with_json, with_vectors};
use support::models::{Model, healthy_models};
use support::table::without_maps;

fn named(name: &str) -> Model {
    healthy_models().into_iter().find(|model| model.name == name).expect("a healthy model of that name")
}

/// A model whose tangents were computed on quads.
fn of_quads() -> Model {
    let mut model = named("wavy grid");
    model.tangents = Some(model.computed_on_quads());
    model
}

/// The same with a vertex of its own for every corner.
fn unindexed(model: &Model) -> Model {
    fn gathered<T: Copy>(values: &[T], indices: &[u32]) -> Vec<T> {
        indices.iter().map(|&index| values[index as usize]).collect()
    }
    Model {
        positions: gathered(&model.positions, &model.indices),
        normals: model.normals.as_ref().map(|normals| gathered(normals, &model.indices)),
        tangents: model.tangents.as_ref().map(|tangents| gathered(tangents, &model.indices)),
        uvs: model.uvs.iter().map(|uvs| gathered(uvs, &model.indices)).collect(),
        indices: (0..model.indices.len() as u32).collect(),
        ..model.clone()
    }
}

fn read(glb: Vec<u8>) -> Document {
    Document::from_bytes("model", glb, None, &LoadOptions::default()).expect("a valid GLB")
}

fn fixed_with(document: &mut Document, options: &FixOptions) -> Vec<FixedFinding> {
    let findings =
        check_document(document, &CheckOptions::default().with_maps(false)).expect("a valid document");
    fix_document(document, findings, &options.clone().with_check(without_maps()))
        .expect("a valid document")
        .findings
}

fn fixed(document: &mut Document) -> Vec<FixedFinding> {
    fixed_with(document, &FixOptions::default())
}

/// The tangents of corners, of all primitives.
fn tangents(document: &Document) -> Vec<[f32; 4]> {
    let corners = document.corners().expect("valid indices");
    let of =
        |corners: &darboux_io::gltf::PrimitiveCorners<'_>| corners.vectors::<4>("TANGENT").expect("tangents");
    corners.iter().flat_map(|corners| of(corners).unwrap_or_default()).collect()
}

/// Whether all corners have the bits of other ones, but those of some vertices, which are the same up to
/// rounding.
fn assert_restored(document: &Document, before: &Model, wrong: &BTreeSet<u32>, what: &str) {
    let old = tangents(&before.document());
    for ((corner, vertex), (old, new)) in
        before.indices.iter().enumerate().zip(old.iter().zip(tangents(document)))
    {
        let distance = (0..4).map(|i| (old[i] - new[i]).abs()).fold(0.0, f32::max);
        let is_same = old.map(f32::to_bits) == new.map(f32::to_bits);
        let is_right = is_same || wrong.contains(vertex) && distance < 1e-5;
        assert!(is_right, "{what}: corner {corner} was {old:?}, is {new:?}");
    }
}

fn across([x, y, z, w]: [f32; 4], n: [f32; 3]) -> [f32; 4] {
    [w * (n[1] * z - n[2] * y), w * (n[2] * x - n[0] * z), w * (n[0] * y - n[1] * x), w]
}

/// Spoils the tangent of a vertex with a normal.
type Damage = fn([f32; 4], [f32; 3]) -> [f32; 4];

const NEGATED: Damage = |[x, y, z, w], _| [-x, -y, -z, w];

/// Mistakes in a part of the tangents.
const DAMAGE: [(&str, Damage); 5] = [
    ("bitangents", across),
    ("negated", NEGATED),
    ("signs", |[x, y, z, w], _| [x, y, z, -w]),
    ("zero with NaN", |_, _| [0.0, 0.0, 0.0, f32::NAN]),
    ("NaN", |[x, y, _, w], _| [x, y, f32::NAN, w]),
];

/// Spoils some vertices, and returns them.
fn damaged(model: &mut Model, damage: Damage, is_chosen: impl Fn(usize) -> bool) -> BTreeSet<u32> {
    let normals = model.normals.clone().expect("normals");
    let chosen: Vec<usize> = (0..normals.len()).filter(|vertex| is_chosen(*vertex)).collect();
    for &vertex in &chosen {
        let tangent = model.tangents()[vertex];
        model.tangents()[vertex] = damage(tangent, normals[vertex]);
    }
    chosen.into_iter().map(|vertex| vertex as u32).collect()
}

#[test]
fn quads_are_recognised_without_indices() {
    let model = unindexed(&of_quads());
    let mut document = model.document();
    let findings = fixed(&mut document);
    let recipe = findings.iter().find(|fixed| fixed.finding.code == Code::TangentOtherRecipe);
    let recipe = recipe.expect("the finding");
    assert!(recipe.finding.text.contains("before quads were cut") && !recipe.repaired, "{recipe:?}");
    assert!(!document.is_changed());
}

#[test]
fn only_the_wrong_tangents_of_quads_change() {
    for (name, before) in [("shared vertices", of_quads()), ("own vertices", unindexed(&of_quads()))] {
        for (mistake, damage) in DAMAGE {
            for every in [3, 20] {
                let mut model = before.clone();
                let wrong = damaged(&mut model, damage, |vertex| vertex % every == 1);
                let mut document = model.document();
                let findings = fixed(&mut document);
                let change = Some(Change::CorrectedTangents { count: wrong.len() });
                let is_corrected = |fixed: &FixedFinding| fixed.repaired && fixed.change == change;
                let what = format!("{name}, {mistake}, every {every}");
                assert!(findings.iter().any(is_corrected), "{what}: {findings:#?}");
                assert_restored(&document, &before, &wrong, &what);
            }
        }
    }
}

/// Single tangents along v become those of the recipe, and the others stay.
#[test]
fn single_rotated_tangents_become_those_of_the_recipe() {
    for before in [named("wavy sphere"), named("wavy grid")] {
        let mut model = before.clone();
        let wrong = damaged(&mut model, across, |vertex| vertex % 40 == 21);
        let mut document = model.document();
        let findings = fixed(&mut document);
        let change = Some(Change::CorrectedTangents { count: wrong.len() });
        let is_corrected = |fixed: &FixedFinding| {
            fixed.finding.code == Code::TangentRotated && fixed.repaired && fixed.change == change
        };
        assert!(findings.iter().any(is_corrected), "{findings:#?}");
        assert_restored(&document, &before, &wrong, &before.name);
    }
}

#[test]
fn only_negated_tangents_are_negated() {
    for before in [named("wavy grid"), of_quads()] {
        let mut model = before.clone();
        let wrong = damaged(&mut model, NEGATED, |vertex| vertex % 20 != 3);
        let mut document = model.document();
        let findings = fixed(&mut document);
        assert!(findings.iter().any(|fixed| fixed.repaired && fixed.finding.code == Code::TangentNegated));
        assert_restored(&document, &before, &wrong, &before.name);
    }
}

/// Signs of faces that are flipped at all corners are not those of a finding about mixed signs.
#[test]
fn only_the_signs_of_the_chosen_finding_are_negated() {
    let healthy = unindexed(&named("wavy grid"));
    let mut model = healthy.clone();
    let count = model.indices.len() / 3 / 4 * 3;
    model.tangents()[..count].iter_mut().for_each(|tangent| tangent[3] = -tangent[3]);
    let mixed = model.indices.len() - 1;
    model.tangents()[mixed][3] *= -1.0;
    for (code, chosen) in
        [(Code::TangentSignMixed, mixed..mixed + 1), (Code::TangentSignPartlyFlipped, 0..count)]
    {
        let mut document = model.document();
        let findings = fixed_with(&mut document, &FixOptions::default().with_codes([code]));
        assert!(findings.iter().all(|fixed| fixed.repaired == (fixed.finding.code == code)), "{findings:#?}");
        for (corner, (old, new)) in model.tangents().to_vec().iter().zip(tangents(&document)).enumerate() {
            assert_eq!(old[3] != new[3], chosen.contains(&corner), "{code}: corner {corner}");
        }
    }
}

/// Two primitives that share their tangents, and want opposite signs.
#[test]
fn primitives_that_share_tangents_get_each_their_own() {
    let mut model = named("wavy grid");
    model.uvs = vec![model.uvs[model.uv_set].clone()];
    model.uv_set = 0;
    model.tangents = Some(model.computed(darboux::Method::default(), 0));
    let healthy = model.clone();
    model.uvs.push(model.uvs[0].iter().map(|[u, v]| [*u, -v]).collect());
    let wrong = damaged(&mut model, |_, _| [f32::NAN; 4], |vertex| vertex % 20 == 1);
    let glb = with_json(&model.glb(), |json| {
        let mut mirrored = json["meshes"][0]["primitives"][0].clone();
        mirrored["attributes"]["TEXCOORD_0"] = mirrored["attributes"]["TEXCOORD_1"].clone();
        let primitives = json["meshes"][0]["primitives"].as_array_mut().expect("primitives");
        primitives.push(mirrored);
    });
    let mut document = read(glb);
    fixed(&mut document);
    let after = tangents(&document);
    let (first, second) = after.split_at(after.len() / 2);
    let of = |tangents: &[[f32; 4]]| tangents.iter().map(|t| t[3]).collect::<Vec<f32>>();
    assert!(of(first).iter().zip(of(second)).all(|(a, b)| *a == -b && a.abs() == 1.0));
    let mut only_first = read(document.to_glb().expect("a GLB"));
    assert!(fixed(&mut only_first).iter().all(|fixed| fixed.change.is_none()));
    let count = first.len();
    let old = tangents(&healthy.document());
    for corner in (0..count).filter(|corner| !wrong.contains(&healthy.indices[*corner])) {
        assert_eq!(old[corner].map(f32::to_bits), first[corner].map(f32::to_bits));
    }
}

/// Two primitives with one mesh but other tangents, whose vertices are split.
#[test]
fn meshes_that_differ_in_their_tangents_keep_them() {
    let mut model = named("mirrored sheared wavy grid");
    let (positions, normals, uvs, of_vertex, indices) = model.unsplit.clone().expect("an unsplit mesh");
    (model.positions, model.normals, model.uvs) = (positions, Some(normals.clone()), uvs);
    (model.tangents, model.indices) = (Some(of_vertex), indices);
    let turned = |degrees: f32| -> Vec<[f32; 4]> {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let turn = |(t, n): (&[f32; 4], &[f32; 3])| {
            let b = across([t[0], t[1], t[2], 1.0], *n);
            [cos * t[0] + sin * b[0], cos * t[1] + sin * b[1], cos * t[2] + sin * b[2], t[3]]
        };
        model.tangents.iter().flatten().zip(&normals).map(turn).collect()
    };
    let (glb, accessor) =
        with_vectors(&Model { tangents: Some(turned(3.0)), ..model.clone() }.glb(), &turned(-3.0), "VEC4");
    let glb = with_json(&glb, |json| {
        let mut other = json["meshes"][0]["primitives"][0].clone();
        other["attributes"]["TANGENT"] = accessor.into();
        json["meshes"][0]["primitives"].as_array_mut().expect("primitives").push(other);
    });
    let before = tangents(&read(glb.clone()));
    let mut document = read(glb);
    let codes = Code::ALL.iter().copied().filter(|code| *code != Code::TangentOtherRecipe);
    let findings = fixed_with(&mut document, &FixOptions::default().with_codes(codes));
    let shared = findings.iter().filter(|fixed| fixed.finding.code == Code::TangentSharedAcrossMirror);
    assert!(shared.clone().count() == 2 && shared.clone().all(|fixed| fixed.repaired), "{findings:#?}");
    // Only on the side that the old tangent did not serve.
    let after = tangents(&document);
    assert!(before.iter().zip(&after).all(|(old, new)| old == new || old[3] != new[3]));
}
