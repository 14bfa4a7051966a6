//! A mesh as packed slices: positions, normals and UVs of vertices, and triangles of vertex numbers, for
//! arithmetic loops.

use std::borrow::Cow;
use std::ops::Range;

use crate::Faces;
use crate::Indices;
use crate::Mesh;
use crate::Strided;
use crate::math::V3;
use crate::topology::triangulate::split_quad;

/// A mesh as packed arrays. Arrays are borrowed where the caller's are packed, indices are 32-bit, faces are
/// triangles, and most vertices are used; otherwise they are copied. Unused vertices may be dropped, which
/// renumbers the others; corners and faces keep their numbers.
pub(crate) struct MeshSlices<'a> {
    pub positions: Cow<'a, [V3]>,
    pub normals: Cow<'a, [V3]>,
    pub uvs: Cow<'a, [[f32; 2]]>,
    pub vertex_of_corner: Cow<'a, [u32]>,
    /// Absent where every face is a triangle.
    faces: Option<SplitFaces>,
}

/// What term kernels read: the vertices of triangles, and the positions and UVs of vertices.
#[derive(Clone, Copy)]
pub(crate) struct TriangleInputs<'a> {
    pub triangles: &'a [[u32; 3]],
    positions: &'a [V3],
    uvs: &'a [[f32; 2]],
}

impl<'a> TriangleInputs<'a> {
    /// References to the positions and UVs of a triangle.
    #[inline(always)]
    pub fn values_of(&self, triangle: [u32; 3]) -> ([&'a V3; 3], [&'a [f32; 2]; 3]) {
        // Written out: `map` over indexing that may panic is not inlined.
        let [a, b, c] = [triangle[0] as usize, triangle[1] as usize, triangle[2] as usize];
        let (positions, uvs) = (self.positions, self.uvs);
        ([&positions[a], &positions[b], &positions[c]], [&uvs[a], &uvs[b], &uvs[c]])
    }
}

/// Faces cut into triangles.
struct SplitFaces {
    triangles: Vec<[u32; 3]>,
    face_of_triangle: Vec<u32>,
    /// The end of each face's corners.
    ends: Vec<u32>,
}

impl<'a> MeshSlices<'a> {
    pub fn new(mesh: &Mesh<'a>) -> Self {
        let (vertex_of_corner, used) = used_vertices(mesh);
        Self {
            positions: packed(mesh.positions(), used.as_deref()),
            normals: packed(mesh.normals(), used.as_deref()),
            uvs: packed(mesh.uvs(), used.as_deref()),
            faces: (!matches!(mesh.faces(), Faces::Triangles)).then(|| split_faces(mesh, &vertex_of_corner)),
            vertex_of_corner,
        }
    }

    /// The vertices of each triangle. The halves of a quad are adjacent.
    pub fn triangles(&self) -> &[[u32; 3]] {
        self.faces.as_ref().map_or(self.vertex_of_corner.as_chunks().0, |faces| &faces.triangles)
    }

    /// True where every face is a triangle, so that triangle `t` is face `t`.
    pub fn is_triangles(&self) -> bool {
        self.faces.is_none()
    }

    /// The number of faces, unsupported ones included.
    pub fn face_count(&self) -> usize {
        self.faces.as_ref().map_or(self.vertex_of_corner.len() / 3, |faces| faces.ends.len())
    }

    /// The face that triangle `t` is, or is half of.
    pub fn face(&self, t: usize) -> usize {
        self.faces.as_ref().map_or(t, |faces| faces.face_of_triangle[t] as usize)
    }

    /// The triangles of consecutive faces.
    pub fn triangles_of(&self, faces: Range<usize>) -> Range<usize> {
        let Some(SplitFaces { face_of_triangle, .. }) = &self.faces else { return faces };
        let first = |face: usize| face_of_triangle.partition_point(|&other| (other as usize) < face);
        first(faces.start)..first(faces.end)
    }

    /// The corners of a face.
    pub fn corners(&self, face: usize) -> Range<usize> {
        self.corners_of(face..face + 1)
    }

    /// The corners of consecutive faces.
    pub fn corners_of(&self, faces: Range<usize>) -> Range<usize> {
        let Some(SplitFaces { ends, .. }) = &self.faces else { return 3 * faces.start..3 * faces.end };
        let end_before = |face: usize| if face == 0 { 0 } else { ends[face - 1] as usize };
        end_before(faces.start)..end_before(faces.end)
    }

    /// The arrays that term kernels read.
    pub fn triangle_inputs(&self) -> TriangleInputs<'_> {
        // Equal lengths, so that one bounds check serves both.
        let (positions, uvs) = (&self.positions[..], &self.uvs[..self.positions.len()]);
        TriangleInputs { triangles: self.triangles(), positions, uvs }
    }

    /// The positions and UVs of triangle `t`.
    pub fn values(&self, t: usize) -> ([V3; 3], [[f32; 2]; 3]) {
        let inputs = self.triangle_inputs();
        let (positions, uvs) = inputs.values_of(inputs.triangles[t]);
        (positions.map(|position| *position), uvs.map(|uv| *uv))
    }
}

/// The vertex of each corner. Where the mesh uses few of its vertices, also the list of used vertices, in
/// which the numbers are indices.
fn used_vertices<'a>(mesh: &Mesh<'a>) -> (Cow<'a, [u32]>, Option<Vec<u32>>) {
    let vertex_of_corner = vertices_of_corners(mesh);
    if mesh.vertex_count() <= 4 * mesh.corner_count() {
        return (vertex_of_corner, None);
    }
    let mut used = vertex_of_corner.to_vec();
    used.sort_unstable();
    used.dedup();
    let place = |v: &u32| used.partition_point(|other| other < v) as u32;
    (vertex_of_corner.iter().map(place).collect(), Some(used))
}

fn packed<'a, const N: usize>(values: Strided<'a, N>, used: Option<&[u32]>) -> Cow<'a, [[f32; N]]> {
    match (used, values.packed()) {
        (Some(used), _) => used.iter().map(|&v| values.get(v as usize)).collect(),
        (None, Some(packed)) => Cow::Borrowed(&packed[..values.len()]),
        (None, None) => (0..values.len()).map(|v| values.get(v)).collect(),
    }
}

fn vertices_of_corners<'a>(mesh: &Mesh<'a>) -> Cow<'a, [u32]> {
    match mesh.indices() {
        Indices::Unindexed => (0..mesh.corner_count() as u32).collect(),
        Indices::U16(list) => list.iter().map(|&index| u32::from(index)).collect(),
        Indices::U32(list) => Cow::Borrowed(list),
    }
}

fn split_faces(mesh: &Mesh<'_>, vertex_of_corner: &[u32]) -> SplitFaces {
    let mut faces = SplitFaces {
        triangles: Vec::new(),
        face_of_triangle: Vec::new(),
        ends: Vec::with_capacity(mesh.face_count()),
    };
    for (face, corners) in mesh.face_ranges().enumerate() {
        let first = corners.start as u32;
        let halves = match corners.len() {
            3 => &[[first, first + 1, first + 2]][..],
            4 => &split_quad(mesh, first),
            _ => &[],
        };
        for half in halves {
            faces.triangles.push(half.map(|corner| vertex_of_corner[corner as usize]));
            faces.face_of_triangle.push(face as u32);
        }
        faces.ends.push(corners.end as u32);
    }
    faces
}
