//! The surfaces of the default scene, in world space: one per primitive and place of its mesh.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use darboux::Transform;

use crate::Error;
use crate::gltf::primitives::corners::{PrimitiveCorners, triangle_count};
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
    let drawn = drawn_primitives(document, &instances);
    let triangles =
        |instance: &MeshInstance| drawn[&instance.mesh].triangles.saturating_mul(instance.matrices.len());
    limits::check_triangles(document, instances.iter().map(triangles))?;
    let mut found = Vec::new();
    for instance in &instances {
        let mesh = &document.meshes()[instance.mesh];
        let node_name = instance.node_name.as_deref().map(Arc::from);
        let own_name: Arc<str> = node_name.or_else(|| mesh.name.clone()).unwrap_or_default();
        for &place in &drawn[&instance.mesh].primitives {
            let primitive = &mesh.primitives[place];
            let name = PrimitiveName::new(instance.mesh, mesh, place);
            let set = primitive.material.and_then(|index| materials.get(index));
            let set = set.map_or(0, |material| material.tangent_uv_set);
            let Some(surface) = surface(document, &name, primitive, set)? else { continue };
            for matrix in &instance.matrices {
                let mut instance_surface = Surface { name: own_name.clone(), ..surface.clone() };
                instance_surface.transform(matrix);
                found.push(instance_surface);
            }
        }
    }
    Ok(found)
}

/// The primitives of a mesh that have triangles. The others are not passed at each place of the mesh.
#[derive(Default)]
struct DrawnPrimitives {
    primitives: Vec<usize>,
    /// The number of their triangles.
    triangles: usize,
}

/// The drawn primitives of every mesh with an instance.
fn drawn_primitives(document: &Document, instances: &[MeshInstance]) -> HashMap<usize, DrawnPrimitives> {
    let mut meshes = HashMap::new();
    for instance in instances {
        meshes.entry(instance.mesh).or_insert_with(|| {
            let mut drawn = DrawnPrimitives::default();
            for (place, primitive) in document.meshes()[instance.mesh].primitives.iter().enumerate() {
                let triangles = triangle_count(document, primitive).unwrap_or_default();
                if triangles > 0 {
                    drawn.primitives.push(place);
                    drawn.triangles = drawn.triangles.saturating_add(triangles);
                }
            }
            drawn
        });
    }
    meshes
}

/// The vertices that corners use, ascending; none if all of them are. Primitives may share many vertices of
/// which each uses few.
fn used_vertices(corners: &[u32], count: usize) -> Option<Vec<u32>> {
    let mut used = corners.to_vec();
    used.sort_unstable();
    used.dedup();
    (used.len() < count).then_some(used)
}

/// The surface of a primitive in its mesh, with the vertices that it uses; none without triangles.
fn surface(
    document: &Document,
    name: &PrimitiveName,
    primitive: &schema::Primitive,
    uv_set: usize,
) -> Result<Option<Surface>, Error> {
    let Some(found) = PrimitiveCorners::find(document, name, primitive)? else { return Ok(None) };
    let Some(positions) = found.used_vectors::<3>("POSITION")?.filter(|_| !found.is_empty()) else {
        return Ok(None);
    };
    let uvs = match found.used_vectors::<2>(&format!("TEXCOORD_{uv_set}"))? {
        None => found.used_vectors::<2>("TEXCOORD_0")?,
        uvs => uvs,
    };
    let used = used_vertices(found.used_indices(), positions.len());
    let used = used.as_deref();
    let mut surface = Surface {
        name: Arc::default(),
        material: primitive.material,
        positions: values(positions, used),
        normals: found.used_vectors::<3>("NORMAL")?.map(|normals| values(normals, used)),
        uvs: uvs.map(|uvs| values(uvs, used)),
        colors: colors(document, primitive, &found, used)?,
        tangents: found.used_vectors::<4>("TANGENT")?.map(|tangents| values(tangents, used)),
        corners: Vec::new(),
        sizes: Vec::new(),
    };
    let vertices = found.into_used_indices();
    match QuadFaces::of(document, name, &IndexList::U32(vertices.as_slice().into())) {
        Some(faces) => (surface.corners, surface.sizes) = (faces.vertices, faces.sizes),
        None => (surface.sizes, surface.corners) = (vec![3; vertices.len() / 3], vertices),
    }
    if let Some(used) = used {
        let place = |vertex: &u32| used.partition_point(|used| used < vertex) as u32;
        surface.corners.iter_mut().for_each(|vertex| *vertex = place(vertex));
    }
    Ok(Some(surface))
}

/// The values at the vertices that are used, or at all.
fn values<T: Copy>(values: Cow<'_, [T]>, used: Option<&[u32]>) -> Vec<T> {
    match used {
        Some(used) => used.iter().map(|&vertex| values[vertex as usize]).collect(),
        None => values.into_owned(),
    }
}

fn colors(
    document: &Document,
    primitive: &schema::Primitive,
    found: &PrimitiveCorners<'_>,
    used: Option<&[u32]>,
) -> Result<Option<Vec<[f32; 4]>>, Error> {
    let Some(accessor) =
        primitive.attributes.get("COLOR_0").and_then(|&index| document.accessors().get(index))
    else {
        return Ok(None);
    };
    Ok(match accessor.element_type {
        ElementType::Vec4 => found.used_vectors::<4>("COLOR_0")?.map(|colors| values(colors, used)),
        _ => found
            .used_vectors::<3>("COLOR_0")?
            .map(|colors| values(colors, used).into_iter().map(|[r, g, b]| [r, g, b, 1.0]).collect()),
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
