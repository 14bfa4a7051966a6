//! Recovers the quads that a triangle list was made of: programs compute tangents on quads and cut them
//! afterwards, often along the other diagonal than MikkTSpace does.
//!
//! Two triangles with a common edge are the likelier halves of a quad, the more it is a parallelogram in UV
//! space, and flat and rectangular in space. The likeliest pairs are taken first, and every triangle once.
//! Vertices with the same values are one: a file may have one per corner.

use std::collections::HashMap;

use crate::Error;
use crate::Mesh;
use crate::exec::limits::RunLimits;
use crate::math::{V3, cross, dot, scale, sub};
use crate::mesh::{Faces, Indices};

/// A mesh of quads and triangles, with the corners that it has in common with a triangle list.
pub struct QuadMesh {
    vertex_of_corner: Vec<u32>,
    face_sizes: Vec<u32>,
    /// The corner of this mesh of every corner of the triangle list.
    pub corner_of_corner: Vec<u32>,
}

/// Two triangles by their corners opposite of the common edge, and how unlikely they are a quad.
struct Pair {
    cost: f32,
    corners: [u32; 2],
}

impl QuadMesh {
    /// None where no triangles have a common edge, and for meshes of other faces than triangles. Errors:
    /// cancellation.
    pub fn recover(mesh: &Mesh<'_>, limits: RunLimits<'_>) -> Result<Option<Self>, Error> {
        if !matches!(mesh.faces(), Faces::Triangles) {
            return Ok(None);
        }
        let mut pairs = pairs(mesh, limits)?;
        pairs.sort_unstable_by(|a, b| a.cost.total_cmp(&b.cost).then(a.corners.cmp(&b.corners)));
        limits.check()?;
        let triangles = mesh.corner_count() / 3;
        let mut partner = vec![None; triangles];
        for Pair { corners: [a, b], .. } in &pairs {
            let [first, second] = [*a as usize / 3, *b as usize / 3];
            if partner[first].is_none() && partner[second].is_none() {
                partner[first] = Some([*a, *b]);
                partner[second] = Some([*b, *a]);
            }
        }
        Ok((!pairs.is_empty()).then(|| Self::join(mesh, &partner)))
    }

    /// `partner`: per triangle its corner opposite of the common edge, and that of the other triangle.
    fn join(mesh: &Mesh<'_>, partner: &[Option<[u32; 2]>]) -> Self {
        let count = mesh.corner_count();
        let mut quads = Self {
            vertex_of_corner: Vec::with_capacity(count),
            face_sizes: Vec::with_capacity(partner.len()),
            corner_of_corner: vec![0; count],
        };
        for (triangle, partner) in partner.iter().enumerate() {
            match *partner {
                Some([_, other]) if (other as usize) / 3 < triangle => {}
                // The quad's corners: opposite of the edge, its start, opposite on the other side, its end.
                Some([apex, other]) => {
                    let [start, end] = [next(apex), next(next(apex))];
                    let [other_end, other_start] = [next(other), next(next(other))];
                    quads.push(mesh, &[&[apex], &[start, other_start], &[other], &[end, other_end]]);
                }
                None => {
                    let first = 3 * triangle as u32;
                    quads.push(mesh, &[&[first], &[first + 1], &[first + 2]]);
                }
            }
        }
        quads
    }

    /// Adds a face, whose corners are given by those of the triangle list.
    fn push(&mut self, mesh: &Mesh<'_>, face: &[&[u32]]) {
        self.face_sizes.push(face.len() as u32);
        for corners in face {
            for &corner in *corners {
                self.corner_of_corner[corner as usize] = self.vertex_of_corner.len() as u32;
            }
            self.vertex_of_corner.push(mesh.vertex_of_corner(corners[0] as usize) as u32);
        }
    }

    /// The mesh, over the vertices of the triangle list.
    pub fn mesh<'a>(&'a self, of: &Mesh<'a>) -> Result<Mesh<'a>, Error> {
        let indices = Indices::from(&self.vertex_of_corner);
        Mesh::with_faces(of.positions(), of.normals(), of.uvs(), indices, Faces::Mixed(&self.face_sizes))
    }

    /// The number of corners.
    pub fn corner_count(&self) -> usize {
        self.vertex_of_corner.len()
    }
}

/// The next corner of a corner's triangle.
fn next(corner: u32) -> u32 {
    if corner % 3 == 2 { corner - 2 } else { corner + 1 }
}

/// All pairs of triangles at edges that have two of them, one on each side.
fn pairs(mesh: &Mesh<'_>, limits: RunLimits<'_>) -> Result<Vec<Pair>, Error> {
    let first_equal = first_equal_vertices(mesh);
    limits.check()?;
    let vertex = |corner: u32| u64::from(first_equal[mesh.vertex_of_corner(corner as usize)]);
    // Every corner stands for the edge that is opposite of it.
    let edge = |corner: u32| [vertex(next(corner)), vertex(next(next(corner)))];
    let key = |[start, end]: [u64; 2]| start.min(end) << 32 | start.max(end);
    let mut edges: Vec<(u64, u32)> =
        (0..mesh.corner_count() as u32).map(|corner| (key(edge(corner)), corner)).collect();
    limits.check()?;
    edges.sort_unstable();
    limits.check()?;
    let pair = |same: &[(u64, u32)]| {
        let &[(_, a), (_, b)] = same else { return None };
        let [start, end] = edge(a);
        let is_opposite = edge(b) == [end, start] && start != end && vertex(a) != vertex(b);
        is_opposite.then(|| Pair { cost: cost(mesh, a, b), corners: [a, b] })
    };
    Ok(edges.chunk_by(|a, b| a.0 == b.0).filter_map(pair).filter(|pair| pair.cost.is_finite()).collect())
}

/// Per vertex the first one with the same position, normal and UV.
fn first_equal_vertices(mesh: &Mesh<'_>) -> Vec<u32> {
    // Adding 0.0 makes both zeros one.
    let bits = |x: f32| (x + 0.0).to_bits();
    let mut first = HashMap::with_capacity(mesh.vertex_count());
    let equal = |vertex: usize| {
        let [position, normal] = [mesh.positions().get(vertex), mesh.normals().get(vertex)];
        let key = (position.map(bits), normal.map(bits), mesh.uvs().get(vertex).map(bits));
        *first.entry(key).or_insert(vertex as u32)
    };
    (0..mesh.vertex_count()).map(equal).collect()
}

/// How much the cosines of a quad's corners weigh.
const SHEAR: f32 = 0.3;

/// How far a quad is from a parallelogram in UV space, in lengths of the diagonal, plus 1 minus the cosine
/// between its halves, plus the weighted mean of the cosines of its corners.
fn cost(mesh: &Mesh<'_>, a: u32, b: u32) -> f32 {
    let at = |corner: u32| mesh.vertex_of_corner(corner as usize);
    let corners = [at(a), at(next(a)), at(b), at(next(next(a)))];
    let [apex, start, other, end] = corners.map(|vertex| mesh.uvs().get(vertex));
    let length = |x: f32, y: f32| (x * x + y * y).sqrt();
    let lack = length(apex[0] + other[0] - start[0] - end[0], apex[1] + other[1] - start[1] - end[1]);
    let diagonal = length(end[0] - start[0], end[1] - start[1]);
    let [p, q, r, s] = corners.map(|vertex| mesh.positions().get(vertex));
    let bend = 1.0 - dot(unit(cross(sub(q, p), sub(s, p))), unit(cross(sub(s, r), sub(q, r))));
    let edges = [sub(q, p), sub(r, q), sub(s, r), sub(p, s)].map(unit);
    let shear: f32 = (0..4).map(|i| dot(edges[i], edges[(i + 1) % 4]).abs()).sum();
    lack / diagonal + bend + SHEAR * shear / 4.0
}

fn unit(vector: V3) -> V3 {
    scale(1.0 / dot(vector, vector).sqrt(), vector)
}
