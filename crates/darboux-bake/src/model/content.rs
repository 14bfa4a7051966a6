//! What the primitives of high models show beside their shape: colours of vertices, materials, and the names
//! of what they belong to.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveCorners, TextureUse};
use darboux_io::image::RgbaCodes;

use super::decoded_bytes::DecodedBytes;
use super::image_key::ImageKey;
use super::stored_material::StoredMaterial;
use crate::{AlphaMode, BakeError, ColorTexture, HighSurface, MapKind, MapSet, MaterialProperty};

/// The colours and properties of a primitive.
#[derive(Debug, Default)]
pub struct PartContent<'a> {
    colors: Option<Cow<'a, [[f32; 4]]>>,
    properties: Vec<PartProperty<'a>>,
    /// The mode of alpha, and the cutoff of a mask. A primitive without a material is opaque.
    pub alpha: (AlphaMode, f32),
}

#[derive(Debug)]
struct PartProperty<'a> {
    property: MaterialProperty,
    factor: [f32; 4],
    texture: Option<TextureWithUvs<'a>>,
}

/// The index of a texture in [`ColorTextures`], and the UVs at which it is read.
type TextureWithUvs<'a> = (usize, Cow<'a, [[f32; 2]]>);

/// The textures of a document that maps need, decoded once each.
#[derive(Debug, Default)]
pub struct ColorTextures {
    list: Vec<ColorTexture>,
    /// By the image and whether it is in sRGB, with the modes in which it is wrapped; none where it cannot
    /// be used.
    known: HashMap<(Option<usize>, bool, String), Option<usize>>,
    /// By the source of the bytes and whether it is in sRGB; the error is a clause.
    decoded: HashMap<(ImageKey, bool), Result<ColorTexture, String>>,
    pub warnings: Vec<String>,
    /// The same, to give each once.
    warned: HashSet<String>,
}

/// Whether the texture of a material holds colours in sRGB, judged by its name in the material, as
/// `baseColorTexture` does.
pub fn is_color_texture(member: &str) -> bool {
    let name = member.rsplit('.').next().unwrap_or(member).to_lowercase();
    ["color", "emissive", "diffuse"].iter().any(|part| name.contains(part))
}

impl<'a> PartContent<'a> {
    /// Reads what maps need of a primitive. `texture`: the name of the texture of [`MapKind::Texture`] in the
    /// material; `decoded`: the images of the document before. Errors: invalid data; factors that are not
    /// finite.
    pub fn read(
        document: &'a Document,
        corners: &'a PrimitiveCorners<'a>,
        (maps, texture): (MapSet, Option<&str>),
        textures: &mut ColorTextures,
        decoded: &mut DecodedBytes,
    ) -> Result<Self, Error> {
        let mut content = Self::default();
        let colored = [MapKind::VertexColor, MapKind::Id, MapKind::BaseColor, MapKind::Opacity];
        if colored.iter().any(|&kind| maps.has(kind)) {
            content.colors = colors(document, corners)?;
        }
        let Some(index) = corners.material() else { return Ok(content) };
        let material = StoredMaterial { document, index };
        content.alpha = material.alpha()?;
        for (property, factor, member) in material.properties(maps, texture)? {
            let texture = match member {
                Some(member) => texture_of(material, corners, member, textures, decoded)?,
                None => None,
            };
            content.properties.push(PartProperty { property, factor, texture });
        }
        Ok(content)
    }

    pub fn has_colors(&self) -> bool {
        self.colors.is_some()
    }

    /// Whether there is a texture for [`MapKind::Texture`].
    pub fn has_chosen_texture(&self) -> bool {
        let is_chosen = |shown: &PartProperty<'_>| shown.property == MaterialProperty::Texture;
        self.properties.iter().any(|shown| is_chosen(shown) && shown.texture.is_some())
    }

    /// A surface with this content.
    pub fn on<'s>(
        &'s self,
        surface: HighSurface<'s>,
        textures: &'s ColorTextures,
    ) -> Result<HighSurface<'s>, BakeError> {
        let (mode, cutoff) = self.alpha;
        let mut surface = surface.with_alpha_mode(mode, cutoff);
        if let Some(colors) = &self.colors {
            surface = surface.with_colors(&**colors)?;
        }
        for PartProperty { property, factor, texture } in &self.properties {
            let texture = texture.as_ref().map(|(index, uvs)| (&textures.list[*index], (&**uvs).into()));
            surface = surface.with_property(*property, *factor, texture)?;
        }
        Ok(surface)
    }
}

/// The texture at a place in a material's JSON, and where the primitive reads it; none if it has none or it
/// cannot be used.
fn texture_of<'a>(
    material: StoredMaterial<'a>,
    corners: &'a PrimitiveCorners<'a>,
    member: &str,
    textures: &mut ColorTextures,
    decoded: &mut DecodedBytes,
) -> Result<Option<TextureWithUvs<'a>>, Error> {
    let StoredMaterial { document, index } = material;
    let Some(used) = document.texture_of_material(index, member)? else { return Ok(None) };
    let at = format!("{member} of materials[{index}]");
    let set = format!("TEXCOORD_{}", used.uv_set);
    let Some(mut uvs) = corners.used_vectors(&set)? else {
        let path = corners.name().path();
        textures.warn(document, format!("{at} is not used, because {path} has no {set}"));
        return Ok(None);
    };
    let Some(index) = textures.index(document, &used, is_color_texture(member), &at, decoded) else {
        return Ok(None);
    };
    uvs.to_mut().iter_mut().for_each(|uv| *uv = used.transform_uv(*uv));
    Ok(Some((index, uvs)))
}

impl ColorTextures {
    fn warn(&mut self, document: &Document, clause: String) {
        let sentence = format!("{}: {clause}", document.name());
        if self.warned.insert(sentence.clone()) {
            self.warnings.push(sentence);
        }
    }

    fn index(
        &mut self,
        document: &Document,
        used: &TextureUse,
        is_srgb: bool,
        at: &str,
        bytes: &mut DecodedBytes,
    ) -> Option<usize> {
        let key = (used.image, is_srgb, format!("{:?}", used.wrap));
        if let Some(&known) = self.known.get(&key) {
            return known;
        }
        let source = (ImageKey::of(document, used), is_srgb);
        let decoded = self.decoded.entry(source);
        let decoded = decoded.or_insert_with(|| decode(document, used, is_srgb, bytes));
        let index = match decoded.clone() {
            Ok(texture) => {
                self.list.push(texture.with_wrap(used.wrap));
                Some(self.list.len() - 1)
            }
            Err(why) => {
                self.warn(document, format!("{at} is not used: {why}"));
                None
            }
        };
        self.known.insert(key, index);
        index
    }
}

/// The bytes of a texel with channels of 8 bits: four, and for the levels above a third of sixteen. With
/// channels of 16 bits: eight, and eight more while it is decoded.
const BYTES_PER_TEXEL: [u64; 2] = [10, 16];

/// The error is a clause.
fn decode(
    document: &Document,
    used: &TextureUse,
    is_srgb: bool,
    decoded: &mut DecodedBytes,
) -> Result<ColorTexture, String> {
    let (bytes, limits) = decoded.limits(document, used.image, BYTES_PER_TEXEL)?;
    let decoding = RgbaCodes::decode(&bytes, &limits);
    let (size, codes) = decoding.map_err(|error| format!("the image {error}"))?;
    decoded.add(&bytes, size, BYTES_PER_TEXEL);
    ColorTexture::of_codes(size, codes, is_srgb).map_err(|error| error.to_string())
}

/// The colours of a primitive's vertices, opaque where they have no alpha. Errors: invalid data.
pub fn colors<'a>(
    document: &'a Document,
    corners: &PrimitiveCorners<'a>,
) -> Result<Option<Cow<'a, [[f32; 4]]>>, Error> {
    let name = corners.name();
    let attributes = &document.meshes()[name.mesh].primitives[name.primitive].attributes;
    let accessor = attributes.get("COLOR_0").and_then(|&index| document.accessors().get(index));
    if accessor.is_some_and(|accessor| accessor.element_type.components() == 3) {
        let colors = corners.used_vectors::<3>("COLOR_0")?.unwrap_or_default();
        let opaque = colors.iter().map(|&[red, green, blue]| [red, green, blue, 1.0]).collect();
        return Ok(Some(Cow::Owned(opaque)));
    }
    corners.used_vectors::<4>("COLOR_0")
}
