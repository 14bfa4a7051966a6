//! Normal maps of high models: images, UVs and tangents.

use std::borrow::Cow;
use std::collections::HashMap;

use darboux::TangentOptions;
use darboux_io::Error;
use darboux_io::gltf::{Document, Material, PrimitiveCorners, TextureUse};
use darboux_io::image::{PngImage, RgbCodes, RgbaImage, rgb_codes};

use super::decoded_bytes::DecodedBytes;
use super::image_key::ImageKey;
use super::instance::PrimitiveInstance;
use super::stored::StoredPrimitive;
use super::stored_material::not_finite;
use crate::NormalTexture;

/// A normal map on an instance of a primitive.
#[derive(Debug)]
pub struct MapOnPart<'a> {
    /// The index in [`Textures`].
    pub texture: usize,
    /// Where the texture is read, one per vertex.
    pub uvs: Cow<'a, [[f32; 2]]>,
    /// One per corner, as generated ones.
    pub tangents: Vec<[f32; 4]>,
}

/// The normal maps of a document's materials, decoded.
#[derive(Debug, Default)]
pub struct Textures {
    list: Vec<NormalTexture>,
    /// By the index of the material; none where the map cannot be used.
    of_material: HashMap<usize, Option<(usize, Material)>>,
    /// All materials, once they were read.
    materials: Option<Vec<Material>>,
    /// By the image, or the source of its bytes; the error is a clause.
    decoded: HashMap<ImageKey, Result<NormalTexture, String>>,
    pub warnings: Vec<String>,
}

impl Textures {
    /// The texture.
    pub fn get(&self, index: usize) -> &NormalTexture {
        &self.list[index]
    }

    /// The material of a primitive, if it has a normal map that can be used. `decoded`: the images of the
    /// document before. Errors: a broken document.
    pub fn of_primitive(
        &mut self,
        document: &Document,
        corners: &PrimitiveCorners<'_>,
        decoded: &mut DecodedBytes,
    ) -> Result<Option<usize>, Error> {
        let Some(material) = corners.material() else { return Ok(None) };
        if !self.of_material.contains_key(&material) {
            let read = self.read(document, material, decoded)?;
            self.of_material.insert(material, read);
        }
        Ok(self.of_material[&material].as_ref().map(|_| material))
    }

    fn read(
        &mut self,
        document: &Document,
        index: usize,
        decoded: &mut DecodedBytes,
    ) -> Result<Option<(usize, Material)>, Error> {
        let materials = match &mut self.materials {
            Some(materials) => materials,
            none => none.insert(document.materials()?),
        };
        let Some(material) = materials.get(index).cloned() else { return Ok(None) };
        let Some(used) = &material.normal_texture else { return Ok(None) };
        if !material.normal_scale.is_finite() {
            return Err(not_finite(document, index, "normalTexture.scale"));
        }
        let colors = document.texture_of_material(index, "pbrMetallicRoughness.baseColorTexture")?;
        let is_colors = |colors: &TextureUse| ImageKey::of(document, colors) == ImageKey::of(document, used);
        if used.image.is_some() && colors.as_ref().is_some_and(is_colors) {
            self.warnings.push(format!(
                "{}: materials[{index}] shows one image as base colour and as normal map, of which one is wrong; \
                 export the model again with each image in a file of its own, or bake without the normal \
                 maps of high models",
                document.name()
            ));
        }
        let texture = self.decoded.entry(ImageKey::of(document, used)).or_insert_with(|| {
            let (size, codes) = decode(document, used, decoded)?;
            NormalTexture::of_codes(size, codes).map_err(|error| error.to_string())
        });
        match texture.clone() {
            Ok(texture) => {
                let texture = texture.with_wrap(used.wrap).with_scale(material.normal_scale);
                self.list.push(texture);
                Ok(Some((self.list.len() - 1, material)))
            }
            Err(why) => {
                let name = document.name();
                self.warnings
                    .push(format!("{name}: the normal map of materials[{index}] is not used: {why}"));
                Ok(None)
            }
        }
    }

    /// The map on a primitive, with the tangents that a renderer uses: the file's, or else MikkTSpace's.
    /// None: the primitive lacks normals or the map's UVs. Errors: invalid data.
    pub fn on_part<'a>(
        &mut self,
        document: &'a Document,
        corners: &'a PrimitiveCorners<'a>,
        material: usize,
        primitive: &PrimitiveInstance<'a>,
    ) -> Result<Option<MapOnPart<'a>>, Error> {
        let Some((texture, material)) = &self.of_material[&material] else { return Ok(None) };
        let Some(used) = &material.normal_texture else { return Ok(None) };
        let (name, set) = (corners.name(), used.uv_set);
        let uvs = corners.used_vectors(&format!("TEXCOORD_{set}"))?;
        let Some(mut uvs) = uvs.filter(|_| primitive.normals.is_some()) else {
            self.warnings.push(format!(
                "{}: {}: the normal map is not used, because the primitive has no {}",
                document.name(),
                name.path(),
                if primitive.normals.is_some() { format!("TEXCOORD_{set}") } else { "normals".to_owned() }
            ));
            return Ok(None);
        };
        let computed = TangentOptions::default();
        let has_own = corners.used_vectors::<4>("TANGENT")?.is_some();
        let stored = StoredPrimitive { document, corners, uvs: &uvs };
        let tangents = stored.tangents((!has_own).then_some(&computed), primitive.transform.as_ref())?;
        uvs.to_mut().iter_mut().for_each(|uv| *uv = used.transform_uv(*uv));
        Ok(Some(MapOnPart { texture: *texture, uvs, tangents }))
    }
}

/// The bytes of a texel with channels of 8 bits, and of 16 bits.
const BYTES_PER_TEXEL: [u64; 2] = [3, 6];

/// The size and the codes of a normal map: 8 or 16 bits of a PNG, 8 bits of other formats. The error is a
/// clause.
fn decode(
    document: &Document,
    used: &TextureUse,
    decoded: &mut DecodedBytes,
) -> Result<([u32; 2], RgbCodes), String> {
    let (bytes, limits) = decoded.limits(document, used.image, BYTES_PER_TEXEL)?;
    if PngImage::is_png(&bytes) && PngImage::obstacle(&bytes).is_none() {
        let name = format!("{}: images[{}]", document.name(), used.image.unwrap_or_default());
        let image = PngImage::from_bytes(&name, bytes.into_owned(), document.load_options());
        let image = image.map_err(|error| error.to_string())?;
        let codes = rgb_codes(&image).map_err(|error| error.to_string())?;
        return Ok((image.size(), codes));
    }
    let image = RgbaImage::decode(&bytes, &limits).map_err(|error| format!("the image {error}"))?;
    decoded.add(&bytes, [image.width, image.height], BYTES_PER_TEXEL);
    let codes = image.texels.iter().map(|&[r, g, b, _]| [r, g, b]).collect();
    Ok(([image.width, image.height], RgbCodes::Bytes(codes)))
}
