//! What a user must know of a run.

use crate::Mesh;
use crate::math::V3;
use crate::util::hash_map::InsertionMap;

use crate::tangents::output::Output;

/// What was met on the way. Quads count as the two triangles that they are split into.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Report {
    /// Triangles, quad halves included.
    pub triangles: usize,
    /// Faces of other than 3 or 4 corners. MikkTSpace gives them no tangents; they get ones from their normals alone.
    pub unsupported_faces: usize,
    /// Triangles with two equal positions.
    pub degenerate_triangles: usize,
    /// Triangles, not degenerate and with finite positions and UVs, whose UVs span no area (or too little for a direction).
    pub uv_degenerate_triangles: usize,
    /// Corners with a NaN or an infinity in position, normal or UV.
    pub non_finite_corners: usize,
    /// Corners whose reference tangent is absent or unusable, or had the wrong sign for its face and no other to take
    /// ([`Mode::Corrected`](crate::Mode::Corrected)). Replaced, but for [`Mode::Reference`](crate::Mode::Reference).
    pub repaired_corners: usize,
    /// Faces whose corners carry both signs; [`Mode::Corrected`](crate::Mode::Corrected) gave them one.
    pub mixed_sign_faces: usize,
    /// Edges between two triangles of opposite UV orientation.
    pub mirrored_edges: usize,
    /// Vertices of the mesh that need more than one tangent: what [`split_vertices`](crate::split_vertices) splits.
    pub split_vertices: usize,
    /// Vertices at which triangles of both UV orientations share one tangent: seams that
    /// [`Method::LengyelPerVertex`](crate::Method::LengyelPerVertex) breaks. None in all other methods.
    pub merged_vertices: usize,
}

/// Whether a triangle's positions and UVs are numbers to compute with.
pub(crate) fn are_finite(positions: [V3; 3], uvs: [[f32; 2]; 3]) -> bool {
    positions.as_flattened().iter().chain(uvs.as_flattened()).all(|x| x.is_finite())
}

pub(crate) fn count_non_finite_corners(mesh: &Mesh<'_>) -> usize {
    let finite = |vertex| {
        let [positions, normals] = [mesh.positions().get(vertex), mesh.normals().get(vertex)];
        positions.iter().chain(&normals).chain(&mesh.uvs().get(vertex)).all(|x| x.is_finite())
    };
    (0..mesh.corner_count()).filter(|&corner| !finite(mesh.vertex_of_corner(corner))).count()
}

/// Vertices with corners of different tangents, compared as bits. Costs time in the corners, however many vertices there are.
pub(crate) fn count_split_vertices<O: Output>(mesh: &Mesh<'_>, corners: &[O]) -> usize {
    let mut count = 0;
    let mut first = FirstCorners::new(mesh);
    for corner in 0..mesh.corner_count() {
        let vertex = mesh.vertex_of_corner(corner);
        let first = first.of(vertex, corner);
        let [ours, theirs] = [corner as u32, *first]
            .map(|corner| corners[(corner & !SPLIT) as usize].tangent().map(f32::to_bits));
        if ours != theirs && *first & SPLIT == 0 {
            *first |= SPLIT;
            count += 1;
        }
    }
    count
}

/// Marks the first corner of a vertex that is split.
const SPLIT: u32 = 1 << 31;

/// The first corner of each vertex: a table, or a map where vertices by far outnumber corners.
enum FirstCorners {
    Table(Vec<u32>),
    Map(InsertionMap<u32>),
}

impl FirstCorners {
    fn new(mesh: &Mesh<'_>) -> Self {
        if mesh.vertex_count() <= 4 * mesh.corner_count() {
            Self::Table(vec![u32::MAX; mesh.vertex_count()])
        } else {
            Self::Map(InsertionMap::new())
        }
    }

    /// The first corner of `vertex`, which is `corner` when none was asked for before.
    fn of(&mut self, vertex: usize, corner: usize) -> &mut u32 {
        match self {
            Self::Table(table) => {
                if table[vertex] == u32::MAX {
                    table[vertex] = corner as u32;
                }
                &mut table[vertex]
            }
            Self::Map(map) => map.get_or_insert_with(&[vertex as u32], || corner as u32),
        }
    }
}
