//! Writes normals into a document. The vertices of one accessor of positions are split jointly for all its
//! primitives.

use std::collections::{BTreeMap, HashMap};

use crate::json::Value;
use darboux::{CornerNormalsRef, NormalSplit, split_normals};

use super::compute::{MovedNormals, ShadedPrimitive};
use super::summary::WrittenNormals;
use crate::Error;
use crate::gltf::primitives::append::{Appended, index_elements, push_vectors, set_attributes};
use crate::gltf::primitives::canonical::CanonicalAccessors;
use crate::gltf::primitives::offsets::VertexOffsets;
use crate::gltf::primitives::triangles::TriangleMode;
use crate::gltf::primitives::{foreign_extensions, limits};
use crate::gltf::schema::{Attributes, Primitive};
use crate::gltf::{Document, ElementType, NewAccessor, Target};

/// Writes the normals of primitives over the accessor `position`. Returns a report for each candidate.
pub fn write(
    document: &mut Document,
    accessors: &CanonicalAccessors,
    position: usize,
    parts: &[&ShadedPrimitive],
    warnings: &mut Vec<String>,
) -> Result<Vec<(usize, WrittenNormals)>, Error> {
    let split = split(document, position, parts)?;
    let old_count = document.accessors()[position].count;
    let copies = &split.source_of_vertex[old_count..];
    let old = parts.first().and_then(|part| {
        document.meshes()[part.name.mesh].primitives[part.name.primitive].attributes.get("NORMAL").copied()
    });
    let normals = push_vectors(document, old, ElementType::Vec3, &split.normal_of_vertex, false);
    limits::check_output(document)?;
    let appended = Appended::new(accessors, copies, old_count);
    let mut writer = NormalWriter {
        accessors,
        split: &split,
        normals,
        same: HashMap::new(),
        appended,
        offsets: HashMap::new(),
        conflicting: HashMap::new(),
        zeros: None,
        indices: Vec::new(),
    };
    writer.push_offsets(document, parts)?;
    let mut written = Vec::with_capacity(parts.len());
    let mut first = 0;
    for part in parts {
        if writer.appended.is_needed() {
            warnings.extend(foreign_extensions::warning(document, &part.name));
        }
        let corners = &split.indices[first..first + part.corners.len()];
        first += part.corners.len();
        written.push((part.candidate, writer.write(document, part, corners)?));
    }
    Ok(written)
}

fn split(document: &Document, position: usize, parts: &[&ShadedPrimitive]) -> Result<NormalSplit, Error> {
    let corners: Vec<u32> = parts.iter().flat_map(|part| &part.corners).copied().collect();
    let normals: Vec<[f32; 3]> = parts.iter().flat_map(|part| &part.normals).copied().collect();
    let vertices = document.accessors()[position].count;
    let at = parts.first().map_or_else(String::new, |part| part.name.path());
    if vertices.saturating_add(corners.len()) >= u32::MAX as usize {
        return Err(document.invalid(at, "has too many vertices for 32-bit indices; divide the mesh"));
    }
    split_normals(vertices, &corners, CornerNormalsRef::from_per_corner(&normals))
        .map_err(|error| document.mesh_error(at, error))
}

struct NormalWriter<'a> {
    accessors: &'a CanonicalAccessors,
    split: &'a NormalSplit,
    /// The accessor of the normals.
    normals: usize,
    /// Whether an old and a new accessor have the same elements.
    same: HashMap<[usize; 2], bool>,
    appended: Appended<'a>,
    /// The accessor of normal offsets, by the accessor of position offsets.
    offsets: HashMap<usize, usize>,
    /// The number of corners, by candidate, whose offset differs from that of their vertex.
    conflicting: HashMap<usize, usize>,
    /// An accessor of zero offsets.
    zeros: Option<usize>,
    /// New index lists: the old accessor, the vertices of the corners, and the new accessor.
    indices: Vec<(Option<usize>, &'a [u32], usize)>,
}

impl<'a> NormalWriter<'a> {
    /// Writes the normal offsets of every accessor of position offsets.
    fn push_offsets(&mut self, document: &mut Document, parts: &[&ShadedPrimitive]) -> Result<(), Error> {
        let mut moves_of_accessor: BTreeMap<usize, Vec<(&ShadedPrimitive, usize, &MovedNormals)>> =
            BTreeMap::new();
        let mut first = 0;
        for part in parts {
            for moved in part.moves.iter().flatten() {
                moves_of_accessor.entry(moved.accessor).or_default().push((part, first, moved));
            }
            first += part.corners.len();
        }
        for (accessor, moves) in moves_of_accessor {
            let old = moves.first().and_then(|(.., moved)| moved.old);
            // Targets may move few of many vertices. The first corner with an offset decides for its vertex.
            let mut offsets: HashMap<u32, [f32; 3]> = HashMap::new();
            for &(_, first, moved) in &moves {
                for &(corner, offset) in &moved.offsets {
                    offsets.entry(self.split.indices[first + corner]).or_insert(offset);
                }
            }
            for (part, first, moved) in moves {
                let vertices = &self.split.indices[first..first + part.corners.len()];
                *self.conflicting.entry(part.candidate).or_default() += conflicts(vertices, moved, &offsets);
            }
            let mut few: Vec<(u32, [f32; 3])> = offsets.into_iter().collect();
            few.sort_unstable_by_key(|(vertex, _)| *vertex);
            let offsets = VertexOffsets::new(self.split.normal_of_vertex.len(), few);
            self.offsets.insert(accessor, offsets.push(document, old, true));
            limits::check_output(document)?;
        }
        Ok(())
    }

    fn write(
        &mut self,
        document: &mut Document,
        part: &ShadedPrimitive,
        corners: &'a [u32],
    ) -> Result<WrittenNormals, Error> {
        let name = &part.name;
        let primitive = document.meshes()[name.mesh].primitives[name.primitive].clone();
        let normals = Some(self.normals);
        let at = format!("{}.attributes", name.path());
        let keeps_tangents = self.is_same(document, &primitive.attributes, normals);
        let attributes = self.attributes(document, &at, &primitive.attributes, normals, keeps_tangents)?;
        let mut targets = Vec::with_capacity(primitive.targets.len());
        for (place, (target, moved)) in primitive.targets.iter().zip(&part.moves).enumerate() {
            let at = format!("{}.targets[{place}]", name.path());
            let offsets = moved.as_ref().map(|moved| self.offsets[&moved.accessor]);
            let keeps_tangents = keeps_tangents && self.is_same(document, target, offsets);
            let mut target = self.attributes(document, &at, target, offsets, keeps_tangents)?;
            if target.is_empty() {
                target.insert("NORMAL".to_owned(), self.zeros(document));
            }
            targets.push(target);
        }
        let indices = self.indices(document, part, corners);
        document.edit_primitive(name.mesh, name.primitive, |json| {
            replace(json.get_mut("attributes"), &attributes);
            let places = json.get_mut("targets").and_then(Value::as_array_mut);
            for (place, target) in places.into_iter().flatten().zip(&targets) {
                replace(Some(place), target);
            }
            if let Some(indices) = indices {
                json.insert("indices", indices.into());
                if part.chosen.topology != TriangleMode::Triangles {
                    json.insert("mode", 4.into());
                }
            }
        })?;
        Ok(self.written(part, &primitive, keeps_tangents))
    }

    /// Whether attributes have these normals, if any, already, so that their tangents can be kept.
    fn is_same(&mut self, document: &Document, old: &Attributes, normals: Option<usize>) -> bool {
        if self.appended.is_needed() {
            return false;
        }
        let Some(normals) = normals else { return true };
        let Some(&old) = old.get("NORMAL") else { return false };
        let pair = [self.accessors.of(old), normals];
        *self.same.entry(pair).or_insert_with(|| {
            let elements = |accessor: usize| document.elements(accessor).ok();
            pair[0] == pair[1] || elements(old).is_some_and(|old| elements(normals) == Some(old))
        })
    }

    fn written(&self, part: &ShadedPrimitive, before: &Primitive, keeps_tangents: bool) -> WrittenNormals {
        WrittenNormals {
            replaced: before.attributes.contains_key("NORMAL"),
            tangents_removed: !keeps_tangents && before.attributes.contains_key("TANGENT"),
            vertices_before: self.appended.old_count(),
            vertices_after: self.split.normal_of_vertex.len(),
            morph_targets: part.moves.iter().flatten().count(),
            conflicting_corners: self.conflicting.get(&part.candidate).copied().unwrap_or(0),
            triangles: part.corners.len() / 3,
            degenerate_triangles: part.report.degenerate_faces,
            repaired_corners: part.report.repaired_corners,
            creased_edges: part.report.creased_edges,
        }
    }

    /// The attributes `old` with the appended vertices, without tangents unless they are kept, and with
    /// `normals`, if given.
    fn attributes(
        &mut self,
        document: &mut Document,
        at: &str,
        old: &Attributes,
        normals: Option<usize>,
        keeps_tangents: bool,
    ) -> Result<Attributes, Error> {
        let mut new = Attributes::new();
        for (semantic, &accessor) in old {
            if (semantic == "TANGENT" && !keeps_tangents) || (semantic == "NORMAL" && normals.is_some()) {
                continue;
            }
            let accessor = if self.appended.is_needed() {
                self.appended.accessor(
                    document,
                    &format!("{at}.{semantic}"),
                    accessor,
                    semantic == "POSITION",
                )?
            } else {
                accessor
            };
            new.insert(semantic.clone(), accessor);
        }
        new.extend(normals.map(|normals| ("NORMAL".to_owned(), normals)));
        Ok(new)
    }

    /// Zero offsets for a target that had tangent offsets only, since a target must not be empty.
    fn zeros(&mut self, document: &mut Document) -> usize {
        let count = self.split.normal_of_vertex.len();
        *self.zeros.get_or_insert_with(|| {
            push_vectors(document, None, ElementType::Vec3, &vec![[0.0; 3]; count], true)
        })
    }

    /// The accessor of new indices; none if no new ones are needed.
    fn indices(
        &mut self,
        document: &mut Document,
        part: &ShadedPrimitive,
        corners: &'a [u32],
    ) -> Option<usize> {
        let old = part.chosen.indices;
        if !self.appended.is_needed() || (old.is_some() && part.corners == corners) {
            return None;
        }
        let same = self.indices.iter().find(|list| list.0 == old && list.1 == corners);
        if let Some(&(_, _, accessor)) = same {
            return Some(accessor);
        }
        let kind = old.and_then(|old| document.accessors().get(old)).map(|old| old.component_type);
        let elements = index_elements(kind, corners.iter().chain(&part.rest).copied().collect());
        let new = NewAccessor::new(elements, Target::Indices).with_metadata_of(old);
        let accessor = document.push_accessor(new);
        self.indices.push((old, corners, accessor));
        Some(accessor)
    }
}

/// Counts the corners whose offset differs from that of their vertex.
fn conflicts(vertices: &[u32], moved: &MovedNormals, offsets: &HashMap<u32, [f32; 3]>) -> usize {
    let mut own = moved.offsets.iter().peekable();
    let corners = vertices.iter().enumerate().filter(|&(corner, &vertex)| {
        let own = own.next_if(|(moves, _)| *moves == corner).map_or([0.0; 3], |(_, offset)| *offset);
        own != offsets.get(&vertex).copied().unwrap_or_default()
    });
    corners.count()
}

/// Replaces the members of a JSON object by `attributes`. Members that exist keep their order.
fn replace(json: Option<&mut Value>, attributes: &Attributes) {
    let Some(json) = json else { return };
    if let Some(members) = json.as_object_mut() {
        members.retain(|semantic, _| attributes.contains_key(semantic));
    }
    set_attributes(Some(json), attributes);
}
