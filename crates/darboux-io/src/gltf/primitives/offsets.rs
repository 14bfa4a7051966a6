//! Offsets that a morph target adds to a vector of every vertex. Where it moves few of many vertices, only
//! those are stored.

use super::append::push_vectors;
use crate::gltf::{ComponentType, Document, ElementType};

/// One offset per vertex.
#[derive(Debug)]
pub enum VertexOffsets {
    All(Vec<[f32; 3]>),
    /// The offsets of few of `count` vertices, ascending. The other vertices have zero offsets.
    Few {
        count: usize,
        offsets: Vec<(u32, [f32; 3])>,
    },
}

impl VertexOffsets {
    /// The offsets of some of `count` vertices, ascending. The other vertices have zero offsets.
    pub fn new(count: usize, offsets: Vec<(u32, [f32; 3])>) -> Self {
        match offsets.len() < count / 2 {
            true => Self::Few { count, offsets },
            false => Self::All(with_zeros(count, offsets)),
        }
    }

    /// The number of bytes in a file.
    pub fn byte_length(&self) -> usize {
        match self {
            Self::All(offsets) => size_of_val(offsets.as_slice()),
            Self::Few { offsets, .. } => size_of_val(offsets.as_slice()),
        }
    }

    /// Appends an accessor of the offsets; one of all vertices is sparse if that is permitted and shorter.
    /// Returns `old` if it has the same elements.
    pub fn push(self, document: &mut Document, old: Option<usize>, sparse: bool) -> usize {
        match self {
            Self::All(offsets) => push_vectors(document, old, ElementType::Vec3, &offsets, sparse),
            Self::Few { count, offsets } => match old {
                Some(old) if has_offsets(document, old, count, &offsets) => old,
                _ => document.push_few_vectors(count, &offsets),
            },
        }
    }
}

/// Whether an accessor of floats has these offsets and otherwise zeros, bit for bit.
fn has_offsets(document: &Document, accessor: usize, count: usize, offsets: &[(u32, [f32; 3])]) -> bool {
    let is_of_floats =
        document.accessors().get(accessor).is_some_and(|found| found.component_type == ComponentType::F32);
    let Ok(vectors) = document.vectors::<3>(accessor) else { return false };
    let mut expected = offsets.iter().peekable();
    let mut is_same = |(vertex, vector): (usize, &[f32; 3])| {
        let offset = expected.next_if(|(place, _)| *place as usize == vertex);
        offset.map_or([0.0; 3], |(_, offset)| *offset).map(f32::to_bits) == vector.map(f32::to_bits)
    };
    is_of_floats && vectors.len() == count && vectors.iter().enumerate().all(&mut is_same)
}

fn with_zeros(count: usize, offsets: Vec<(u32, [f32; 3])>) -> Vec<[f32; 3]> {
    let mut all = vec![[0.0; 3]; count];
    offsets.into_iter().for_each(|(vertex, offset)| all[vertex as usize] = offset);
    all
}
