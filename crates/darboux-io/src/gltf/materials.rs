//! The materials and the bytes of images, for renderers.

use std::borrow::Cow;

use serde::Deserialize;
use serde::de::{DeserializeOwned, IgnoredAny};

use super::Document;
use super::objects_only::read_from_objects;
use super::resources::{UriTarget, decode_data_uri};
use super::schema::{Image, TextureInfoExtensions};
use super::tangents::uv::{UvChoice, UvTransform};
use crate::Error;
use crate::error::{ContentError, system_reason};
use crate::json;

/// A material: the parts that a simple renderer needs.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Material {
    /// The base colour: linear red, green and blue, and alpha.
    pub base_color: [f32; 4],
    /// The texture of the base colour, in sRGB.
    pub base_texture: Option<TextureUse>,
    /// How metallic the surface is, from 0 to 1.
    pub metallic: f32,
    /// How rough the surface is, from 0 to 1.
    pub roughness: f32,
    /// The texture of roughness (green) and metal (blue), which the factors scale.
    pub metallic_roughness_texture: Option<TextureUse>,
    /// The texture of ambient occlusion (red).
    pub occlusion_texture: Option<TextureUse>,
    /// How strong the occlusion is, from 0 to 1.
    pub occlusion_strength: f32,
    /// The emitted light: linear red, green and blue, times `KHR_materials_emissive_strength`.
    pub emission: [f32; 3],
    /// The texture of emitted light, in sRGB.
    pub emission_texture: Option<TextureUse>,
    /// Whether the base colour is shown without light (`KHR_materials_unlit`).
    pub is_unlit: bool,
    /// Whether highlights follow the tangents (`KHR_materials_anisotropy`).
    pub is_anisotropic: bool,
    /// The normal map.
    pub normal_texture: Option<TextureUse>,
    /// The normal map of the clear coat (`KHR_materials_clearcoat`).
    pub clearcoat_normal_texture: Option<TextureUse>,
    /// The scale of the normal map's x and y.
    pub normal_scale: f32,
    /// The use of alpha.
    pub alpha: Alpha,
    /// The UV set n of `TEXCOORD_n` that tangents follow.
    pub tangent_uv_set: usize,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            base_color: [1.0; 4],
            base_texture: None,
            metallic: 1.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            occlusion_texture: None,
            occlusion_strength: 1.0,
            emission: [0.0; 3],
            emission_texture: None,
            is_unlit: false,
            is_anisotropic: false,
            normal_texture: None,
            clearcoat_normal_texture: None,
            normal_scale: 1.0,
            alpha: Alpha::Opaque,
            tangent_uv_set: 0,
        }
    }
}

impl Material {
    /// The textures that are normal maps.
    pub fn normal_maps(&self) -> impl Iterator<Item = &TextureUse> {
        self.normal_texture.iter().chain(&self.clearcoat_normal_texture)
    }
}

/// The use of a base colour's alpha.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Alpha {
    /// Alpha is ignored.
    Opaque,
    /// Texels with a smaller alpha are discarded.
    Mask(f32),
    /// Alpha is the coverage.
    Blend,
}

/// A texture of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureUse {
    /// The index of the image: the texture's source, or else the source of an extension for WebP, AVIF or
    /// KTX 2.
    pub image: Option<usize>,
    /// The UV set n of `TEXCOORD_n`.
    pub uv_set: usize,
    /// The wrapping modes along u and v.
    pub wrap: [Wrap; 2],
    /// Whether magnification uses the nearest texel.
    pub is_nearest: bool,
    transform: Option<UvTransform>,
}

impl TextureUse {
    /// Applies `KHR_texture_transform` to a UV.
    pub fn transform_uv(&self, uv: [f32; 2]) -> [f32; 2] {
        self.transform.map_or(uv, |transform| transform.apply(uv))
    }

    /// The offset and the scale of `KHR_texture_transform`; none if it rotates the texture.
    pub(super) fn offset_and_scale(&self) -> Option<([f32; 2], [f32; 2])> {
        self.transform.map_or(Some(([0.0; 2], [1.0; 2])), |transform| transform.without_rotation())
    }
}

/// The wrapping mode of UVs outside [0, 1].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The image is repeated.
    #[default]
    Repeat,
    /// The image is repeated, every second time mirrored.
    Mirror,
    /// The texels at the edge continue.
    Clamp,
}

read_from_objects! { StoredMaterials, StoredMaterial, StoredExtensions, StoredClearcoat, StoredEmission, StoredAnisotropy, Metallic, StoredTextureUse, Texture, TextureExtensions, ImageSource, Sampler }

#[derive(Deserialize)]
#[serde(remote = "Self")]
struct StoredMaterials {
    #[serde(default)]
    materials: Vec<StoredMaterial>,
    #[serde(default)]
    textures: Vec<Texture>,
    #[serde(default)]
    samplers: Vec<Sampler>,
}

#[derive(Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
struct StoredMaterial {
    #[serde(default)]
    pbr_metallic_roughness: Metallic,
    normal_texture: Option<StoredTextureUse>,
    occlusion_texture: Option<StoredTextureUse>,
    #[serde(default)]
    emissive_factor: [f32; 3],
    emissive_texture: Option<StoredTextureUse>,
    alpha_mode: Option<String>,
    #[serde(default = "half")]
    alpha_cutoff: f32,
    #[serde(default)]
    extensions: StoredExtensions,
}

#[derive(Default, Deserialize)]
#[serde(remote = "Self")]
struct StoredExtensions {
    #[serde(rename = "KHR_materials_clearcoat")]
    clearcoat: Option<StoredClearcoat>,
    #[serde(rename = "KHR_materials_emissive_strength")]
    emission: Option<StoredEmission>,
    #[serde(rename = "KHR_materials_anisotropy")]
    anisotropy: Option<StoredAnisotropy>,
    #[serde(rename = "KHR_materials_unlit")]
    unlit: Option<IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
struct StoredEmission {
    #[serde(default = "one")]
    emissive_strength: f32,
}

#[derive(Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
struct StoredAnisotropy {
    #[serde(default)]
    anisotropy_strength: f32,
}

#[derive(Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
struct StoredClearcoat {
    clearcoat_normal_texture: Option<StoredTextureUse>,
}

#[derive(Default, Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
struct Metallic {
    base_color_factor: Option<[f32; 4]>,
    base_color_texture: Option<StoredTextureUse>,
    metallic_factor: Option<f32>,
    roughness_factor: Option<f32>,
    metallic_roughness_texture: Option<StoredTextureUse>,
}

#[derive(Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
struct StoredTextureUse {
    index: usize,
    #[serde(default)]
    tex_coord: usize,
    #[serde(default = "one")]
    scale: f32,
    #[serde(default = "one")]
    strength: f32,
    #[serde(default)]
    extensions: TextureInfoExtensions,
}

#[derive(Deserialize)]
#[serde(remote = "Self")]
pub(super) struct Texture {
    sampler: Option<usize>,
    source: Option<usize>,
    #[serde(default)]
    extensions: TextureExtensions,
}

/// The extensions for other image formats.
#[derive(Default, Deserialize)]
#[serde(remote = "Self")]
struct TextureExtensions {
    #[serde(rename = "EXT_texture_webp")]
    webp: Option<ImageSource>,
    #[serde(rename = "EXT_texture_avif")]
    avif: Option<ImageSource>,
    #[serde(rename = "KHR_texture_basisu")]
    ktx2: Option<ImageSource>,
    #[serde(rename = "MSFT_texture_dds")]
    dds: Option<ImageSource>,
}

#[derive(Deserialize)]
#[serde(remote = "Self")]
struct ImageSource {
    source: Option<usize>,
}

impl Texture {
    /// The image in the most common of its formats.
    pub(super) fn image(&self) -> Option<usize> {
        self.source.or_else(|| self.others().next())
    }

    /// The number of formats.
    pub(super) fn formats(&self) -> usize {
        usize::from(self.source.is_some()) + self.others().count()
    }

    /// The images of extensions.
    fn others(&self) -> impl Iterator<Item = usize> {
        let TextureExtensions { webp, avif, ktx2, dds } = &self.extensions;
        [webp, avif, ktx2, dds].into_iter().flatten().filter_map(|other| other.source)
    }
}

#[derive(Default, Deserialize)]
#[serde(remote = "Self", rename_all = "camelCase")]
struct Sampler {
    mag_filter: Option<u32>,
    wrap_s: Option<u32>,
    wrap_t: Option<u32>,
}

fn half() -> f32 {
    0.5
}

fn one() -> f32 {
    1.0
}

impl Document {
    /// All materials. Errors: textures, samplers or images that do not exist.
    pub fn materials(&self) -> Result<Vec<Material>, Error> {
        let read = || -> Result<Vec<Material>, ContentError> {
            let all: StoredMaterials = self.read()?;
            let material = |(index, stored)| self.material(&all, index, stored);
            all.materials.iter().enumerate().map(material).collect()
        };
        read().map_err(|error| error.in_file(self.name()))
    }

    /// The texture of a material at a place in its JSON, such as `emissiveTexture` or
    /// `extensions.KHR_materials_clearcoat.clearcoatTexture`; none if it does not have it.
    ///
    /// Errors: a texture, sampler or image that does not exist; a member that is no texture.
    pub fn texture_of_material(&self, material: usize, member: &str) -> Result<Option<TextureUse>, Error> {
        let read = || -> Result<Option<TextureUse>, ContentError> {
            let stored =
                member.split('.').fold(self.element("materials", material), |json, name| &json[name]);
            if stored.is_null() {
                return Ok(None);
            }
            let at = format!("materials[{material}].{member}");
            let used: StoredTextureUse = json::read(stored, &at)?;
            // Only what it names is read, since callers ask for each of many materials.
            let texture: Option<Texture> = self.optional_element("textures", used.index)?;
            let sampler = match texture.as_ref().and_then(|texture| texture.sampler) {
                Some(index) => self.optional_element("samplers", index)?,
                None => None,
            };
            self.texture_use((texture.as_ref(), sampler.as_ref()), &used, &at).map(Some)
        };
        read().map_err(|error| error.in_file(self.name()))
    }

    /// An element of an array of the root object; none if it does not exist.
    fn optional_element<T: DeserializeOwned>(
        &self,
        array: &str,
        index: usize,
    ) -> Result<Option<T>, ContentError> {
        let stored = self.element(array, index);
        if stored.is_null() {
            return Ok(None);
        }
        json::read(stored, &format!("{array}[{index}]")).map(Some)
    }

    fn material(
        &self,
        all: &StoredMaterials,
        index: usize,
        stored: &StoredMaterial,
    ) -> Result<Material, ContentError> {
        let at = format!("materials[{index}]");
        let texture = |used: Option<&StoredTextureUse>, member: &str| {
            let found = used.map(|used| {
                let texture = all.textures.get(used.index);
                let sampler = texture.and_then(|texture| all.samplers.get(texture.sampler?));
                self.texture_use((texture, sampler), used, &format!("{at}.{member}"))
            });
            found.transpose()
        };
        let metallic = &stored.pbr_metallic_roughness;
        let coat =
            stored.extensions.clearcoat.as_ref().and_then(|coat| coat.clearcoat_normal_texture.as_ref());
        let choice = self.stored_materials().get(index).and_then(|material| UvChoice::of(material, index));
        let extensions = &stored.extensions;
        let emission_strength =
            extensions.emission.as_ref().map_or(1.0, |emission| emission.emissive_strength);
        Ok(Material {
            metallic: metallic.metallic_factor.unwrap_or(1.0),
            roughness: metallic.roughness_factor.unwrap_or(1.0),
            metallic_roughness_texture: texture(
                metallic.metallic_roughness_texture.as_ref(),
                "pbrMetallicRoughness.metallicRoughnessTexture",
            )?,
            occlusion_texture: texture(stored.occlusion_texture.as_ref(), "occlusionTexture")?,
            occlusion_strength: stored.occlusion_texture.as_ref().map_or(1.0, |used| used.strength),
            emission: stored.emissive_factor.map(|factor| factor * emission_strength),
            emission_texture: texture(stored.emissive_texture.as_ref(), "emissiveTexture")?,
            is_unlit: extensions.unlit.is_some(),
            is_anisotropic: extensions
                .anisotropy
                .as_ref()
                .is_some_and(|anisotropy| anisotropy.anisotropy_strength > 0.0),
            base_color: metallic.base_color_factor.unwrap_or([1.0; 4]),
            base_texture: texture(
                metallic.base_color_texture.as_ref(),
                "pbrMetallicRoughness.baseColorTexture",
            )?,
            normal_texture: texture(stored.normal_texture.as_ref(), "normalTexture")?,
            clearcoat_normal_texture: texture(
                coat,
                "extensions.KHR_materials_clearcoat.clearcoatNormalTexture",
            )?,
            normal_scale: stored.normal_texture.as_ref().map_or(1.0, |used| used.scale),
            alpha: match stored.alpha_mode.as_deref() {
                Some("MASK") => Alpha::Mask(stored.alpha_cutoff),
                Some("BLEND") => Alpha::Blend,
                _ => Alpha::Opaque,
            },
            tangent_uv_set: choice.unwrap_or_default().set,
        })
    }

    /// The use of a texture and its sampler; none if the document does not have them.
    fn texture_use(
        &self,
        (texture, sampler): (Option<&Texture>, Option<&Sampler>),
        used: &StoredTextureUse,
        at: &str,
    ) -> Result<TextureUse, ContentError> {
        let missing = |what: &str, index: usize| {
            ContentError::invalid(at, format!("{what} {index} does not exist; export the file again"))
        };
        let texture = texture.ok_or_else(|| missing("texture", used.index))?;
        let none = Sampler::default();
        let sampler = match texture.sampler {
            Some(index) => sampler.ok_or_else(|| missing("sampler", index))?,
            None => &none,
        };
        let image = texture.image();
        if let Some(image) = image.filter(|&image| image >= self.root.images.len()) {
            return Err(missing("image", image));
        }
        let transform = used.extensions.transform.as_ref();
        Ok(TextureUse {
            image,
            uv_set: transform.and_then(|transform| transform.tex_coord).unwrap_or(used.tex_coord),
            wrap: [sampler.wrap_s, sampler.wrap_t].map(Wrap::from_code),
            is_nearest: sampler.mag_filter == Some(NEAREST),
            transform: transform.and_then(UvTransform::new),
        })
    }

    /// The content of an image file of any format. Errors: the image has no content, or its file may not be
    /// read.
    pub fn image_bytes(&self, index: usize) -> Result<Cow<'_, [u8]>, Error> {
        self.find_image(index).map_err(|error| error.in_file(self.name()))
    }

    fn find_image(&self, index: usize) -> Result<Cow<'_, [u8]>, ContentError> {
        if let Some(file) = self.image_files.get(&index) {
            return Ok(file.bytes.as_slice().into());
        }
        let at = format!("images[{index}]");
        let (uri, at) = match self.root.images.get(index) {
            Some(&Image { buffer_view: Some(view), .. }) => {
                return Ok(self.view(view, &at)?.0.into());
            }
            Some(Image { uri: Some(uri), .. }) => (uri, format!("{at}.uri")),
            Some(_) => return Err(ContentError::invalid(at, "has no content; export the file again")),
            None => return Err(ContentError::invalid(at, "does not exist; export the file again")),
        };
        match self.resources.resolve(uri) {
            Ok(UriTarget::Data(data)) => {
                decode_data_uri(data).map(Cow::Owned).map_err(|problem| ContentError::invalid(at, problem))
            }
            Ok(UriTarget::Remote) => {
                Err(ContentError::resource(at, "is on another machine; download it and refer to the file"))
            }
            Ok(UriTarget::File(located)) => {
                // Files that were given in memory are not on the disk, and take no more memory.
                let size = located.path.metadata().map_or(0, |metadata| metadata.len()) as usize;
                let budget = self.options.budget(size, 0);
                if size > budget.bytes {
                    return Err(ContentError::unsupported(at, budget.exceeded("is so large that it needs")));
                }
                (self.resources.bytes(&located.path)).map(|bytes| Cow::Owned(bytes.into_vec())).map_err(
                    |error| ContentError::resource(at, format!("cannot be read: {}", system_reason(&error))),
                )
            }
            Err(problem) => Err(ContentError::resource(at, problem)),
        }
    }
}

/// Constants of OpenGL, which glTF uses.
const NEAREST: u32 = 9728;
const CLAMP_TO_EDGE: u32 = 33071;
const MIRRORED_REPEAT: u32 = 33648;

impl Wrap {
    fn from_code(code: Option<u32>) -> Self {
        match code {
            Some(CLAMP_TO_EDGE) => Self::Clamp,
            Some(MIRRORED_REPEAT) => Self::Mirror,
            _ => Self::Repeat,
        }
    }
}
