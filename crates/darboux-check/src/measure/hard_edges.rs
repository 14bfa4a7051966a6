//! Hard edges at which the UVs go on.
//!
//! At a hard edge both sides have normals of their own, and so does a map that is baked for them: its texels differ from one side to the other. Without a UV seam
//! both sides meet within one texel, so that filtering and smaller mip levels mix them: a line along the edge is lit from a wrong side.

use std::collections::{BTreeMap, HashMap};

use crate::indices::Indices;
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

/// An edge of a triangle: the number of the triangle, and the vertices at both ends, ordered by their positions.
type Edge = (usize, [usize; 2]);

impl HardEdges {
    /// None where there are no such edges. `uvs`: of the vertices.
    pub fn of(surface: &Surface, uvs: &[[f32; 2]]) -> Option<Self> {
        let normals = surface.normals.as_ref()?;
        let places = places(surface);
        // Most surfaces have no place with several normals.
        let mut first = HashMap::new();
        let breaks = |vertex: usize| {
            let normal = normals[vertex];
            angle(*first.entry(places[vertex]).or_insert(normal), normal) >= HARD / 2.0
        };
        (0..normals.len()).any(breaks).then_some(())?;
        let mut edges: BTreeMap<[u32; 2], Vec<Edge>> = BTreeMap::new();
        for (number, triangle) in surface.triangles().enumerate() {
            for corner in 0..3 {
                let mut ends = [triangle[corner], triangle[(corner + 1) % 3]];
                ends.sort_by_key(|&vertex| places[vertex]);
                let key = ends.map(|vertex| places[vertex]);
                if key[0] != key[1] {
                    edges.entry(key).or_default().push((number, ends));
                }
            }
        }
        let (mut triangles, mut all, mut count, mut largest) = (Vec::new(), 0, 0, 0.0f64);
        for sides in edges.values() {
            let [(first, a), (second, b)] = sides[..] else { continue };
            let angles = [0, 1].map(|end| angle(normals[a[end]], normals[b[end]]));
            if angles.iter().any(|angle| *angle < HARD) {
                continue;
            }
            all += 1;
            if (0..2).all(|end| uvs[a[end]] == uvs[b[end]]) {
                count += 1;
                triangles.extend([first, second]);
                largest = largest.max(angles[0]).max(angles[1]);
            }
        }
        triangles.sort_unstable();
        triangles.dedup();
        let triangles = triangles.as_slice().into();
        (count > 0).then_some(Self { triangles, edges: count, all, largest })
    }
}

/// The angle between two normals in degrees; 0 where one has no direction.
fn angle(a: [f32; 3], b: [f32; 3]) -> f64 {
    let cosine = dot(a, b) / (dot(a, a) * dot(b, b)).sqrt();
    if cosine.is_finite() { cosine.clamp(-1.0, 1.0).acos().to_degrees() } else { 0.0 }
}

/// Numbers the positions: equal ones have equal numbers.
fn places(surface: &Surface) -> Vec<u32> {
    let mut numbers: HashMap<[u32; 3], u32> = HashMap::new();
    let number = |position: &[f32; 3]| {
        let next = numbers.len() as u32;
        // Adding 0.0 makes both zeros one.
        *numbers.entry(position.map(|x| (x + 0.0).to_bits())).or_insert(next)
    };
    surface.positions.iter().map(number).collect()
}
