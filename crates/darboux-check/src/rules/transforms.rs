//! Rules about texture transforms.

use darboux_io::gltf::TextureUse;

use crate::code::Code;
use crate::finding::Finding;
use crate::rule::TextureRule;

pub const RULES: &[TextureRule] = &[mirrors];

/// Degrees of rotation that are rounding.
const ROUNDING: f64 = 0.01;

fn mirrors(texture: &TextureUse) -> Option<Finding> {
    let origin = texture.transform_uv([0.0, 0.0]);
    let axis = |uv: [f32; 2]| {
        let placed = texture.transform_uv(uv);
        [0, 1].map(|i| f64::from(placed[i]) - f64::from(origin[i]))
    };
    let (u, v) = (axis([1.0, 0.0]), axis([0.0, 1.0]));
    let is_mirrored = u[0] * v[1] - u[1] * v[0] < 0.0;
    let rotation = u[1].atan2(u[0]).to_degrees();
    if rotation.abs() <= ROUNDING && !is_mirrored {
        return None;
    }
    let text = if is_mirrored { "its normal texture is mirrored" } else { "its normal texture is rotated" };
    Some(Finding::new(Code::TransformMirrors, text).with_evidence("direction of u", rotation, "degrees"))
}
