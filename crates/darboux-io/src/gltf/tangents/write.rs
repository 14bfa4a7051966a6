//! Into the document: new accessors, and primitives that refer to them. Accessors that exist are never changed.

use std::collections::HashMap;

use serde_json::Value;

use super::compute::Surface;
use super::excess;
use super::morph::Movement;
use super::select::Candidate;
use super::share::{Canonical, Group, Member};
use super::split::Split;
use super::topology::Topology;
use super::{TangentEncoding, TangentsOptions};
use crate::Error;
use crate::gltf::schema::Attributes;
use crate::gltf::{ComponentType, Document, ElementType, Elements, NewAccessor, Target};

/// Appends an accessor of floats, one element per vertex; without the zeros, if `sparse`.
pub fn push_vectors<const N: usize>(
    document: &mut Document,
    element_type: ElementType,
    vectors: &[[f32; N]],
    sparse: bool,
) -> usize {
    let elements = Elements {
        bytes: vectors.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect(),
        count: vectors.len(),
        component_type: ComponentType::F32,
        element_type,
        normalized: false,
    };
    let target = Target::Vertices;
    document.push_accessor(NewAccessor { elements, target, bounds: false, sparse, like: None })
}

/// Appends an accessor of tangents, one per vertex, and declares the extension that it needs.
pub fn push_tangents(document: &mut Document, encoding: TangentEncoding, tangents: &[[f32; 4]]) -> usize {
    document.require_extensions(encoding.extension());
    let elements = encoding.elements(tangents);
    let target = Target::Vertices;
    document.push_accessor(NewAccessor { elements, target, bounds: false, sparse: false, like: None })
}

/// Whether an accessor leaves out zeros, so that what follows it should do the same.
pub fn is_sparse(document: &Document, accessor: usize) -> bool {
    document.accessors().get(accessor).is_some_and(|accessor| accessor.buffer_view.is_none())
}

/// What the primitives of a group refer to.
#[derive(Debug)]
pub struct Results<'a> {
    pub surfaces: &'a [Surface],
    pub split: &'a Split,
    /// The accessor of the tangents.
    pub tangents: usize,
    /// The accessors of tangent offsets.
    pub offsets: HashMap<Movement, usize>,
}

/// Writes the members of one group. What they share is written when the first of them needs it.
#[derive(Debug)]
pub struct Writer<'a> {
    accessors: &'a Canonical,
    options: &'a TangentsOptions,
    group: &'a Group,
    results: Results<'a>,
    /// Attributes with the appended vertices, by the old accessor and whether they have bounds.
    extended: HashMap<(usize, bool), usize>,
    /// New indices, by job.
    indices: HashMap<usize, usize>,
}

impl<'a> Writer<'a> {
    /// A writer that has written nothing yet.
    pub fn new(
        accessors: &'a Canonical,
        options: &'a TangentsOptions,
        group: &'a Group,
        results: Results<'a>,
    ) -> Self {
        Self { accessors, options, group, results, extended: HashMap::new(), indices: HashMap::new() }
    }

    /// Gives a primitive its tangents. Returns the movements of its targets that got tangent offsets.
    ///
    /// Errors: attributes that must be extended and do not exist, or have another number of elements than positions.
    pub fn write(
        &mut self,
        document: &mut Document,
        member: &Member,
        candidate: &Candidate,
    ) -> Result<Vec<Movement>, Error> {
        let name = &candidate.name;
        let primitive = document.meshes()[name.mesh].primitives[name.primitive].clone();
        let at = format!("{}.attributes", name.path());
        let attributes =
            self.attributes(document, &at, &primitive.attributes, Some(self.results.tangents))?;
        let mut targets = Vec::with_capacity(primitive.targets.len());
        let mut morphed = Vec::new();
        for (place, target) in primitive.targets.iter().enumerate() {
            let movement = Movement::of(self.accessors, target, self.options);
            let offsets = movement.map(|movement| self.results.offsets[&movement]);
            morphed.extend(movement);
            let at = format!("{}.targets[{place}]", name.path());
            targets.push(self.attributes(document, &at, target, offsets)?);
        }
        let indices = self.indices(document, member.job)?;
        document.edit_primitive(name.mesh, name.primitive, |json| {
            set(json.get_mut("attributes"), &attributes);
            let places = json.get_mut("targets").and_then(Value::as_array_mut);
            for (place, target) in places.into_iter().flatten().zip(&targets) {
                set(Some(place), target);
            }
            if let Some(indices) = indices {
                json.insert("indices".to_owned(), indices.into());
                if self.group.jobs[member.job].topology != Topology::Triangles {
                    json.insert("mode".to_owned(), 4.into());
                }
            }
        })?;
        Ok(morphed)
    }

    /// `old` with the appended vertices, if there are any, and with `tangents`, if given. `at` is its JSON path.
    fn attributes(
        &mut self,
        document: &mut Document,
        at: &str,
        old: &Attributes,
        tangents: Option<usize>,
    ) -> Result<Attributes, Error> {
        let mut new = Attributes::new();
        for (semantic, &accessor) in old {
            if semantic == "TANGENT" && tangents.is_some() {
                continue;
            }
            let at = format!("{at}.{semantic}");
            let accessor = if self.results.split.is_needed() {
                self.extended(document, &at, accessor, semantic == "POSITION")?
            } else {
                accessor
            };
            new.insert(semantic.clone(), accessor);
        }
        new.extend(tangents.map(|tangents| ("TANGENT".to_owned(), tangents)));
        Ok(new)
    }

    /// An accessor with the elements of `old` and the appended vertices.
    fn extended(
        &mut self,
        document: &mut Document,
        at: &str,
        old: usize,
        bounds: bool,
    ) -> Result<usize, Error> {
        let key = (self.accessors.of(old), bounds);
        if let Some(&extended) = self.extended.get(&key) {
            return Ok(extended);
        }
        let mut elements = document.read_elements(old)?;
        let vertices = self.results.split.old_vertex_count();
        if elements.count != vertices {
            let problem = format!("accessor {old} has {} elements for {vertices} vertices", elements.count);
            return Err(document.invalid(at, format!("{problem}; export the file again")));
        }
        self.results.split.extend(&mut elements);
        let sparse = is_sparse(document, old);
        let new = NewAccessor { elements, target: Target::Vertices, bounds, sparse, like: Some(old) };
        let extended = document.push_accessor(new);
        excess::check_output(document)?;
        self.extended.insert(key, extended);
        Ok(extended)
    }

    /// The accessor of new indices for a job; none where the old ones, or their absence, serve.
    fn indices(&mut self, document: &mut Document, job: usize) -> Result<Option<usize>, Error> {
        let Results { surfaces, split, .. } = self.results;
        let (surface, old) = (&surfaces[job], self.group.jobs[job].indices);
        if !split.is_needed() || (old.is_some() && split.corners[job] == surface.corners) {
            return Ok(None);
        }
        if let Some(&indices) = self.indices.get(&job) {
            return Ok(Some(indices));
        }
        let kind = old.and_then(|old| document.accessors().get(old)).map(|old| old.component_type);
        let values = split.corners[job].iter().chain(&surface.rest).copied();
        let elements = index_elements(kind, values.collect());
        let new = NewAccessor { elements, target: Target::Indices, bounds: false, sparse: false, like: old };
        let indices = document.push_accessor(new);
        self.indices.insert(job, indices);
        Ok(Some(indices))
    }
}

/// Sets members of a JSON object to accessors.
fn set(json: Option<&mut Value>, attributes: &Attributes) {
    let Some(json) = json.and_then(Value::as_object_mut) else { return };
    for (semantic, &accessor) in attributes {
        json.insert(semantic.clone(), accessor.into());
    }
}

/// Indices of the type they had, or the next one that holds them; of 16 bits where there were none. The greatest number of a
/// type is no index: it restarts primitives (glTF 2.0, 3.7.2.1).
fn index_elements(old: Option<ComponentType>, indices: Vec<u32>) -> Elements {
    let greatest = indices.iter().copied().max().unwrap_or(0);
    let least = match old {
        Some(ComponentType::U8) => 1,
        Some(ComponentType::U32) => 4,
        _ => 2,
    };
    let (component_type, bytes) = if least <= 1 && greatest < 0xff {
        (ComponentType::U8, indices.iter().map(|&index| index as u8).collect())
    } else if least <= 2 && greatest < 0xffff {
        (ComponentType::U16, indices.iter().flat_map(|&index| (index as u16).to_le_bytes()).collect())
    } else {
        (ComponentType::U32, indices.iter().flat_map(|&index| index.to_le_bytes()).collect())
    };
    Elements {
        bytes,
        count: indices.len(),
        component_type,
        element_type: ElementType::Scalar,
        normalized: false,
    }
}

#[cfg(test)]
mod tests {
    use super::{ComponentType, index_elements};

    #[test]
    fn indices_widen_before_the_restart_value() {
        use ComponentType::{U8, U16, U32};
        let cases = [
            (Some(U8), 254, U8),
            (Some(U8), 255, U16),
            (Some(U8), 65534, U16),
            (Some(U8), 65535, U32),
            (Some(U16), 3, U16),
            (Some(U16), 65535, U32),
            (Some(U32), 3, U32),
            (None, 254, U16),
            (None, 65535, U32),
        ];
        for (old, greatest, new) in cases {
            let elements = index_elements(old, vec![0, greatest]);
            assert_eq!(elements.component_type, new, "{old:?} {greatest}");
            assert_eq!(elements.bytes.len(), 2 * new.size());
        }
    }
}
