//! Generates random meshes from small sets of values, so that cases that are rare in models are common: equal
//! and almost equal values, both zeros, repeated vertices and faces, edges of many faces, collapsed and
//! mirrored UVs, mixed face sizes, extreme scales.
//!
//! A [`Dice`] makes all choices, from a seed in tests and from the fuzzer's bytes in fuzzing.

use darboux_dice::Dice;

use crate::damage::{damage_faces, negate_zeros};
use crate::model_part::model_part;
use crate::{FaceSizes, OwnedMesh, families};

/// A mesh and a threshold to run it with.
#[derive(Clone, Debug)]
pub struct Case {
    /// The mesh.
    pub mesh: OwnedMesh,
    /// The angular threshold in degrees.
    pub threshold: f32,
}

/// Interesting thresholds: the default, zero, usual values, above 180, negative, NaN.
pub const THRESHOLDS: [f32; 20] = [
    180.0,
    180.0,
    180.0,
    180.0,
    180.0,
    0.0,
    1.0,
    15.0,
    30.0,
    44.9,
    45.0,
    60.0,
    90.0,
    120.0,
    179.0,
    179.99,
    360.0,
    -30.0,
    f32::NAN,
    f32::INFINITY,
];

impl Case {
    /// A mesh of up to about sixty faces, or a part as models have it of up to two hundred.
    pub fn draw(dice: &mut Dice) -> Self {
        let threshold = dice.pick(&THRESHOLDS);
        let mut mesh = match dice.below(12) {
            0..4 => soup(dice),
            4..7 => damaged_family(dice),
            7 => crowded_edges(dice),
            _ => model_part(dice),
        };
        if dice.one_in(6) {
            insert_unsupported_faces(dice, &mut mesh);
        }
        if dice.one_in(4) {
            mesh = mesh.unindexed();
        }
        Self { mesh, threshold }
    }

    /// The case of a seed.
    pub fn from_seed(seed: u64) -> Self {
        Self::draw(&mut Dice::from_seed(seed))
    }

    /// The case of a fuzzer's bytes.
    pub fn from_bytes(bytes: &[u8]) -> Self {
        Self::draw(&mut Dice::from_bytes(bytes))
    }
}

/// The set of values that coordinates are drawn from.
#[derive(Clone, Copy)]
enum Palette {
    Uniform,
    Listed(&'static [f32]),
    AnyFloat,
}

const MIN: f32 = f32::MIN_POSITIVE;
const NEXT_TO_MIN: [f32; 2] = [f32::from_bits(0x007f_ffff), f32::from_bits(0x0080_0001)];
const STEP: f32 = f32::EPSILON;

const PLAIN: &[f32] = &[0.0, 1.0, -1.0, 0.5, -0.0, 2.0];
const ZEROS: &[f32] = &[0.0, -0.0, 1.0, -1.0];
const NEAR: &[f32] =
    &[1.0, 1.0 + STEP, 1.0 - STEP / 2.0, 1.0 + 2.0 * STEP, -1.0, 0.0, 0.333_333_34, 0.333_333_3];
const HUGE: &[f32] = &[0.0, 1.0, 1e15, 1e19, -1e19, 1.9e19, 1e30, -1e30];
const TINY: &[f32] = &[0.0, -0.0, 1.0, 1e-19, -1.1e-19, 1e-22, 1e-30, -1e-30];
const SUBNORMAL: &[f32] =
    &[0.0, -0.0, MIN, -MIN, NEXT_TO_MIN[0], NEXT_TO_MIN[1], 2.0 * MIN, 1e-45, -1e-45, 1e-40];
const SPREAD: &[f32] = &[0.0, 1e-20, 1e-10, -1e-5, 1.0, -1e5, 1e10, 1e20];
const OVERFLOWING: &[f32] = &[0.0, 1.0, f32::MAX, f32::MIN, 1.7e38, 1.8e38, -1.75e38, 3e38];
const NON_FINITE: &[f32] = &[0.0, -0.0, 1.0, -1.0, 0.5, f32::NAN, f32::INFINITY, f32::NEG_INFINITY];

/// Palettes with their frequencies; ordinary numbers are the most frequent.
const PALETTES: [Palette; 20] = [
    Palette::Uniform,
    Palette::Uniform,
    Palette::Uniform,
    Palette::Uniform,
    Palette::Uniform,
    Palette::Listed(PLAIN),
    Palette::Listed(PLAIN),
    Palette::Listed(PLAIN),
    Palette::Listed(PLAIN),
    Palette::Listed(ZEROS),
    Palette::Listed(ZEROS),
    Palette::Listed(NEAR),
    Palette::Listed(NEAR),
    Palette::Listed(HUGE),
    Palette::Listed(TINY),
    Palette::Listed(SUBNORMAL),
    Palette::Listed(SPREAD),
    Palette::Listed(OVERFLOWING),
    Palette::Listed(NON_FINITE),
    Palette::AnyFloat,
];

impl Palette {
    fn draw(self, dice: &mut Dice) -> f32 {
        match self {
            Palette::Uniform => dice.uniform(),
            Palette::Listed(values) => dice.pick(values),
            Palette::AnyFloat => dice.any_float(),
        }
    }

    fn vector<const N: usize>(self, dice: &mut Dice) -> [f32; N] {
        std::array::from_fn(|_| self.draw(dice))
    }
}

/// Faces among few vertices, whose attributes are drawn from fewer values.
fn soup(dice: &mut Dice) -> OwnedMesh {
    let palettes: [Palette; 2] = std::array::from_fn(|_| dice.pick(&PALETTES));
    let positions: Vec<[f32; 3]> = (0..3 + dice.below(8)).map(|_| palettes[0].vector(dice)).collect();
    let uvs: Vec<[f32; 2]> = (0..1 + dice.below(8)).map(|_| palettes[1].vector(dice)).collect();
    let normals: Vec<[f32; 3]> = (0..1 + dice.below(3)).map(|_| normal(dice)).collect();
    let free = dice.one_in(2);
    let mut mesh = OwnedMesh::default();
    for i in 0..3 + dice.below(10) {
        // UVs tied to vertices give connected charts; free UVs separate the triangles at every edge.
        let position = if free { dice.below(positions.len()) } else { i % positions.len() };
        let uv = if free { dice.below(uvs.len()) } else { position % uvs.len() };
        mesh.push((positions[position], normals[dice.below(normals.len())], uvs[uv]));
    }
    let sizes: &[usize] = dice.pick(&[&[3][..], &[3], &[4], &[3, 4]]);
    let faces: Vec<Vec<u32>> =
        (0..1 + dice.below(16)).map(|_| random_face(dice, sizes, mesh.positions.len())).collect();
    mesh.with_face_list(&faces)
}

fn random_face(dice: &mut Dice, sizes: &[usize], vertices: usize) -> Vec<u32> {
    let size = dice.pick(sizes);
    let stray = dice.one_in(3);
    let start = dice.below(vertices);
    (0..size).map(|i| if stray { dice.below(vertices) } else { (start + i) % vertices } as u32).collect()
}

fn normal(dice: &mut Dice) -> [f32; 3] {
    const AXES: [[f32; 3]; 4] = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [-0.0, 0.0, -1.0]];
    match dice.below(8) {
        0..3 => dice.pick(&AXES),
        3 => [0.0; 3],
        4 => [0.0, 0.0, dice.pick(&[0.5, 2.0, 1e-30, 1e30])],
        5 => dice.pick(&PALETTES).vector(dice),
        _ => unit(Palette::Uniform.vector(dice)),
    }
}

fn unit(v: [f32; 3]) -> [f32; 3] {
    let length = v.iter().map(|x| x * x).sum::<f32>().sqrt();
    if length > 0.0 { v.map(|x| x / length) } else { v }
}

/// A regular mesh with a few random defects.
fn damaged_family(dice: &mut Dice) -> OwnedMesh {
    let quads = dice.one_in(2);
    let (width, height) = (1 + dice.below(5), 1 + dice.below(4));
    let mut mesh = match dice.below(6) {
        0 => families::grid(width, height, quads, dice.one_in(2)),
        1 => families::sphere(1 + width, 2 + height, quads),
        2 => families::fan(2 + dice.below(24), dice.one_in(2)),
        3 => families::strip(1 + dice.below(24)),
        4 => families::moebius(3 + dice.below(6), quads),
        _ => families::cube(quads),
    };
    for _ in 0..dice.below(8) {
        damage(dice, &mut mesh);
    }
    mesh
}

fn damage(dice: &mut Dice, mesh: &mut OwnedMesh) {
    let count = mesh.positions.len();
    let (a, b) = (dice.below(count), dice.below(count));
    let palette = dice.pick(&PALETTES);
    match dice.below(14) {
        0 => mesh.positions[a] = mesh.positions[b],
        1 => mesh.uvs[a] = mesh.uvs[b],
        2 => mesh.normals[a] = normal(dice),
        3 => mesh.positions[a][dice.below(3)] = palette.draw(dice),
        4 => mesh.uvs[a][dice.below(2)] = palette.draw(dice),
        5 => negate_zeros(dice, mesh),
        6 => mesh.uvs.iter_mut().take(a).for_each(|uv| uv[0] = -uv[0]),
        7 => {
            let scale = dice.pick(&[1e-30, 1e-19, 1e-38, 1e30, 1e19, -1.0, 0.0]);
            mesh.positions.as_flattened_mut().iter_mut().for_each(|x| *x *= scale);
        }
        8 => {
            let scale = dice.pick(&[1e-30, 1e-19, 1e-38, 1e30, 1e19, -1.0, 0.0]);
            mesh.uvs.as_flattened_mut().iter_mut().for_each(|x| *x *= scale);
        }
        _ => damage_faces(dice, mesh),
    }
}

/// Many faces that share few edges, in both orientations and in random order; some are quads.
fn crowded_edges(dice: &mut Dice) -> OwnedMesh {
    let mut mesh = OwnedMesh::default();
    let spokes = 3 + dice.below(6) as u32;
    for i in 0..spokes {
        let position = Palette::Uniform.vector(dice);
        let normal = if dice.one_in(4) { normal(dice) } else { [0.0, 0.0, 1.0] };
        let uv = if dice.one_in(2) { Palette::Uniform.vector(dice) } else { [position[0], position[1]] };
        mesh.push((position, normal, if i == 0 { [0.0; 2] } else { uv }));
    }
    let hub = dice.pick(&[0, spokes - 1]);
    let has_quads = dice.one_in(2);
    let mut faces = Vec::new();
    for _ in 0..2 + dice.below(60) {
        let [a, b, c] = [(); 3].map(|()| (hub + 1 + dice.below(spokes as usize - 1) as u32) % spokes);
        let mut face = vec![hub, a, b, c];
        face.truncate(if has_quads && dice.one_in(2) { 4 } else { 3 });
        face.rotate_left(dice.below(3));
        faces.push(face);
    }
    mesh.with_face_list(&faces)
}

/// Inserts faces with unsupported corner counts, often before the first face.
fn insert_unsupported_faces(dice: &mut Dice, mesh: &mut OwnedMesh) {
    let mut faces = mesh.face_list();
    for _ in 0..1 + dice.below(3) {
        let at = if dice.one_in(2) { 0 } else { dice.below(faces.len()) };
        let size = dice.pick(&[1, 2, 5, 6]);
        faces.insert(at, random_face(dice, &[size], mesh.positions.len()));
    }
    *mesh = std::mem::take(mesh).with_face_list(&faces);
    debug_assert!(matches!(mesh.faces, FaceSizes::Mixed(_)));
}
