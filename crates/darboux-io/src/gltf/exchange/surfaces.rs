//! The surfaces of the default scene, in world space: one per primitive and place of its mesh.

use std::borrow::Cow;
use std::sync::Arc;

use darboux::Transform;

use crate::Error;
use crate::gltf::primitives::corners::PrimitiveCorners;
use crate::gltf::primitives::limits;
use crate::gltf::primitives::name::PrimitiveName;
use crate::gltf::primitives::quads::QuadFaces;
use crate::gltf::{Document, ElementType, IndexList, MeshInstance, schema};

/// The faces of a primitive at one place, with quads where the source had quads.
#[derive(Clone)]
pub struct Surface {
    /// The name of its node, or else of its mesh; empty if neither has one.
    pub name: Arc<str>,
    pub material: Option<usize>,
    pub positions: Vec<[f32; 3]>,
    pub normals: Option<Vec<[f32; 3]>>,
    /// `v` points down, as in glTF.
    pub uvs: Option<Vec<[f32; 2]>>,
    /// Linear RGBA.
    pub colors: Option<Vec<[f32; 4]>>,
    pub tangents: Option<Vec<[f32; 4]>>,
    /// The vertex of each corner, face after face.
    pub corners: Vec<u32>,
    pub sizes: Vec<u32>,
}

/// The surfaces of a document. Errors: invalid data; more corners than the memory limit permits.
pub fn of(document: &Document) -> Result<Vec<Surface>, Error> {
    let instances = document.mesh_instances()?.meshes;
    let materials = document.materials()?;
    limits::check_triangles(document, instances.iter().flat_map(|instance| triangles(document, instance)))?;
    let mut found = Vec::new();
    for instance in &instances {
        let mesh = &document.meshes()[instance.mesh];
        let node_name = instance.node_name.as_deref().map(Arc::from);
        let own_name: Arc<str> = node_name.or_else(|| mesh.name.clone()).unwrap_or_default();
        for (place, primitive) in mesh.primitives.iter().enumerate() {
            let name = PrimitiveName::new(instance.mesh, mesh, place);
            let set = primitive.material.and_then(|index| materials.get(index));
            let set = set.map_or(0, |material| material.tangent_uv_set);
            let Some(surface) = surface(document, &name, primitive, set)? else { continue };
            for matrix in &instance.matrices {
                let mut placed = Surface { name: own_name.clone(), ..surface.clone() };
                placed.transform(matrix);
                found.push(placed);
            }
        }
    }
    Ok(found)
}

/// The triangles of each primitive of an instance, at all its places.
fn triangles<'a>(document: &'a Document, instance: &'a MeshInstance) -> impl Iterator<Item = usize> + 'a {
    let primitives = document.meshes()[instance.mesh].primitives.iter();
    let counts = primitives
        .filter_map(|primitive| crate::gltf::primitives::corners::triangle_count(document, primitive));
    counts.map(|count| count.saturating_mul(instance.matrices.len()))
}

/// The surface of a primitive in its mesh; none without triangles.
fn surface(
    document: &Document,
    name: &PrimitiveName,
    primitive: &schema::Primitive,
    uv_set: usize,
) -> Result<Option<Surface>, Error> {
    let Some(found) = PrimitiveCorners::find(document, name, primitive)? else { return Ok(None) };
    let Some(positions) = found.vertex_vectors::<3>("POSITION")?.filter(|_| !found.is_empty()) else {
        return Ok(None);
    };
    let uvs = match found.vertex_vectors::<2>(&format!("TEXCOORD_{uv_set}"))? {
        None => found.vertex_vectors::<2>("TEXCOORD_0")?,
        uvs => uvs,
    };
    let mut surface = Surface {
        name: Arc::default(),
        material: primitive.material,
        positions: positions.into_owned(),
        normals: found.vertex_vectors::<3>("NORMAL")?.map(Cow::into_owned),
        uvs: uvs.map(Cow::into_owned),
        colors: colors(document, primitive, &found)?,
        tangents: found.vertex_vectors::<4>("TANGENT")?.map(Cow::into_owned),
        corners: Vec::new(),
        sizes: Vec::new(),
    };
    let vertices = found.into_vertices();
    match QuadFaces::of(document, name, &IndexList::U32(vertices.as_slice().into())) {
        Some(faces) => (surface.corners, surface.sizes) = (faces.vertices, faces.sizes),
        None => (surface.sizes, surface.corners) = (vec![3; vertices.len() / 3], vertices),
    }
    Ok(Some(surface))
}

fn colors(
    document: &Document,
    primitive: &schema::Primitive,
    found: &PrimitiveCorners<'_>,
) -> Result<Option<Vec<[f32; 4]>>, Error> {
    let Some(accessor) =
        primitive.attributes.get("COLOR_0").and_then(|&index| document.accessors().get(index))
    else {
        return Ok(None);
    };
    Ok(match accessor.element_type {
        ElementType::Vec4 => found.vertex_vectors::<4>("COLOR_0")?.map(Cow::into_owned),
        _ => found
            .vertex_vectors::<3>("COLOR_0")?
            .map(|colors| colors.iter().map(|&[r, g, b]| [r, g, b, 1.0]).collect()),
    })
}

impl Surface {
    /// Moves the surface to the scene. The identity changes no bit.
    fn transform(&mut self, matrix: &[[f64; 4]; 4]) {
        let is_one = |column: usize, row: usize| matrix[column][row] == f64::from(u8::from(column == row));
        if (0..16).all(|at| is_one(at / 4, at % 4)) {
            return;
        }
        let linear = [0, 1, 2].map(|column| [0, 1, 2].map(|row| matrix[column][row] as f32));
        let transform = Transform::new(linear);
        for position in &mut self.positions {
            let [x, y, z] = position.map(f64::from);
            *position = [0, 1, 2].map(|row| {
                (matrix[0][row] * x + matrix[1][row] * y + matrix[2][row] * z + matrix[3][row]) as f32
            });
        }
        if let (Some(normals), Some(tangents)) = (&self.normals, &mut self.tangents) {
            for (normal, tangent) in normals.iter().zip(tangents) {
                *tangent = transform.frame(*normal, *tangent).1;
            }
        }
        self.normals.iter_mut().flatten().for_each(|normal| *normal = transform.normal(*normal));
        if transform.orientation() < 0.0 {
            let mut first = 0;
            for &size in &self.sizes {
                let end = first + size as usize;
                self.corners[first + 1..end].reverse();
                first = end;
            }
        }
    }
}
