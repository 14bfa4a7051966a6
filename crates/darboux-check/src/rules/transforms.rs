//! Rules about how materials use normal textures.

use darboux_io::gltf::{Material, TextureUse};

use super::rule::MaterialRule;
use crate::defect::{Defect, MaterialFault};
use crate::measure::texture_axes::axes;

pub const RULES: &[MaterialRule] = &[mirrors, negative_scale, zero_scale, extreme_scale];

/// Degrees of rotation that are rounding.
const ROUNDING: f64 = 0.01;

fn mirrors(material: &Material) -> Option<Defect> {
    material.normal_maps().find_map(mirrored_or_rotated).map(Defect::new)
}

fn mirrored_or_rotated(texture: &TextureUse) -> Option<MaterialFault> {
    let [u, v] = axes(texture);
    let determinant = u[0] * v[1] - u[1] * v[0];
    let rotation = u[1].atan2(u[0]).to_degrees();
    let is_unusual = determinant < 0.0 || rotation.abs() > ROUNDING;
    is_unusual.then_some(MaterialFault::TransformMirrors { axes: [u, v], determinant, rotation })
}

fn negative_scale(material: &Material) -> Option<Defect> {
    let scale = f64::from(material.normal_scale);
    let is_inverting = material.normal_texture.is_some() && scale < 0.0;
    is_inverting.then(|| Defect::new(MaterialFault::ScaleNegative(scale)))
}

/// Below this size, a scale leaves less than a code of 8 bits of most bumps.
const ZERO_SCALE: f64 = 0.01;

fn zero_scale(material: &Material) -> Option<Defect> {
    let scale = f64::from(material.normal_scale);
    let is_hidden = material.normal_texture.is_some() && scale.abs() < ZERO_SCALE;
    is_hidden.then(|| Defect::new(MaterialFault::ScaleZero(scale)))
}

/// The largest scale that is not worth a warning: of 436 normal textures of public models, 3 have a larger
/// one.
const LARGEST_SCALE: f64 = 4.0;

fn extreme_scale(material: &Material) -> Option<Defect> {
    let scale = f64::from(material.normal_scale);
    let is_extreme = material.normal_texture.is_some() && scale.abs() > LARGEST_SCALE;
    is_extreme.then(|| Defect::new(MaterialFault::ScaleExtreme(scale)))
}
