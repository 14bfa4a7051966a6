//! [`Surface`]: the data of one primitive, as the rules read it.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::hash::Hash;
use std::sync::{Arc, OnceLock};

use darboux::internal::DisjointSets;
pub use darboux::internal::vectors::single::{cross, sub};
use darboux::{Convention, Mesh, TangentOptions, generate_tangents};
use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveCorners, PrimitiveInfo};

use crate::indices::Part;
use crate::once_per::{OncePer, Reading};
use crate::place::Place;
use crate::tilts::Tilts;

/// A primitive with triangles.
#[derive(Debug)]
pub struct Surface {
    /// Where it is.
    pub place: Place,
    /// Whether its material uses tangents.
    pub needs_tangents: bool,
    /// Why tangents cannot be computed, as a sentence; none if they can.
    pub ineligible: Option<String>,
    /// Whether morph targets move its normals.
    pub moves_normals: bool,
    /// The UV set that its tangents follow.
    pub uv_set: usize,
    /// The vertex of every corner, three corners per triangle.
    pub vertex_of_corner: Vec<u32>,
    /// The index of every vertex in the file, ascending, where the primitive shares more vertices than it
    /// uses with others; none where all vertices of its accessors were read.
    pub vertices_in_file: Option<Vec<u32>>,
    /// The number of vertices in the file.
    pub vertices_of_file: usize,
    pub positions: Vec<[f32; 3]>,
    pub normals: Option<Vec<[f32; 3]>>,
    pub tangents: Option<Vec<[f32; 4]>>,
    /// Bytes per tangent in the file, without padding; 0 where it has none.
    pub tangent_size: usize,
    /// The UV sets by the n of `TEXCOORD_n`. UV sets in one accessor share a list.
    pub uv_sets: BTreeMap<usize, Arc<Vec<[f32; 2]>>>,
    /// Whether its faces say nothing about maps, once that was asked.
    pub has_no_votes: OnceLock<bool>,
    /// The smooth edges at which maps are cut: of each side the triangle and the corner where it begins.
    pub smooth_seams: OncePer<Reading, Vec<[CornerOfTriangle; 2]>>,
    /// The triangles that are one face: for each the first one of its face, by number.
    pub face_of_triangle: OncePer<Reading, Vec<u32>>,
    /// Whether the tilts of its triangles are kept, which take 240 bytes for each.
    pub keeps_tilts: bool,
    /// How triangles lean, by how the map is read and how many triangles are skipped between them.
    pub tilts: OncePer<(Reading, usize), Tilts>,
}

/// A triangle by its number, and one of its corners.
pub type CornerOfTriangle = (u32, u8);

impl Surface {
    /// Reads a primitive; none where it has no positions. All attributes have as many elements, or the
    /// document would not have opened. `info`: where it is absent, the surface does not need tangents,
    /// and they follow the first UV set. Errors: invalid accessors; an index out of range; UV sets that need
    /// more than the memory limit.
    pub fn read(
        document: &Document,
        corners: &PrimitiveCorners<'_>,
        info: Option<&PrimitiveInfo>,
    ) -> Result<Option<Self>, Error> {
        let Some(positions) = vertices(corners, "POSITION")? else { return Ok(None) };
        let name = corners.name();
        let primitive = &document.meshes()[name.mesh].primitives[name.primitive];
        let attributes = &primitive.attributes;
        let mut surface = Self {
            place: Place { primitive: Some(name.clone()), material: corners.material(), ..Place::default() },
            needs_tangents: info.is_some_and(|info| info.needs_tangents),
            ineligible: info.and_then(|info| info.ineligible.clone()),
            moves_normals: primitive.targets.iter().any(|target| target.contains_key("NORMAL")),
            uv_set: info.map_or(0, |info| info.uv_set),
            vertex_of_corner: corners.used_indices().to_vec(),
            vertices_in_file: corners.used_vertices().map(<[u32]>::to_vec),
            vertices_of_file: attributes
                .get("POSITION")
                .map_or(0, |&index| document.accessors()[index].count),
            positions,
            normals: vertices(corners, "NORMAL")?,
            tangents: vertices(corners, "TANGENT")?,
            tangent_size: attributes.get("TANGENT").map_or(0, |&accessor| element_size(document, accessor)),
            uv_sets: BTreeMap::new(),
            has_no_votes: OnceLock::new(),
            smooth_seams: OncePer::default(),
            face_of_triangle: OncePer::default(),
            keeps_tilts: false,
            tilts: OncePer::default(),
        };
        let set_of = |semantic: &str| semantic.strip_prefix("TEXCOORD_").and_then(|set| set.parse().ok());
        let sets = || attributes.iter().filter_map(|(name, &at)| Some((set_of(name)?, name, at)));
        let accessors: BTreeSet<usize> = sets().map(|(_, _, accessor)| accessor).collect();
        document.check_uv_count(accessors.len().saturating_mul(surface.positions.len()))?;
        let mut read: BTreeMap<usize, Arc<Vec<[f32; 2]>>> = BTreeMap::new();
        for (set, semantic, accessor) in sets() {
            if !read.contains_key(&accessor) {
                read.extend(vertices(corners, semantic)?.map(|uvs| (accessor, Arc::new(uvs))));
            }
            surface.uv_sets.extend(read.get(&accessor).map(|uvs| (set, Arc::clone(uvs))));
        }
        Ok(Some(surface))
    }

    /// The index in the file of a vertex.
    pub fn vertex_in_file(&self, vertex: usize) -> usize {
        self.vertices_in_file.as_ref().map_or(vertex, |in_file| in_file[vertex] as usize)
    }

    /// The mesh with one of its UV sets; none where it has no normals or not that set.
    pub fn mesh(&self, uv_set: usize) -> Option<Mesh<'_>> {
        let (normals, uvs) = (self.normals.as_ref()?, self.uv_sets.get(&uv_set)?);
        Mesh::triangles(&self.positions, normals, &**uvs, &self.vertex_of_corner).ok()
    }

    /// MikkTSpace's tangents of all corners in glTF's convention.
    pub fn expected_tangents(&self, uv_set: usize) -> Option<Vec<[f32; 4]>> {
        let tangents = generate_tangents(&self.mesh(uv_set)?, &TangentOptions::default()).corners;
        Some(tangents.converted(Convention::GLTF.generated(), Convention::GLTF).into_per_corner())
    }

    /// The vertices of every triangle.
    pub fn triangles(&self) -> impl Iterator<Item = [usize; 3]> {
        self.vertex_of_corner.as_chunks::<3>().0.iter().map(|triangle| triangle.map(|vertex| vertex as usize))
    }

    /// Whether a triangle has an area in space.
    pub fn has_area(&self, triangle: [usize; 3]) -> bool {
        let [a, b, c] = triangle.map(|vertex| self.positions[vertex]);
        length(cross(sub(b, a), sub(c, a))) > 0.0
    }

    /// The connected part of every vertex, named by one of its vertices. Vertices with the same key are one
    /// vertex.
    pub fn parts<K: Eq + Hash>(&self, key: impl Fn(usize) -> K) -> Vec<u32> {
        let mut first = HashMap::new();
        let mut parts = DisjointSets::new(self.positions.len());
        for vertex in 0..self.positions.len() {
            parts.join(vertex, *first.entry(key(vertex)).or_insert(vertex));
        }
        for [a, b, c] in self.triangles() {
            parts.join(a, b);
            parts.join(a, c);
        }
        parts.into_names()
    }

    /// Drops vertices that no triangle uses; the others keep their order.
    pub fn used(&self, vertices: Vec<usize>) -> Vec<usize> {
        if vertices.is_empty() {
            return vertices;
        }
        let is_used = self.is_used();
        vertices.into_iter().filter(|&vertex| is_used[vertex]).collect()
    }

    /// The number of vertices that triangles use.
    pub fn used_count(&self) -> usize {
        self.is_used().into_iter().filter(|is_used| *is_used).count()
    }

    /// The vertices that triangles use whose elements fulfil a condition; none where none does. `elements`:
    /// one per vertex.
    pub fn vertices_where<T>(&self, elements: &[T], condition: impl Fn(&T) -> bool) -> Option<Part> {
        let found = self.used(indices_where(elements, condition));
        if found.is_empty() { None } else { Part::new(&found, self.used_count()) }
    }

    /// The triangles whose vertices fulfil a condition; none where none does.
    pub fn part_of_triangles(&self, condition: impl FnMut([usize; 3]) -> bool) -> Option<Part> {
        Part::new(&self.triangles_where(condition), self.vertex_of_corner.len() / 3)
    }

    /// Per vertex whether a triangle uses it.
    fn is_used(&self) -> Vec<bool> {
        let mut is_used = vec![false; self.positions.len()];
        self.vertex_of_corner.iter().for_each(|&vertex| is_used[vertex as usize] = true);
        is_used
    }

    /// The indices of the triangles whose vertices fulfil a condition.
    pub fn triangles_where(&self, mut condition: impl FnMut([usize; 3]) -> bool) -> Vec<usize> {
        let numbered = self.triangles().enumerate();
        numbered.filter(|(_, triangle)| condition(*triangle)).map(|(number, _)| number).collect()
    }
}

#[cfg(test)]
impl Surface {
    /// Triangles without normals, tangents and UVs.
    pub fn of_triangles(positions: Vec<[f32; 3]>, vertex_of_corner: Vec<u32>) -> Self {
        Self {
            place: Place::default(),
            needs_tangents: true,
            ineligible: None,
            moves_normals: false,
            uv_set: 0,
            vertices_in_file: None,
            vertices_of_file: positions.len(),
            has_no_votes: OnceLock::new(),
            smooth_seams: OncePer::default(),
            face_of_triangle: OncePer::default(),
            keeps_tilts: false,
            tilts: OncePer::default(),
            vertex_of_corner,
            positions,
            normals: None,
            tangents: None,
            tangent_size: 0,
            uv_sets: BTreeMap::new(),
        }
    }
}

/// The values of an attribute at the vertices of a primitive. Errors: invalid data; an index of a corner that
/// is out of range.
fn vertices<const N: usize>(
    corners: &PrimitiveCorners<'_>,
    semantic: &str,
) -> Result<Option<Vec<[f32; N]>>, Error> {
    Ok(corners.used_vectors(semantic)?.map(|vectors| vectors.into_owned()))
}

/// Twice the signed area of a triangle in UV space, with v as stored.
pub fn uv_area(uvs: &[[f32; 2]], triangle: [usize; 3]) -> f64 {
    let [a, b, c] = triangle.map(|vertex| uvs[vertex].map(f64::from));
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Bytes per element of an accessor.
fn element_size(document: &Document, accessor: usize) -> usize {
    let accessor = &document.accessors()[accessor];
    accessor.element_type.size(accessor.component_type)
}

/// The indices of the elements that fulfil a condition.
pub fn indices_where<T>(elements: &[T], condition: impl Fn(&T) -> bool) -> Vec<usize> {
    elements.iter().enumerate().filter(|(_, element)| condition(element)).map(|(index, _)| index).collect()
}

pub fn dot(a: [f32; 3], b: [f32; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(b)).sum()
}

pub fn length(a: [f32; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// Whether a vector is finite and long enough to be made a unit vector.
pub fn has_direction(vector: [f32; 3]) -> bool {
    let length = length(vector);
    length.is_finite() && length > 1e-9
}

pub fn xyz([x, y, z, _]: [f32; 4]) -> [f32; 3] {
    [x, y, z]
}
