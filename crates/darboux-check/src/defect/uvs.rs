//! [`UvFault`]: what is wrong with the UVs of a primitive, or worth knowing.

use crate::code::Code;
use crate::indices::{Indices, Items, Part};
use crate::measure::hard_edges::HardEdges;
use crate::measure::uv_rounding::UvRounding;
use crate::measure::uv_scale::Outliers;

/// What is wrong with UVs.
#[derive(Clone, Debug, PartialEq)]
pub enum UvFault {
    Missing {
        set: usize,
        /// The number of sets that are there.
        present: usize,
    },
    NotFinite {
        set: usize,
        /// The number of other sets with the same data.
        others: usize,
        vertices: Part,
    },
    Degenerate {
        set: usize,
        triangles: Part,
    },
    Mirrored(Part),
    Overlapping {
        set: usize,
        triangles: Indices,
        /// Whether all pairs of triangles were compared.
        is_complete: bool,
        /// The share of the UV area.
        area_share: f64,
    },
    /// Faces whose UVs are stretched more than the UVs of the other faces.
    Stretched(Outliers),
    /// Faces with fewer texels than the others.
    Coarse(Outliers),
    /// UVs on a grid that turns tangents.
    Rounded(UvRounding),
    /// Hard edges at which the UVs go on.
    HardEdge(HardEdges),
}

impl UvFault {
    pub fn code(&self) -> Code {
        match self {
            Self::Missing { .. } => Code::UvMissing,
            Self::NotFinite { .. } => Code::UvNotFinite,
            Self::Degenerate { .. } => Code::UvDegenerate,
            Self::Mirrored(_) => Code::UvMirrored,
            Self::Overlapping { .. } => Code::UvOverlapping,
            Self::Stretched(_) => Code::UvStretched,
            Self::Coarse(_) => Code::UvCoarse,
            Self::Rounded(_) => Code::UvRounded,
            Self::HardEdge(_) => Code::UvHardEdge,
        }
    }

    pub fn items(&self) -> Option<Items<'_>> {
        let triangles = match self {
            Self::Missing { .. } => return None,
            Self::NotFinite { vertices, .. } => return Some(Items::Vertices(&vertices.items)),
            Self::Degenerate { triangles: part, .. } | Self::Mirrored(part) => &part.items,
            Self::Overlapping { triangles, .. } => triangles,
            Self::Stretched(faces) | Self::Coarse(faces) => &faces.triangles,
            Self::Rounded(rounding) => &rounding.triangles,
            Self::HardEdge(edges) => &edges.triangles,
        };
        Some(Items::Triangles(triangles))
    }

    /// The indices of vertices.
    pub fn vertices_mut(&mut self) -> Option<&mut Indices> {
        match self {
            Self::NotFinite { vertices, .. } => Some(&mut vertices.items),
            Self::Missing { .. }
            | Self::Degenerate { .. }
            | Self::Mirrored(_)
            | Self::Overlapping { .. }
            | Self::Stretched(_)
            | Self::Coarse(_)
            | Self::Rounded(_)
            | Self::HardEdge(_) => None,
        }
    }
}
