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
    /// Alpha is glossiness, as in `KHR_materials_pbrSpecularGlossiness`. The roughness is 1 minus it, and the
    /// metalness 0, in place of [`MaterialProperty::MetallicRoughness`].
    Glossiness,
}

/// What the alpha of a material means (glTF 2.0, 3.9.4). The order is that of what renderers must do: a
/// material that has the parts of several needs the last of their modes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum AlphaMode {
    /// Nothing: the surface is opaque.
    #[default]
    Opaque,
    /// The surface is opaque where alpha is at least a cutoff, and elsewhere not there.
    Mask,
    /// The opacity.
    Blend,
}

/// All parts of a surface's material, by [`MaterialProperty`]; none are as a material of glTF without
/// members: white, rough, metal, dark.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceMaterial<'a> {
    properties: [Option<Property<'a>>; 5],
    alpha: (AlphaMode, f64),
}

impl Default for SurfaceMaterial<'_> {
    fn default() -> Self {
        Self { properties: [None; 5], alpha: (AlphaMode::Blend, 0.0) }
    }
}

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
        self.properties[property as usize] = Some(value);
    }

    /// `cutoff`: of a mask.
    pub fn set_alpha_mode(&mut self, mode: AlphaMode, cutoff: f32) {
        self.alpha = (mode, f64::from(cutoff));
    }

    /// The opacity that an alpha means.
    pub fn opacity(&self, alpha: f64) -> f64 {
        match self.alpha {
            (AlphaMode::Opaque, _) => 1.0,
            (AlphaMode::Mask, cutoff) => f64::from(u8::from(alpha >= cutoff)),
            (AlphaMode::Blend, _) => alpha,
        }
    }

    /// The mean roughness and metalness over the footprint of a sample.
    pub fn roughness_and_metalness(&self, place: &TrianglePlace) -> [f64; 2] {
        if self.properties[MaterialProperty::Glossiness as usize].is_some() {
            return [1.0 - self.mean(MaterialProperty::Glossiness, place)[3], 0.0];
        }
        let [_, roughness, metalness, _] = self.mean(MaterialProperty::MetallicRoughness, place);
        [roughness, metalness]
    }

    /// The factor of a property.
    pub fn factor(&self, property: MaterialProperty) -> [f32; 4] {
        match (self.properties[property as usize], property) {
            (Some(Property { factor, .. }), _) => factor,
            (None, MaterialProperty::BaseColor | MaterialProperty::MetallicRoughness) => [1.0; 4],
            (None, MaterialProperty::Emission) => [0.0, 0.0, 0.0, 1.0],
            (None, MaterialProperty::Texture | MaterialProperty::Glossiness) => [0.0; 4],
        }
    }

    /// The mean of a property over the footprint of a sample.
    pub fn mean(&self, property: MaterialProperty, place: &TrianglePlace) -> Color {
        let factor = self.factor(property);
        let texture = self.properties[property as usize].and_then(|property| property.texture);
        let shown = texture.and_then(|(texture, uvs)| {
            let corners = place.vertices.map(|vertex| uvs.get(vertex));
            let along: [Place; 2] = place.changes.map(|change| weighted(change, corners));
            texture.mean(weighted(place.weights, corners), along)
        });
        let shown = shown.unwrap_or([1.0; 4]);
        [0, 1, 2, 3].map(|i| f64::from(factor[i]) * shown[i])
    }
}
