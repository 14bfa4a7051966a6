//! Materials with their textures, as metallic-roughness shading.

use std::collections::{HashMap, HashSet};

use ufbx::{MaterialMap, Scene, ShaderType, Texture, TextureFile, WrapMode};

use super::placement::{self, Convention, Placement};
use crate::error::shortened;
use crate::image::{DecodeLimits, RgbaImage};
use crate::source::{
    MissingImage, MissingNormalMap, ModelFiles, NormalMap, SourceImage, SourceMaterial, SourceTexture,
};

/// Reads the materials of a scene with their images.
pub struct MaterialReader<'a> {
    scene: &'a Scene,
    files: &'a ModelFiles,
    /// By which rule textures are placed.
    convention: Convention,
    /// The image of each texture file.
    image_of_file: HashMap<u32, Result<usize, MissingImage>>,
    /// The images of bump maps that were decoded: whether they are heights.
    is_grey: HashMap<usize, bool>,
    pub images: Vec<SourceImage>,
    pub warnings: Vec<String>,
    pub not_carried: Vec<String>,
}

impl<'a> MaterialReader<'a> {
    pub fn new(scene: &'a Scene, files: &'a ModelFiles) -> Self {
        Self {
            scene,
            files,
            convention: Convention::of(&scene.metadata),
            image_of_file: HashMap::new(),
            is_grey: HashMap::new(),
            images: Vec::new(),
            warnings: Vec::new(),
            not_carried: Vec::new(),
        }
    }

    /// A material of ufbx. Lambert's and Phong's have no metal, and a roughness by their shininess.
    ///
    /// `uv_sets`: the names of the UV sets of the meshes with the material.
    pub fn material(&mut self, material: &ufbx::Material, uv_sets: &[String]) -> SourceMaterial {
        let (pbr, fbx) = (&material.pbr, &material.fbx);
        let opacity = opacity(material);
        self.list_losses(material);
        let base_color_texture = self.texture(&pbr.base_color, uv_sets);
        let emissive_texture = self.texture(&pbr.emission_color, uv_sets);
        // A texture replaces the colour in FBX and is multiplied by it in glTF.
        let [r, g, b] = match base_color_texture {
            Some(_) => [scalar(&pbr.base_factor, 1.0); 3],
            None => color(&pbr.base_color, &pbr.base_factor).unwrap_or([1.0; 3]),
        };
        let emissive = match emissive_texture {
            Some(_) => Some([scalar(&pbr.emission_factor, 1.0); 3]),
            None => color(&pbr.emission_color, &pbr.emission_factor),
        };
        SourceMaterial {
            name: material.element.name.to_string(),
            base_color: Some([r, g, b, opacity]),
            base_color_texture,
            metallic: Some(scalar(&pbr.metalness, 0.0)),
            roughness: Some(roughness(material)),
            normal_map: self.normal_map(material, uv_sets),
            missing_normal_map: self.missing_normal_map(material, uv_sets),
            emissive: emissive.filter(|color| *color != [0.0; 3]),
            emissive_texture,
            occlusion_texture: self.texture(&pbr.ambient_occlusion, uv_sets),
            is_double_sided: material.features.double_sided.enabled,
            is_transparent: opacity < 1.0 || fbx.transparency_color.texture.is_some(),
            ..SourceMaterial::default()
        }
    }

    /// The normal map, or a coloured bump map, in which many programs write normal maps.
    fn normal_map(&mut self, material: &ufbx::Material, uv_sets: &[String]) -> Option<NormalMap> {
        let name = shortened(&material.element.name);
        let (fbx, pbr) = (&material.fbx, &material.pbr);
        let named = self.texture(&fbx.normal_map, uv_sets).or_else(|| self.texture(&pbr.normal_map, uv_sets));
        let texture = match named {
            Some(texture) => texture,
            None => {
                let texture = self.texture(&fbx.bump, uv_sets)?;
                let (bytes, limit) = (&self.images[texture.image].bytes, self.files.memory_limit());
                let is_grey = self.is_grey.entry(texture.image).or_insert_with(|| {
                    let image = RgbaImage::decode(bytes, &DecodeLimits::of_file(bytes.len(), limit));
                    image.is_ok_and(|image| !image.is_colored())
                });
                if *is_grey {
                    self.warnings.push(format!(
                        "the bump map of material {name:?} is grey, so it holds heights and is left out; \
                         normal maps are coloured"
                    ));
                    return None;
                }
                texture
            }
        };
        // Blender's normal maps have green up. FBX itself does not say it, and other programs write either.
        if self.convention == Convention::Others {
            self.warnings.push(format!(
                "FBX does not say whether green points up or down in the normal map of material {name:?}; it \
                 is taken as glTF's, up: darboux check judges the image"
            ));
        }
        Some(NormalMap { texture, scale: None })
    }

    /// The normal map whose file was not read, of a material without another one. A bump map that was not
    /// read may hold heights.
    fn missing_normal_map(&self, material: &ufbx::Material, uv_sets: &[String]) -> Option<MissingNormalMap> {
        let maps = [&material.fbx.normal_map, &material.pbr.normal_map];
        let images = maps.map(|map| {
            let (texture, with_file) = texture_of(map)?;
            Some((texture, self.image_of_file.get(&with_file.file_index)?))
        });
        if images.iter().flatten().any(|(_, image)| image.is_ok()) {
            return None;
        }
        let (texture, image) = images.into_iter().flatten().next()?;
        let uv_set = place_of_uv_set(texture, uv_sets).unwrap_or(0);
        Some(MissingNormalMap { image: image.as_ref().err()?.clone(), uv_set })
    }

    /// Lists the textures and layers of shading that have no place in glTF's metallic-roughness.
    fn list_losses(&mut self, material: &ufbx::Material) {
        let (pbr, fbx) = (&material.pbr, &material.fbx);
        let name = shortened(&material.element.name);
        let maps = [
            ("metalness", &pbr.metalness),
            ("roughness", &pbr.roughness),
            ("glossiness", &pbr.glossiness),
            ("specular colour", &pbr.specular_color),
            ("opacity", &pbr.opacity),
            ("displacement", &pbr.displacement_map),
            ("tangent", &pbr.tangent_map),
            ("coat normal", &pbr.coat_normal),
        ];
        // Some maps are one texture under several names: it is listed once.
        let mut known: HashSet<(bool, u32)> = [
            &pbr.base_color,
            &pbr.emission_color,
            &pbr.ambient_occlusion,
            &pbr.normal_map,
            &fbx.normal_map,
            &fbx.bump,
        ]
        .into_iter()
        .filter_map(identity_of_map)
        .collect();
        for (map_name, map) in maps {
            // The base colour's texture has opacity in its alpha.
            if let Some(id) = identity_of_map(map).filter(|id| map_name != "opacity" || !known.contains(id)) {
                self.not_carried.push(format!("the {map_name} texture of material {name:?}"));
                known.insert(id);
            }
        }
        for other in &material.textures {
            if known.insert(identity(&other.texture)) {
                let property = shortened(&other.material_prop);
                self.not_carried.push(format!("the texture of {property} of material {name:?}"));
            }
        }
        let layers = [
            ("coat", &pbr.coat_factor),
            ("sheen", &pbr.sheen_factor),
            ("transmission", &pbr.transmission_factor),
            ("subsurface scattering", &pbr.subsurface_factor),
            ("thin film", &pbr.thin_film_factor),
        ];
        for (layer, factor) in layers {
            let is_opacity = layer == "transmission" && is_classic(material);
            if !is_opacity && scalar(factor, 0.0) > 0.0 && !factor.feature_disabled {
                self.not_carried.push(format!("the {layer} of material {name:?}"));
            }
        }
    }

    /// The texture of a map: the first file, where the material layers or computes several.
    fn texture(&mut self, map: &MaterialMap, uv_sets: &[String]) -> Option<SourceTexture> {
        let (texture, with_file) = texture_of(map)?;
        let image = self.image(with_file.file_index)?;
        let wanted = shortened(&texture.uv_set);
        let uv_set = place_of_uv_set(texture, uv_sets);
        let name = &self.images[image].name;
        if uv_set.is_none() && !uv_sets.is_empty() && !["", "default"].contains(&&*wanted) {
            self.warnings.push(format!(
                "{name} is placed by the UV set {wanted:?}, which its mesh does not have; the first set is \
                 taken"
            ));
        }
        let uv_set = uv_set.unwrap_or(0);
        let layers = texture.file_textures.count;
        let placement = placement::of(with_file, self.convention);
        let losses = [
            (placement == Placement::Unknown, "the scale, rotation or offset of"),
            (!texture.has_file && layers > 1, "the layers of a texture but"),
        ];
        let losses = losses.into_iter().filter(|(is_lost, _)| *is_lost);
        self.not_carried.extend(losses.map(|(_, what)| format!("{what} {name}")));
        let transform = match placement {
            Placement::Moved(transform) => {
                if self.convention == Convention::Blender {
                    self.warnings.push(format!(
                        "{name} is placed as by a Mapping node of the type Texture; Blender's FBX does not \
                         say the type: with Point, export glTF"
                    ));
                }
                Some(transform)
            }
            Placement::Plain | Placement::Unknown => None,
        };
        let clamps = [with_file.wrap_u, with_file.wrap_v].map(|wrap| wrap == WrapMode::Clamp);
        Some(SourceTexture { image, uv_set, transform, clamps })
    }

    fn image(&mut self, file: u32) -> Option<usize> {
        if let Some(image) = self.image_of_file.get(&file) {
            return image.as_ref().ok().copied();
        }
        let read = self.scene.texture_files.get(file as usize).and_then(|file| self.read_image(file));
        let image = read?.map(|image| {
            self.images.push(image);
            self.images.len() - 1
        });
        let place = image.as_ref().ok().copied();
        self.image_of_file.insert(file, image);
        place
    }

    /// The bytes within the FBX, or of the file that it names: relative to the model, then as the exporter's
    /// machine had it. None where it names no file.
    fn read_image(&mut self, file: &TextureFile) -> Option<Result<SourceImage, MissingImage>> {
        let paths = [&*file.relative_filename, &*file.absolute_filename, &*file.filename];
        let mut references = paths.into_iter().filter(|path| !path.is_empty());
        let embedded = (!file.content.is_empty()).then_some("embedded texture");
        let first = references.clone().next().or(embedded)?;
        let name = first.rsplit(['/', '\\']).next().unwrap_or(first).to_owned();
        if !file.content.is_empty() {
            return Some(Ok(SourceImage { name, bytes: file.content.to_vec() }));
        }
        self.files.begin_reference();
        // A path that leads to the file comes before one of which only the name is found.
        let found: Vec<_> =
            references.by_ref().filter_map(|path| Some((path, self.files.find("", path)?))).collect();
        let best = found.iter().find(|(_, file)| !file.is_by_name).or_else(|| found.first());
        let Some((path, found)) = best else {
            self.warnings.push(format!("{}; the texture is left out", self.files.problem(first)));
            return Some(Err(self.files.missing_image(first)));
        };
        self.warnings.extend(ModelFiles::by_name_warning(path, found));
        Some(match self.files.read(found) {
            Ok(bytes) => Ok(SourceImage { name, bytes }),
            Err(error) => {
                let problem = format!("cannot be read: {error}");
                self.warnings.push(format!("{}: {problem}; the texture is left out", found.name));
                Err(MissingImage { name: found.name.clone(), problem, is_absent: true })
            }
        })
    }
}

/// The texture of a map, and the first one with a file, where the material layers or computes several.
fn texture_of(map: &MaterialMap) -> Option<(&Texture, &Texture)> {
    let texture: &Texture = map.texture.as_deref().filter(|_| map.texture_enabled)?;
    let with_file = if texture.has_file { texture } else { texture.file_textures.into_iter().next()? };
    Some((texture, with_file))
}

/// The index, among the UV sets of a mesh, of the set that each texture of a material names; 0 where the mesh
/// has none of this name.
pub fn places_of_uv_sets(material: &ufbx::Material, names: &[String]) -> Vec<usize> {
    let place = |texture: &Texture| place_of_uv_set(texture, names).unwrap_or(0);
    material.textures.iter().map(|found| place(&found.texture)).collect()
}

fn place_of_uv_set(texture: &Texture, names: &[String]) -> Option<usize> {
    let wanted = shortened(&texture.uv_set);
    names.iter().position(|name| *name == wanted)
}

/// The opacity. Lambert's and Phong's materials have the opposite: a factor and a colour. Programs write 1
/// and white for opaque materials, too, so that a material without any opacity is opaque.
fn opacity(material: &ufbx::Material) -> f32 {
    let (pbr, fbx) = (&material.pbr, &material.fbx);
    if !is_classic(material) {
        return scalar(&pbr.opacity, 1.0);
    }
    let [r, g, b] = color(&fbx.transparency_color, &fbx.transparency_factor).unwrap_or([0.0; 3]);
    let opacity = 1.0 - (r + g + b) / 3.0;
    if opacity > 0.0 && opacity < 1.0 { opacity } else { 1.0 }
}

/// Whether the shading is Lambert's or Phong's, without Blender's extensions.
fn is_classic(material: &ufbx::Material) -> bool {
    matches!(material.shader_type, ShaderType::FbxLambert | ShaderType::FbxPhong)
}

/// The roughness; some programs write its inverse.
fn roughness(material: &ufbx::Material) -> f32 {
    let pbr = &material.pbr;
    match material.features.roughness_as_glossiness.enabled {
        true if pbr.glossiness.has_value => 1.0 - scalar(&pbr.glossiness, 0.0),
        _ => scalar(&pbr.roughness, 1.0),
    }
}

/// What tells textures apart: their file, or their place in the scene.
fn identity(texture: &Texture) -> (bool, u32) {
    (texture.has_file, if texture.has_file { texture.file_index } else { texture.element.typed_id })
}

fn identity_of_map(map: &MaterialMap) -> Option<(bool, u32)> {
    map.texture.as_deref().filter(|_| map.texture_enabled).map(identity)
}

fn scalar(map: &MaterialMap, default: f32) -> f32 {
    if map.has_value { map.value_vec4.x as f32 } else { default }
}

/// A colour with its factor; none if the file has none.
fn color(map: &MaterialMap, factor: &MaterialMap) -> Option<[f32; 3]> {
    let value = map.value_vec4;
    let factor = scalar(factor, 1.0);
    map.has_value.then(|| [value.x, value.y, value.z].map(|channel| channel as f32 * factor))
}
