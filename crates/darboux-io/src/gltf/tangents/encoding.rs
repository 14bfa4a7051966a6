//! The encodings of tangents that glTF permits.

use darboux::choice;
use darboux::encode::{tangent_from_snorm8, tangent_from_snorm16, tangent_to_snorm8, tangent_to_snorm16};

use crate::gltf::{ComponentType, ElementType, Elements};

/// The encoding of a `TANGENT` accessor (glTF 2.0, 3.7.2.1; `KHR_mesh_quantization`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum TangentEncoding {
    /// Floats: 16 bytes per vertex, exact.
    #[default]
    F32x4,
    /// Normalised 16-bit integers: 8 bytes per vertex, directions change by up to 0.0016 degrees. Needs
    /// `KHR_mesh_quantization`.
    Snorm16x4,
    /// Normalised 8-bit integers: 4 bytes per vertex, directions change by up to 0.40 degrees. Needs
    /// `KHR_mesh_quantization`.
    Snorm8x4,
}

choice! { TangentEncoding, "encoding",
    F32x4 => "f32x4", "16 bytes per vertex, exact";
    Snorm16x4 => "snorm16x4", "8 bytes per vertex, directions change by up to 0.0016 degrees";
    Snorm8x4 => "snorm8x4", "4 bytes per vertex, directions change by up to 0.40 degrees";
}

impl TangentEncoding {
    /// The tangent that a reader decodes. Tangents are rounded before splitting, so that no vertex is split
    /// for differences that are not stored.
    pub(super) fn rounded(self, tangent: [f32; 4]) -> [f32; 4] {
        match self {
            Self::F32x4 => tangent,
            Self::Snorm16x4 => tangent_from_snorm16(tangent_to_snorm16(tangent)),
            Self::Snorm8x4 => tangent_from_snorm8(tangent_to_snorm8(tangent)),
        }
    }

    /// Bytes per tangent.
    pub(super) fn bytes(self) -> usize {
        match self {
            Self::F32x4 => 16,
            Self::Snorm16x4 => 8,
            Self::Snorm8x4 => 4,
        }
    }

    /// The extension that the encoding needs.
    pub(super) fn extension(self) -> Option<&'static str> {
        (self != Self::F32x4).then_some("KHR_mesh_quantization")
    }

    /// The tangents as elements of an accessor.
    pub(super) fn elements(self, tangents: &[[f32; 4]]) -> Elements {
        let stored = tangents.iter();
        let (component_type, bytes) = match self {
            Self::F32x4 => (ComponentType::F32, stored.flatten().flat_map(|x| x.to_le_bytes()).collect()),
            Self::Snorm16x4 => {
                let codes = stored.flat_map(|&tangent| tangent_to_snorm16(tangent));
                (ComponentType::I16, codes.flat_map(i16::to_le_bytes).collect())
            }
            Self::Snorm8x4 => {
                let codes = stored.flat_map(|&tangent| tangent_to_snorm8(tangent));
                (ComponentType::I8, codes.map(|code| code as u8).collect())
            }
        };
        Elements {
            bytes,
            count: tangents.len(),
            component_type,
            element_type: ElementType::Vec4,
            normalized: self != Self::F32x4,
        }
    }
}
