//! Offsets that a morph target adds to a vector of every vertex. Where it moves few of many vertices, only
//! those are stored.

use super::append::push_vectors;
use crate::gltf::{Document, ElementType};

/// One offset per vertex.
#[derive(Debug)]
pub enum VertexOffsets {
    All(Vec<[f32; 3]>),
    /// The offsets of few of `count` vertices, ascending. Those of the others are zero.
    Few {
        count: usize,
        offsets: Vec<(u32, [f32; 3])>,
    },
}

impl VertexOffsets {
    /// The offsets of some of `count` vertices, ascending. Those of the others are zero.
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
        let all = match self {
            Self::Few { count, offsets } if old.is_none() => {
                return document.push_few_vectors(count, &offsets);
            }
            Self::Few { count, offsets } => with_zeros(count, offsets),
            Self::All(offsets) => offsets,
        };
        push_vectors(document, old, ElementType::Vec3, &all, sparse)
    }
}

fn with_zeros(count: usize, offsets: Vec<(u32, [f32; 3])>) -> Vec<[f32; 3]> {
    let mut all = vec![[0.0; 3]; count];
    offsets.into_iter().for_each(|(vertex, offset)| all[vertex as usize] = offset);
    all
}
