//! [`ModelArea`]: the area of all surfaces of a model in its scene, which the damaged area of a defect is
//! compared with.

use std::collections::{BTreeMap, HashSet};

use darboux_io::Error;
use darboux_io::gltf::{Document, Material, MeshInstances};

use crate::code::Family;
use crate::instances::{Key, first_with_same_data, key, meshes_without_node};
use crate::place::Place;
use crate::surface::{Surface, cross, length, sub};

/// The area of the surfaces of a model.
#[derive(Clone, Debug, Default)]
pub struct ModelArea {
    /// The area of all surfaces, in the squared units of the scene.
    total: f64,
    /// The area of those whose tangents something shows.
    with_maps: f64,
    /// The area of the primitives with the same data, by the first of them.
    of_primitives: BTreeMap<Key, f64>,
    /// By the index of a mesh: how many times its area is in the scene, scaled as its nodes are; 0 where
    /// other meshes have nodes and it has none. 1 for a mesh of another scene.
    scale_of_mesh: BTreeMap<usize, f64>,
}

impl ModelArea {
    /// Errors: invalid data of primitives.
    pub fn of(document: &Document) -> Result<Self, Error> {
        // Where the nodes are broken, every mesh counts once.
        let instances = document.mesh_instances().unwrap_or_default();
        let mut area = Self { scale_of_mesh: scales(&instances), ..Self::default() };
        area.scale_of_mesh.extend(meshes_without_node(document).into_iter().map(|mesh| (mesh, 0.0)));
        let needing: HashSet<Key> = tangents_needed_by(document)?;
        let first = first_with_same_data(document);
        for corners in document.corners()? {
            let Some(positions) = corners.used_vectors::<3>("POSITION")? else { continue };
            let position = |vertex: u32| positions[vertex as usize];
            let triangles = corners.used_indices().as_chunks::<3>().0.iter();
            let own: f64 = triangles
                .map(|triangle| area_of(triangle.map(position)))
                .filter(|area| area.is_finite())
                .sum();
            let (own, at) = (own * area.scale(corners.name().mesh), key(corners.name()));
            area.total += own;
            area.with_maps += if needing.contains(&at) { own } else { 0.0 };
            *area.of_primitives.entry(first[&at]).or_default() += own;
        }
        Ok(area)
    }

    /// The same for maps on all surfaces.
    #[must_use]
    pub fn with_maps_on_all(self) -> Self {
        Self { with_maps: self.total, ..self }
    }

    /// The area of a part of the primitive at a place in percent of the model's, for tangents of what shows
    /// them; none for a model without an area. `own`: in the units of its positions.
    pub fn percent(&self, place: &Place, own: f64, family: Family) -> Option<f64> {
        let mesh = place.primitive.as_ref()?.mesh;
        let all = if family == Family::Tangents { self.with_maps } else { self.total };
        let shown = own * self.scale(mesh) * (1 + place.same_as) as f64;
        let share = if shown == 0.0 { 0.0 } else { shown / all };
        (self.total > 0.0 && share.is_finite()).then_some(100.0 * share.min(1.0))
    }

    /// The area of a primitive and all with the same data in percent of what shows tangents. `at`: the first
    /// of them.
    pub fn percent_of_all(&self, at: Key) -> f64 {
        let percent = 100.0 * self.of_primitives.get(&at).copied().unwrap_or(0.0) / self.with_maps;
        if percent.is_finite() { percent.min(100.0) } else { 0.0 }
    }

    fn scale(&self, mesh: usize) -> f64 {
        self.scale_of_mesh.get(&mesh).copied().unwrap_or(1.0)
    }
}

/// The primitives whose tangents something shows.
fn tangents_needed_by(document: &Document) -> Result<HashSet<Key>, Error> {
    let materials = document.materials()?;
    let is_unread = |material: usize| {
        document.provenance().is_some_and(|source| source.unread_maps_of(material).next().is_some())
    };
    let shows =
        |&material: &usize| materials.get(material).is_some_and(shows_tangents) || is_unread(material);
    let meshes = document.meshes().iter().enumerate();
    let primitives = meshes.flat_map(|(mesh, of_mesh)| {
        of_mesh.primitives.iter().enumerate().map(move |(number, primitive)| ((mesh, number), primitive))
    });
    Ok(primitives
        .filter(|(_, primitive)| primitive.materials().iter().any(shows))
        .map(|(key, _)| key)
        .collect())
}

fn shows_tangents(material: &Material) -> bool {
    material.is_anisotropic || material.normal_maps().next().is_some()
}

/// By mesh, the sum of the area scales of its places in the scene.
fn scales(instances: &MeshInstances) -> BTreeMap<usize, f64> {
    let mut scales = BTreeMap::new();
    for mesh in &instances.meshes {
        let joints = mesh.skin.and_then(|skin| instances.skins.get(skin)).filter(|joints| !joints.is_empty());
        let scale = match joints {
            // Most joints of a skin have one scale.
            Some(joints) => joints.iter().map(area_scale).sum::<f64>() / joints.len() as f64,
            None => mesh.matrices.iter().map(area_scale).sum(),
        };
        if scale.is_finite() {
            *scales.entry(mesh.mesh).or_default() += scale;
        }
    }
    scales
}

/// The factor by which a transform changes areas, averaged over their directions where it stretches: the
/// determinant to the power of 2/3.
fn area_scale([x, y, z, _]: &[[f64; 4]; 4]) -> f64 {
    let determinant = x[0] * (y[1] * z[2] - y[2] * z[1]) - y[0] * (x[1] * z[2] - x[2] * z[1])
        + z[0] * (x[1] * y[2] - x[2] * y[1]);
    determinant.abs().cbrt().powi(2)
}

/// The area of a triangle of a surface; 0 where that is not finite.
pub fn area(surface: &Surface, triangle: [usize; 3]) -> f64 {
    let area = area_of(triangle.map(|vertex| surface.positions[vertex]));
    if area.is_finite() { area } else { 0.0 }
}

/// The area of a triangle.
pub fn area_of([a, b, c]: [[f32; 3]; 3]) -> f64 {
    length(cross(sub(b, a), sub(c, a))) / 2.0
}
