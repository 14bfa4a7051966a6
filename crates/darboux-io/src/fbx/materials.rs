//! Materials with their textures, as metallic-roughness shading.

use std::collections::HashMap;

use darboux::BitangentDirection;
use ufbx::{Exporter, MaterialMap, Scene, Texture, TextureFile};

use crate::error::shortened;
use crate::image::{DecodeLimits, RgbaImage};
use crate::source::{ModelFiles, NormalMap, SourceImage, SourceMaterial, SourceTexture};

/// Reads the materials of a scene with their images.
pub struct MaterialReader<'a> {
    scene: &'a Scene,
    files: &'a ModelFiles,
    /// What green means in normal maps, where the program that wrote the file decides it.
    green: Option<BitangentDirection>,
    /// The image of each texture file; none for those that cannot be read.
    image_of_file: HashMap<u32, Option<usize>>,
    pub images: Vec<SourceImage>,
    pub warnings: Vec<String>,
    pub not_carried: Vec<String>,
}

impl<'a> MaterialReader<'a> {
    pub fn new(scene: &'a Scene, files: &'a ModelFiles) -> Self {
        // Blender's normal maps have green up. FBX itself does not say it, and other programs write either.
        let is_blenders = matches!(scene.metadata.exporter, Exporter::BlenderBinary | Exporter::BlenderAscii);
        Self {
            scene,
            files,
            green: is_blenders.then_some(BitangentDirection::Up),
            image_of_file: HashMap::new(),
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
        let opacity = scalar(&pbr.opacity, 1.0);
        let [r, g, b] = color(&pbr.base_color, &pbr.base_factor).unwrap_or([1.0; 3]);
        self.list_other_textures(material);
        SourceMaterial {
            name: material.element.name.to_string(),
            base_color: Some([r, g, b, opacity]),
            base_color_texture: self.texture(&pbr.base_color, uv_sets),
            metallic: Some(scalar(&pbr.metalness, 0.0)),
            roughness: Some(scalar(&pbr.roughness, 1.0)),
            normal_map: self.normal_map(material, uv_sets),
            emissive: color(&pbr.emission_color, &pbr.emission_factor).filter(|color| *color != [0.0; 3]),
            emissive_texture: self.texture(&pbr.emission_color, uv_sets),
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
                let image = RgbaImage::decode(&self.images[texture.image].bytes, &DecodeLimits::default());
                if image.is_ok_and(|image| !image.is_colored()) {
                    self.warnings.push(format!(
                        "the bump map of material {name:?} is grey, so it holds heights and is left out; normal maps are coloured"
                    ));
                    return None;
                }
                texture
            }
        };
        if self.green.is_none() {
            self.warnings.push(format!(
                "FBX does not say whether green points up or down in the normal map of material {name:?}; it is taken as glTF's, up: darboux check judges the image"
            ));
        }
        Some(NormalMap { texture, scale: None, green: self.green })
    }

    fn list_other_textures(&mut self, material: &ufbx::Material) {
        let pbr = &material.pbr;
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
        for (name, _) in maps.into_iter().filter(|(_, map)| map.texture_enabled && map.texture.is_some()) {
            self.not_carried
                .push(format!("the {name} texture of material {:?}", shortened(&material.element.name)));
        }
    }

    /// The texture of a map: the first file, where the material layers or computes several.
    fn texture(&mut self, map: &MaterialMap, uv_sets: &[String]) -> Option<SourceTexture> {
        let texture: &Texture = map.texture.as_deref().filter(|_| map.texture_enabled)?;
        let with_file = if texture.has_file { texture } else { texture.file_textures.into_iter().next()? };
        let image = self.image(with_file.file_index)?;
        let uv_set = uv_sets.iter().position(|name| *name == *texture.uv_set).unwrap_or(0);
        if with_file.has_uv_transform {
            self.not_carried.push(format!("the scale, rotation or offset of {}", self.images[image].name));
        }
        Some(SourceTexture { image, uv_set, transform: None })
    }

    fn image(&mut self, file: u32) -> Option<usize> {
        if let Some(&image) = self.image_of_file.get(&file) {
            return image;
        }
        let image = self.scene.texture_files.get(file as usize).and_then(|file| self.read_image(file));
        let place = image.map(|image| {
            self.images.push(image);
            self.images.len() - 1
        });
        self.image_of_file.insert(file, place);
        place
    }

    /// The bytes within the FBX, or those of the file that it names: relative to the model, then as the exporter's machine had it.
    fn read_image(&mut self, file: &TextureFile) -> Option<SourceImage> {
        let paths = [&*file.relative_filename, &*file.absolute_filename, &*file.filename];
        let mut references = paths.into_iter().filter(|path| !path.is_empty());
        let embedded = (!file.content.is_empty()).then_some("embedded texture");
        let first = references.clone().next().or(embedded)?;
        let name = first.rsplit(['/', '\\']).next().unwrap_or(first).to_owned();
        if !file.content.is_empty() {
            return Some(SourceImage { name, bytes: file.content.to_vec() });
        }
        // A path that leads to the file comes before one of which only the name is found.
        let found: Vec<_> =
            references.by_ref().filter_map(|path| Some((path, self.files.find("", path)?))).collect();
        let best = found.iter().find(|(_, file)| !file.is_by_name).or_else(|| found.first());
        let Some((path, found)) = best else {
            self.warnings.push(format!("{}; the texture is left out", self.files.problem(first)));
            return None;
        };
        self.warnings.extend(ModelFiles::by_name_warning(path, found));
        match self.files.read(found) {
            Ok(bytes) => Some(SourceImage { name, bytes }),
            Err(error) => {
                self.warnings
                    .push(format!("{}: cannot be read: {error}; the texture is left out", found.name));
                None
            }
        }
    }
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
