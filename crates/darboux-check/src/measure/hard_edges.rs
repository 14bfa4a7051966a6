//! Hard edges at which the UVs go on.
//!
//! At a hard edge both sides have normals of their own, and so does a map that is baked for them: its texels
//! differ from one side to the other. Without a UV seam both sides meet within one texel, so that filtering
//! and smaller mip levels mix them: a line along the edge is lit from a wrong side.

use crate::indices::Indices;
use crate::measure::values::first_equal;
use crate::surface::{Surface, dot};

/// The edges of a surface at which normals break and UVs do not.
#[derive(Clone, Debug, PartialEq)]
pub struct HardEdges {
    /// The numbers of the triangles at such edges, ascending.
    pub triangles: Indices,
    /// The number of these edges, and of all hard ones.
    pub edges: usize,
    pub all: usize,
    /// The largest angle between the normals of both sides, in degrees.
    pub largest: f64,
}

/// The degrees from which on the normals of both sides make an edge hard.
const HARD: f64 = 30.0;

/// An edge of a triangle.
struct Edge {
    /// The places of both ends, the lower one first.
    places: [u32; 2],
    triangle: usize,
    /// The vertices at these places.
    ends: [usize; 2],
}

impl HardEdges {
    /// None where there are no such edges. `uvs`: of the vertices.
    pub fn of(surface: &Surface, uvs: &[[f32; 2]]) -> Option<Self> {
        let normals = surface.normals.as_ref()?;
        let edges = edges_between_breaks(surface, normals)?;
        let (mut triangles, mut all, mut count, mut largest) = (Vec::new(), 0, 0, 0.0f64);
        for sides in edges.chunk_by(|a, b| a.places == b.places) {
            let [a, b] = sides else { continue };
            let angles = [0, 1].map(|end| angle(normals[a.ends[end]], normals[b.ends[end]]));
            if angles.iter().any(|angle| *angle < HARD) {
                continue;
            }
            all += 1;
            if (0..2).all(|end| uvs[a.ends[end]] == uvs[b.ends[end]]) {
                count += 1;
                triangles.extend([a.triangle, b.triangle]);
                largest = largest.max(angles[0]).max(angles[1]);
            }
        }
        triangles.sort_unstable();
        triangles.dedup();
        let triangles = triangles.as_slice().into();
        (count > 0).then_some(Self { triangles, edges: count, all, largest })
    }
}

/// The edges both of whose ends have vertices with unlike normals, ordered by their places; none where no
/// place has.
fn edges_between_breaks(surface: &Surface, normals: &[[f32; 3]]) -> Option<Vec<Edge>> {
    let places = first_equal(&surface.positions);
    let mut is_break = vec![false; places.len()];
    for (normal, &place) in normals.iter().zip(&places) {
        // Of two normals that are 30 degrees apart, one is at least 15 from the first.
        is_break[place as usize] |= angle(normals[place as usize], *normal) >= HARD / 2.0;
    }
    is_break.contains(&true).then_some(())?;
    let mut edges = Vec::new();
    for (triangle, corners) in surface.triangles().enumerate() {
        for corner in 0..3 {
            let mut ends = [corners[corner], corners[(corner + 1) % 3]];
            ends.sort_by_key(|&vertex| places[vertex]);
            let places = ends.map(|vertex| places[vertex]);
            if places[0] != places[1] && places.iter().all(|&place| is_break[place as usize]) {
                edges.push(Edge { places, triangle, ends });
            }
        }
    }
    edges.sort_by_key(|edge| edge.places);
    Some(edges)
}

/// The angle between two normals in degrees; 0 where one has no direction.
fn angle(a: [f32; 3], b: [f32; 3]) -> f64 {
    let cosine = dot(a, b) / (dot(a, a) * dot(b, b)).sqrt();
    if cosine.is_finite() { cosine.clamp(-1.0, 1.0).acos().to_degrees() } else { 0.0 }
}
