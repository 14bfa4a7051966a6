//! Writes tangents into a document: new accessors, and primitives that refer to them. Existing accessors are
//! never changed.

use std::collections::HashMap;

use crate::json::Value;

use super::encoding::TangentEncoding;
use super::groups::{Group, GroupMember};
use super::morph::Movement;
use super::options::AddTangentsOptions;
use super::select::TangentCandidate;
use super::split::Split;
use crate::Error;
use crate::gltf::primitives::append::{Appended, index_elements, set_attributes};
use crate::gltf::primitives::canonical::CanonicalAccessors;
use crate::gltf::primitives::triangles::TriangleMode;
use crate::gltf::schema::Attributes;
use crate::gltf::{Document, NewAccessor, Target};

/// Appends an accessor of tangents, one per vertex, and declares the extension of its encoding. Returns `old`
/// if it has the same elements.
pub fn push_tangents(
    document: &mut Document,
    old: Option<usize>,
    encoding: TangentEncoding,
    tangents: &[[f32; 4]],
) -> usize {
    document.require_extensions(encoding.extension());
    let elements = encoding.elements(tangents);
    let target = Target::Vertices;
    document.push_in_place_of(old, NewAccessor::new(elements, target))
}

/// The new accessors of a group.
#[derive(Debug)]
pub struct GroupAccessors<'a> {
    pub split: &'a Split,
    /// The new index list of each job; none if the old one is kept.
    pub lists: Vec<Option<Vec<u32>>>,
    /// The accessor of the tangents.
    pub tangents: usize,
    /// The accessors of tangent offsets.
    pub offsets: HashMap<Movement, usize>,
}

/// Writes the members of one group. Shared accessors are made on first use.
#[derive(Debug)]
pub struct TangentWriter<'a> {
    accessors: &'a CanonicalAccessors,
    options: &'a AddTangentsOptions,
    group: &'a Group,
    results: GroupAccessors<'a>,
    appended: Appended<'a>,
    /// The accessors of new indices, by job.
    indices: HashMap<usize, usize>,
}

impl<'a> TangentWriter<'a> {
    /// A writer without any accessor yet.
    pub fn new(
        accessors: &'a CanonicalAccessors,
        options: &'a AddTangentsOptions,
        group: &'a Group,
        results: GroupAccessors<'a>,
    ) -> Self {
        let appended = Appended::new(accessors, &results.split.copies, results.split.old_vertex_count());
        Self { accessors, options, group, results, appended, indices: HashMap::new() }
    }

    /// Writes the tangents of a primitive. Returns the movements of its targets that got tangent offsets.
    ///
    /// Errors: an attribute that must be extended does not exist, or does not have one element per vertex.
    pub fn write(
        &mut self,
        document: &mut Document,
        member: &GroupMember,
        candidate: &TangentCandidate,
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
            set_attributes(json.get_mut("attributes"), &attributes);
            let places = json.get_mut("targets").and_then(Value::as_array_mut);
            for (place, target) in places.into_iter().flatten().zip(&targets) {
                set_attributes(Some(place), target);
            }
            if let Some(indices) = indices {
                json.insert("indices", indices.into());
                if self.group.jobs[member.job].topology != TriangleMode::Triangles {
                    json.insert("mode", 4.into());
                }
            }
        })?;
        Ok(morphed)
    }

    /// The attributes `old` with the appended vertices, if any, and with `tangents`, if given. `at` is their
    /// JSON path.
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
                self.appended.accessor(document, &at, accessor, semantic == "POSITION")?
            } else {
                accessor
            };
            new.insert(semantic.clone(), accessor);
        }
        new.extend(tangents.map(|tangents| ("TANGENT".to_owned(), tangents)));
        Ok(new)
    }

    /// The accessor of new indices for a job; none if it needs no new ones.
    fn indices(&mut self, document: &mut Document, job: usize) -> Result<Option<usize>, Error> {
        if let Some(&indices) = self.indices.get(&job) {
            return Ok(Some(indices));
        }
        let Some(list) = self.results.lists[job].take() else { return Ok(None) };
        let old = self.group.jobs[job].indices;
        let kind = old.and_then(|old| document.accessors().get(old)).map(|old| old.component_type);
        let elements = index_elements(kind, list);
        let new = NewAccessor::new(elements, Target::Indices).with_metadata_of(old);
        let indices = document.push_accessor(new);
        self.indices.insert(job, indices);
        Ok(Some(indices))
    }
}
