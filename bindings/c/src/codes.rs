//! Enumerations that callers pass. They arrive as plain numbers, since a number that is no variant must be an error.

use darboux::{Method, Mode, NormalWeight, Shading, SmoothingSeams};

use crate::status::{Error, darboux_status};

/// How tangents are computed. Normal maps need the method that they were baked with, nearly always the default.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MethodCode {
    /// The standard of bakers and renderers.
    Mikktspace = 0,
    /// MikkTSpace's groups with weights of corner angle times area, where no baked map asks for another.
    AngleArea = 1,
    /// Per vertex and UV orientation the sum of dP/du, as long as they are.
    Lengyel = 2,
    /// As LENGYEL with one sum per vertex: mirrored seams break, nothing splits.
    LengyelPerVertex = 3,
    /// Per vertex and UV orientation the mean of the unit tangents.
    Average = 4,
    /// Per vertex and UV orientation the mean of the unit tangents, weighted by area.
    Area = 5,
    /// Per face dP/du itself: exact on each, not smooth.
    Face = 6,
    /// A perpendicular of the normal, without any UVs.
    FromNormal = 7,
}

/// How faithfully defects of mikktspace.c are kept.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModeCode {
    /// Every bit of the reference where its result is usable, a unit tangent perpendicular to the normal elsewhere.
    Repaired = 0,
    /// Every bit of the reference, its defects included: zero-length tangents, tangents along the normal, NaN.
    Reference = 1,
    /// As REPAIRED, with complete edge matching and one sign per face.
    Corrected = 2,
}

/// How corners make faces.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FacesCode {
    /// Three corners each.
    Triangles = 0,
    /// Four corners each.
    Quads = 1,
    /// `face_sizes` holds the corner count of each face.
    Mixed = 2,
}

/// Flat or smooth.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShadingCode {
    /// Corners around a vertex share the weighted mean of their faces' normals, but for creases.
    Smooth = 0,
    /// Every corner has its face's normal.
    Flat = 1,
}

/// The weight of a face at a vertex.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NormalWeightCode {
    /// The angle of its corner there: independent of how a flat surface is cut.
    Angle = 0,
    /// Its area.
    Area = 1,
    /// Both multiplied: wide faces stay flat beside bevels.
    AngleArea = 2,
}

/// What keeps vertices apart while normals are smoothed.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SmoothingSeamsCode {
    /// Nothing: vertices at equal positions are one.
    Ignored = 0,
    /// The index list: distinct vertices have distinct normals.
    Respected = 1,
}

/// Tangents in fewer bytes. The largest error of a direction is given in degrees; the sign is exact in all of them.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TangentEncodingCode {
    /// `int8_t[4]`, c / 127. 0.40 degrees.
    Snorm8 = 0,
    /// `uint32_t`: ten bits each for x (the lowest), y and z, two for w. 0.098 degrees.
    Snorm10 = 1,
    /// `int16_t[4]`, c / 32767. 0.0016 degrees.
    Snorm16 = 2,
    /// `int16_t[2]`: a point of the unfolded octahedron; the lowest bit of y is the sign. 0.0057 degrees.
    Octahedral = 3,
    /// `uint16_t`: the place around the normal, which the decoder is given too; the lowest bit is the sign. 0.0071 degrees.
    Diamond = 4,
}

/// A [`MethodCode`].
pub type darboux_method = u32;
/// A [`ModeCode`].
pub type darboux_mode = u32;
/// A [`FacesCode`].
pub type darboux_faces = u32;
/// A [`ShadingCode`].
pub type darboux_shading = u32;
/// A [`NormalWeightCode`].
pub type darboux_normal_weight = u32;
/// A [`SmoothingSeamsCode`].
pub type darboux_smoothing_seams = u32;
/// A [`TangentEncodingCode`].
pub type darboux_tangent_encoding = u32;

/// The variant of each listed code. Errors: a number that is none of them.
macro_rules! from_code {
    ($name:ident, $what:literal, $codes:ident => $target:ty { $($code:ident => $value:expr),* $(,)? }) => {
        pub(crate) fn $name(code: u32) -> Result<$target, Error> {
            $(if code == $codes::$code as u32 {
                return Ok($value);
            })*
            Err(Error::new(darboux_status::UnknownValue, format!("{code} is no {}", $what)))
        }
    };
}

from_code!(method, "darboux_method", MethodCode => Method {
    Mikktspace => Method::MikkTSpace,
    AngleArea => Method::AngleArea,
    Lengyel => Method::Lengyel,
    LengyelPerVertex => Method::LengyelPerVertex,
    Average => Method::Average,
    Area => Method::Area,
    Face => Method::Face,
    FromNormal => Method::FromNormal,
});
from_code!(mode, "darboux_mode", ModeCode => Mode {
    Repaired => Mode::Repaired,
    Reference => Mode::Reference,
    Corrected => Mode::Corrected,
});
from_code!(faces, "darboux_faces", FacesCode => FacesCode {
    Triangles => FacesCode::Triangles,
    Quads => FacesCode::Quads,
    Mixed => FacesCode::Mixed,
});
from_code!(shading, "darboux_shading", ShadingCode => Shading {
    Smooth => Shading::Smooth,
    Flat => Shading::Flat,
});
from_code!(normal_weight, "darboux_normal_weight", NormalWeightCode => NormalWeight {
    Angle => NormalWeight::Angle,
    Area => NormalWeight::Area,
    AngleArea => NormalWeight::AngleArea,
});
from_code!(smoothing_seams, "darboux_smoothing_seams", SmoothingSeamsCode => SmoothingSeams {
    Ignored => SmoothingSeams::Ignored,
    Respected => SmoothingSeams::Respected,
});
from_code!(tangent_encoding, "darboux_tangent_encoding", TangentEncodingCode => TangentEncodingCode {
    Snorm8 => TangentEncodingCode::Snorm8,
    Snorm10 => TangentEncodingCode::Snorm10,
    Snorm16 => TangentEncodingCode::Snorm16,
    Octahedral => TangentEncodingCode::Octahedral,
    Diamond => TangentEncodingCode::Diamond,
});
