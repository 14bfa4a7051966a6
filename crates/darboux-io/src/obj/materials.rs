//! The materials of an OBJ: loads the libraries that it names, and finds their textures.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::path::PathBuf;

use super::lookup;
use super::mtl::{self, MtlMaterial};
use super::texture_map::MtlMap;
use crate::code_page::decoded;
use crate::error::{shortened, system_reason};
use crate::git_lfs;
use crate::image::{DecodeLimits, RgbaImage, srgb_to_linear};
use crate::source::{
    FoundFile, MissingImage, MissingNormalMap, ModelFiles, NormalMap, SourceImage, SourceMaterial,
    SourceScene, SourceTexture,
};
use crate::words::counted;

/// The libraries that an OBJ names, loaded while their names are met. Each library is loaded once.
pub struct Materials<'a> {
    files: &'a ModelFiles,
    loaded: HashSet<PathBuf>,
    lines: HashSet<Vec<u8>>,
    index_of_name: HashMap<Vec<u8>, u32>,
    materials: Vec<SourceMaterial>,
    images: Vec<SourceImage>,
    image_of_file: HashMap<PathBuf, Result<usize, MissingImage>>,
    /// The images of bump statements that were decoded: whether they are heights.
    is_grey: HashMap<usize, bool>,
    image_of_statement: HashMap<(String, String), Result<usize, MissingImage>>,
    /// The name of the last `usemtl` statement.
    name: Vec<u8>,
    /// Names of faces' materials that no library has, or not yet: materials with a name only.
    unknown: HashSet<Vec<u8>>,
    /// The materials that lose a statement, by the statement.
    lost: BTreeMap<String, usize>,
    warnings: Vec<String>,
}

impl<'a> Materials<'a> {
    pub fn new(files: &'a ModelFiles) -> Self {
        Self {
            files,
            loaded: HashSet::new(),
            lines: HashSet::new(),
            index_of_name: HashMap::new(),
            materials: Vec::new(),
            images: Vec::new(),
            image_of_file: HashMap::new(),
            is_grey: HashMap::new(),
            image_of_statement: HashMap::new(),
            name: Vec::new(),
            unknown: HashSet::new(),
            lost: BTreeMap::new(),
            warnings: Vec::new(),
        }
    }

    /// The material of a `usemtl` statement; none for a name that no library has so far.
    pub fn choose(&mut self, name: &[u8]) -> Option<u32> {
        self.name.clear();
        self.name.extend_from_slice(name);
        self.index_of_name.get(name).copied()
    }

    /// The material of a face after a `usemtl` statement whose name no library has so far: one with that name
    /// only, which a later library may fill. None before the first such statement and for an empty name.
    pub fn with_name_only(&mut self) -> Option<u32> {
        if self.name.is_empty() {
            return None;
        }
        if let Some(&index) = self.index_of_name.get(&self.name) {
            return Some(index);
        }
        let index = self.materials.len() as u32;
        let name = decoded(&self.name).into_owned();
        let made = self.material("", &MtlMaterial { name, ..MtlMaterial::default() }, true);
        self.materials.push(made);
        self.index_of_name.insert(self.name.clone(), index);
        self.unknown.insert(self.name.clone());
        Some(index)
    }

    /// Loads the libraries of a `mtllib` statement: one whose name may contain spaces, or several.
    pub fn load(&mut self, line: &[u8]) {
        if !self.lines.insert(line.to_owned()) {
            return;
        }
        let found = lookup::libraries(self.files, line);
        let left_out = |name: &str| format!("{}; its materials are left out", self.files.problem(name));
        if found.iter().all(Result::is_err) {
            // One name with spaces, as far as anyone can tell.
            self.warnings.push(left_out(&decoded(line)));
            return;
        }
        self.warnings
            .extend(found.iter().filter_map(|found| found.as_ref().err()).map(|name| left_out(name)));
        for (reference, library) in found.into_iter().flatten() {
            if !self.loaded.insert(library.path.clone()) {
                continue;
            }
            self.warnings.extend(ModelFiles::by_name_warning(&reference, &library));
            match self.files.read(&library) {
                Ok(text) if git_lfs::is_pointer(&text) => self.warnings.push(format!(
                    "{}: {}; its materials are left out",
                    library.name,
                    git_lfs::NOT_THE_FILE
                )),
                Ok(text) => {
                    let is_linear = mtl::has_linear_colors(&text);
                    let materials = mtl::parse(&text).into_iter();
                    materials.for_each(|material| self.add(&library.name, &material, is_linear));
                }
                Err(error) => self.warnings.push(format!(
                    "{}: cannot be read: {}; its materials are left out",
                    library.name,
                    system_reason(&error)
                )),
            }
        }
    }

    fn add(&mut self, library: &str, material: &MtlMaterial, is_linear: bool) {
        let made = self.material(library, material, is_linear);
        self.count_lost(material);
        if self.unknown.remove(&material.name_bytes) {
            let index = self.index_of_name[&material.name_bytes];
            self.materials[index as usize] = made;
            return;
        }
        self.index_of_name.insert(material.name_bytes.clone(), self.materials.len() as u32);
        self.materials.push(made);
    }

    fn material(&mut self, library: &str, material: &MtlMaterial, is_linear: bool) -> SourceMaterial {
        let linear = |color: [f32; 3]| {
            color.map(|x| x.max(0.0)).map(|x| if is_linear { x } else { srgb_to_linear(f64::from(x)) as f32 })
        };
        let [r, g, b] = linear(material.diffuse.unwrap_or([1.0; 3]).map(|x| x.min(1.0)));
        let alpha = material.opacity.filter(|opacity| *opacity > 0.0 && *opacity < 1.0);
        let is_packed = is_packed(material);
        let emissive_texture = self.texture(library, material.emissive_map.as_ref());
        let emissive = material.emissive.map(linear).filter(|color| *color != [0.0; 3]);
        let packed = material.roughness_map.as_ref().filter(|_| is_packed);
        SourceMaterial {
            name: material.name.clone(),
            base_color: Some([r, g, b, alpha.unwrap_or(1.0)]),
            base_color_texture: self.texture(library, material.diffuse_map.as_ref()),
            metallic: Some(material.metallic.unwrap_or(if is_packed { 1.0 } else { 0.0 })),
            roughness: material.roughness.or_else(|| material.shininess.map(roughness)),
            metallic_roughness_texture: self.texture(library, packed),
            normal_map: self.normal_map(library, material),
            missing_normal_map: self.missing_normal_map(library, material),
            // A map without a colour shines as it is.
            emissive: emissive.or(emissive_texture.as_ref().map(|_| [1.0; 3])),
            emissive_texture,
            is_transparent: alpha.is_some(),
            ..SourceMaterial::default()
        }
    }

    /// Counts what a material loses.
    fn count_lost(&mut self, material: &MtlMaterial) {
        let mut lost: BTreeSet<&str> = material.lost.iter().map(String::as_str).collect();
        for (statement, map) in [("map_Pr", &material.roughness_map), ("map_Pm", &material.metallic_map)] {
            if map.is_some() && !is_packed(material) {
                lost.insert(statement);
            }
        }
        if material.maps().any(|map| map.has_options) {
            lost.insert("options of textures");
        }
        lost.into_iter().for_each(|what| *self.lost.entry(what.to_owned()).or_default() += 1);
    }

    /// The map of `norm`, or of the bump statements, unless its texels are grey, as in height maps.
    fn normal_map(&mut self, library: &str, material: &MtlMaterial) -> Option<NormalMap> {
        if let Some(map) = &material.normal_map {
            let texture = self.texture(library, Some(map))?;
            return Some(NormalMap { texture, scale: map.multiplier });
        }
        let map = material.bump_map.as_ref()?;
        let texture = self.texture(library, Some(map))?;
        let (bytes, limit) = (&self.images[texture.image].bytes, self.files.memory_limit());
        let is_grey = self.is_grey.entry(texture.image).or_insert_with(|| {
            let image = RgbaImage::decode(bytes, &DecodeLimits::of_file(bytes.len(), limit));
            image.is_ok_and(|image| !image.is_colored())
        });
        if *is_grey {
            self.warnings.push(format!(
                "the bump map of {} is grey, so it holds heights and is left out; normal maps are coloured",
                material.name
            ));
            return None;
        }
        Some(NormalMap { texture, scale: map.multiplier })
    }

    /// The map of `norm` whose file was not read. One of the bump statements may hold heights.
    fn missing_normal_map(&self, library: &str, material: &MtlMaterial) -> Option<MissingNormalMap> {
        let statement = material.normal_map.as_ref()?.statement.clone();
        let image = self.image_of_statement.get(&(library.to_owned(), statement))?.as_ref().err()?;
        Some(MissingNormalMap { image: image.clone(), uv_set: 0 })
    }

    fn texture(&mut self, library: &str, map: Option<&MtlMap>) -> Option<SourceTexture> {
        let map = map?;
        let key = (library.to_owned(), map.statement.clone());
        let image = match self.image_of_statement.get(&key) {
            Some(image) => image.as_ref().ok().copied(),
            None => {
                let found = self.find_image(library, map);
                let image = found.as_ref().ok().copied();
                self.image_of_statement.insert(key, found);
                image
            }
        };
        Some(SourceTexture {
            image: image?,
            transform: map.transform(),
            clamps: [map.is_clamped; 2],
            ..SourceTexture::default()
        })
    }

    fn find_image(&mut self, library: &str, map: &MtlMap) -> Result<usize, MissingImage> {
        let Some((reference, file)) = lookup::texture(self.files, library, map) else {
            let reference = lookup::without_quotes(&map.file).unwrap_or(&map.file);
            let problem = self.files.problem(reference);
            self.warnings.push(format!("{library}: {problem}; the texture is left out"));
            return Err(self.files.missing_image(reference));
        };
        self.warnings.extend(ModelFiles::by_name_warning(&reference, &file));
        self.image(file)
    }

    fn image(&mut self, file: FoundFile) -> Result<usize, MissingImage> {
        if let Some(image) = self.image_of_file.get(&file.path) {
            return image.clone();
        }
        let image = match self.files.read(&file) {
            Ok(bytes) => {
                self.images.push(SourceImage { name: file.name, bytes });
                Ok(self.images.len() - 1)
            }
            Err(error) => {
                let problem = format!("cannot be read: {}", system_reason(&error));
                self.warnings.push(format!("{}: {problem}; the texture is left out", file.name));
                Err(MissingImage { name: file.name, problem, is_absent: true })
            }
        };
        self.image_of_file.insert(file.path, image.clone());
        image
    }

    /// Moves everything into a scene.
    pub fn finish(self, scene: &mut SourceScene) {
        scene.warnings.extend(self.warnings);
        let names = self.unknown.iter().map(|name| shortened(&decoded(name)));
        scene.warnings.extend(unknown_warning(names.collect()));
        let lost = self.lost.into_iter().map(|(statement, materials)| {
            format!("{statement} of {}", counted(materials, "material", "materials"))
        });
        scene.not_carried.extend(lost);
        scene.materials = self.materials;
        scene.images = self.images;
    }
}

/// A sentence about materials that no library has; none for none.
fn unknown_warning(mut names: Vec<String>) -> Option<String> {
    const MOST: usize = 5;
    names.sort_unstable();
    let (shown, others) = names.split_at(names.len().min(MOST));
    const MADE: &str = "they are kept with default values";
    Some(match (shown, others.len()) {
        ([], _) => return None,
        ([name], _) => {
            format!("no library has the material {name}; it is kept with default values")
        }
        (_, 0) => format!("no library has the materials {}; {MADE}", shown.join(", ")),
        (_, others) => {
            format!("no library has the materials {} and {others} more; {MADE}", shown.join(", "))
        }
    })
}

/// Whether one file holds roughness and metalness, as glTF has them.
fn is_packed(material: &MtlMaterial) -> bool {
    material.roughness_map.is_some() && material.roughness_map == material.metallic_map
}

/// The roughness of a shininess, as Blender relates them.
fn roughness(shininess: f32) -> f32 {
    1.0 - (shininess.clamp(0.0, 1000.0) / 1000.0).sqrt()
}
