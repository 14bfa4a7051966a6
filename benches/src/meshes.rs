//! The meshes of the benchmark: generated from formulas and fixed seeds, or read from models.

use std::collections::HashSet;
use std::f32::consts::{PI, TAU};
use std::path::Path;

use darboux_tests::{Dice, FaceSizes, OwnedMesh, families, models};

/// The size of the generated meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// About how many triangles the large meshes have.
    pub triangles: usize,
}

/// A mesh and its name in the table.
#[derive(Debug)]
pub struct Named {
    /// Its name.
    pub name: String,
    /// A mesh of triangles or of quads.
    pub mesh: OwnedMesh,
}

impl Named {
    /// The number of triangles; a quad is two.
    pub fn triangles(&self) -> usize {
        self.mesh.corner_count() - 2 * self.mesh.face_sizes().len()
    }
}

type Maker = fn(Size) -> OwnedMesh;

/// The generated meshes, in the table's order. The reference takes quadratic time on the last four.
const MAKERS: &[(&str, Maker)] = &[
    ("grid", |size| grid(size.side(1000), size.side(500))),
    ("quads", |size| quads(grid(size.side(1000), size.side(500)))),
    ("sphere", |size| sphere(size.side(500), size.side(1000))),
    ("soup", |size| grid(size.side(1000), size.side(500)).unindexed()),
    ("charts", |size| charts(size.count(20_000))),
    ("small", |_| grid(50, 50)),
    ("fan", |size| families::fan(size.count(20_000), false)),
    ("polar-fan", |size| families::fan(size.count(4_000), true)),
    ("lone-degenerates", |size| {
        let side = size.side(200);
        families::with_lone_degenerates(families::grid(side, side, false, false), size.count(20_000))
    }),
    ("one-position", |size| families::unwelded_fan(size.count(20_000))),
];

/// The model of which all primitives are measured, whatever their size.
const HELMET: &str = "FlightHelmet";

/// Primitives of other models need more triangles than this.
const LARGE: usize = 50_000;

impl Size {
    /// The size of the benchmark.
    pub const FULL: Self = Self { triangles: 1_000_000 };
    /// For quick runs and instruction counts.
    pub const QUICK: Self = Self { triangles: 50_000 };

    /// A number of triangles, `full` in [`Size::FULL`].
    fn count(self, full: usize) -> usize {
        full * self.triangles / Self::FULL.triangles
    }

    /// A side of a rectangle of cells, `full` in [`Size::FULL`], whose area shrinks as [`Size::count`] does.
    fn side(self, full: usize) -> usize {
        (full as f64 * (self.triangles as f64 / Self::FULL.triangles as f64).sqrt()) as usize
    }
}

/// The names of the generated meshes.
pub fn made() -> impl Iterator<Item = &'static str> {
    MAKERS.iter().map(|maker| maker.0)
}

/// The generated mesh with this name.
pub fn make(name: &str, size: Size) -> Option<Named> {
    let (_, maker) = MAKERS.iter().find(|maker| maker.0 == name)?;
    Some(Named { name: name.into(), mesh: maker(size) })
}

/// `helmet` (all of FlightHelmet as one mesh), its primitives, and every other one of more than 50,000
/// triangles below a folder.
pub fn real(folder: &Path) -> Vec<Named> {
    let mut found: Vec<Named> = Vec::new();
    for path in models::models(folder) {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let primitives = models::meshes(&path);
        if stem == HELMET {
            found.push(Named { name: "helmet".into(), mesh: joined(&primitives) });
        }
        let is_wanted = |mesh: &OwnedMesh| stem == HELMET || mesh.corner_count() / 3 > LARGE;
        let large = primitives.into_iter().filter(|(_, mesh)| is_wanted(mesh));
        found.extend(large.map(|(number, mesh)| Named { name: format!("{stem}:{number}"), mesh }));
    }
    // A model may exist in several containers (.gltf and .glb).
    let mut names = HashSet::new();
    found.retain(|mesh| names.insert(mesh.name.clone()));
    found
}

/// All primitives of a model as one indexed mesh.
fn joined(primitives: &[(usize, OwnedMesh)]) -> OwnedMesh {
    let mut whole = OwnedMesh::default();
    let mut corners = Vec::new();
    for (_, mesh) in primitives {
        let first = whole.positions.len();
        whole.positions.extend(&mesh.positions);
        whole.normals.extend(&mesh.normals);
        whole.uvs.extend(&mesh.uvs);
        corners.extend((0..mesh.corner_count()).map(|corner| (first + mesh.vertex_of_corner(corner)) as u32));
    }
    OwnedMesh { indices: Some(corners), ..whole }
}

/// A smooth height field of `width` by `height` cells, two triangles each, all vertices shared.
fn grid(width: usize, height: usize) -> OwnedMesh {
    let (rows, columns) = (height + 1, width + 1);
    let mut mesh = OwnedMesh::default();
    for y in 0..rows {
        for x in 0..columns {
            mesh.push(bump([x as f32 / width as f32, y as f32 / height as f32]));
        }
    }
    OwnedMesh { indices: Some(cells(width, height)), ..mesh }
}

/// Joins pairs of triangles into quads. The triangles must be split from the first corner to the third.
fn quads(mesh: OwnedMesh) -> OwnedMesh {
    let halves: &[[u32; 6]] = mesh.indices.as_deref().map_or(&[], |list| list.as_chunks().0);
    let corners = halves.iter().flat_map(|&[a, b, c, _, _, d]| [a, b, c, d]).collect();
    OwnedMesh { indices: Some(corners), faces: FaceSizes::Quads, ..mesh }
}

/// A point of the height field over the unit square, and its UV a slight warp of the square.
fn bump([x, y]: [f32; 2]) -> darboux_tests::mesh::Vertex {
    let height = 0.05 * (9.0 * x).sin() * (7.0 * y).cos();
    let slope = [0.45 * (9.0 * x).cos() * (7.0 * y).cos(), -0.35 * (9.0 * x).sin() * (7.0 * y).sin()];
    let uv = [x + 0.02 * (5.0 * y).sin(), y + 0.02 * (4.0 * x).sin()];
    ([x, y, height], normalized([-slope[0], -slope[1], 1.0]), uv)
}

/// A UV sphere of `rings` by `segments` cells, two triangles each: a seam, and at the poles a vertex per
/// segment, so that every second triangle there has no area.
fn sphere(rings: usize, segments: usize) -> OwnedMesh {
    let mut mesh = OwnedMesh::default();
    for ring in 0..=rings {
        for segment in 0..=segments {
            let (v, u) = (ring as f32 / rings as f32, segment as f32 / segments as f32);
            let (radius, z) = if ring == rings { (0.0, -1.0) } else { (PI * v).sin_cos() };
            let (y, x) = if segment == segments { (0.0, 1.0) } else { (TAU * u).sin_cos() };
            let position = [radius * x, radius * y, z];
            mesh.push((position, position, [u, v]));
        }
    }
    OwnedMesh { indices: Some(cells(segments, rings)), ..mesh }
}

/// `count` pieces of 50 triangles on a surface, every second one with mirrored UVs, their triangles and
/// vertices shuffled: the worst case for caches.
fn charts(count: usize) -> OwnedMesh {
    const SIDE: usize = 5;
    let columns = (count as f32).sqrt().ceil() as usize;
    let mut mesh = OwnedMesh::default();
    let mut corners = Vec::new();
    for chart in 0..count {
        let first = mesh.positions.len() as u32;
        let [left, top] = [(chart % columns) as f32, (chart / columns) as f32];
        let turn = if chart.is_multiple_of(2) { 1.0 } else { -1.0 };
        for i in 0..(SIDE + 1) * (SIDE + 1) {
            let [x, y] = [(i % (SIDE + 1)) as f32, (i / (SIDE + 1)) as f32].map(|x| 0.9 * x / SIDE as f32);
            let (position, normal, [u, v]) = bump([(left + x) / columns as f32, (top + y) / columns as f32]);
            mesh.push((position, normal, [turn * u, v]));
        }
        corners.extend(cells(SIDE, SIDE).into_iter().map(|vertex| first + vertex));
    }
    shuffled(&mesh, &corners, &mut Dice::from_seed(20_000))
}

/// The same triangles in another order, their vertices renumbered at random.
fn shuffled(mesh: &OwnedMesh, corners: &[u32], dice: &mut Dice<'_>) -> OwnedMesh {
    let mut old_of_new: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    shuffle(&mut old_of_new, dice);
    let mut result = OwnedMesh::default();
    let mut new_of_old = vec![0; old_of_new.len()];
    for &old in &old_of_new {
        new_of_old[old as usize] = result.push(mesh.vertex(old as usize));
    }
    let mut triangles: Vec<[u32; 3]> = corners.as_chunks().0.to_vec();
    shuffle(&mut triangles, dice);
    let corners = triangles.as_flattened().iter().map(|&old| new_of_old[old as usize]).collect();
    OwnedMesh { indices: Some(corners), ..result }
}

/// Fisher-Yates shuffle. The generator returns 16 bits per draw, so each index takes two draws.
fn shuffle<T>(list: &mut [T], dice: &mut Dice<'_>) {
    for last in (1..list.len()).rev() {
        let draw = dice.below(1 << 16) << 16 | dice.below(1 << 16);
        list.swap(last, draw % (last + 1));
    }
}

/// Two triangles for each cell of a rectangle with `width` + 1 vertices in a row.
fn cells(width: usize, height: usize) -> Vec<u32> {
    let cell = |i: usize| {
        let a = ((i / width) * (width + 1) + i % width) as u32;
        let c = a + width as u32 + 1;
        [a, a + 1, c + 1, a, c + 1, c]
    };
    (0..width * height).flat_map(cell).collect()
}

fn normalized(v: [f32; 3]) -> [f32; 3] {
    let length = v.iter().map(|x| x * x).sum::<f32>().sqrt();
    v.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangles(name: &str, size: Size) -> usize {
        make(name, size).expect("a mesh of this name").triangles()
    }

    #[test]
    fn sizes_are_as_named() {
        for name in ["grid", "quads", "sphere", "soup", "charts"] {
            assert_eq!(triangles(name, Size::FULL), 1_000_000, "{name}");
            assert!((48_000..=50_000).contains(&triangles(name, Size::QUICK)), "{name}");
        }
        assert_eq!(triangles("small", Size::FULL), 5_000);
        assert_eq!(triangles("lone-degenerates", Size::FULL), 100_000);
    }

    #[test]
    fn half_of_the_charts_are_mirrored() {
        let mesh = charts(100);
        let mirrored = (0..mesh.corner_count()).step_by(3).filter(|&corner| {
            let [a, b, c] = [0, 1, 2].map(|i| mesh.uvs[mesh.vertex_of_corner(corner + i)]);
            (b[0] - a[0]) * (c[1] - a[1]) < (b[1] - a[1]) * (c[0] - a[0])
        });
        assert_eq!(mirrored.count(), 100 * 50 / 2);
    }

    #[test]
    fn shuffling_moves_vertices_and_triangles_and_is_the_same_every_time() {
        let (mesh, again) = (charts(100), charts(100));
        assert_eq!(mesh, again);
        let far = (0..mesh.corner_count())
            .step_by(3)
            .filter(|&corner| mesh.vertex_of_corner(corner).abs_diff(mesh.vertex_of_corner(corner + 1)) > 36);
        assert!(far.count() > 4_500);
    }

    #[test]
    fn a_sphere_s_pole_triangles_have_no_area() {
        let mesh = sphere(4, 8);
        let flat = (0..mesh.corner_count()).step_by(3).filter(|&corner| {
            let [a, b, c] = [0, 1, 2].map(|i| mesh.positions[mesh.vertex_of_corner(corner + i)]);
            a == b || b == c || c == a
        });
        assert_eq!(flat.count(), 16);
    }
}
