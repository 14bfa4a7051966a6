//! Builds a glTF document, as the bytes of a GLB, from the meshes and materials of an OBJ.

use std::collections::HashMap;
use std::path::PathBuf;

use serde_json::{Value, json};
use tobj::Model;

use super::companions::Companion;
use super::libraries::LibraryMaterial;
use crate::error::{ContentError, system_reason};
use crate::gltf::{ComponentType, ElementType, container, segments};
use crate::image::{DecodeLimits, RgbaImage, srgb_to_linear};

/// The lists of a glTF document while they grow, and its binary chunk.
#[derive(Default)]
pub struct DocumentBuilder {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    images: Vec<Value>,
    image_of_file: HashMap<PathBuf, usize>,
    materials: Vec<Value>,
    meshes: Vec<Value>,
    /// One sentence for each texture that was left out.
    pub warnings: Vec<String>,
}

impl DocumentBuilder {
    /// Adds a material and embeds its textures. Channels that are not finite count as 1.
    pub fn add_material(&mut self, material: &LibraryMaterial) {
        let finite =
            |channel: f32| if channel.is_finite() { f64::from(channel.clamp(0.0, 1.0)) } else { 1.0 };
        let [r, g, b] = material.color.map(|channel| srgb_to_linear(finite(channel)));
        let color_texture = material.color_texture.as_ref().and_then(|file| self.texture(file));
        let normal_map = material.normal_texture.as_ref().or_else(|| self.normal_map_in_bump(material));
        let normal_map = normal_map.and_then(|file| self.texture(file));
        let mut json =
            json!({"name": material.name, "pbrMetallicRoughness": {"baseColorFactor": [r, g, b, 1.0]}});
        if let Some(index) = color_texture {
            json["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": index});
        }
        if let Some(index) = normal_map {
            json["normalTexture"] = json!({"index": index});
        }
        self.materials.push(json);
    }

    /// The bump map of a material, unless its texels are grey, as those of height maps are.
    fn normal_map_in_bump<'a>(&mut self, material: &'a LibraryMaterial) -> Option<&'a Companion> {
        let file = material.bump_texture.as_ref()?;
        let image =
            file.read().ok().and_then(|bytes| RgbaImage::decode(&bytes, &DecodeLimits::default()).ok());
        if image.is_some_and(|image| !image.is_colored()) {
            self.warnings.push(format!(
                "the bump map of {} is grey, so it holds heights and is left out; normal maps are coloured",
                material.name
            ));
            return None;
        }
        Some(file)
    }

    /// The index of the texture of a file; none when the file cannot be read.
    fn texture(&mut self, file: &Companion) -> Option<usize> {
        if let Some(&index) = self.image_of_file.get(&file.path) {
            return Some(index);
        }
        let bytes = match file.read() {
            Ok(bytes) => bytes,
            Err(error) => {
                self.warnings.push(format!(
                    "{}: cannot be read: {}; the texture is left out",
                    file.name,
                    system_reason(&error)
                ));
                return None;
            }
        };
        let view = self.push_view(&bytes);
        self.images.push(json!({"bufferView": view}));
        self.image_of_file.insert(file.path.clone(), self.images.len() - 1);
        Some(self.images.len() - 1)
    }

    /// Adds a mesh of one primitive. UVs and normals that some corners lack are left out.
    pub fn add_mesh(&mut self, model: &Model) {
        let mesh = &model.mesh;
        let count = mesh.positions.len() / 3;
        let mut attributes = json!({"POSITION": self.push_floats(&mesh.positions, ElementType::Vec3)});
        if mesh.normals.len() == 3 * count {
            attributes["NORMAL"] = self.push_floats(&mesh.normals, ElementType::Vec3).into();
        }
        if mesh.texcoords.len() == 2 * count {
            let flipped: Vec<f32> =
                mesh.texcoords.as_chunks().0.iter().flat_map(|&[u, v]| [u, 1.0 - v]).collect();
            attributes["TEXCOORD_0"] = self.push_floats(&flipped, ElementType::Vec2).into();
        }
        let indices: Vec<u8> = mesh.indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let indices =
            self.push_accessor(&indices, ComponentType::U32, mesh.indices.len(), ElementType::Scalar);
        let mut primitive = json!({"attributes": attributes, "indices": indices});
        if let Some(material) = mesh.material_id.filter(|&material| material < self.materials.len()) {
            primitive["material"] = material.into();
        }
        self.meshes.push(json!({"name": model.name, "primitives": [primitive]}));
    }

    /// Whether a mesh was added.
    pub fn has_meshes(&self) -> bool {
        !self.meshes.is_empty()
    }

    fn push_floats(&mut self, floats: &[f32], kind: ElementType) -> usize {
        let bytes: Vec<u8> = floats.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.push_accessor(&bytes, ComponentType::F32, floats.len() / kind.components(), kind)
    }

    fn push_accessor(
        &mut self,
        bytes: &[u8],
        component: ComponentType,
        count: usize,
        kind: ElementType,
    ) -> usize {
        let view = self.push_view(bytes);
        let (component, kind) = (component.code(), kind.name());
        self.accessors
            .push(json!({"bufferView": view, "componentType": component, "count": count, "type": kind}));
        self.accessors.len() - 1
    }

    fn push_view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()}));
        self.bytes.extend(bytes);
        self.views.len() - 1
    }

    /// The document as a GLB. Errors: more than the 4 GiB that a GLB can hold.
    pub fn into_glb(self) -> Result<Vec<u8>, ContentError> {
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
        let chunk = vec![segments::Segment::Borrowed(&self.bytes)];
        let glb = container::glb(document.to_string().into_bytes(), Some(chunk), Vec::new())?;
        Ok(segments::joined(&glb))
    }
}
