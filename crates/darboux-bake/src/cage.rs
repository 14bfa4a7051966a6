//! Cages: low meshes with their vertices moved outwards, from which rays begin.

use darboux::{Faces, Mesh, NormalOptions, generate_normals};

use crate::common_box::CommonBox;
use crate::vector::{Vector, add_scaled, narrow, wide};
use crate::{BakeError, LowSurface, SkewCorrection};

/// How far a cage lies outside a model without another choice: 2 % of the diagonal of the model's box, in the
/// same unit.
pub fn default_cage_offset(diagonal: f64) -> f32 {
    (0.02 * diagonal).max(f64::from(f32::MIN_POSITIVE)) as f32
}

/// How far a cage that is made lies outside a model at most, without another choice: five times
/// [`default_cage_offset`], 10 % of the diagonal.
pub fn default_cage_reach(diagonal: f64) -> f32 {
    5.0 * default_cage_offset(diagonal)
}

/// The vertices of a mesh, moved outwards by `offset`: a cage without gaps.
///
/// Vertices at equal positions move in the same direction, the mean of the normals of their faces weighted by
/// angle, also where the normals of the mesh differ as at hard edges. Vertices that no corner uses stay.
/// Errors: faces that are not triangles.
pub fn inflated_cage(mesh: &Mesh<'_>, offset: f32) -> Result<Vec<[f32; 3]>, BakeError> {
    inflated_cage_by(mesh, &vec![offset; mesh.vertex_count()])
}

/// Surfaces with their cages, one for each; as they are where there is none. Errors: a cage of another number
/// of vertices.
pub fn with_cages<'a>(
    low: &[LowSurface<'a>],
    cages: &'a [Vec<[f32; 3]>],
) -> Result<Vec<LowSurface<'a>>, BakeError> {
    if cages.is_empty() {
        return Ok(low.to_vec());
    }
    low.iter().zip(cages).map(|(surface, cage)| surface.with_cage(cage)).collect()
}

/// Surfaces whose rays turn towards the normals of triangles. Errors: as of
/// [`LowSurface::with_skew_correction`].
pub fn with_skew<'a>(
    low: &[LowSurface<'a>],
    correction: SkewCorrection<'a>,
) -> Result<Vec<LowSurface<'a>>, BakeError> {
    low.iter().map(|surface| surface.with_skew_correction(correction)).collect()
}

/// As [`inflated_cage`], each vertex by its own offset.
///
/// `offset_of_vertex`: one per vertex. Where vertices at equal positions have different offsets, the cage has
/// a gap. Errors: faces that are not triangles; another number of offsets.
pub fn inflated_cage_by(mesh: &Mesh<'_>, offset_of_vertex: &[f32]) -> Result<Vec<[f32; 3]>, BakeError> {
    let vertices = mesh.vertex_count();
    if offset_of_vertex.len() != vertices {
        return Err(BakeError::Cage { vertices, found: offset_of_vertex.len() });
    }
    let directions = cage_directions(mesh)?;
    let moved = |vertex: usize| {
        let position = mesh.positions().get(vertex);
        match directions[vertex] {
            Some(direction) => {
                narrow(add_scaled(wide(position), f64::from(offset_of_vertex[vertex]), direction))
            }
            None => position,
        }
    };
    Ok((0..vertices).map(moved).collect())
}

/// The directions in which the vertices of a cage move; none for vertices that no corner uses. Errors: faces
/// that are not triangles.
pub(crate) fn cage_directions(mesh: &Mesh<'_>) -> Result<Vec<Option<Vector>>, BakeError> {
    if !matches!(mesh.faces(), Faces::Triangles) {
        return Err(BakeError::NotTriangles);
    }
    let positions: Vec<[f32; 3]> =
        (0..mesh.vertex_count()).map(|vertex| mesh.positions().get(vertex)).collect();
    let space = CommonBox::around(positions.iter().copied());
    let in_box: Vec<[f32; 3]> = positions.iter().map(|&position| space.position(position)).collect();
    let normals = generate_normals(&in_box, mesh.indices(), mesh.faces(), &NormalOptions::new())?;
    let mut directions = vec![None; positions.len()];
    for (corner, &normal) in normals.corners.per_corner().iter().enumerate() {
        directions[mesh.vertex_of_corner(corner)] = Some(wide(normal));
    }
    Ok(directions)
}
