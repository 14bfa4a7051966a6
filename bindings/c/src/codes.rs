//! Enumerations that callers pass. They arrive as plain numbers, since a number that is no variant must be an error.

use darboux::{
    Axis, BitangentDirection, Convention, Method, Mode, NormalWeight, Shading, SignRule, SmoothingSeams,
    TangentDirection, UvOrigin, Winding,
};

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

/// A direction along a coordinate axis.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisCode {
    /// As in glTF: right is -x, up is y, front is z.
    Default = 0,
    /// Along x.
    X = 1,
    /// Against x.
    MinusX = 2,
    /// Along y.
    Y = 3,
    /// Against y.
    MinusY = 4,
    /// Along z.
    Z = 5,
    /// Against z.
    MinusZ = 6,
}

/// The order of a face's corners, seen from the side that its normal points to, as the eye sees it and not as the numbers say.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WindingCode {
    /// Against the clock.
    CounterClockwise = 0,
    /// With the clock.
    Clockwise = 1,
}

/// Where in the picture v = 0 is. u always runs to the right.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UvOriginCode {
    /// v runs down.
    TopLeft = 0,
    /// v runs up.
    BottomLeft = 1,
}

/// Where the tangent points on the surface, and more red leans the normal: a direction in the picture that lies on it.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TangentDirectionCode {
    /// To the picture's right.
    Right = 0,
    /// To the picture's left.
    Left = 1,
}

/// Where the bitangent that a shader rebuilds points on the surface, and more green leans the normal: a direction in the picture.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BitangentDirectionCode {
    /// To the picture's top ("OpenGL", Y+).
    Up = 0,
    /// To the picture's bottom ("DirectX", Y-).
    Down = 1,
}

/// How a shader rebuilds the bitangent from normal, tangent and sign, by numbers.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignRuleCode {
    /// w * cross(normal, tangent).
    NormalCrossTangent = 0,
    /// w * cross(tangent, normal).
    TangentCrossNormal = 1,
}

/// Programs whose conventions are known.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProgramCode {
    /// glTF 2.0.
    Gltf = 0,
    /// OpenGL, as is usual with it.
    Opengl = 1,
    /// Direct3D.
    Directx = 2,
    /// Blender.
    Blender = 3,
    /// Unity.
    Unity = 4,
    /// Unreal Engine.
    Unreal = 5,
    /// Godot 4.
    Godot = 6,
    /// three.js, but for the glTF files that it loads.
    Threejs = 7,
    /// Maya.
    Maya = 8,
    /// 3ds Max.
    Max = 9,
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
/// An [`AxisCode`].
pub type darboux_axis = u32;
/// A [`WindingCode`].
pub type darboux_winding = u32;
/// A [`UvOriginCode`].
pub type darboux_uv_origin = u32;
/// A [`TangentDirectionCode`].
pub type darboux_tangent_direction = u32;
/// A [`BitangentDirectionCode`].
pub type darboux_bitangent_direction = u32;
/// A [`SignRuleCode`].
pub type darboux_sign_rule = u32;
/// A [`ProgramCode`].
pub type darboux_program = u32;

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
    Mikktspace => Method::default(),
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
from_code!(axis, "darboux_axis", AxisCode => Option<Axis> {
    Default => None,
    X => Some(Axis::X),
    MinusX => Some(Axis::MinusX),
    Y => Some(Axis::Y),
    MinusY => Some(Axis::MinusY),
    Z => Some(Axis::Z),
    MinusZ => Some(Axis::MinusZ),
});
from_code!(winding, "darboux_winding", WindingCode => Winding {
    CounterClockwise => Winding::CounterClockwise,
    Clockwise => Winding::Clockwise,
});
from_code!(uv_origin, "darboux_uv_origin", UvOriginCode => UvOrigin {
    TopLeft => UvOrigin::TopLeft,
    BottomLeft => UvOrigin::BottomLeft,
});
from_code!(tangent_direction, "darboux_tangent_direction", TangentDirectionCode => TangentDirection {
    Right => TangentDirection::Right,
    Left => TangentDirection::Left,
});
from_code!(bitangent_direction, "darboux_bitangent_direction", BitangentDirectionCode => BitangentDirection {
    Up => BitangentDirection::Up,
    Down => BitangentDirection::Down,
});
from_code!(sign_rule, "darboux_sign_rule", SignRuleCode => SignRule {
    NormalCrossTangent => SignRule::NormalCrossTangent,
    TangentCrossNormal => SignRule::TangentCrossNormal,
});
from_code!(program, "darboux_program", ProgramCode => Convention {
    Gltf => Convention::GLTF,
    Opengl => Convention::OPENGL,
    Directx => Convention::DIRECTX,
    Blender => Convention::BLENDER,
    Unity => Convention::UNITY,
    Unreal => Convention::UNREAL,
    Godot => Convention::GODOT,
    Threejs => Convention::THREE_JS,
    Maya => Convention::MAYA,
    Max => Convention::MAX,
});
