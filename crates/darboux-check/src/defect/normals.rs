//! [`NormalFault`]: what is wrong with the normals of a primitive.

use crate::code::Code;
use crate::indices::{Indices, Items, Part};
use crate::measure::other_axes::OtherAxes;
use crate::measure::reversal::Reversal;

/// What is wrong with normals.
#[derive(Clone, Debug, PartialEq)]
pub enum NormalFault {
    /// The number of vertices without normals.
    Missing(usize),
    NotFinite(Part),
    NotUnit {
        vertices: Part,
        /// The smallest length.
        smallest: f64,
    },
    OtherAxes {
        axes: OtherAxes,
        vertices: usize,
    },
    /// Most triangles are wound against their normals.
    Reversed {
        reversal: Reversal,
        triangles: Part,
    },
    /// The normals of some vertices point to the back of all faces around them.
    PartlyReversed {
        /// All triangles with such vertices.
        triangles: Part,
        /// The number of these whose normals all point to the back, and of those with normals on both sides.
        whole: usize,
        mixed: usize,
        vertices: usize,
        /// The number of connected parts with such vertices, and of all parts.
        parts: [usize; 2],
    },
}

impl NormalFault {
    pub fn code(&self) -> Code {
        match self {
            Self::Missing(_) => Code::NormalMissing,
            Self::NotFinite(_) => Code::NormalNotFinite,
            Self::NotUnit { .. } => Code::NormalNotUnit,
            Self::OtherAxes { .. } => Code::NormalOtherAxes,
            Self::Reversed { .. } | Self::PartlyReversed { .. } => Code::NormalAgainstWinding,
        }
    }

    pub fn items(&self) -> Option<Items<'_>> {
        match self {
            Self::NotFinite(part) | Self::NotUnit { vertices: part, .. } => {
                Some(Items::Vertices(&part.items))
            }
            Self::Reversed { triangles: part, .. } | Self::PartlyReversed { triangles: part, .. } => {
                Some(Items::Triangles(&part.items))
            }
            Self::Missing(_) | Self::OtherAxes { .. } => None,
        }
    }

    /// The indices of vertices.
    pub fn vertices_mut(&mut self) -> Option<&mut Indices> {
        match self {
            Self::NotFinite(part) | Self::NotUnit { vertices: part, .. } => Some(&mut part.items),
            Self::Missing(_)
            | Self::OtherAxes { .. }
            | Self::Reversed { .. }
            | Self::PartlyReversed { .. } => None,
        }
    }
}
