//! Materials, textures and images of a document.

use std::borrow::Cow;
use std::collections::{BTreeSet, HashMap};
use std::path::Path;

use serde_json::{Value, json};

use super::data::DataBuilder;
use crate::source::provenance::UnreadMap;
use crate::source::scene::{NormalMap, SourceImage, SourceMaterial, SourceScene, SourceTexture};
use crate::words::counted;
use crate::{FileKind, LoadOptions, git_lfs};

/// The lists of materials, textures, images and samplers, and the extensions that they use.
#[derive(Debug, Default)]
pub struct Materials {
    pub materials: Vec<Value>,
    pub textures: Vec<Value>,
    pub images: Vec<Value>,
    pub samplers: Vec<Value>,
    pub extensions: BTreeSet<&'static str>,
    pub unread_maps: Vec<UnreadMap>,
}

const TEXTURE_TRANSFORM: &str = "KHR_texture_transform";
const EMISSIVE_STRENGTH: &str = "KHR_materials_emissive_strength";
pub const WEBP: &str = "EXT_texture_webp";
const CLAMP_TO_EDGE: u32 = 33071;

/// Builds all materials of a scene.
pub fn build(
    scene: &SourceScene,
    data: &mut DataBuilder,
    options: &LoadOptions,
    warnings: &mut Vec<String>,
) -> Materials {
    let mut builder = MaterialBuilder {
        scene,
        options,
        data,
        warnings,
        built: Materials::default(),
        texture_of_use: HashMap::new(),
        image_of_source: HashMap::new(),
        problem_of_image: HashMap::new(),
        sampler_of_clamps: HashMap::new(),
        first_tga: String::new(),
        tga_images: 0,
    };
    for material in &scene.materials {
        let json = builder.material(material);
        builder.built.materials.push(json);
    }
    builder.warn_of_tga();
    builder.built
}

struct MaterialBuilder<'a> {
    scene: &'a SourceScene,
    data: &'a mut DataBuilder,
    options: &'a LoadOptions,
    warnings: &'a mut Vec<String>,
    built: Materials,
    /// The texture of an image, repeated or clamped; none for images that glTF cannot hold.
    texture_of_use: HashMap<(usize, [bool; 2]), Option<usize>>,
    image_of_source: HashMap<usize, Option<GltfImage>>,
    /// Why images are left out: a clause each, whose subject is the image.
    problem_of_image: HashMap<usize, String>,
    sampler_of_clamps: HashMap<[bool; 2], usize>,
    /// The name of the first TGA, and their number.
    first_tga: String,
    tga_images: usize,
}

/// An image in the document.
#[derive(Clone, Copy, Debug)]
struct GltfImage {
    index: usize,
    is_webp: bool,
}

impl MaterialBuilder<'_> {
    fn material(&mut self, material: &SourceMaterial) -> Value {
        let mut shading = json!({});
        if let Some(color) = material.base_color {
            shading["baseColorFactor"] = json!(color.map(unit));
        }
        if let Some(metallic) = material.metallic {
            shading["metallicFactor"] = json!(unit(metallic));
        }
        if let Some(roughness) = material.roughness {
            shading["roughnessFactor"] = json!(unit(roughness));
        }
        self.set(&mut shading, "baseColorTexture", material.base_color_texture.as_ref());
        self.set(&mut shading, "metallicRoughnessTexture", material.metallic_roughness_texture.as_ref());
        let mut json = json!({"name": material.name, "pbrMetallicRoughness": shading});
        if let Some(map) = &material.normal_map {
            self.set_normal_map(&mut json, map);
        } else if let Some(missing) = &material.missing_normal_map {
            self.built.unread_maps.push(UnreadMap {
                material: self.built.materials.len(),
                uv_set: missing.uv_set,
                file: missing.image.name.clone(),
                problem: missing.image.problem.clone(),
                is_absent: missing.image.is_absent,
            });
        }
        self.set(&mut json, "occlusionTexture", material.occlusion_texture.as_ref());
        self.set(&mut json, "emissiveTexture", material.emissive_texture.as_ref());
        if let Some(emissive) = material.emissive {
            self.set_emission(&mut json, emissive);
        }
        if material.is_double_sided {
            json["doubleSided"] = true.into();
        }
        if material.is_transparent {
            json["alphaMode"] = "BLEND".into();
        }
        json
    }

    /// Light of more than 1 has its strength in an extension.
    fn set_emission(&mut self, json: &mut Value, color: [f32; 3]) {
        let strength = color.into_iter().filter(|channel| channel.is_finite()).fold(1.0, f32::max);
        json["emissiveFactor"] = json!(color.map(|channel| unit(channel / strength)));
        if strength > 1.0 {
            json["extensions"] = json!({EMISSIVE_STRENGTH: {"emissiveStrength": strength}});
            self.built.extensions.insert(EMISSIVE_STRENGTH);
        }
    }

    fn set(&mut self, json: &mut Value, key: &str, texture: Option<&SourceTexture>) {
        if let Some(info) = texture.and_then(|texture| self.texture_info(texture)) {
            json[key] = info;
        }
    }

    fn set_normal_map(&mut self, json: &mut Value, map: &NormalMap) {
        let Some(mut info) = self.texture_info(&map.texture) else {
            let image = map.texture.image;
            if let (Some(source), Some(problem)) =
                (self.scene.images.get(image), self.problem_of_image.get(&image))
            {
                self.built.unread_maps.push(UnreadMap {
                    material: self.built.materials.len(),
                    uv_set: map.texture.uv_set,
                    file: source.name.clone(),
                    problem: problem.clone(),
                    is_absent: false,
                });
            }
            return;
        };
        if let Some(scale) = map.scale.filter(|&scale| scale.is_finite() && scale != 1.0) {
            info["scale"] = json!(scale);
        }
        json["normalTexture"] = info;
    }

    fn texture_info(&mut self, texture: &SourceTexture) -> Option<Value> {
        let index = self.texture(texture)?;
        let mut info = json!({"index": index});
        if texture.uv_set > 0 {
            info["texCoord"] = texture.uv_set.into();
        }
        if let Some((offset, rotation, scale)) = texture.transform {
            let transform = json!({"offset": offset, "rotation": rotation, "scale": scale});
            info["extensions"] = json!({TEXTURE_TRANSFORM: transform});
            self.built.extensions.insert(TEXTURE_TRANSFORM);
        }
        Some(info)
    }

    fn texture(&mut self, texture: &SourceTexture) -> Option<usize> {
        let texture_use = (texture.image, texture.clamps);
        if let Some(&texture) = self.texture_of_use.get(&texture_use) {
            return texture;
        }
        let image = self.image(texture.image);
        let made = image.map(|image| self.add_texture(image, texture.clamps));
        self.texture_of_use.insert(texture_use, made);
        made
    }

    fn add_texture(&mut self, image: GltfImage, clamps: [bool; 2]) -> usize {
        let mut json = if image.is_webp {
            self.built.extensions.insert(WEBP);
            json!({"extensions": {WEBP: {"source": image.index}}})
        } else {
            json!({"source": image.index})
        };
        if clamps.contains(&true) {
            json["sampler"] = self.sampler(clamps).into();
        }
        self.built.textures.push(json);
        self.built.textures.len() - 1
    }

    fn sampler(&mut self, clamps: [bool; 2]) -> usize {
        let samplers = &mut self.built.samplers;
        *self.sampler_of_clamps.entry(clamps).or_insert_with(|| {
            let mut json = json!({});
            for (name, _) in ["wrapS", "wrapT"].into_iter().zip(clamps).filter(|(_, clamps)| *clamps) {
                json[name] = CLAMP_TO_EDGE.into();
            }
            samplers.push(json);
            samplers.len() - 1
        })
    }

    fn image(&mut self, image: usize) -> Option<GltfImage> {
        if let Some(&made) = self.image_of_source.get(&image) {
            return made;
        }
        let made = self.scene.images.get(image).and_then(|source| match self.as_gltf_holds_it(source) {
            Ok(file) => self.add_image(source, &file),
            Err(problem) => {
                self.warnings.push(format!("{}: {problem}; the texture is left out", source.name));
                self.problem_of_image.insert(image, problem);
                None
            }
        });
        self.image_of_source.insert(image, made);
        made
    }

    /// Adds an image. `file`: one that glTF can hold.
    fn add_image(&mut self, image: &SourceImage, file: &[u8]) -> Option<GltfImage> {
        let mime = mime_type(file)?;
        let view = self.data.view(file);
        let is_converted = mime_type(&image.bytes) != Some(mime);
        let name = if is_converted { Cow::Owned(png_name(&image.name)) } else { Cow::Borrowed(&*image.name) };
        self.built.images.push(json!({"name": name, "mimeType": mime, "bufferView": view}));
        Some(GltfImage { index: self.built.images.len() - 1, is_webp: mime == "image/webp" })
    }

    /// The file of an image, as PNG where glTF cannot hold its format. Errors, as clauses: no PNG can be made
    /// of it.
    fn as_gltf_holds_it<'i>(&mut self, image: &'i SourceImage) -> Result<Cow<'i, [u8]>, String> {
        let (name, bytes) = (&image.name, &image.bytes);
        if mime_type(bytes).is_some() {
            return Ok(bytes.into());
        }
        if git_lfs::is_pointer(bytes) {
            return Err(git_lfs::NOT_AN_IMAGE.to_owned());
        }
        if !converted::is_tga(bytes) {
            return Err(match converted::other_format(bytes) {
                Some(format) => format!("is {format}, which is not read; save it as PNG"),
                None => "is neither PNG, JPEG, WebP nor TGA; save it as PNG".to_owned(),
            });
        }
        let png = converted::to_png(name, bytes, self.options)?;
        if self.tga_images == 0 {
            self.first_tga.clone_from(name);
        }
        self.tga_images += 1;
        Ok(png.into())
    }

    fn warn_of_tga(&mut self) {
        let first = &self.first_tga;
        self.warnings.push(match self.tga_images {
            0 => return,
            1 => format!("{first} is a TGA, which glTF cannot hold; in the document it is a PNG"),
            count => {
                let others = counted(count - 1, "other texture", "other textures");
                format!("{first} and {others} are TGA, which glTF cannot hold; in the document they are PNG")
            }
        });
    }
}

/// The name of an image that became a PNG.
fn png_name(name: &str) -> String {
    let is_image = FileKind::of(Path::new(name)).is_some_and(FileKind::is_image);
    match name.rsplit_once('.').filter(|_| is_image) {
        Some((stem, _)) => format!("{stem}.png"),
        None => name.to_owned(),
    }
}

/// A factor of glTF: from 0 to 1; numbers that are not finite count as 1.
fn unit(x: f32) -> f32 {
    if x.is_finite() { x.clamp(0.0, 1.0) } else { 1.0 }
}

/// The type of an image that glTF can hold.
fn mime_type(bytes: &[u8]) -> Option<&'static str> {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => Some("image/png"),
        [0xFF, 0xD8, 0xFF, ..] => Some("image/jpeg"),
        [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => Some("image/webp"),
        _ => None,
    }
}

/// Images as PNG.
#[cfg(feature = "textures")]
mod converted {
    use crate::LoadOptions;
    use crate::image::{DecodeLimits, RgbaImage};

    pub fn is_tga(bytes: &[u8]) -> bool {
        RgbaImage::is_tga(bytes)
    }

    pub fn other_format(bytes: &[u8]) -> Option<&'static str> {
        RgbaImage::other_format(bytes)
    }

    /// A PNG of an image. Errors, as clauses: the image cannot be decoded.
    pub fn to_png(name: &str, bytes: &[u8], options: &LoadOptions) -> Result<Vec<u8>, String> {
        let limits = DecodeLimits::of_file(bytes.len(), options.memory_limit);
        // While the PNG is made, the texels are there three times.
        let limits = limits.with_max_texels(limits.max_texels / 2);
        let image = RgbaImage::decode(bytes, &limits).map_err(|error| error.to_string())?;
        image.to_png(name).map_err(|error| error.to_string())
    }
}

/// Without decoders, no reader of a format with images is there.
#[cfg(not(feature = "textures"))]
mod converted {
    use crate::LoadOptions;

    pub fn is_tga(_: &[u8]) -> bool {
        false
    }

    pub fn other_format(_: &[u8]) -> Option<&'static str> {
        None
    }

    pub fn to_png(_: &str, _: &[u8], _: &LoadOptions) -> Result<Vec<u8>, String> {
        Err("cannot be decoded here".to_owned())
    }
}
