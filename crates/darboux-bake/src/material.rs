//! What the material of a high surface shows: factors and textures.

use darboux::Strided;

use crate::ColorTexture;
use crate::color_texture::Color;
use crate::vector::{Place, weighted};

/// A part of a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MaterialProperty {
    /// Red, green and blue in linear light, and alpha.
    BaseColor,
    /// Green is roughness and blue is metalness, as in glTF.
    MetallicRoughness,
    /// Red, green and blue in linear light.
    Emission,
    /// Whatever [`MapKind::Texture`](crate::MapKind::Texture) is baked from.
    Texture,
}

/// All parts of a surface's material, by [`MaterialProperty`]; none are as a material of glTF without
/// members: white, rough, metal, dark.
#[derive(Clone, Copy, Debug, Default)]
pub struct SurfaceMaterial<'a>([Option<Property<'a>>; 4]);

/// A factor, times a texture if there is one.
#[derive(Clone, Copy, Debug)]
pub struct Property<'a> {
    pub factor: [f32; 4],
    pub texture: Option<(&'a ColorTexture, Strided<'a, 2>)>,
}

/// Where on a triangle a texel of the low surface lies.
#[derive(Clone, Copy, Debug)]
pub struct TrianglePlace {
    /// The vertices of the triangle's corners.
    pub vertices: [usize; 3],
    /// The weights of the corners.
    pub weights: [f64; 3],
    /// How these weights change along both sides of the sample's area.
    pub changes: [[f64; 3]; 2],
}

impl<'a> SurfaceMaterial<'a> {
    pub fn set(&mut self, property: MaterialProperty, value: Property<'a>) {
        self.0[property as usize] = Some(value);
    }

    /// The mean of a property over the footprint of a sample.
    pub fn mean(&self, property: MaterialProperty, place: &TrianglePlace) -> Color {
        let Some(Property { factor, texture }) = self.0[property as usize] else {
            return match property {
                MaterialProperty::BaseColor | MaterialProperty::MetallicRoughness => [1.0; 4],
                MaterialProperty::Emission => [0.0, 0.0, 0.0, 1.0],
                MaterialProperty::Texture => [0.0; 4],
            };
        };
        let shown = texture.and_then(|(texture, uvs)| {
            let corners = place.vertices.map(|vertex| uvs.get(vertex));
            let along: [Place; 2] = place.changes.map(|change| weighted(change, corners));
            texture.mean(weighted(place.weights, corners), along)
        });
        let shown = shown.unwrap_or([1.0; 4]);
        [0, 1, 2, 3].map(|i| f64::from(factor[i]) * shown[i])
    }
}
