//! The recipe of tangents is recognised.

use std::path::Path;

use darboux::{
    CornerTangents, Mesh, Method, MikkTSpaceOptions, Mode, Recipe, RecipeMatch, RecipeRounding,
    RecipeWriting, TangentOptions, generate_tangents, recognise_recipe,
};
use darboux_tests::models::{further_models, meshes, models};
use darboux_tests::{Dice, METHODS, OwnedMesh, families};

fn tangents(mesh: &Mesh<'_>, method: Method) -> Vec<[f32; 4]> {
    generate_tangents(mesh, &TangentOptions::from(method)).corners.into_per_corner()
}

fn best(mesh: &Mesh<'_>, tangents: &[[f32; 4]]) -> RecipeMatch {
    recognise_recipe(mesh, tangents).expect("one tangent per corner")[0]
}

/// Every method that is in the list; the normal alone is no recipe for normal maps.
fn recipes() -> impl Iterator<Item = Method> {
    let modes =
        [Mode::Reference, Mode::Corrected].map(|mode| MikkTSpaceOptions::new().with_mode(mode).into());
    METHODS.iter().copied().filter(|method| *method != Method::FromNormal).chain(modes)
}

/// The tangents after they were written through the index list by a loop over the corners.
fn written_through_indices(mesh: &Mesh<'_>, tangents: &[[f32; 4]], first_wins: bool) -> Vec<[f32; 4]> {
    let mut of_vertex = vec![None; mesh.vertex_count()];
    for (corner, tangent) in tangents.iter().enumerate() {
        let slot = &mut of_vertex[mesh.vertex_of_corner(corner)];
        *slot = if first_wins { slot.or(Some(*tangent)) } else { Some(*tangent) };
    }
    (0..tangents.len()).map(|corner| of_vertex[mesh.vertex_of_corner(corner)].expect("written")).collect()
}

/// Asserts that the best match is `method`, or gives the same bits as it.
fn assert_recognised(name: &str, mesh: &OwnedMesh) {
    let view = mesh.view();
    for method in recipes() {
        let made = tangents(&view, method);
        let found = best(&view, &made);
        assert_eq!(found.identical, made.len(), "{name}: {method:?} found as {found:?}");
        let again = tangents(&view, found.recipe.method);
        let again = match found.recipe.writing {
            RecipeWriting::Corners => again,
            writing => written_through_indices(&view, &again, writing == RecipeWriting::FirstCorner),
        };
        let is_same = found.recipe.flips_v || same_bits(&rounded(&again, found.recipe.rounding), &made);
        assert!(is_same, "{name}: {method:?} found as {found:?}");
    }
}

/// The tangents as a recipe rounds them.
fn rounded(tangents: &[[f32; 4]], rounding: RecipeRounding) -> Vec<[f32; 4]> {
    let largest = match rounding {
        RecipeRounding::Bits8 => 127.0,
        RecipeRounding::Bits16 => 32767.0,
        _ => return tangents.to_vec(),
    };
    tangents.iter().map(|tangent| tangent.map(|x| (x * largest).round() / largest)).collect()
}

fn same_bits(a: &[[f32; 4]], b: &[[f32; 4]]) -> bool {
    let numbers = a.as_flattened().iter().zip(b.as_flattened());
    a.len() == b.len() && numbers.into_iter().all(|(a, b)| a == b || (a.is_nan() && b.is_nan()))
}

#[test]
fn every_recipe_is_recognised_on_regular_meshes() {
    for mirrored in [false, true] {
        assert_recognised("grid", &families::grid(9, 7, false, mirrored));
    }
    assert_recognised("sphere", &families::sphere(12, 17, false));
    assert_recognised("Möbius strip", &families::moebius(9, false));
}

fn assert_recognised_below(folder: &Path) {
    for path in models(folder) {
        for (number, mesh) in meshes(&path) {
            assert_recognised(&format!("{} {number}", path.display()), &mesh);
        }
    }
}

#[test]
fn every_recipe_is_recognised_on_the_repository_s_models() {
    assert_recognised_below(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets"));
}

#[test]
#[ignore = "takes a minute: every recipe on every further model"]
fn every_recipe_is_recognised_on_further_models() {
    if let Some(folder) = further_models() {
        assert_recognised_below(&folder);
    }
}

/// Large meshes are sampled: MikkTSpace is compared on all corners, and so are others where the sample leaves
/// a doubt.
#[test]
fn recipes_of_large_meshes_are_recognised() {
    let mut grid = families::grid(400, 320, false, true);
    for (position, uv) in grid.positions.iter_mut().zip(&mut grid.uvs) {
        position[2] += 0.02 * (40.0 * position[0] + 9.0 * position[1]).sin();
        uv[1] += 0.01 * (50.0 * position[0]).sin();
    }
    for mesh in [grid.clone(), grid.unindexed()] {
        let view = mesh.view();
        for method in [Method::default(), Method::LengyelPerVertex, Method::Face] {
            let made = tangents(&view, method);
            let matches = recognise_recipe(&view, &made).expect("one tangent per corner");
            let best = matches[0];
            assert_eq!(best.recipe.method, method, "{best:?}");
            assert_eq!(best.identical, best.corners, "{best:?}");
            let is_whole = |found: &&RecipeMatch| found.corners == made.len();
            assert!(matches.iter().filter(is_whole).any(|found| found.recipe.method == Method::default()));
            assert!(matches.iter().any(|found| found.corners < made.len() / 8), "{matches:?}");
            assert!(recipes().all(|method| matches.iter().any(|found| found.recipe.method == method)));
        }
    }
    // Slightly noisy tangents of a gently curved grid: several methods are about as close, and are compared
    // on all corners.
    let gentle = families::grid(400, 320, false, false);
    let mut noisy = tangents(&gentle.view(), Method::Area);
    noisy.iter_mut().for_each(|tangent| tangent[1] += 1e-4);
    let matches = recognise_recipe(&gentle.view(), &noisy).expect("one tangent per corner");
    let whole = matches.iter().filter(|found| found.corners == noisy.len());
    assert!(whole.count() > 2, "{matches:?}");
    // Tangents of no recipe: the shares in the sample are those in the whole mesh, up to chance.
    let mut made = tangents(&grid.view(), Method::Area);
    made.iter_mut()
        .enumerate()
        .filter(|(corner, _)| corner % 3 == 0)
        .for_each(|(_, tangent)| *tangent = [1.0; 4]);
    let matches = recognise_recipe(&grid.view(), &made).expect("one tangent per corner");
    let share = matches[0].identical as f64 / matches[0].corners as f64;
    assert!(matches[0].recipe.method == Method::Area && (share - 2.0 / 3.0).abs() < 0.01, "{:?}", matches[0]);
}

#[test]
fn a_mirrored_seam_that_was_written_through_the_index_list_is_recognised() {
    let mesh = families::grid(8, 7, false, true);
    let view = mesh.view();
    let made = tangents(&view, Method::default());
    for (first_wins, writing) in [(false, RecipeWriting::LastCorner), (true, RecipeWriting::FirstCorner)] {
        let written = written_through_indices(&view, &made, first_wins);
        assert!(!same_bits(&written, &made));
        let found = best(&view, &written);
        assert_eq!((found.recipe.writing, found.identical), (writing, written.len()), "{found:?}");
        assert!(matches!(found.recipe.method, Method::MikkTSpace(_)), "{found:?}");
    }
}

#[test]
fn flipped_v_is_recognised_where_its_rounding_shows() {
    let mut mesh = families::sphere(12, 17, false);
    mesh.uvs.iter_mut().for_each(|uv| *uv = [uv[0] * 0.37 + 0.01, uv[1] * 0.71 + 0.003]);
    let mut flipped = mesh.clone();
    flipped.uvs.iter_mut().for_each(|uv| uv[1] = 1.0 - uv[1]);
    let mut made = tangents(&flipped.view(), Method::default());
    made.iter_mut().for_each(|tangent| tangent[3] = -tangent[3]);
    assert!(!same_bits(&made, &tangents(&mesh.view(), Method::default())));
    let found = best(&mesh.view(), &made);
    let Recipe { method, flips_v, .. } = found.recipe;
    assert_eq!((method, flips_v, found.identical), (Method::default(), true, made.len()));
}

/// A grid of irregular quads.
fn irregular_quads() -> OwnedMesh {
    let mut dice = Dice::from_seed(7);
    let mut mesh = families::grid(12, 9, true, false);
    for position in &mut mesh.positions {
        position[2] += 0.02 * dice.uniform();
    }
    for uv in &mut mesh.uvs {
        *uv = uv.map(|x| x + 0.004 * dice.uniform());
    }
    mesh
}

/// As Unity makes them: MikkTSpace on quads, which are cut afterwards, here always along the same diagonal.
#[test]
fn tangents_of_quads_that_were_cut_are_recognised() {
    let quads = irregular_quads();
    let made = tangents(&quads.view(), Method::default());
    let corners: Vec<usize> =
        (0..made.len() / 4).flat_map(|quad| [0, 1, 2, 0, 2, 3].map(|corner| 4 * quad + corner)).collect();
    let indices = corners.iter().map(|&corner| quads.vertex_of_corner(corner) as u32).collect();
    let triangles = OwnedMesh {
        positions: quads.positions.clone(),
        normals: quads.normals.clone(),
        uvs: quads.uvs.clone(),
        indices: Some(indices),
        ..OwnedMesh::default()
    };
    let cut: Vec<[f32; 4]> = corners.iter().map(|&corner| made[corner]).collect();
    let found = best(&triangles.view(), &cut);
    assert!(found.recipe.from_quads && found.close == found.corners, "{found:?}");
    assert_eq!(found.recipe.method, Method::default());
    let whole = best(&triangles.view(), &tangents(&triangles.view(), Method::default()));
    assert!(!whole.recipe.from_quads && whole.identical == whole.corners, "{whole:?}");
}

/// As Maya makes them, here in f64: unit tangents in the plane of the corner's normal, summed per vertex.
#[test]
fn averages_of_projected_tangents_are_recognised() {
    let mesh = families::sphere(12, 17, false);
    let unit = |v: [f64; 3]| v.map(|x| x / v.iter().map(|x| x * x).sum::<f64>().sqrt());
    let in_plane = |v: [f64; 3], normal: [f64; 3]| {
        let lean: f64 = (0..3).map(|i| v[i] * normal[i]).sum();
        unit([0, 1, 2].map(|i| v[i] - lean * normal[i]))
    };
    let normals: Vec<[f64; 3]> = mesh.normals.iter().map(|normal| unit(normal.map(f64::from))).collect();
    let mut sums = vec![[0.0; 3]; mesh.positions.len()];
    let vertices: Vec<usize> = (0..mesh.corner_count()).map(|corner| mesh.vertex_of_corner(corner)).collect();
    let mut signs = Vec::new();
    for triangle in vertices.as_chunks::<3>().0 {
        let [p, q, r] = triangle.map(|vertex| mesh.positions[vertex].map(f64::from));
        let [a, b, c] = triangle.map(|vertex| mesh.uvs[vertex].map(f64::from));
        let [v1, v2] = [b[1] - a[1], c[1] - a[1]];
        let sign = ((b[0] - a[0]) * v2 - (c[0] - a[0]) * v1).signum();
        let along_u = unit([0, 1, 2].map(|i| sign * (v2 * (q[i] - p[i]) - v1 * (r[i] - p[i]))));
        for &vertex in triangle {
            let tangent = in_plane(along_u, normals[vertex]);
            (0..3).for_each(|i| sums[vertex][i] += tangent[i]);
        }
        signs.extend([sign; 3]);
    }
    let tangent = |(&vertex, sign): (&usize, f64)| {
        let [x, y, z] = unit(sums[vertex]).map(|x| x as f32);
        [x, y, z, sign as f32]
    };
    let made: Vec<[f32; 4]> = vertices.iter().zip(signs).map(tangent).collect();
    let found = best(&mesh.view(), &made);
    assert_eq!((found.recipe.method, found.close), (Method::Average, found.corners), "{found:?}");
}

/// As gltfpack stores them: signed normalised integers.
#[test]
fn quantised_tangents_are_recognised() {
    let mesh = families::sphere(24, 31, false);
    let view = mesh.view();
    for rounding in [RecipeRounding::Bits8, RecipeRounding::Bits16] {
        for method in [Method::default(), Method::AngleEdge, Method::Lengyel] {
            let made = rounded(&tangents(&view, method), rounding);
            let found = best(&view, &made);
            assert_eq!(
                (found.recipe.rounding, found.identical),
                (rounding, made.len()),
                "{method:?} {found:?}"
            );
            let again = rounded(&tangents(&view, found.recipe.method), rounding);
            assert!(same_bits(&again, &made), "{method:?} found as {found:?}");
        }
    }
}

/// The coarsest rounding that all tangents have, which is found whatever the method: bits that differ from
/// every candidate.
#[test]
fn the_rounding_is_the_coarsest_that_explains_every_component() {
    let mesh = families::grid(1, 1, false, false);
    let found = |tangent: [f32; 4], other: [f32; 4]| {
        let mut tangents = vec![tangent; mesh.corner_count()];
        tangents[4] = other;
        best(&mesh.view(), &tangents).recipe.rounding
    };
    use RecipeRounding::{Bits8, Bits16, Floats};
    let [eighth, sixteenth] = [127.0, 32767.0].map(|largest: f32| [80.0 / largest, -1.0, 0.0, 1.0]);
    let third = [1.0 / 3.0, -1.0, 0.0, 1.0];
    let nan = [f32::NAN; 4];
    // 0, 1 and -1 are multiples of everything and tell nothing.
    let axis = [0.0, -1.0, -0.0, 1.0];
    for (tangent, other, expected) in [
        (axis, axis, Floats),
        (third, third, Floats),
        (eighth, eighth, Bits8),
        (eighth, axis, Bits8),
        // NaN stays NaN in every rounding.
        (nan, axis, Bits8),
        (sixteenth, sixteenth, Bits16),
        (eighth, third, Floats),
        (sixteenth, third, Floats),
        (eighth, [80.0 / 127.0, -1.0, 0.0, 1.0f32.next_down()], Floats),
    ] {
        assert_eq!(found(tangent, other), expected, "{tangent:?}, {other:?}");
    }
}

#[test]
fn counts_tell_how_far_a_recipe_is() {
    let mesh = families::sphere(12, 17, false);
    let view = mesh.view();
    let turned = |degrees: f32| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let turn = |(corner, [x, y, z, w]): (usize, [f32; 4])| {
            let normal = view.normals().get(view.vertex_of_corner(corner));
            let length = normal.iter().map(|x| x * x).sum::<f32>().sqrt();
            let [a, b, c] = normal.map(|x| x / length);
            let across = [b * z - c * y, c * x - a * z, a * y - b * x];
            [cos * x + sin * across[0], cos * y + sin * across[1], cos * z + sin * across[2], w]
        };
        let made = tangents(&view, Method::default());
        best(&view, &made.into_iter().enumerate().map(turn).collect::<Vec<_>>())
    };
    let slightly = turned(0.05);
    assert!(matches!(slightly.recipe.method, Method::MikkTSpace(_)));
    assert_eq!((slightly.identical, slightly.close, slightly.sign_flips), (0, slightly.corners, 0));
    assert!((slightly.worst - 0.05).abs() < 0.001, "{slightly:?}");
    let much = turned(120.0);
    assert_eq!(much.close, 0);
    assert!(much.worst > 100.0, "{much:?}");
}

#[test]
fn wrong_lengths_and_unusable_tangents_are_handled() {
    let mesh = families::grid(2, 2, false, false);
    let view = mesh.view();
    assert!(recognise_recipe(&view, &[[0.0; 4]; 3]).is_err());
    for tangent in [[0.0; 4], [f32::NAN; 4], [f32::INFINITY, 0.0, 0.0, 1.0]] {
        let matches = recognise_recipe(&view, &vec![tangent; view.corner_count()]).expect("one per corner");
        assert!(matches.iter().all(|found| found.close == 0 && found.worst == 180.0), "{tangent:?}");
    }
    let empty = Mesh::triangles(&[[0.0; 3]; 0], &[[0.0; 3]; 0], &[[0.0; 2]; 0], &[0u16; 0])
        .expect("an empty mesh is one");
    assert_eq!(best(&empty, CornerTangents::default().per_corner()).corners, 0);
}
