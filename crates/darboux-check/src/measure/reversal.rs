//! Decides whether faces or normals are reversed, where they disagree.
//!
//! Faces that enclose a volume are wound outwards if it is positive. On an open surface the tangents can side
//! with the faces: the bitangent w cross(n, t) points along the rising v if the normals are those that the
//! tangents were made for, and against it if the normals were negated since. (So it does in a mirrored space,
//! where the faces and the signs w are reversed; turning the normals over keeps the visible side visible.)
//! Tangents that side with the normals decide nothing: either the faces are reversed, or both the normals and
//! the signs w were negated.

use std::collections::BTreeMap;

use darboux::internal::vectors::double;

use crate::surface::{Surface, cross, dot, has_direction, sub, uv_area, xyz};

/// The triangles by the side to which the normals of all their corners point.
#[derive(Debug)]
pub struct Sides {
    /// The numbers of the triangles whose normals all point to their back, ascending.
    pub against: Vec<usize>,
    /// The number of triangles whose normals all point to their front.
    along: usize,
    /// The number of triangles with an area and three normals that have a direction: the others show no
    /// side, and none of them may hide which side is that of most.
    with_directions: usize,
}

impl Sides {
    /// Without normals, no triangle has a side.
    pub fn of(surface: &Surface) -> Self {
        let mut sides = Self { against: Vec::new(), along: 0, with_directions: 0 };
        let Some(normals) = &surface.normals else { return sides };
        for (number, triangle) in surface.triangles().enumerate() {
            let [a, b, c] = triangle.map(|vertex| surface.positions[vertex]);
            let front = cross(sub(b, a), sub(c, a));
            let have_directions = triangle.iter().all(|&vertex| has_direction(normals[vertex]));
            // The front of a triangle with NaN is not longer than zero.
            if !(have_directions && dot(front, front) > 0.0) {
                continue;
            }
            sides.with_directions += 1;
            let cosines = triangle.map(|vertex| dot(front, normals[vertex]));
            if cosines.iter().all(|cosine| *cosine < 0.0) {
                sides.against.push(number);
            } else if cosines.iter().all(|cosine| *cosine > 0.0) {
                sides.along += 1;
            }
        }
        sides
    }

    /// Whether most triangles that can show a side are wound against their normals.
    pub fn are_mostly_against(&self) -> bool {
        2 * self.against.len() > self.with_directions
    }
}

/// What is reversed on a surface that is wound against its normals, and how that is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reversal {
    /// The order of the faces' corners: they enclose a negative volume.
    Faces,
    /// The normals: the faces enclose a positive volume.
    Normals,
    /// The normals: the surface is open, and its tangents contradict them.
    NormalsByTangents,
    /// Undecided, and why.
    Unknown(Undecided),
}

/// Why it is undecided whether faces or normals are reversed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Undecided {
    /// Only a part of the surface is reversed.
    OnlyAPart,
    /// The surface is open and has no tangents.
    NoTangents,
    /// The surface is open, and its tangents side with the normals.
    TangentsFollowNormals,
    /// The surface is open, and its tangents contradict each other.
    ContradictoryTangents,
}

/// The share of triangles, area or corners that decides.
const NEARLY_ALL: f64 = 0.98;

impl Reversal {
    /// None where most faces agree with their normals.
    pub fn of(surface: &Surface, sides: &Sides) -> Option<Self> {
        if !sides.are_mostly_against() {
            return None;
        }
        let against = sides.against.len();
        let is_uniform = against as f64 >= NEARLY_ALL * (against + sides.along) as f64;
        if !is_uniform {
            return Some(Self::Unknown(Undecided::OnlyAPart));
        }
        Some(by_volume(surface).unwrap_or_else(|| by_tangents(surface)))
    }
}

type Vector = [f64; 3];

/// Sums over a part of the surface that is connected through equal positions.
#[derive(Clone, Copy)]
struct Solid {
    area: f64,
    /// The sum of the faces' normals times their areas. Zero for closed surfaces.
    area_vector: Vector,
    /// The volume of the tetrahedra from the origin to the faces.
    volume: f64,
    low: Vector,
    high: Vector,
}

/// The largest length of the area vector, as a part of the area, of surfaces that are called nearly closed:
/// their holes are no larger. Published models with small gaps have at most 0.013, an open hemisphere has
/// 0.5.
const MAX_HOLES: f64 = 0.1;

/// The smallest volume over area and distance from the origin: rounding of positions changes the ratio by
/// some 1e-7. Smaller volumes belong to flat shapes that are closed by having two sides.
const MIN_THICKNESS: f64 = 1e-6;

/// By the signs of the volumes of nearly closed parts; none where they are less than half of the surface or
/// contradict each other.
fn by_volume(surface: &Surface) -> Option<Reversal> {
    let solids = solids(surface);
    let all: f64 = solids.iter().map(|solid| solid.area).sum();
    let area_of = |sign: f64| -> f64 {
        solids.iter().filter(|solid| solid.sign() == sign).map(|solid| solid.area).sum()
    };
    let [outwards, inwards] = [1.0, -1.0].map(area_of);
    let decided = outwards + inwards;
    if decided == 0.0 || decided < 0.5 * all {
        None
    } else if outwards >= NEARLY_ALL * decided {
        Some(Reversal::Normals)
    } else if inwards >= NEARLY_ALL * decided {
        Some(Reversal::Faces)
    } else {
        None
    }
}

/// Whether the faces enclose a negative volume.
pub fn are_faces_inwards(surface: &Surface) -> bool {
    by_volume(surface) == Some(Reversal::Faces)
}

impl Solid {
    const EMPTY: Self = Self {
        area: 0.0,
        area_vector: [0.0; 3],
        volume: 0.0,
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    fn add(&mut self, corners: [Vector; 3]) {
        let [a, b, c] = corners;
        let edges = [b, c].map(|end| [0, 1, 2].map(|i| end[i] - a[i]));
        let normal = double::cross(edges[0], edges[1]);
        self.area += 0.5 * double::dot(normal, normal).sqrt();
        self.volume += double::dot(a, normal) / 6.0;
        for i in 0..3 {
            self.area_vector[i] += 0.5 * normal[i];
            self.low[i] = corners.iter().fold(self.low[i], |low, corner| low.min(corner[i]));
            self.high[i] = corners.iter().fold(self.high[i], |high, corner| high.max(corner[i]));
        }
    }

    /// 1 where a nearly closed part is wound outwards, -1 where it is wound inwards, 0 where it has too large
    /// holes or no volume.
    ///
    /// Holes that are closed by cones to a point q leave the volume V(q) = V(0) - dot(q, area vector) / 3, so
    /// the sign is sure if it is the same for every q of the bounding box.
    fn sign(&self) -> f64 {
        let Self { area, area_vector, volume, low, high } = *self;
        let distance = (0..3).map(|i| low[i].abs().max(high[i].abs())).fold(0.0, f64::max);
        let middle = [0, 1, 2].map(|i| 0.5 * (low[i] + high[i]));
        let reach: f64 = (0..3).map(|i| 0.5 * (high[i] - low[i]) * area_vector[i].abs()).sum();
        let volume = volume - double::dot(middle, area_vector) / 3.0;
        let is_closed = double::dot(area_vector, area_vector).sqrt() <= MAX_HOLES * area;
        let is_sure = volume.abs() > reach / 3.0 && volume.abs() > MIN_THICKNESS * area * distance;
        if is_closed && is_sure { volume.signum() } else { 0.0 }
    }
}

/// The parts with an area.
fn solids(surface: &Surface) -> Vec<Solid> {
    let part_of_vertex = surface.parts(|vertex| surface.positions[vertex].map(bits));
    let mut solids = BTreeMap::new();
    for triangle in surface.triangles() {
        let corners = triangle.map(|vertex| surface.positions[vertex].map(f64::from));
        if corners.as_flattened().iter().all(|x| x.is_finite()) {
            solids.entry(part_of_vertex[triangle[0]]).or_insert(Solid::EMPTY).add(corners);
        }
    }
    solids.into_values().filter(|solid| solid.area > 0.0).collect()
}

/// The bits of a coordinate; adding 0.0 makes both zeros one.
fn bits(x: f32) -> u32 {
    (x + 0.0).to_bits()
}

/// By the tangents of an open surface.
fn by_tangents(surface: &Surface) -> Reversal {
    match share_against_normals(surface) {
        None => Reversal::Unknown(Undecided::NoTangents),
        Some(share) if share >= NEARLY_ALL => Reversal::NormalsByTangents,
        Some(share) if share <= 1.0 - NEARLY_ALL => Reversal::Unknown(Undecided::TangentsFollowNormals),
        Some(_) => Reversal::Unknown(Undecided::ContradictoryTangents),
    }
}

/// The share of corners whose tangents contradict their normals; none without tangents.
fn share_against_normals(surface: &Surface) -> Option<f64> {
    let (normals, tangents) = (surface.normals.as_ref()?, surface.tangents.as_ref()?);
    let uvs = surface.uv_sets.get(&surface.uv_set)?;
    let (mut along, mut against) = (0usize, 0usize);
    for triangle in surface.triangles() {
        let [a, b, c] = triangle.map(|vertex| surface.positions[vertex]);
        let area = uv_area(uvs, triangle);
        let [u, v, w] = triangle.map(|vertex| uvs[vertex]);
        let (along_b, along_c) = (f64::from(v[0]) - f64::from(u[0]), f64::from(w[0]) - f64::from(u[0]));
        let [b, c] = [sub(b, a), sub(c, a)];
        // dP/dv times the UV area; glTF's v points down.
        let rising = |i: usize| (along_c * f64::from(b[i]) - along_b * f64::from(c[i])) * area.signum();
        for vertex in triangle {
            let (normal, tangent) = (normals[vertex], tangents[vertex]);
            let bitangent = cross(normal, xyz(tangent));
            let agreement: f64 = (0..3).map(|i| f64::from(bitangent[i]) * rising(i)).sum();
            match agreement * f64::from(tangent[3]) {
                x if x > 0.0 => along += 1,
                x if x < 0.0 => against += 1,
                _ => {}
            }
        }
    }
    let all = along + against;
    (all > 0).then(|| against as f64 / all as f64)
}
