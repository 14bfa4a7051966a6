//! How a texture lies in the plane of UVs, as `KHR_texture_transform`.
//!
//! FBX has a translation, a rotation and a scaling, and does not say in which order they apply, nor whether
//! to the texture or to the UVs. Two conventions are known, both with v up:
//!
//! ```text
//! 3ds Max      texture coordinate = scaling * uv + translation
//!              (also how three.js and assimp read it; here no rotation is known to be read alike)
//! Blender      texture coordinate = scaling * rotation * (uv - translation), the rotation in radians
//! ```
//!
//! Blender up to 2.79 had textures without nodes; how its exporter placed them is not known here.
//!
//! The scaling is the number of repetitions in both. (ufbx's own matrix takes it for the size of the
//! texture.)

use ufbx::{Exporter, Metadata, Texture};

/// Offset, rotation in radians, scale, in glTF's UVs.
pub type Transform = ([f32; 2], f32, [f32; 2]);

const PLAIN: Transform = ([0.0, 0.0], 0.0, [1.0, 1.0]);

/// How a texture is placed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Placement {
    /// As UVs say.
    Plain,
    Moved(Transform),
    /// Readers disagree, or glTF has no such transform.
    Unknown,
}

/// By which rule a program places textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Convention {
    /// Blender from 2.80 on.
    Blender,
    OldBlender,
    Others,
}

impl Convention {
    pub fn of(metadata: &Metadata) -> Self {
        // The version is that of the exporter, which was 3.7 in Blender 2.79 and 4.14 in 2.80.
        const FIRST_WITH_NODES: u32 = 4_000_000;
        match metadata.exporter {
            Exporter::BlenderBinary if metadata.exporter_version >= FIRST_WITH_NODES => Self::Blender,
            Exporter::BlenderBinary | Exporter::BlenderAscii => Self::OldBlender,
            _ => Self::Others,
        }
    }
}

/// The placement of a texture.
pub fn of(texture: &Texture, convention: Convention) -> Placement {
    let values = Values::of(texture);
    let transform = match convention {
        Convention::Blender => values.of_blender(),
        Convention::OldBlender => values.of_blender().filter(|moved| *moved == PLAIN),
        Convention::Others => values.of_others(),
    };
    match transform {
        Some(PLAIN) => Placement::Plain,
        Some(moved) if is_finite(&moved) => Placement::Moved(moved),
        _ => Placement::Unknown,
    }
}

fn is_finite((offset, rotation, scale): &Transform) -> bool {
    [*rotation].iter().chain(offset).chain(scale).all(|x| x.is_finite())
}

/// The properties of a texture that place it. Properties of the third axis mean nothing.
#[derive(Clone, Copy, Debug)]
struct Values {
    translation: [f64; 2],
    rotation: [f64; 3],
    scaling: [f64; 2],
    /// Whether the scaling or the rotation has another centre than the origin.
    has_pivot: bool,
    /// Whether u and v change places.
    is_swapped: bool,
}

impl Values {
    fn of(texture: &Texture) -> Self {
        let property = |name: &str| ufbx::find_prop(&texture.element.props, name);
        let vector = |name: &str, default: [f64; 3]| {
            property(name).map_or(default, |found| {
                let value = found.value_vec4;
                [value.x, value.y, value.z]
            })
        };
        let [tx, ty, _] = vector("Translation", [0.0; 3]);
        let [sx, sy, _] = vector("Scaling", [1.0; 3]);
        let has_pivot = ["TextureScalingPivot", "TextureRotationPivot"]
            .into_iter()
            .any(|name| vector(name, [0.0; 3])[..2] != [0.0; 2]);
        Self {
            translation: [tx, ty],
            rotation: vector("Rotation", [0.0; 3]),
            scaling: [sx, sy],
            has_pivot,
            is_swapped: property("UVSwap").is_some_and(|found| found.value_int != 0),
        }
    }

    /// By Blender's convention. None: the rotation is about another axis, or follows a scaling that differs
    /// by axis, as glTF has it the other way around.
    fn of_blender(&self) -> Option<Transform> {
        let [x, y, angle] = self.rotation;
        let is_sheared = angle != 0.0 && self.scaling[0] != self.scaling[1];
        if self.is_swapped || self.has_pivot || [x, y] != [0.0; 2] || is_sheared {
            return None;
        }
        let ([sx, sy], (sin, cos), [tx, ty]) = (self.scaling, angle.sin_cos(), self.translation);
        let moved = [-sx * (cos * tx - sin * ty), -sy * (sin * tx + cos * ty)];
        Some(self.with_v_down(moved, angle))
    }

    /// By the convention of 3ds Max.
    fn of_others(&self) -> Option<Transform> {
        let is_known =
            !self.is_swapped && self.rotation == [0.0; 3] && (!self.has_pivot || self.scaling == [1.0; 2]);
        is_known.then(|| self.with_v_down(self.translation, 0.0))
    }

    /// The transform `offset + rotation * scaling * uv`, for UVs whose v points down.
    fn with_v_down(&self, offset: [f64; 2], angle: f64) -> Transform {
        let ([sx, sy], (sin, cos)) = (self.scaling, angle.sin_cos());
        // The point (0, 1) of v up is the origin of v down.
        let origin = [offset[0] - sin * sy, offset[1] + cos * sy];
        ([origin[0], 1.0 - origin[1]].map(single), single(angle), [sx, sy].map(single))
    }
}

/// In single precision, 0 without a sign.
fn single(x: f64) -> f32 {
    x as f32 + 0.0
}
