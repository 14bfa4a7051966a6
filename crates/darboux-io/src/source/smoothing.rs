//! Makes the normals that a mesh lacks by its smoothing groups.
//!
//! Corners at one position share a normal if their faces have the same group. Faces of group 0, as `s off`
//! writes it, are flat.

use std::collections::HashMap;

use darboux::{Faces, NormalOptions, Shading, SmoothingSeams, generate_normals};

use super::scene::{CornerValues, FaceSizes, SourceMesh};
use crate::words::counted;

/// The numbers of meshes whose normals were made.
#[derive(Clone, Copy, Debug, Default)]
pub struct MadeNormals {
    /// Meshes without normals.
    pub all: usize,
    /// Meshes with normals at some corners.
    pub some: usize,
}

impl MadeNormals {
    pub fn warnings(self) -> impl Iterator<Item = String> {
        let all = (self.all > 0).then(|| {
            let meshes = counted(
                self.all,
                "mesh has no normals; they were made by its",
                "meshes have no normals; they were made by their",
            );
            format!("{meshes} smoothing groups")
        });
        let some = (self.some > 0).then(|| {
            let meshes = counted(
                self.some,
                "mesh lacks normals at some corners; those were made by its",
                "meshes lack normals at some corners; those were made by their",
            );
            format!("{meshes} smoothing groups")
        });
        all.into_iter().chain(some)
    }
}

/// Adds normals to the meshes that have smoothing groups, at the corners that have none.
pub fn add_normals(meshes: &mut [SourceMesh]) -> MadeNormals {
    let mut made = MadeNormals::default();
    for mesh in meshes.iter_mut().filter(|mesh| !mesh.smoothing_of_face.is_empty()) {
        let given: Vec<Option<[f32; 3]>> = match &mesh.normals {
            Some(normals) => {
                let corners = mesh.corners.iter().enumerate();
                corners.map(|(corner, &position)| normals.get(corner, position)).collect()
            }
            None => vec![None; mesh.corners.len()],
        };
        if given.iter().all(Option::is_some) {
            continue;
        }
        let Some(computed) = normals_of_corners(mesh) else { continue };
        let is_new = given.iter().all(Option::is_none);
        (made.all, made.some) = (made.all + usize::from(is_new), made.some + usize::from(!is_new));
        let merged = given.into_iter().zip(computed).map(|(given, computed)| given.unwrap_or(computed));
        mesh.normals = Some(CornerValues::of_corners(merged.collect()));
    }
    made
}

/// The normal of each corner. None: the mesh refers to positions that do not exist, which the builder
/// refuses.
fn normals_of_corners(mesh: &SourceMesh) -> Option<Vec<[f32; 3]>> {
    let groups = groups_of_corners(mesh)?;
    let faces = match &mesh.faces {
        FaceSizes::Triangles => Faces::Triangles,
        FaceSizes::Sizes(sizes) => Faces::Mixed(sizes),
    };
    let make = |shading: Shading| {
        let (positions, indices) = grouped_vertices(mesh, &groups)?;
        let options = NormalOptions::new().with_shading(shading).with_seams(SmoothingSeams::Respected);
        Some(generate_normals(&positions[..], &indices[..], faces, &options).ok()?.corners.into_per_corner())
    };
    if groups.iter().all(|&group| group == 0) {
        return make(Shading::Flat);
    }
    let mut normals = make(Shading::Smooth)?;
    if groups.contains(&0) {
        let flat = make(Shading::Flat)?;
        let corners = normals.iter_mut().zip(flat).zip(&groups);
        corners.filter(|(_, group)| **group == 0).for_each(|((normal, flat), _)| *normal = flat);
    }
    Some(normals)
}

/// The smoothing group of each corner. None: another number of groups than faces.
fn groups_of_corners(mesh: &SourceMesh) -> Option<Vec<u32>> {
    let groups = &mesh.smoothing_of_face;
    let groups: Vec<u32> = match &mesh.faces {
        FaceSizes::Triangles => groups.iter().flat_map(|&group| [group; 3]).collect(),
        FaceSizes::Sizes(sizes) => {
            let faces = groups.iter().zip(sizes);
            faces.flat_map(|(&group, &size)| std::iter::repeat_n(group, size as usize)).collect()
        }
    };
    (groups.len() == mesh.corners.len()).then_some(groups)
}

/// A vertex for each pair of position and group, and the vertex of each corner.
fn grouped_vertices(mesh: &SourceMesh, groups: &[u32]) -> Option<(Vec<[f32; 3]>, Vec<u32>)> {
    let (mut vertices, mut positions) = (HashMap::new(), Vec::new());
    let mut indices = Vec::with_capacity(mesh.corners.len());
    for (&corner, &group) in mesh.corners.iter().zip(groups) {
        let position = *mesh.positions.get(corner as usize)?;
        // Adding zero turns -0 into +0.
        let key = (position.map(|x| (x + 0.0).to_bits()), group);
        indices.push(*vertices.entry(key).or_insert_with(|| {
            positions.push(position);
            positions.len() as u32 - 1
        }));
    }
    Some((positions, indices))
}
