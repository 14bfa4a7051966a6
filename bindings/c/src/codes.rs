//! Enumerations of the C interface. Callers pass them as `uint32_t`, so that an invalid value is an error
//! instead of undefined behaviour.

use darboux::encode::Encoding;
use darboux::{
    Axis, BitangentDirection, Choice, Convention, Method, Mode, NormalWeight, Shading, SignRule,
    SmoothingSeams, TangentDirection, UvOrigin, Winding,
};

use crate::status::{Error, darboux_status};

/// How tangents are computed. A normal map needs the method that it was baked with, nearly always the
/// default.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MethodCode {
    /// The standard of bakers and renderers: sums of unit tangents weighted by corner angles, over welded
    /// vertices.
    Mikktspace = 0,
    /// MikkTSpace's groups with weights of corner angle times area. The choice where no baked map requires
    /// another method.
    AngleArea = 1,
    /// The sum of dP/du per vertex and UV orientation, not normalised (Lengyel 2001).
    Lengyel = 2,
    /// As LENGYEL with one sum per vertex. Mirrored seams break. No vertex is split.
    LengyelPerVertex = 3,
    /// The mean of the unit tangents per vertex and UV orientation.
    Average = 4,
    /// The mean of the unit tangents per vertex and UV orientation, weighted by area.
    Area = 5,
    /// dP/du of each face: exact on each face, not smooth.
    Face = 6,
    /// A perpendicular of the normal. UVs are ignored.
    FromNormal = 7,
    /// MikkTSpace's groups with weights of corner angle times the lengths of the corner's edges:
    /// meshoptimizer's default.
    AngleEdge = 8,
}

/// How faithfully defects of mikktspace.c are kept.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModeCode {
    /// Every bit of the reference where its result is usable; elsewhere a unit tangent perpendicular to the
    /// normal.
    Repaired = 0,
    /// Every bit of the reference, its defects included: zero-length tangents, tangents along the normal,
    /// NaN.
    Reference = 1,
    /// As REPAIRED, with complete edge matching and one sign per face.
    Corrected = 2,
}

/// What the texels of a normal map say about its green channel.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapVerdictCode {
    /// Green points up, as glTF and OpenGL want it (or red and green are both inverted).
    Opengl = 0,
    /// Green points down, as DirectX wants it (or red is inverted).
    Directx = 1,
    /// The texels are not the slope of a surface.
    NoGradient = 2,
    /// All texels are the same but for rounding.
    Flat = 3,
    /// There is too little evidence.
    CannotTell = 4,
}

/// How the tangents of corners became tangents of vertices.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecipeWritingCode {
    /// Every corner has its own tangent.
    Corners = 0,
    /// Every vertex has the tangent of its last corner. Mirrored seams break.
    LastCorner = 1,
    /// Every vertex has the tangent of its first corner.
    FirstCorner = 2,
}

/// How corners are grouped into faces.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FacesCode {
    /// Three corners per face.
    Triangles = 0,
    /// Four corners per face.
    Quads = 1,
    /// `face_sizes` holds the corner count of each face.
    Mixed = 2,
}

/// Flat or smooth shading.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShadingCode {
    /// Corners of a vertex share the weighted mean of their faces' normals, except across creases.
    Smooth = 0,
    /// Every corner has its face's normal.
    Flat = 1,
}

/// The weight of a face at a vertex.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NormalWeightCode {
    /// The angle of the face's corner. The result does not depend on the triangulation of flat surfaces.
    Angle = 0,
    /// The area of the face.
    Area = 1,
    /// Angle times area. Wide faces stay flat beside bevels.
    AngleArea = 2,
}

/// The treatment of vertices at equal positions while normals are smoothed.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SmoothingSeamsCode {
    /// Vertices at equal positions are merged, so that UV seams are not visible in the shading.
    Ignored = 0,
    /// Distinct vertices have distinct normals.
    Respected = 1,
}

/// Compressed formats of tangents. Each comment gives the largest error of a direction, in degrees. The sign
/// is exact in all formats.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TangentEncodingCode {
    /// `int8_t[4]`: components times 127, rounded. 0.40 degrees.
    Snorm8 = 0,
    /// `uint32_t`: ten bits each for x (the lowest bits), y and z, two bits for w. 0.098 degrees.
    Snorm10 = 1,
    /// `int16_t[4]`: components times 32767, rounded. 0.0016 degrees.
    Snorm16 = 2,
    /// `int16_t[2]`: octahedral map; the lowest bit of y is the sign. 0.0057 degrees.
    Octahedral = 3,
    /// `uint16_t`: the angle around the normal; the lowest bit is the sign. The decoder needs the same
    /// normal. 0.0071 degrees.
    Diamond = 4,
}

/// A direction along a coordinate axis.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisCode {
    /// As in glTF: right is -x, up is +y, front is +z.
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

/// The winding of front faces, as seen on the screen from the side that the normal points to.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WindingCode {
    /// Counter-clockwise.
    CounterClockwise = 0,
    /// Clockwise.
    Clockwise = 1,
}

/// The origin of UVs in the image. u always points to the right.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UvOriginCode {
    /// v = 0 is the top; v points down.
    TopLeft = 0,
    /// v = 0 is the bottom; v points up.
    BottomLeft = 1,
}

/// The direction of the tangent, as a direction in the texture image. More red tilts the normal in this
/// direction.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TangentDirectionCode {
    /// To the right of the image.
    Right = 0,
    /// To the left of the image.
    Left = 1,
}

/// The direction of the bitangent that a shader rebuilds, as a direction in the texture image. More green
/// tilts the normal in this direction.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BitangentDirectionCode {
    /// To the top of the image ("OpenGL", Y+).
    Up = 0,
    /// To the bottom of the image ("DirectX", Y-).
    Down = 1,
}

/// The formula by which a shader rebuilds the bitangent from normal, tangent and sign, applied to coordinates
/// of either handedness.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignRuleCode {
    /// w * cross(normal, tangent).
    NormalCrossTangent = 0,
    /// w * cross(tangent, normal).
    TangentCrossNormal = 1,
}

/// Programs with a preset convention. docs/conventions.md gives the sources.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProgramCode {
    /// glTF 2.0.
    Gltf = 0,
    /// OpenGL, with the common practice for what OpenGL does not define.
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
    /// three.js. Use GLTF for the glTF files that it loads.
    Threejs = 7,
    /// Maya.
    Maya = 8,
    /// 3ds Max.
    Max = 9,
}

/// The value of a [`MethodCode`].
pub type darboux_method = u32;
/// The value of a [`ModeCode`].
pub type darboux_mode = u32;
/// The value of a [`MapVerdictCode`].
pub type darboux_map_verdict = u32;
/// The value of a [`RecipeWritingCode`].
pub type darboux_recipe_writing = u32;
/// The value of a [`FacesCode`].
pub type darboux_faces = u32;
/// The value of a [`ShadingCode`].
pub type darboux_shading = u32;
/// The value of a [`NormalWeightCode`].
pub type darboux_normal_weight = u32;
/// The value of a [`SmoothingSeamsCode`].
pub type darboux_smoothing_seams = u32;
/// The value of a [`TangentEncodingCode`].
pub type darboux_tangent_encoding = u32;
/// The value of an [`AxisCode`].
pub type darboux_axis = u32;
/// The value of a [`WindingCode`].
pub type darboux_winding = u32;
/// The value of a [`UvOriginCode`].
pub type darboux_uv_origin = u32;
/// The value of a [`TangentDirectionCode`].
pub type darboux_tangent_direction = u32;
/// The value of a [`BitangentDirectionCode`].
pub type darboux_bitangent_direction = u32;
/// The value of a [`SignRuleCode`].
pub type darboux_sign_rule = u32;
/// The value of a [`ProgramCode`].
pub type darboux_program = u32;

/// Defines a function that converts a number to a value of the core. Errors: a number that is not in the
/// list.
macro_rules! from_code {
    ($name:ident, $what:literal, $codes:ident => $target:ty { $($code:ident => $value:expr),* $(,)? }) => {
        pub(crate) fn $name(code: u32) -> Result<$target, Error> {
            $(if code == $codes::$code as u32 {
                return Ok($value);
            })*
            Err(Error::new(darboux_status::UnknownValue, format!("{code} is not a value of {}", $what)))
        }
    };
}

/// The value of a code of a choice of the core: its position in the list. `what`: the type in C. Errors: a
/// code beyond the list.
fn choice<T: Choice>(what: &str, code: u32) -> Result<T, Error> {
    T::from_code(code)
        .ok_or_else(|| Error::new(darboux_status::UnknownValue, format!("{code} is not a value of {what}")))
}

pub(crate) fn method(code: u32) -> Result<Method, Error> {
    choice("darboux_method", code)
}

pub(crate) fn mode(code: u32) -> Result<Mode, Error> {
    choice("darboux_mode", code)
}

pub(crate) fn shading(code: u32) -> Result<Shading, Error> {
    choice("darboux_shading", code)
}

pub(crate) fn normal_weight(code: u32) -> Result<NormalWeight, Error> {
    choice("darboux_normal_weight", code)
}

pub(crate) fn smoothing_seams(code: u32) -> Result<SmoothingSeams, Error> {
    choice("darboux_smoothing_seams", code)
}

pub(crate) fn tangent_encoding(code: u32) -> Result<Encoding, Error> {
    choice("darboux_tangent_encoding", code)
}

from_code!(faces, "darboux_faces", FacesCode => FacesCode {
    Triangles => FacesCode::Triangles,
    Quads => FacesCode::Quads,
    Mixed => FacesCode::Mixed,
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

#[cfg(test)]
mod tests {
    use darboux::{MapVerdict, RecipeWriting};

    use super::*;

    const HEADER: &str = include_str!("../include/darboux.h");

    /// Whether an enumeration of the header has the values of a list of the core, in their order. `prefix`:
    /// that of the constants.
    fn is_list_of<T: Choice>(prefix: &str) {
        let constants = HEADER.lines().filter_map(|line| line.trim().strip_prefix(prefix));
        let found: Vec<String> = constants
            .filter(|line| line.contains(" = "))
            .map(|line| line.replace('_', "").to_ascii_lowercase())
            .collect();
        let names = T::ALL.iter().map(|value| value.name().replace(['-', '_'], ""));
        let expected: Vec<String> =
            names.enumerate().map(|(code, name)| format!("{name} = {code},")).collect();
        assert_eq!(found, expected, "{prefix}");
    }

    #[test]
    fn enumerations_of_the_header_are_the_lists_of_the_core() {
        is_list_of::<Method>("DARBOUX_METHOD_");
        is_list_of::<Mode>("DARBOUX_MODE_");
        is_list_of::<Shading>("DARBOUX_SHADING_");
        is_list_of::<NormalWeight>("DARBOUX_NORMAL_WEIGHT_");
        is_list_of::<SmoothingSeams>("DARBOUX_SMOOTHING_SEAMS_");
        is_list_of::<MapVerdict>("DARBOUX_MAP_VERDICT_");
        is_list_of::<RecipeWriting>("DARBOUX_RECIPE_WRITING_");
        is_list_of::<Encoding>("DARBOUX_TANGENT_ENCODING_");
    }
}
