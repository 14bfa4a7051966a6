//! The faces of a mesh with the values of their corners, in single precision.

use ufbx::{List, Mesh, SubdivisionDisplayMode, UvSet, Vec2, Vec3, VertexVec2, VertexVec3, VertexVec4};

use crate::error::shortened;
use crate::source::{CornerValues, FaceSizes, SourceMesh, SourceUvSet};

/// An estimate of the bytes that [`fill`] and the document made of it take.
pub fn estimate(mesh: &Mesh) -> usize {
    const PER_CORNER: usize = 100;
    const PER_VERTEX: usize = 16;
    let sets = mesh.uv_sets.count.saturating_add(2 * mesh.color_sets.count);
    let corners = mesh.num_indices.saturating_mul(sets.saturating_mul(16).saturating_add(PER_CORNER));
    let offsets = mesh.blend_deformers.into_iter().map(|deformer| deformer.channels.count).sum::<usize>();
    let vertices = mesh.vertices.count.saturating_mul(offsets.saturating_mul(48).saturating_add(PER_VERTEX));
    corners.saturating_add(vertices)
}

/// What is lost or made while a mesh is read.
#[derive(Debug, Default)]
pub struct Losses {
    /// Faces of one or two corners, which are left out.
    pub lines_and_points: usize,
    /// Whether ufbx made the normals, from smoothing groups.
    pub has_made_normals: bool,
    /// Whether there are tangents without a sign: neither bitangents nor a fourth component. They are left
    /// out.
    pub has_tangents_without_sign: bool,
    /// Whether UV sets after the first have tangents.
    pub has_further_tangents: bool,
    /// Whether the file shows the mesh as a subdivision surface.
    pub is_subdivided: bool,
}

/// Reads the faces, the positions and all attributes of corners into `to`.
pub fn fill(mesh: &Mesh, to: &mut SourceMesh) -> Losses {
    let faces = || mesh.faces.iter().enumerate().filter(|(_, face)| face.num_indices >= 3);
    let sizes: Vec<u32> = faces().map(|(_, face)| face.num_indices).collect();
    // The positions of the faces' corners in ufbx's lists, without lines and points.
    let places: Vec<usize> = faces()
        .flat_map(|(_, face)| (0..face.num_indices as usize).map(move |i| face.index_begin as usize + i))
        .collect();
    let lines_and_points = mesh.faces.count - sizes.len();
    to.positions = mesh.vertices.iter().map(vector).collect();
    to.corners = places.iter().map(|&place| mesh.vertex_indices[place]).collect();
    to.faces =
        if sizes.iter().all(|&size| size == 3) { FaceSizes::Triangles } else { FaceSizes::Sizes(sizes) };
    to.normals = corner_values(&mesh.vertex_normal, &places, vector);
    to.uv_sets = mesh.uv_sets.iter().filter_map(|set| uv_set(set, &places)).collect();
    to.colors = mesh.color_sets.iter().filter_map(|set| colors(&set.vertex_color, &places)).collect();
    to.tangents = tangents(mesh, &places);
    Losses {
        lines_and_points,
        has_made_normals: mesh.generated_normals,
        has_further_tangents: mesh.uv_sets.iter().skip(1).any(|set| set.vertex_tangent.exists),
        is_subdivided: mesh.subdivision_display_mode != SubdivisionDisplayMode::Disabled,
        has_tangents_without_sign: mesh.vertex_tangent.exists && to.tangents.is_none(),
    }
}

/// The place of each kept face's material in the mesh's list; empty if the mesh has none or one.
pub fn material_slots(mesh: &Mesh) -> Vec<u32> {
    if mesh.face_material.count != mesh.faces.count || mesh.materials.count < 2 {
        return Vec::new();
    }
    let faces = mesh.faces.iter().zip(&mesh.face_material).filter(|(face, _)| face.num_indices >= 3);
    faces.map(|(_, &slot)| slot).collect()
}

fn uv_set(set: &UvSet, places: &[usize]) -> Option<SourceUvSet> {
    let uvs = corner_values(&set.vertex_uv, places, |uv: &Vec2| [uv.x as f32, uv.y as f32])?;
    Some(SourceUvSet { name: shortened(&set.name), uvs })
}

fn colors(attribute: &VertexVec4, places: &[usize]) -> Option<CornerValues<4>> {
    corner_values(attribute, places, |color: &ufbx::Vec4| {
        [color.x, color.y, color.z, color.w].map(|x| x as f32)
    })
}

/// Tangents with their sign, from bitangents or from the fourth component.
///
/// The sign is that for which bitangent = sign * cross(normal, tangent). FBX's bitangents point along
/// increasing v, which points up.
fn tangents(mesh: &Mesh, places: &[usize]) -> Option<CornerValues<4>> {
    let (normal, tangent, bitangent) = (&mesh.vertex_normal, &mesh.vertex_tangent, &mesh.vertex_bitangent);
    if !tangent.exists || !normal.exists {
        return None;
    }
    let sign = |&place: &usize| -> Option<f32> {
        let is_negative = if bitangent.exists {
            volume(&normal[place], &tangent[place], &bitangent[place]) < 0.0
        } else {
            *tangent.values_w.get(tangent.indices[place] as usize)? < 0.0
        };
        Some(if is_negative { -1.0 } else { 1.0 })
    };
    let with_sign = |place: &usize| {
        let [x, y, z] = vector(&tangent[*place]);
        Some([x, y, z, sign(place)?])
    };
    Some(CornerValues::of_corners(places.iter().map(with_sign).collect::<Option<_>>()?))
}

/// The determinant of three vectors: positive if they are right-handed.
fn volume(a: &Vec3, b: &Vec3, c: &Vec3) -> f64 {
    a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x)
}

pub fn vector(v: &Vec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

/// An attribute of corners: a list of values and the index of the value of each corner.
trait Attribute<T> {
    fn parts(&self) -> (bool, &List<T>, &List<u32>);
}

macro_rules! attributes {
    ($($attribute:ty, $value:ty);*) => {$(
        impl Attribute<$value> for $attribute {
            fn parts(&self) -> (bool, &List<$value>, &List<u32>) {
                (self.exists, &self.values, &self.indices)
            }
        }
    )*};
}

attributes! { VertexVec2, Vec2; VertexVec3, Vec3; VertexVec4, ufbx::Vec4 }

/// The values of an attribute at `places`; none if the attribute is absent.
fn corner_values<T, const N: usize>(
    attribute: &impl Attribute<T>,
    places: &[usize],
    convert: impl Fn(&T) -> [f32; N],
) -> Option<CornerValues<N>> {
    let (exists, values, indices) = attribute.parts();
    let indexed = || {
        let indices = places.iter().map(|&place| indices[place]).collect();
        CornerValues::indexed(values.iter().map(convert).collect(), indices)
    };
    exists.then(indexed)
}
