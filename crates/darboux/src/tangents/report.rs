//! [`Report`]: the counts of a run, of degenerate input, repairs and splits.

use crate::Mesh;
use crate::exec::limits::RunLimits;
use crate::math::{V3, distinct_bits};
use crate::util::hash_map::InsertionMap;

use crate::tangents::output::Output;

/// The counts of a run. Quads count as two triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Report {
    /// The triangles of the mesh, halves of quads included.
    pub triangles: usize,
    /// Faces of other than 3 or 4 corners. Their tangents are perpendiculars of their normals.
    pub unsupported_faces: usize,
    /// Triangles with two equal positions.
    pub degenerate_triangles: usize,
    /// Triangles whose UVs span no area, or too little area for a direction. Degenerate and non-finite
    /// triangles are not counted.
    pub uv_degenerate_triangles: usize,
    /// Corners with NaN or infinity in the position, normal or UV.
    pub non_finite_corners: usize,
    /// Corners without a usable tangent, or whose sign [`Mode::Corrected`](crate::Mode::Corrected) changed
    /// without a tangent to copy. Their tangents are replaced, except in
    /// [`Mode::Reference`](crate::Mode::Reference).
    pub repaired_corners: usize,
    /// Faces whose corners have both signs before [`Mode::Corrected`](crate::Mode::Corrected) unifies them.
    pub mixed_sign_faces: usize,
    /// Edges between two triangles of opposite UV orientation.
    pub mirrored_edges: usize,
    /// Vertices of the mesh whose corners have different tangents. [`split_vertices`](crate::split_vertices)
    /// splits them.
    pub split_vertices: usize,
    /// Vertices at which triangles of both UV orientations share one tangent. Zero for all methods but
    /// [`Method::LengyelPerVertex`](crate::Method::LengyelPerVertex).
    pub merged_vertices: usize,
}

/// True when all positions and UVs are finite.
pub(crate) fn are_finite(positions: [V3; 3], uvs: [[f32; 2]; 3]) -> bool {
    positions.as_flattened().iter().chain(uvs.as_flattened()).all(|x| x.is_finite())
}

/// The number of corners with a position, normal or UV that is not finite.
pub(crate) fn count_non_finite_corners(mesh: &Mesh<'_>) -> usize {
    let finite = |vertex| {
        let [positions, normals] = [mesh.positions().get(vertex), mesh.normals().get(vertex)];
        positions.iter().chain(&normals).chain(&mesh.uvs().get(vertex)).all(|x| x.is_finite())
    };
    (0..mesh.corner_count()).filter(|&corner| !finite(mesh.vertex_of_corner(corner))).count()
}

/// The number of vertices whose corners have different tangents, compared as bits, all NaNs as one value. The
/// time depends on the number of corners only. The result is unspecified after cancellation.
pub(crate) fn count_split_vertices<O: Output>(
    mesh: &Mesh<'_>,
    corners: &[O],
    limits: RunLimits<'_>,
) -> usize {
    let mut count = 0;
    let mut first = FirstCorners::new(mesh);
    for part in limits.parts(0..mesh.corner_count()) {
        for corner in part {
            let vertex = mesh.vertex_of_corner(corner);
            let first = first.of(vertex, corner);
            let [ours, theirs] = [corner as u32, *first]
                .map(|corner| distinct_bits(corners[(corner & !SPLIT) as usize].tangent()));
            if ours != theirs && *first & SPLIT == 0 {
                *first |= SPLIT;
                count += 1;
            }
        }
    }
    count
}

/// The flag of a vertex that has been counted, in its first corner.
const SPLIT: u32 = 1 << 31;

/// The first corner of each vertex: an array, or a hash map where vertices far outnumber corners.
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

    /// The first corner of `vertex`, set to `corner` at the first call for the vertex.
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
