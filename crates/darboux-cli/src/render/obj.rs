//! An OBJ as a document, with the materials and textures of its folder.

use std::cell::RefCell;
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use darboux_io::gltf::{Document, LoadOptions};
use darboux_render::{is_colored, linear_of_srgb};
use serde_json::{Value, json};
use tobj::{LoadError, Material, Model};

use crate::view::obj::{folder_of, named, texture};

/// Reads an OBJ; gives what is odd about it, too. v runs down then, as in glTF. The error is a sentence.
pub fn open(path: &Path) -> Result<(Document, Vec<String>), String> {
    let shown = path.display().to_string();
    let folder = folder_of(path)?;
    let bytes = fs::read(path).map_err(|error| format!("{shown}: cannot be read: {error}"))?;
    let options =
        tobj::LoadOptions { triangulate: true, single_index: true, ignore_points: true, ignore_lines: true };
    let libraries = Libraries { folder, looks: RefCell::default(), warnings: RefCell::default() };
    // Comments and names may be in any encoding.
    let text = String::from_utf8_lossy(&bytes);
    let loaded = tobj::load_obj_buf(&mut text.as_bytes(), &options, |line| Ok(libraries.read(line)));
    let broken = |error: LoadError| format!("{shown}: is no OBJ that can be read ({error}); export it again");
    let (models, _) = loaded.map_err(broken)?;
    let mut glb = Glb { warnings: libraries.warnings.take(), ..Glb::default() };
    libraries.looks.take().iter().for_each(|look| glb.add_material(look));
    models.iter().filter(|model| !model.mesh.indices.is_empty()).for_each(|model| glb.add_mesh(model));
    if glb.meshes.is_empty() {
        return Err(format!("{shown}: has no faces as an OBJ has them; export it again"));
    }
    let warnings = std::mem::take(&mut glb.warnings);
    let bytes =
        glb.into_bytes().ok_or_else(|| format!("{shown}: is too large; export it as .glb in parts"))?;
    let document = Document::from_bytes(&shown, bytes, None, &LoadOptions::default());
    Ok((document.map_err(|error| error.to_string())?, warnings))
}

/// A material, its textures by their paths.
struct Look {
    name: String,
    /// In sRGB.
    color: [f32; 3],
    base: Option<PathBuf>,
    /// Of the statement `norm`.
    normal: Option<PathBuf>,
    /// Of the statements for heights, where many programs write normal maps.
    bump: Option<PathBuf>,
}

/// The material libraries of a folder.
struct Libraries {
    folder: PathBuf,
    /// All materials, in the order in which they were read, which is that of their indices.
    looks: RefCell<Vec<Look>>,
    warnings: RefCell<Vec<String>>,
}

impl Libraries {
    /// The materials of the libraries that a line names, and their places by name.
    fn read(&self, line: &Path) -> (Vec<Material>, HashMap<String, usize>) {
        let line = line.to_string_lossy();
        let mut materials = Vec::new();
        let libraries = named(&self.folder, line.as_bytes());
        if libraries.is_empty() {
            self.warn(format!("{line} is not in the model's folder, and its materials are missing"));
        }
        for library in libraries {
            let text = fs::read(&library.path).unwrap_or_default();
            match tobj::load_mtl_buf(&mut String::from_utf8_lossy(&text).as_bytes()) {
                Ok((found, _)) => {
                    self.looks.borrow_mut().extend(found.iter().map(|found| self.look(&library.name, found)));
                    materials.extend(found);
                }
                Err(error) => {
                    self.warn(format!("{}: cannot be read ({error}); export it again", library.name))
                }
            }
        }
        let places = materials.iter().enumerate().map(|(at, found)| (found.name.clone(), at)).collect();
        (materials, places)
    }

    fn look(&self, library: &str, material: &Material) -> Look {
        let located = |line: Option<&String>| {
            let line = line?;
            let found = texture(&self.folder, library, line.as_bytes());
            if found.is_none() {
                self.warn(format!("{library}: {line} is not in the model's folder; drawn without it"));
            }
            Some(found?.path)
        };
        Look {
            name: material.name.clone(),
            color: material.diffuse.unwrap_or([1.0; 3]),
            base: located(material.diffuse_texture.as_ref()),
            normal: located(material.unknown_param.get("norm")),
            bump: located(material.normal_texture.as_ref()),
        }
    }

    fn warn(&self, sentence: String) {
        self.warnings.borrow_mut().push(sentence);
    }
}

/// A document as it grows.
#[derive(Default)]
struct Glb {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    images: Vec<Value>,
    texture_of: HashMap<PathBuf, usize>,
    materials: Vec<Value>,
    meshes: Vec<Value>,
    warnings: Vec<String>,
}

impl Glb {
    fn add_material(&mut self, look: &Look) {
        // What is no number is as if it were not said.
        let said = |channel: f32| if channel.is_finite() { f64::from(channel.clamp(0.0, 1.0)) } else { 1.0 };
        let [r, g, b] = look.color.map(|channel| linear_of_srgb(said(channel)));
        let base = look.base.as_deref().and_then(|path| self.texture(path));
        let normal = look.normal.as_deref().or_else(|| self.normal_map_in_bump(look));
        let normal = normal.and_then(|path| self.texture(path));
        let mut material =
            json!({"name": look.name, "pbrMetallicRoughness": {"baseColorFactor": [r, g, b, 1.0]}});
        if let Some(index) = base {
            material["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": index});
        }
        if let Some(index) = normal {
            material["normalTexture"] = json!({"index": index});
        }
        self.materials.push(material);
    }

    /// The bump map of a material, unless it is grey.
    fn normal_map_in_bump<'a>(&mut self, look: &'a Look) -> Option<&'a Path> {
        let path = look.bump.as_deref()?;
        if fs::read(path).ok().and_then(|bytes| is_colored(&bytes)) == Some(false) {
            self.warnings.push(format!(
                "the bump map of {} is grey, so it holds heights, which are not shown; normal maps are coloured",
                look.name
            ));
            return None;
        }
        Some(path)
    }

    /// The index of the texture of a file; none where it cannot be read.
    fn texture(&mut self, path: &Path) -> Option<usize> {
        if let Some(&index) = self.texture_of.get(path) {
            return Some(index);
        }
        let bytes = match fs::read(path) {
            Ok(bytes) => bytes,
            Err(error) => {
                self.warnings.push(format!("{}: cannot be read: {error}; drawn without it", path.display()));
                return None;
            }
        };
        let view = self.view(&bytes);
        self.images.push(json!({"bufferView": view}));
        self.texture_of.insert(path.to_owned(), self.images.len() - 1);
        Some(self.images.len() - 1)
    }

    fn add_mesh(&mut self, model: &Model) {
        let mesh = &model.mesh;
        let count = mesh.positions.len() / 3;
        let mut attributes = json!({"POSITION": self.floats(&mesh.positions, "VEC3")});
        if mesh.normals.len() == 3 * count {
            attributes["NORMAL"] = self.floats(&mesh.normals, "VEC3").into();
        }
        if mesh.texcoords.len() == 2 * count {
            let down: Vec<f32> =
                mesh.texcoords.as_chunks().0.iter().flat_map(|&[u, v]| [u, 1.0 - v]).collect();
            attributes["TEXCOORD_0"] = self.floats(&down, "VEC2").into();
        }
        let indices: Vec<u8> = mesh.indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let indices = self.accessor(&indices, UNSIGNED_INT, mesh.indices.len(), "SCALAR");
        let mut primitive = json!({"attributes": attributes, "indices": indices});
        if let Some(material) = mesh.material_id.filter(|&material| material < self.materials.len()) {
            primitive["material"] = material.into();
        }
        self.meshes.push(json!({"name": model.name, "primitives": [primitive]}));
    }

    fn floats(&mut self, floats: &[f32], kind: &str) -> usize {
        let bytes: Vec<u8> = floats.iter().flat_map(|x| x.to_le_bytes()).collect();
        let components = if kind == "VEC2" { 2 } else { 3 };
        self.accessor(&bytes, FLOAT, floats.len() / components, kind)
    }

    fn accessor(&mut self, bytes: &[u8], component: u32, count: usize, kind: &str) -> usize {
        let view = self.view(bytes);
        self.accessors
            .push(json!({"bufferView": view, "componentType": component, "count": count, "type": kind}));
        self.accessors.len() - 1
    }

    fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()}));
        self.bytes.extend(bytes);
        self.views.len() - 1
    }

    /// The document as a GLB; none where that would be larger than GLBs can be.
    fn into_bytes(mut self) -> Option<Vec<u8>> {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let nodes: Vec<Value> = (0..self.meshes.len()).map(|mesh| json!({"mesh": mesh})).collect();
        let textures: Vec<Value> = (0..self.images.len()).map(|image| json!({"source": image})).collect();
        let mut document = json!({
            "asset": {"version": "2.0"},
            "nodes": nodes,
            "meshes": self.meshes,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": self.bytes.len()}],
        });
        for (name, list) in [("materials", self.materials), ("images", self.images), ("textures", textures)] {
            if !list.is_empty() {
                document[name] = list.into();
            }
        }
        glb_of(document.to_string(), &self.bytes)
    }
}

/// OpenGL's numbers, which glTF uses.
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;

/// The container (glTF 2.0, 4.4).
fn glb_of(json: String, bytes: &[u8]) -> Option<Vec<u8>> {
    let mut json = json.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let lens = [12 + 8 + json.len() + 8 + bytes.len(), json.len(), bytes.len()].map(u32::try_from);
    let [Ok(whole), Ok(text), Ok(binary)] = lens else { return None };
    let word = u32::to_le_bytes;
    let head = [&b"glTF"[..], &word(2), &word(whole), &word(text), b"JSON"].concat();
    Some([&head, &json[..], &word(binary), b"BIN\0", bytes].concat())
}
