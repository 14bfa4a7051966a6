//! Rules about how materials use normal textures.

use darboux_io::gltf::{Appearance, TextureUse};

use crate::code::Code;
use crate::finding::Finding;
use crate::rule::MaterialRule;

pub const RULES: &[MaterialRule] = &[mirrors, negative_scale];

/// Degrees of rotation that are rounding.
const ROUNDING: f64 = 0.01;

fn mirrors(appearance: &Appearance) -> Option<Finding> {
    appearance.normal_maps().find_map(mirrored_or_rotated)
}

fn mirrored_or_rotated(texture: &TextureUse) -> Option<Finding> {
    let origin = texture.transform_uv([0.0, 0.0]);
    let axis = |uv: [f32; 2]| {
        let placed = texture.transform_uv(uv);
        [0, 1].map(|i| f64::from(placed[i]) - f64::from(origin[i]))
    };
    let (u, v) = (axis([1.0, 0.0]), axis([0.0, 1.0]));
    let determinant = u[0] * v[1] - u[1] * v[0];
    let rotation = u[1].atan2(u[0]).to_degrees();
    let what = match (determinant < 0.0, rotation.abs() > ROUNDING) {
        (false, false) => return None,
        (false, true) => "rotates",
        (true, _) => "mirrors",
    };
    let text = format!(
        "KHR_texture_transform {what} its normal texture: u goes to ({:.3}, {:.3}) and v to ({:.3}, {:.3})",
        u[0], u[1], v[0], v[1]
    );
    let finding = Finding::new(Code::TransformMirrors, text);
    let finding =
        finding.with_evidence("determinant of the transform (negative if mirrored)", determinant, "");
    Some(finding.with_evidence("direction of u", rotation, "degrees"))
}

fn negative_scale(appearance: &Appearance) -> Option<Finding> {
    let scale = f64::from(appearance.normal_scale);
    let is_inverting = appearance.normal_texture.is_some() && scale < 0.0;
    let text = "normalTexture.scale is negative, so that red and green of its normal map are both inverted";
    is_inverting.then(|| Finding::new(Code::MapScaleNegative, text).with_evidence("scale", scale, ""))
}
