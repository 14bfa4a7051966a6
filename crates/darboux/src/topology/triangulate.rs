//! Faces to triangles, welded, with the degenerate ones set aside.

use crate::Faces;
use crate::Mesh;
use crate::math::{V3, dot, equal, sub};
use crate::topology::triangles::{Triangles, Triangulation};
use crate::topology::weld::weld;

/// Splits faces into triangles, welds their corners and sets degenerate triangles aside; both lists keep the faces' order.
pub(crate) fn triangulate(mesh: &Mesh<'_>) -> Triangulation {
    let mut out = Triangulation::default();
    let all = split_faces(mesh, &mut out);
    let vertices = weld(mesh, all.corners.as_flattened());
    out.set_aside_degenerate(mesh, &all, &vertices);
    out
}

/// As [`triangulate`] for a mesh whose corners' vertices are known.
pub(crate) fn triangulate_welded(mesh: &Mesh<'_>, vertex_of_corner: &[u32]) -> Triangulation {
    let mut out = Triangulation::default();
    let all = split_faces(mesh, &mut out);
    let vertices: Vec<u32> =
        all.corners.as_flattened().iter().map(|&corner| vertex_of_corner[corner as usize]).collect();
    out.set_aside_degenerate(mesh, &all, &vertices);
    out
}

impl Triangulation {
    fn set_aside_degenerate(&mut self, mesh: &Mesh<'_>, all: &Triangles, vertex_of_entry: &[u32]) {
        for (t, vertices) in vertex_of_entry.as_chunks().0.iter().enumerate() {
            let [a, b, c] = vertices.map(|vertex| position(mesh, vertex));
            let degenerate = equal(a, b) || equal(a, c) || equal(b, c);
            let list = if degenerate { &mut self.degenerate } else { &mut self.good };
            list.push_welded(all.corners[t], *vertices, all.face[t]);
        }
    }
}

fn split_faces(mesh: &Mesh<'_>, out: &mut Triangulation) -> Triangles {
    let mut all = Triangles::default();
    let mut first = 0;
    for face in 0..mesh.face_count() {
        let size = match mesh.faces() {
            Faces::Triangles => 3,
            Faces::Quads => 4,
            Faces::Mixed(sizes) => sizes[face],
        };
        match size {
            3 => all.push([first, first + 1, first + 2], face),
            4 => {
                for half in split_quad(mesh, first) {
                    all.push(half, face);
                }
            }
            _ => {
                out.unsupported_faces += 1;
                out.unsupported_corners.extend(first..first + size);
            }
        }
        first += size;
    }
    all
}

/// The halves of the quad whose first corner is `first`.
pub(crate) fn split_quad(mesh: &Mesh<'_>, first: u32) -> [[u32; 3]; 2] {
    let [a, b, c, d] = [first, first + 1, first + 2, first + 3];
    let uv = |corner: u32| mesh.uvs().get(mesh.vertex_of_corner(corner as usize));
    let is_across = is_cut_across([a, b, c, d].map(uv), || [a, b, c, d].map(|corner| position(mesh, corner)));
    if is_across { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] }
}

/// Whether a quad is cut from corner 1 to 3: along the shorter diagonal in UV space; where neither is shorter (or one is NaN), along the
/// one that is shorter in space, 0-2 unless 1-3 is strictly shorter.
#[inline(always)]
pub(crate) fn is_cut_across(uvs: [[f32; 2]; 4], positions: impl FnOnce() -> [V3; 4]) -> bool {
    match shorter_diagonal(uvs.map(|[u, v]| [u, v, 1.0])) {
        (_, true) => shorter_diagonal(positions()).0,
        (is_across, _) => is_across,
    }
}

/// Whether the diagonal from corner 1 to 3 is shorter than that from 0 to 2, and whether neither is shorter.
#[inline(always)]
pub(crate) fn shorter_diagonal([a, b, c, d]: [V3; 4]) -> (bool, bool) {
    let squared = |p: V3, q: V3| dot(sub(p, q), sub(p, q));
    let (ac, bd) = (squared(c, a), squared(d, b));
    (bd < ac, !(bd < ac) & !(ac < bd))
}

fn position(mesh: &Mesh<'_>, corner: u32) -> V3 {
    mesh.positions().get(mesh.vertex_of_corner(corner as usize))
}
