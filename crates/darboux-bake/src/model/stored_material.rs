//! A material of a high model as its document has it: where its parts lie, with their factors.

use std::collections::BTreeSet;

use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveCorners};
use darboux_io::json::Value;
use darboux_io::words::counted_if_any;

use crate::text::listed;
use crate::{AlphaMode, MapKind, MapSet, MaterialProperty};

/// A material of a document.
#[derive(Clone, Copy, Debug)]
pub struct StoredMaterial<'a> {
    pub document: &'a Document,
    pub index: usize,
}

/// What the base colour and the roughness of a material are defined by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shading {
    MetallicRoughness,
    /// `KHR_materials_unlit`: the base colour is shown without light.
    Unlit,
    /// `KHR_materials_pbrSpecularGlossiness`, unless the material has a metallic-roughness texture, too,
    /// which maps need.
    SpecularGlossiness,
}

/// A part of a material: its factor, and the place of its texture in the material's JSON if it may have one.
pub type StoredProperty<'t> = (MaterialProperty, [f32; 4], Option<&'t str>);

const METALLIC_TEXTURE: &str = "pbrMetallicRoughness.metallicRoughnessTexture";
const UNLIT: &str = "extensions.KHR_materials_unlit";
const SPECULAR: &str = "extensions.KHR_materials_pbrSpecularGlossiness";
const DIFFUSE_FACTOR: &str = "extensions.KHR_materials_pbrSpecularGlossiness.diffuseFactor";
const DIFFUSE_TEXTURE: &str = "extensions.KHR_materials_pbrSpecularGlossiness.diffuseTexture";
const GLOSSINESS_FACTOR: &str = "extensions.KHR_materials_pbrSpecularGlossiness.glossinessFactor";
const GLOSSINESS_TEXTURE: &str = "extensions.KHR_materials_pbrSpecularGlossiness.specularGlossinessTexture";
const EMISSIVE_STRENGTH: &str = "extensions.KHR_materials_emissive_strength.emissiveStrength";

impl StoredMaterial<'_> {
    pub fn shading(&self) -> Shading {
        match [UNLIT, METALLIC_TEXTURE, SPECULAR].map(|member| self.json(member).is_object()) {
            [true, ..] => Shading::Unlit,
            [false, false, true] => Shading::SpecularGlossiness,
            _ => Shading::MetallicRoughness,
        }
    }

    /// The mode of alpha, and the cutoff of a mask (glTF 2.0, 3.9.4). Errors: a cutoff that is not finite.
    pub fn alpha(&self) -> Result<(AlphaMode, f32), Error> {
        let mode = match self.json("alphaMode").as_str() {
            Some("MASK") => AlphaMode::Mask,
            Some("BLEND") => AlphaMode::Blend,
            _ => AlphaMode::Opaque,
        };
        let [cutoff] = self.numbers("alphaCutoff", [0.5])?;
        Ok((mode, cutoff))
    }

    /// The parts that maps need. `texture`: the place of the texture of [`MapKind::Texture`]. Errors: factors
    /// that are not finite; invalid data.
    pub fn properties<'t>(
        &self,
        maps: MapSet,
        texture: Option<&'t str>,
    ) -> Result<Vec<StoredProperty<'t>>, Error> {
        let has_any = |kinds: &[MapKind]| kinds.iter().any(|&kind| maps.has(kind));
        let mut properties = Vec::new();
        if has_any(&[MapKind::BaseColor, MapKind::Opacity]) {
            properties.push(self.base_color()?);
        }
        if has_any(&[MapKind::Roughness, MapKind::Metalness]) {
            properties.push(self.roughness()?);
        }
        if maps.has(MapKind::Emission) {
            properties.push((MaterialProperty::Emission, self.emission()?, Some("emissiveTexture")));
        }
        if let Some(member) = texture.filter(|_| maps.has(MapKind::Texture)) {
            let has_it = self.document.texture_of_material(self.index, member)?.is_some();
            properties.push((MaterialProperty::Texture, [f32::from(u8::from(has_it)); 4], Some(member)));
        }
        Ok(properties)
    }

    fn base_color(&self) -> Result<StoredProperty<'static>, Error> {
        let [factor, texture] = match self.shading() {
            Shading::SpecularGlossiness => [DIFFUSE_FACTOR, DIFFUSE_TEXTURE],
            _ => ["pbrMetallicRoughness.baseColorFactor", "pbrMetallicRoughness.baseColorTexture"],
        };
        Ok((MaterialProperty::BaseColor, self.numbers(factor, [1.0; 4])?, Some(texture)))
    }

    fn roughness(&self) -> Result<StoredProperty<'static>, Error> {
        match self.shading() {
            Shading::Unlit => Ok((MaterialProperty::MetallicRoughness, [1.0, 1.0, 0.0, 1.0], None)),
            Shading::SpecularGlossiness => {
                let [glossiness] = self.numbers(GLOSSINESS_FACTOR, [1.0])?;
                Ok((MaterialProperty::Glossiness, [1.0, 1.0, 1.0, glossiness], Some(GLOSSINESS_TEXTURE)))
            }
            Shading::MetallicRoughness => {
                let [roughness] = self.numbers("pbrMetallicRoughness.roughnessFactor", [1.0])?;
                let [metalness] = self.numbers("pbrMetallicRoughness.metallicFactor", [1.0])?;
                let factor = [1.0, roughness, metalness, 1.0];
                Ok((MaterialProperty::MetallicRoughness, factor, Some(METALLIC_TEXTURE)))
            }
        }
    }

    fn emission(&self) -> Result<[f32; 4], Error> {
        let [red, green, blue] = self.numbers("emissiveFactor", [0.0; 3])?;
        let [strength] = self.numbers(EMISSIVE_STRENGTH, [1.0])?;
        let factor = [strength * red, strength * green, strength * blue, 1.0];
        if factor.iter().all(|x| x.is_finite()) {
            Ok(factor)
        } else {
            Err(self.not_finite(EMISSIVE_STRENGTH))
        }
    }

    /// Numbers at a place in the material's JSON: one, or an array of them. Errors: a number that single
    /// precision does not hold.
    fn numbers<const N: usize>(&self, member: &str, default: [f32; N]) -> Result<[f32; N], Error> {
        let found = self.json(member);
        let number = |i: usize| if found.is_array() { &found[i] } else { found };
        let numbers = std::array::from_fn(|i| number(i).as_f64().map_or(default[i], |x| x as f32));
        if numbers.iter().all(|x| x.is_finite()) { Ok(numbers) } else { Err(self.not_finite(member)) }
    }

    fn not_finite(&self, member: &str) -> Error {
        not_finite(self.document, self.index, member)
    }

    fn json(&self, member: &str) -> &Value {
        let material = &self.document.json()["materials"][self.index];
        member.split('.').fold(material, |json, name| &json[name])
    }
}

/// The error about a number of a material that single precision does not hold.
pub fn not_finite(document: &Document, material: usize, member: &str) -> Error {
    Error::Invalid {
        file: document.name().to_owned(),
        at: format!("materials[{material}].{member}"),
        problem: "the number is too large for single precision; choose a smaller one".to_owned(),
    }
}

/// What maps do not show of the materials of primitives, one sentence each.
pub fn warnings_of_materials<'a>(
    document: &Document,
    primitives: impl Iterator<Item = &'a PrimitiveCorners<'a>>,
    maps: MapSet,
) -> Vec<String> {
    let has_any = |kinds: &[MapKind]| kinds.iter().any(|&kind| maps.has(kind));
    let (used, without): (Vec<_>, Vec<_>) =
        primitives.map(PrimitiveCorners::material).partition(Option::is_some);
    let used: BTreeSet<usize> = used.into_iter().flatten().collect();
    let is_specular =
        |&index: &usize| StoredMaterial { document, index }.shading() == Shading::SpecularGlossiness;
    let specular: Vec<String> =
        used.into_iter().filter(is_specular).map(|index| format!("materials[{index}]")).collect();
    let mut warnings = Vec::new();
    if !specular.is_empty() && has_any(&[MapKind::BaseColor, MapKind::Roughness, MapKind::Metalness]) {
        warnings.push(format!(
            "{}: no map has the specular colours (KHR_materials_pbrSpecularGlossiness) of {}, so that metals \
             become dark plastics; convert them to metallic-roughness materials first",
            document.name(),
            listed(specular)
        ));
    }
    let white_metal = counted_if_any(
        without.len(),
        "primitive has no material and is baked as glTF's own, white metal; give it one, or leave \
         roughness and metalness out of the maps",
        "primitives have no material and are baked as glTF's own, white metal; give them one, or leave \
         roughness and metalness out of the maps",
    );
    let white_metal = white_metal.filter(|_| has_any(&[MapKind::Roughness, MapKind::Metalness]));
    warnings.extend(white_metal.map(|sentence| format!("{}: {sentence}", document.name())));
    warnings
}
