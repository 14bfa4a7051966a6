//! The textures of a material that are drawn.

use darboux_io::gltf::{Material, TextureUse};

use crate::textures::Kind;

/// The textures of a material, in the order of surface.wgsl: base colour, normal map, roughness and metal,
/// occlusion, emission.
pub const TEXTURES: usize = 5;

/// The index of the normal map among these textures.
pub const NORMAL: usize = 1;

/// The textures that a material uses.
pub fn textures_of(material: &Material) -> [(Option<&TextureUse>, Kind); TEXTURES] {
    [
        (material.base_texture.as_ref(), Kind::Color),
        (material.normal_texture.as_ref(), Kind::Normal),
        (material.metallic_roughness_texture.as_ref(), Kind::Data),
        (material.occlusion_texture.as_ref(), Kind::Data),
        (material.emission_texture.as_ref(), Kind::Color),
    ]
}
