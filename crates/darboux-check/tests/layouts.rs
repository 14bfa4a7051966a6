//! Maps that were baked for another UV layout than that of the mesh: turned UVs and turned images are named,
//! and other maps are not.

mod support;

use darboux::internal::vectors::single::cross;
use darboux_check::{CheckOptions, Code, Finding, FixOptions, Severity, check_document, fix_document};
use darboux_tests::{OwnedMesh, families};
use support::maps::{Map, healthy_map, png};
use support::models::Model;

/// Texels per row and column.
const SIDE: usize = 256;

/// Quads per chart along u and v, and charts along each side of the map.
const QUADS: usize = 4;
const CHARTS: usize = 4;

/// Where each chart lies: in no order that a turned layout would have, too.
const PLACES: [usize; CHARTS * CHARTS] = [5, 12, 0, 9, 14, 3, 10, 7, 1, 15, 6, 2, 11, 8, 4, 13];

/// A sphere whose quads are cut into charts, every second of which is turned by a right angle, with the seams
/// smooth.
fn charted() -> OwnedMesh {
    let (rows, columns) = (CHARTS * QUADS, CHARTS * QUADS);
    let mut mesh = families::sphere(4, 4, false);
    (mesh.positions, mesh.normals, mesh.uvs) = (Vec::new(), Vec::new(), Vec::new());
    let mut indices = Vec::new();
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let first = mesh.positions.len() as u32;
        for [i, j] in [[0, 0], [1, 0], [1, 1], [0, 1]] {
            let [u, v] = [(column + i) as f32 / columns as f32, (row + j) as f32 / rows as f32];
            // No poles, so that all quads have an area; the last column ends where the first one begins.
            let around = std::f32::consts::TAU * if column + i == columns { 0.0 } else { u };
            let down = 0.2 + 2.7 * v;
            let normal = [down.sin() * around.cos(), down.sin() * around.sin(), down.cos()];
            mesh.positions.push(normal);
            mesh.normals.push(normal);
            mesh.uvs.push(place([row, column], [i, j]));
        }
        indices.extend([0, 2, 1, 0, 3, 2].map(|corner| first + corner));
    }
    mesh.indices = Some(indices);
    mesh
}

/// The UV of a corner of a quad, in a chart with a border of empty texels.
fn place([row, column]: [usize; 2], [i, j]: [usize; 2]) -> [f32; 2] {
    let chart = PLACES[row / QUADS * CHARTS + column / QUADS];
    let chart = [chart % CHARTS, chart / CHARTS];
    let own = [(column % QUADS + i) as f32 / QUADS as f32, (row % QUADS + j) as f32 / QUADS as f32];
    let own = if (chart[0] + chart[1]) % 2 == 1 { [1.0 - own[1], own[0]] } else { own };
    [0, 1].map(|axis| (chart[axis] as f32 + 0.08 + 0.84 * own[axis]) / CHARTS as f32)
}

/// The slope of a field in space, which leans the normals.
fn slope([x, y, z]: [f32; 3]) -> [f32; 3] {
    let wave = |phase: f32, [a, b, c]: [f32; 3]| 0.3 * (a * x + b * y + c * z + phase).cos();
    [wave(0.3, [5.0, 3.0, 1.0]), wave(1.7, [2.0, 6.0, 3.0]), wave(4.1, [3.0, 1.0, 7.0])]
}

/// The map of that field, baked for the model.
fn baked(model: &Model) -> Vec<[u8; 3]> {
    let normals = model.normals.as_ref().expect("normals");
    let tangents = model.tangents.as_ref().expect("tangents");
    let mut texels = vec![[128, 128, 255]; SIDE * SIDE];
    for triangle in model.indices.as_chunks::<3>().0 {
        let at = triangle.map(|vertex| vertex as usize);
        let uvs = at.map(|vertex| model.uvs[model.uv_set][vertex].map(|x| x * SIDE as f32 - 0.5));
        for (x, y, weights) in support::texels::texels_inside(uvs) {
            let mean = |of: &dyn Fn(usize) -> [f32; 3]| -> [f32; 3] {
                [0, 1, 2].map(|i| (0..3).map(|corner| weights[corner] * of(at[corner])[i]).sum())
            };
            let normal = unit(mean(&|vertex| normals[vertex]));
            let tangent = unit(mean(&|vertex| [0, 1, 2].map(|i| tangents[vertex][i])));
            let bitangent = cross(normal, tangent).map(|x| x * tangents[at[0]][3]);
            let lean = slope(mean(&|vertex| model.positions[vertex]));
            let [p, q] = [tangent, bitangent].map(|axis| (0..3).map(|i| axis[i] * lean[i]).sum::<f32>());
            let texel = unit([p, q, 1.0]).map(|x| (127.5 + 127.5 * x).round() as u8);
            texels[y as usize * SIDE + x as usize] = texel;
        }
    }
    texels
}

fn unit(v: [f32; 3]) -> [f32; 3] {
    let length = v.iter().map(|x| x * x).sum::<f32>().sqrt();
    v.map(|x| x / length)
}

fn with_texels(texels: Vec<[u8; 3]>) -> Map {
    Map { file: png(&texels), texels, ..healthy_map(0) }
}

fn model() -> Model {
    let mut model = Model::new(0, "charts", charted());
    model.map = with_texels(baked(&model));
    model
}

fn layout(model: &Model) -> Option<Finding> {
    let findings = check_document(&model.document(), &CheckOptions::default()).expect("a valid document");
    findings.into_iter().find(|finding| finding.code == Code::MapOtherLayout)
}

/// New tangents would follow the UVs that were turned after the bake. `code`: the finding about those of
/// before.
fn tangents_are_left(turned: &Model, healthy: &Model, code: Code) {
    let model = Model { tangents: healthy.tangents.clone(), ..turned.clone() };
    let mut document = model.document();
    let findings = check_document(&document, &CheckOptions::default()).expect("a valid document");
    let errors = findings.iter().filter(|found| found.severity == Severity::Error);
    let errors: Vec<Code> = errors.map(|found| found.code).collect();
    assert_eq!(errors, [Code::MapOtherLayout], "{findings:#?}");
    assert!(findings.iter().any(|found| found.code == code), "{findings:#?}");
    let fixed = fix_document(&mut document, findings, &FixOptions::default()).expect("a repair");
    assert!(!fixed.is_changed);
}

#[test]
fn maps_of_a_turned_layout_are_named() {
    let healthy = model();
    assert_eq!(layout(&healthy), None);
    let mut turned = healthy.clone();
    turned.uvs.iter_mut().flatten().for_each(|uv| uv[1] = 1.0 - uv[1]);
    turned.tangents = Some(turned.computed(Default::default(), turned.uv_set));
    let found = layout(&turned).expect("the finding");
    assert!(found.text.contains("v of the UVs is turned") && !found.is_fixable(), "{found:?}");
    for turn in [|[u, v]: [f32; 2]| [1.0 - v, u], |[u, v]: [f32; 2]| [v, 1.0 - u]] {
        let mut turned = healthy.clone();
        turned.uvs.iter_mut().flatten().for_each(|uv| *uv = turn(*uv));
        tangents_are_left(&turned, &healthy, Code::TangentRotated);
        turned.tangents = Some(turned.computed(Default::default(), turned.uv_set));
        let found = layout(&turned).expect("the finding");
        assert!(found.text.contains("the UVs are turned by 90 degrees"), "{found:?}");
    }
    tangents_are_left(&turned, &healthy, Code::TangentSignFlipped);
    let mut reversed = healthy.clone();
    let rows = healthy.map.texels.chunks_exact(SIDE).rev();
    reversed.map = with_texels(rows.flatten().copied().collect());
    let found = layout(&reversed).expect("the finding");
    assert!(found.text.contains("image is turned upside down"), "{found:?}");
}

/// A map that has nothing to do with the layout fits it in no way.
#[test]
fn tiling_maps_are_of_no_other_layout() {
    for number in 0..6 {
        let mut model = model();
        model.map = healthy_map(number);
        assert_eq!(layout(&model), None, "{number}");
    }
}
