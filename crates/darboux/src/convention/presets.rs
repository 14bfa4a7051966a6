//! Named conventions, each with its source. Comments say what a source does not define.

use crate::convention::rules::{
    Axes, Axis, BitangentDirection, Convention, SignRule, TangentDirection, UvOrigin, Winding,
};

const fn axes(right: Axis, up: Axis, front: Axis) -> Axes {
    match Axes::new(right, up, front) {
        Some(axes) => axes,
        None => panic!("two axes lie along one line"),
    }
}

/// Right-handed, y up, models face +z.
const Y_UP_RIGHT_HANDED: Axes = axes(Axis::MinusX, Axis::Y, Axis::Z);
/// Left-handed, y up, models face +z.
const Y_UP_LEFT_HANDED: Axes = axes(Axis::X, Axis::Y, Axis::Z);
/// Right-handed, z up, models face -y, as in Blender's front view.
const Z_UP_RIGHT_HANDED: Axes = axes(Axis::MinusX, Axis::Z, Axis::MinusY);

impl Convention {
    /// glTF 2.0, 3.4 (y up, z forward, -x right), 3.7.2.1 (counter-clockwise fronts; bitangent =
    /// cross(normal, tangent.xyz) * tangent.w), 3.8.2 (UVs from the upper left) and 3.9.3 (red to the
    /// right, green up).
    pub const GLTF: Self = Self {
        axes: Y_UP_RIGHT_HANDED,
        winding: Winding::CounterClockwise,
        uv_origin: UvOrigin::TopLeft,
        tangent: TangentDirection::Right,
        bitangent: BitangentDirection::Up,
        sign: SignRule::NormalCrossTangent,
    };

    /// OpenGL: front faces are GL_CCW by default (OpenGL 4.6, 14.6.1), and the first row of a texture is at t
    /// = 0, the bottom of the image (8.5). OpenGL does not define the axes of models and the direction of
    /// green; common practice is right-handed, y up, "Y+".
    pub const OPENGL: Self = Self { uv_origin: UvOrigin::BottomLeft, ..Self::GLTF };

    /// Direct3D: left-handed, clockwise front faces (D3D11_RASTERIZER_DESC, FrontCounterClockwise is FALSE by
    /// default), UVs from the upper left. Direct3D does not define the direction of green; common
    /// practice is down, "Y-".
    pub const DIRECTX: Self = Self {
        axes: Y_UP_LEFT_HANDED,
        winding: Winding::Clockwise,
        bitangent: BitangentDirection::Down,
        ..Self::GLTF
    };

    /// Blender: z up, UVs from the lower left, bitangent = bitangent_sign * cross(normal, tangent)
    /// (MeshLoop.bitangent_sign), baked normal maps +X +Y +Z.
    pub const BLENDER: Self = Self { axes: Z_UP_RIGHT_HANDED, ..Self::OPENGL };

    /// Unity: left-handed, y up, z forward, clockwise fronts, UVs from the lower left, normal maps "Y+".
    pub const UNITY: Self = Self { axes: Y_UP_LEFT_HANDED, winding: Winding::Clockwise, ..Self::OPENGL };

    /// Unreal Engine: left-handed, z up, x forward, y right; UVs from the upper left, green down.
    pub const UNREAL: Self =
        Self { axes: axes(Axis::Y, Axis::Z, Axis::X), bitangent: BitangentDirection::Down, ..Self::GLTF };

    /// Godot 4: right-handed, y up, models face +z (Vector3.MODEL_FRONT), clockwise front faces (ArrayMesh),
    /// UVs from the upper left, green up.
    pub const GODOT: Self = Self { winding: Winding::Clockwise, ..Self::GLTF };

    /// three.js: right-handed, y up, objects face +z; textures are flipped on upload (Texture.flipY), so the
    /// UV origin is the lower left. Textures of loaded glTF are not flipped: use [`Convention::GLTF`] for
    /// those.
    pub const THREE_JS: Self = Self::OPENGL;

    /// Maya: right-handed, y up, UVs from the lower left, right-handed tangent space.
    pub const MAYA: Self = Self::OPENGL;

    /// 3ds Max: right-handed, z up, UVs from the lower left, left-handed tangent space with green down.
    pub const MAX: Self = Self { bitangent: BitangentDirection::Down, ..Self::BLENDER };

    /// All presets with their names on the command line.
    pub const PRESETS: [(&str, Self); 10] = [
        ("gltf", Self::GLTF),
        ("opengl", Self::OPENGL),
        ("directx", Self::DIRECTX),
        ("blender", Self::BLENDER),
        ("unity", Self::UNITY),
        ("unreal", Self::UNREAL),
        ("godot", Self::GODOT),
        ("threejs", Self::THREE_JS),
        ("maya", Self::MAYA),
        ("3dsmax", Self::MAX),
    ];
}
