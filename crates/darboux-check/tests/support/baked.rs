//! Maps that were baked for a mesh, and mistakes that only the mesh can name.

use std::collections::BTreeSet;

use darboux::internal::vectors::single::{cross, dot};
use darboux::{MapVerdict, TexelLayout, judge_normal_map};
use darboux_check::{CheckOptions, Code, FixOptions, Severity, check_document, fix_document};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;

use super::maps::Map;
use super::models::{Model, healthy_models};
use super::table::{Row, codes, rgb};
use super::texels::{texels_inside, twice_area};

type Vector = [f32; 3];

/// A mistake in a map that was baked for a mesh.
pub struct BakedMistake {
    pub code: Code,
    /// How it was made.
    pub how: &'static str,
    pub make: fn([u8; 3]) -> [u8; 3],
    /// All errors that are named.
    pub named: &'static [Code],
}

/// All mistakes that are made in baked maps.
pub const BAKED_MISTAKES: &[BakedMistake] = &[
    BakedMistake {
        code: Code::MapRedFlipped,
        how: "red inverted in a map that was baked for the mesh",
        make: |[r, g, b]| [255 - r, g, b],
        named: &[Code::MapRedFlipped],
    },
    BakedMistake {
        code: Code::MapRedFlipped,
        how: "red and green inverted in a map that was baked for the mesh",
        make: |[r, g, b]| [255 - r, 255 - g, b],
        named: &[Code::MapRedFlipped, Code::MapGreenFlipped],
    },
    BakedMistake {
        code: Code::MapGreenFlipped,
        how: "green inverted in a map that was baked for the mesh",
        make: |[r, g, b]| [r, 255 - g, b],
        named: &[Code::MapGreenFlipped],
    },
    BakedMistake {
        code: Code::MapChannelsSwapped,
        how: "red and green exchanged in a map that was baked for the mesh",
        make: |[r, g, b]| [g, r, b],
        named: &[Code::MapChannelsSwapped],
    },
];

/// The rows of the table.
pub fn rows() -> Vec<Row> {
    let models = baked_models();
    BAKED_MISTAKES.iter().map(|mistake| row(mistake, &models)).collect()
}

/// The healthy models that are curved and have enough faces to vote, each with a map that was baked for it.
/// Models are left out whose faces overlap in the map so that its texels show no convention, and mirrored
/// grids that bend along one axis, which have fewer than ten faces in different planes.
pub fn baked_models() -> Vec<Model> {
    const FACES: usize = 100;
    let has_votes = |model: &Model| {
        let is_flat = model.positions.iter().all(|position| position[2] == model.positions[0][2]);
        model.indices.len() >= 3 * FACES && !is_flat
    };
    let with_map = |model: Model| Model { map: baked(&model), ..model };
    let is_decided = |model: &Model| {
        let side = model.map.texels.len().isqrt();
        let judged = judge_normal_map(&model.map.texels, [side; 2], TexelLayout::RGB);
        judged.is_ok_and(|judgement| judgement.verdict == MapVerdict::OpenGl)
    };
    let is_ruled = |model: &Model| model.name.contains("mirrored") && !model.name.contains("wavy");
    let models = healthy_models().into_iter().filter(|model| has_votes(model) && !is_ruled(model));
    models.map(with_map).filter(is_decided).collect()
}

fn row(mistake: &BakedMistake, models: &[Model]) -> Row {
    let BakedMistake { code, how, make, named } = *mistake;
    let mut row = Row::new(code, how);
    for healthy in models {
        row.models += 1;
        let texels = healthy.map.texels.iter().copied().map(make).collect();
        let model = Model { map: healthy.map.with_texels(texels), ..healthy.clone() };
        let findings = check_document(&model.document(), &CheckOptions::default()).expect("a valid document");
        let errors = codes(&findings, |severity| severity == Severity::Error);
        row.require_evidence(&healthy.name, &findings);
        row.named += usize::from(errors.contains(&code));
        if errors != BTreeSet::from_iter(named.iter().copied()) {
            row.with_other_errors += 1;
            row.failures.push(format!("{how} on {} gives {errors:?}: {findings:?}", healthy.name));
        }
        match repaired(&model, healthy) {
            Ok(()) => *row.repaired.get_or_insert(0) += 1,
            Err(problem) => row.failures.push(format!("{how} on {}: {problem}", healthy.name)),
        }
    }
    row
}

/// Repairs the map of a model, and compares its texels with the healthy ones.
fn repaired(model: &Model, healthy: &Model) -> Result<(), String> {
    let mut document = model.document();
    let findings = check_document(&document, &CheckOptions::default()).map_err(|error| error.to_string())?;
    fix_document(&mut document, findings, &FixOptions::default()).map_err(|error| error.to_string())?;
    let glb = document.to_glb().map_err(|error| error.to_string())?;
    let after = Document::from_bytes("repaired", glb, None, &LoadOptions::default())
        .map_err(|error| error.to_string())?;
    let left = check_document(&after, &CheckOptions::default()).map_err(|error| error.to_string())?;
    if let Some(finding) = left.iter().find(|finding| finding.severity == Severity::Error) {
        return Err(format!("{} is still there: {}", finding.code, finding.text));
    }
    let image = after.image_bytes(0).map_err(|error| error.to_string())?;
    if rgb(&image) == healthy.map.texels { Ok(()) } else { Err("the texels are others".to_owned()) }
}

fn unit(a: Vector) -> Vector {
    a.map(|x| x / dot(a, a).sqrt())
}

/// The map of a detailed model whose flat parts are the faces of `model`, with gentle bumps on them: what a
/// baker writes.
fn baked(model: &Model) -> Map {
    const BUMPS: f32 = 0.25;
    let bumps = &model.map.texels;
    let side = bumps.len().isqrt();
    let (normals, tangents) = (model.normals.as_ref(), model.tangents.as_ref());
    let (normals, tangents) = (normals.expect("normals"), tangents.expect("tangents"));
    let mut texels = vec![[128, 128, 255]; side * side];
    for triangle in model.indices.as_chunks::<3>().0 {
        let at = triangle.map(|vertex| vertex as usize);
        let [a, b, c] = at.map(|vertex| model.positions[vertex]);
        let edges = [b, c].map(|end| [0, 1, 2].map(|i| end[i] - a[i]));
        let uvs = at.map(|vertex| model.uvs[model.uv_set][vertex].map(|x| x * side as f32 - 0.5));
        let face = cross(edges[0], edges[1]);
        if dot(face, face) == 0.0 || twice_area(uvs) == 0.0 {
            continue;
        }
        for (x, y, weights) in texels_inside(uvs) {
            let mean = |of: &dyn Fn(usize) -> Vector| {
                unit([0, 1, 2].map(|i| (0..3).map(|corner| weights[corner] * of(at[corner])[i]).sum()))
            };
            let normal = mean(&|vertex| normals[vertex]);
            let tangent = mean(&|vertex| [0, 1, 2].map(|i| tangents[vertex][i]));
            let bitangent = cross(normal, tangent).map(|x| x * tangents[at[0]][3]);
            let [p, q, up] = [tangent, bitangent, normal].map(|axis| dot(unit(face), axis));
            let [x, y] = [x, y].map(|place| place.rem_euclid(side as i32) as usize);
            let [r, g, b] = bumps[y * side + x].map(|code| f32::from(code) / 127.5 - 1.0);
            let texel = unit([p / up + BUMPS * r / b, q / up + BUMPS * g / b, 1.0]);
            texels[y * side + x] = texel.map(|x| ((x + 1.0) * 127.5).round() as u8);
        }
    }
    model.map.with_texels(texels)
}
