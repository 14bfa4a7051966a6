//! Mistakes of code that computes tangents, made on purpose to show what they look like
//! (docs/algorithms/mistakes.md).
//!
//! Each is the computation as it is found in code, over the triangles of the model. Two mistakes need a mesh
//! that has something to trip over, and are made as if it had: [`FrameMistake::NoGuard`] takes every 61st
//! triangle for one without UV area, and [`FrameMistake::NormalMatrix`] takes the model for one that a node
//! stretched to twice its size along a diagonal.

use std::collections::HashMap;

use darboux::choice;

use crate::algebra::{V3, cross, dot};
use crate::vertex::SurfaceVertex;

/// A mistake in the computation of tangents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FrameMistake {
    /// The sign is tested against the tangent's sum instead of the bitangent's.
    SignNoise,
    /// Triangles without UV area are divided by zero.
    NoGuard,
    /// Tangent and bitangent are both negated.
    BothNegated,
    /// The UV matrix is not inverted: T = du1 e1 + du2 e2.
    UvNotInverted,
    /// One edge is used twice in the bitangent, from which the sign is taken.
    EdgeTwice,
    /// The bitangent is computed without w.
    WithoutW,
    /// The tangent is transformed by the normal matrix.
    NormalMatrix,
    /// Threads lose additions of each other.
    Race,
    /// The last vertices are written from beyond the end of a buffer.
    NoBoundsCheck,
    /// The offsets of adjacency lists are vertex numbers.
    AdjacencyOffsets,
    /// Gram-Schmidt with normals of length 10.
    LongNormals,
    /// One tangent per vertex at mirrored seams: both orientations are added.
    OneTangent,
    /// Results of corners are written through the index list: the last triangle wins.
    LastCorner,
}

choice! { FrameMistake, "mistake",
    SignNoise => "sign-noise", "Test the sign against the tangent's sum";
    NoGuard => "no-guard", "Divide by the UV area of triangles without one";
    BothNegated => "both-negated", "Negate tangent and bitangent";
    UvNotInverted => "uv-not-inverted", "Use the UV matrix instead of its inverse";
    EdgeTwice => "edge-twice", "Use one edge twice in the bitangent";
    WithoutW => "without-w", "Leave w out of the bitangent";
    NormalMatrix => "normal-matrix", "Transform tangents by the normal matrix";
    Race => "race", "Let threads lose each other's additions";
    NoBoundsCheck => "no-bounds-check", "Let threads beyond the last vertex write";
    AdjacencyOffsets => "adjacency-offsets", "Use vertex numbers as offsets of adjacency lists";
    LongNormals => "long-normals", "Apply Gram-Schmidt with normals of length 10";
    OneTangent => "one-tangent", "Give vertices at mirrored seams one tangent";
    LastCorner => "last-corner", "Write corners through the old index list";
}

/// The tangents of corners with a mistake. `uvs`: one per corner.
pub fn tangents(mistake: FrameMistake, corners: &[SurfaceVertex], uvs: &[[f32; 2]]) -> Vec<[f32; 4]> {
    let surface = Surface::new(corners, uvs);
    let each = |change: &dyn Fn(usize, &SurfaceVertex) -> [f32; 4]| {
        corners.iter().enumerate().map(|(at, corner)| change(at, corner)).collect()
    };
    match mistake {
        FrameMistake::SignNoise => each(&|_, corner| {
            let [x, y, z, _] = corner.tangent;
            let noise = dot(cross(corner.normal, [x, y, z]), [x, y, z]);
            [x, y, z, if noise < 0.0 { -1.0 } else { 1.0 }]
        }),
        FrameMistake::BothNegated => each(&|_, corner| {
            let [x, y, z, w] = corner.tangent;
            [-x, -y, -z, w]
        }),
        FrameMistake::WithoutW => each(&|_, corner| {
            let [x, y, z, _] = corner.tangent;
            [x, y, z, 1.0]
        }),
        FrameMistake::EdgeTwice => each(&|at, corner| surface.sign_of_one_edge(at, corner)),
        FrameMistake::NormalMatrix => each(&|_, corner| unstretched(corner)),
        FrameMistake::LastCorner => {
            let mut last = vec![[0.0; 4]; surface.vertex_count];
            surface.vertices.iter().zip(corners).for_each(|(&vertex, corner)| last[vertex] = corner.tangent);
            each(&|at, _| last[surface.vertices[at]])
        }
        FrameMistake::NoBoundsCheck => each(&|at, corner| {
            let is_last = surface.vertices[at] + LAST_VERTICES >= surface.vertex_count;
            let [x, y, z] = unit(corner.position);
            if is_last { [x, y, z, corner.tangent[3]] } else { corner.tangent }
        }),
        FrameMistake::NoGuard => surface.summed(corners, |_, triangle| match triangle % COLLAPSED_EVERY {
            0 => [f32::NAN; 3],
            _ => surface.triangles[triangle].s,
        }),
        FrameMistake::UvNotInverted => {
            surface.summed(corners, |_, triangle| surface.triangles[triangle].not_inverted)
        }
        FrameMistake::Race => surface.summed(corners, |at, triangle| {
            [0, 1, 2].map(|axis| if is_lost(at, axis) { 0.0 } else { surface.triangles[triangle].s[axis] })
        }),
        FrameMistake::OneTangent => surface.summed_without_orientation(corners),
        FrameMistake::AdjacencyOffsets => surface.gathered_from_wrong_lists(corners),
        FrameMistake::LongNormals => surface.with_long_normals(corners),
    }
}

/// The size of a workgroup, whose threads beyond the end are not stopped.
const LAST_VERTICES: usize = 256;

/// Every such triangle counts as one without UV area.
const COLLAPSED_EVERY: usize = 61;

/// The derivatives of a triangle.
struct Triangle {
    /// The unit direction of dP/du; zero without UV area.
    s: V3,
    /// du1 e1 + du2 e2, of unit length.
    not_inverted: V3,
    /// e2 (du1 - du2) / det.
    one_edge: V3,
    /// The sign of glTF, whose v points down.
    w: f32,
}

/// The welded vertices and the triangles of a model.
struct Surface {
    /// The vertex of each corner: corners with equal positions, normals and UVs have one.
    vertices: Vec<usize>,
    vertex_count: usize,
    triangles: Vec<Triangle>,
}

impl Surface {
    fn new(corners: &[SurfaceVertex], uvs: &[[f32; 2]]) -> Self {
        let mut known = HashMap::new();
        let key = |(corner, uv): (&SurfaceVertex, &[f32; 2])| {
            let floats = [corner.position.as_slice(), &corner.normal, uv].concat();
            floats.into_iter().map(f32::to_bits).collect::<Vec<_>>()
        };
        let vertices = corners.iter().zip(uvs).map(|corner| {
            let next = known.len();
            *known.entry(key(corner)).or_insert(next)
        });
        let vertices: Vec<usize> = vertices.collect();
        let triangles = corners.as_chunks::<3>().0.iter().zip(uvs.as_chunks::<3>().0);
        let triangles = triangles.map(|(corners, uvs)| triangle(corners.map(|c| c.position), *uvs)).collect();
        Self { vertices, vertex_count: known.len(), triangles }
    }

    /// The sums per vertex and orientation of a term per corner and triangle, made perpendicular to the
    /// normals.
    fn summed(&self, corners: &[SurfaceVertex], term: impl Fn(usize, usize) -> V3) -> Vec<[f32; 4]> {
        self.finished(corners, term, in_plane)
    }

    /// T - (n . T) n with n of length 10: 100 times the part along the normal is subtracted.
    fn with_long_normals(&self, corners: &[SurfaceVertex]) -> Vec<[f32; 4]> {
        let leaning = |normal: V3, sum: V3| {
            let n = normal.map(|x| 10.0 * x);
            let along = dot(n, sum);
            unit([0, 1, 2].map(|axis| sum[axis] - along * n[axis]))
        };
        self.finished(corners, |_, triangle| self.triangles[triangle].s, leaning)
    }

    /// A function of the normal and the sum of every corner. The sums are those of its vertex and
    /// orientation.
    fn finished(
        &self,
        corners: &[SurfaceVertex],
        term: impl Fn(usize, usize) -> V3,
        finish: impl Fn(V3, V3) -> V3,
    ) -> Vec<[f32; 4]> {
        let mut sums = vec![[[0.0; 3]; 2]; self.vertex_count];
        for (at, &vertex) in self.vertices.iter().enumerate() {
            let side = &mut sums[vertex][usize::from(self.triangles[at / 3].w > 0.0)];
            *side = added(*side, term(at, at / 3));
        }
        let finished = |(at, corner): (usize, &SurfaceVertex)| {
            let w = self.triangles[at / 3].w;
            let [x, y, z] = finish(corner.normal, sums[self.vertices[at]][usize::from(w > 0.0)]);
            [x, y, z, w]
        };
        corners.iter().enumerate().map(finished).collect()
    }

    /// One sum per vertex for both orientations; the sign is that of the vertex's last triangle.
    fn summed_without_orientation(&self, corners: &[SurfaceVertex]) -> Vec<[f32; 4]> {
        let mut sums = vec![([0.0; 3], 1.0); self.vertex_count];
        for (at, &vertex) in self.vertices.iter().enumerate() {
            let Triangle { s, w, .. } = &self.triangles[at / 3];
            sums[vertex] = (added(sums[vertex].0, *s), *w);
        }
        let finished = |(&vertex, corner): (&usize, &SurfaceVertex)| {
            let (sum, w) = sums[vertex];
            let [x, y, z] = in_plane(corner.normal, sum);
            [x, y, z, w]
        };
        self.vertices.iter().zip(corners).map(finished).collect()
    }

    /// Vertex v reads the entries from v to v + its count, instead of from the sum of the counts before it.
    fn gathered_from_wrong_lists(&self, corners: &[SurfaceVertex]) -> Vec<[f32; 4]> {
        let mut lists = vec![Vec::new(); self.vertex_count];
        self.vertices.iter().enumerate().for_each(|(at, &vertex)| lists[vertex].push(at / 3));
        let entries = lists.concat();
        let gathered = |(vertex, list): (usize, &Vec<usize>)| {
            let read = entries.iter().skip(vertex).take(list.len());
            read.fold([0.0; 3], |sum, &triangle| added(sum, self.triangles[triangle].s))
        };
        let sums: Vec<V3> = lists.iter().enumerate().map(gathered).collect();
        let finished = |(at, corner): (usize, &SurfaceVertex)| {
            let [x, y, z] = in_plane(corner.normal, sums[self.vertices[at]]);
            [x, y, z, self.triangles[at / 3].w]
        };
        corners.iter().enumerate().map(finished).collect()
    }

    /// The tangent of a corner with the sign that the wrong bitangent of its triangle gives.
    fn sign_of_one_edge(&self, at: usize, corner: &SurfaceVertex) -> [f32; 4] {
        let [x, y, z, _] = corner.tangent;
        let along_v = dot(cross(corner.normal, [x, y, z]), self.triangles[at / 3].one_edge);
        [x, y, z, if along_v > 0.0 { -1.0 } else { 1.0 }]
    }
}

fn triangle(positions: [V3; 3], uvs: [[f32; 2]; 3]) -> Triangle {
    let [e1, e2] = [1, 2].map(|i| [0, 1, 2].map(|axis| positions[i][axis] - positions[0][axis]));
    let [[du1, dv1], [du2, dv2]] = [1, 2].map(|i| [0, 1].map(|axis| uvs[i][axis] - uvs[0][axis]));
    let det = du1 * dv2 - dv1 * du2;
    let mixed = |a: f32, b: f32| [0, 1, 2].map(|axis| a * e1[axis] + b * e2[axis]);
    Triangle {
        s: if det == 0.0 { [0.0; 3] } else { unit(mixed(dv2 / det, -dv1 / det)) },
        not_inverted: unit(mixed(du1, du2)),
        one_edge: mixed(0.0, (du1 - du2) * det.signum()),
        w: if det > 0.0 { -1.0 } else { 1.0 },
    }
}

/// The tangent of a model that was stretched to twice its size along the diagonal of x and y, transformed by
/// the inverse transpose instead of the matrix: from the stretched tangent back to the one before, and back
/// once more.
fn unstretched(corner: &SurfaceVertex) -> [f32; 4] {
    const DIAGONAL: V3 = [std::f32::consts::FRAC_1_SQRT_2, std::f32::consts::FRAC_1_SQRT_2, 0.0];
    let [x, y, z, w] = corner.tangent;
    let along = dot(DIAGONAL, [x, y, z]);
    let [x, y, z] = unit([0, 1, 2].map(|axis| [x, y, z][axis] - 0.75 * along * DIAGONAL[axis]));
    [x, y, z, w]
}

/// Whether the addition of one component for one corner is lost; two in three are.
fn is_lost(at: usize, axis: usize) -> bool {
    (3 * at + axis).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 33 & 0xffff < 0xaaaa
}

fn added(a: V3, b: V3) -> V3 {
    [0, 1, 2].map(|axis| a[axis] + b[axis])
}

/// The unit part of a vector perpendicular to a unit normal.
fn in_plane(normal: V3, v: V3) -> V3 {
    let along = dot(normal, v);
    unit([0, 1, 2].map(|axis| v[axis] - along * normal[axis]))
}

/// The vector divided by its length; zero stays zero, and NaN stays NaN.
fn unit(v: V3) -> V3 {
    let size = dot(v, v).sqrt();
    if size == 0.0 { v } else { v.map(|x| x / size) }
}
