//! Splits the faces of a mesh into welded triangles, and separates the degenerate ones.
//!
//! A quad is cut along its shorter diagonal in UV space; if both are equally long there, along the shorter
//! one in space; if both are equally long there as well, from corner 0 to 2. Faces of other than 3 or 4
//! corners have no triangles.
//!
//! Source: mikktspace.c, `GenerateInitialVerticesIndexList` and `DegenPrologue`.

use crate::Mesh;
use crate::exec::limits::RunLimits;
use crate::math::{V3, dot, equal, sub};
use crate::topology::triangles::{Triangles, Triangulation};
use crate::topology::weld::weld;

/// Triangulates and welds a mesh. Triangles are absent after cancellation.
pub(crate) fn triangulate(mesh: &Mesh<'_>, limits: RunLimits<'_>) -> Triangulation {
    SplitMesh::new(mesh, limits).separate(mesh, limits, |corners| weld(mesh, corners.as_flattened(), limits))
}

/// As [`triangulate`] for a mesh that is welded already.
///
/// `vertex_of_corner`: the welded vertex of each corner.
pub(crate) fn triangulate_welded(
    mesh: &Mesh<'_>,
    vertex_of_corner: &[u32],
    limits: RunLimits<'_>,
) -> Triangulation {
    let vertices = |corners: &[[u32; 3]]| -> Vec<u32> {
        corners.as_flattened().iter().map(|&corner| vertex_of_corner[corner as usize]).collect()
    };
    SplitMesh::new(mesh, limits).separate(mesh, limits, vertices)
}

/// All triangles of a mesh, degenerate ones included, before welding.
#[derive(Default)]
struct SplitMesh {
    corners: Vec<[u32; 3]>,
    face: Vec<u32>,
    unsupported_faces: usize,
    unsupported_corners: Vec<u32>,
}

impl SplitMesh {
    fn new(mesh: &Mesh<'_>, limits: RunLimits<'_>) -> Self {
        let mut split = Self::default();
        for (face, corners) in mesh.face_ranges().enumerate() {
            if limits.check_at(face).is_err() {
                break;
            }
            let first = corners.start as u32;
            match corners.len() {
                3 => split.corners.push([first, first + 1, first + 2]),
                4 => split.corners.extend(split_quad(mesh, first)),
                _ => {
                    split.unsupported_faces += 1;
                    split.unsupported_corners.extend(corners.map(|corner| corner as u32));
                }
            }
            split.face.resize(split.corners.len(), face as u32);
        }
        split
    }

    /// Separates degenerate triangles. `weld` returns the welded vertex of every corner of the triangles.
    fn separate(
        self,
        mesh: &Mesh<'_>,
        limits: RunLimits<'_>,
        weld: impl FnOnce(&[[u32; 3]]) -> Vec<u32>,
    ) -> Triangulation {
        let (mut good, mut degenerate) = (Triangles::default(), Triangles::default());
        let vertices = weld(&self.corners);
        for (t, vertices) in vertices.as_chunks().0.iter().enumerate() {
            if limits.check_at(t).is_err() {
                break;
            }
            let [a, b, c] = vertices.map(|vertex| position(mesh, vertex));
            let is_degenerate = equal(a, b) || equal(a, c) || equal(b, c);
            let list = if is_degenerate { &mut degenerate } else { &mut good };
            list.push(self.corners[t], *vertices, self.face[t]);
        }
        let Self { unsupported_faces, unsupported_corners, .. } = self;
        Triangulation { good, degenerate, unsupported_faces, unsupported_corners }
    }
}

/// The halves of the quad whose first corner is `first`.
pub(crate) fn split_quad(mesh: &Mesh<'_>, first: u32) -> [[u32; 3]; 2] {
    let [a, b, c, d] = [first, first + 1, first + 2, first + 3];
    let uv = |corner: u32| mesh.uvs().get(mesh.vertex_of_corner(corner as usize));
    let is_across = is_cut_across([a, b, c, d].map(uv), || [a, b, c, d].map(|corner| position(mesh, corner)));
    if is_across { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] }
}

/// True when a quad is cut from corner 1 to 3. NaN lengths count as equal.
#[inline(always)]
pub(crate) fn is_cut_across(uvs: [[f32; 2]; 4], positions: impl FnOnce() -> [V3; 4]) -> bool {
    match shorter_diagonal(uvs.map(|[u, v]| [u, v, 1.0])) {
        (_, true) => shorter_diagonal(positions()).0,
        (is_across, _) => is_across,
    }
}

/// Returns two flags: the diagonal from corner 1 to 3 is the shorter one; neither diagonal is shorter.
#[inline(always)]
pub(crate) fn shorter_diagonal([a, b, c, d]: [V3; 4]) -> (bool, bool) {
    let squared = |p: V3, q: V3| dot(sub(p, q), sub(p, q));
    let (ac, bd) = (squared(c, a), squared(d, b));
    (bd < ac, !(bd < ac) & !(ac < bd))
}

fn position(mesh: &Mesh<'_>, corner: u32) -> V3 {
    mesh.positions().get(mesh.vertex_of_corner(corner as usize))
}
