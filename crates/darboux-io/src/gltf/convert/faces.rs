//! Reverses the winding of triangles, each index list once.

use std::collections::HashMap;

use darboux::{Convention, Conversion};

use crate::Error;
use crate::gltf::primitives::append::index_elements;
use crate::gltf::primitives::canonical::CanonicalAccessors;
use crate::gltf::primitives::element_count;
use crate::gltf::primitives::limits;
use crate::gltf::primitives::triangles::TriangleMode;
use crate::gltf::{Document, NewAccessor, Target};

/// Reverses faces of primitives.
pub struct FaceReverser<'a> {
    accessors: &'a CanonicalAccessors,
    conversion: Conversion,
    reverses: bool,
    /// The accessors of new indices, by the source of the corners and the mode.
    made: HashMap<(CornerSource, TriangleMode), usize>,
}

/// The source of corners: an accessor of indices, or a number of vertices without indices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum CornerSource {
    Indices(usize),
    Vertices(usize),
}

impl<'a> FaceReverser<'a> {
    pub fn new(accessors: &'a CanonicalAccessors, from: Convention, to: Convention) -> Self {
        let reverses = from.winding != to.winding;
        Self { accessors, conversion: from.to(to), reverses, made: HashMap::new() }
    }

    /// Reverses the triangles of a primitive. Returns whether it has any. Strips and fans become triangle
    /// lists.
    pub fn convert(&mut self, document: &mut Document, mesh: usize, place: usize) -> Result<bool, Error> {
        let primitive = &document.meshes()[mesh].primitives[place];
        let Some(topology) = TriangleMode::from_mode(primitive.mode).filter(|_| self.reverses) else {
            return Ok(false);
        };
        let source = match (primitive.indices, primitive.attributes.get("POSITION")) {
            (Some(accessor), _) => CornerSource::Indices(self.accessors.of(accessor)),
            (None, Some(&position)) => CornerSource::Vertices(element_count(document, position)?),
            (None, None) => return Ok(false),
        };
        let indices = match self.made.get(&(source, topology)) {
            Some(&made) => made,
            None => {
                let made = self.reversed(document, source, topology)?;
                self.made.insert((source, topology), made);
                made
            }
        };
        document.edit_primitive(mesh, place, |json| {
            json.insert("indices", indices.into());
            if topology != TriangleMode::Triangles {
                json.insert("mode", 4.into());
            }
        })?;
        Ok(true)
    }

    fn reversed(
        &self,
        document: &mut Document,
        source: CornerSource,
        topology: TriangleMode,
    ) -> Result<usize, Error> {
        let (old, count) = match source {
            CornerSource::Indices(accessor) => (Some(accessor), element_count(document, accessor)?),
            CornerSource::Vertices(count) => (None, count),
        };
        limits::check_triangles(document, [topology.triangle_count(count)].into_iter())?;
        let mut corners = match old {
            Some(accessor) => document.indices(accessor)?.into_u32(),
            None => (0..count as u32).collect(),
        };
        let rest = corners.split_off(topology.whole(corners.len()));
        let mut corners = topology.corners(corners);
        corners.as_chunks_mut::<3>().0.iter_mut().for_each(|face| self.conversion.face(face));
        corners.extend(rest);
        let kind = old.and_then(|old| document.accessors().get(old)).map(|old| old.component_type);
        let elements = index_elements(kind, corners);
        let new = NewAccessor::new(elements, Target::Indices).with_metadata_of(old);
        Ok(document.push_accessor(new))
    }
}
