//! Gives materials a normal map, and paints them.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use crate::Error;
use crate::error::ContentError;
use crate::gltf::schema::{Image, Material, Primitive};
use crate::gltf::{Document, PrimitiveName, json};

/// A primitive that gets a normal map, and the UV set n of `TEXCOORD_n` that the map uses.
type MappedPrimitive = (PrimitiveName, usize);

impl Document {
    /// Gives the materials of primitives one new normal map, embedded as a PNG. Primitives without a material get a new one.
    ///
    /// The scale of an existing normal map is dropped. Its texture transform is kept where the UV set stays. A material that other primitives
    /// have, too, changes for all of them. Errors: a primitive that does not exist; a material that cannot be edited.
    pub fn set_normal_map(
        &mut self,
        png: Vec<u8>,
        name: &str,
        primitives: &[MappedPrimitive],
    ) -> Result<(), Error> {
        let texture = self.push_texture(png, name);
        let mut without_material = BTreeMap::new();
        for (primitive, uv_set) in primitives {
            match self.primitive(primitive)?.material {
                Some(material) => {
                    let edited = self.set_normal_texture(material, texture, *uv_set);
                    edited.map_err(|error| error.in_file(self.name()))?;
                }
                None => {
                    let new = *without_material
                        .entry(*uv_set)
                        .or_insert_with(|| self.push_material(texture, *uv_set));
                    self.edit_primitive(primitive.mesh, primitive.primitive, |json| {
                        json.insert("material".to_owned(), new.into());
                    })?;
                }
            }
        }
        Ok(())
    }

    /// Paints primitives: replaces their materials by unlit ones (`KHR_materials_unlit`) with a new base colour, embedded as a PNG, which uses the
    /// UVs of the normal map. Light would change the colours, and the normal map more so.
    ///
    /// Primitives whose material has no normal map stay as they are. A material that other primitives have, too, changes for all of them.
    /// Errors: a primitive that does not exist; a material that cannot be edited.
    pub fn paint(&mut self, png: Vec<u8>, name: &str, primitives: &[PrimitiveName]) -> Result<(), Error> {
        let texture = self.push_texture(png, name);
        self.use_extension(UNLIT);
        for primitive in primitives {
            if let Some(material) = self.primitive(primitive)?.material {
                let painted = self.edit_element("materials", material, |material| paint(material, texture));
                painted.map_err(|error| error.in_file(self.name()))?;
            }
        }
        Ok(())
    }

    pub(in crate::gltf) fn primitive(&self, name: &PrimitiveName) -> Result<&Primitive, Error> {
        let stored = self.root.meshes.get(name.mesh).and_then(|mesh| mesh.primitives.get(name.primitive));
        stored.ok_or_else(|| self.invalid(name.path(), "does not exist; name one of the document"))
    }

    /// Appends an image and a texture with it. Returns the index of the texture.
    fn push_texture(&mut self, png: Vec<u8>, name: &str) -> usize {
        let (media_type, view) = ("image/png", self.push_view(png, 1, 1, None));
        self.root.images.push(Image {
            uri: None,
            buffer_view: Some(view),
            mime_type: Some(media_type.to_owned()),
        });
        let image =
            self.push_element("images", json!({ "name": name, "mimeType": media_type, "bufferView": view }));
        self.push_element("textures", json!({ "source": image }))
    }

    /// Appends a material with a normal map. Returns its index.
    fn push_material(&mut self, texture: usize, uv_set: usize) -> usize {
        let material = json!({ "normalTexture": { "index": texture, "texCoord": uv_set } });
        self.root.materials.push(json::read(&material, "").unwrap_or_default());
        self.push_element("materials", material)
    }

    fn set_normal_texture(
        &mut self,
        material: usize,
        texture: usize,
        uv_set: usize,
    ) -> Result<bool, ContentError> {
        let keeps_transform =
            self.root.materials.get(material).is_some_and(|stored| uses_set(stored, uv_set));
        self.edit_element("materials", material, |material| {
            let old = material["normalTexture"].take();
            let mut new = json!({ "index": texture, "texCoord": uv_set });
            if let Some(extensions) = old.get("extensions").filter(|_| keeps_transform) {
                new["extensions"] = extensions.clone();
            }
            material["normalTexture"] = new;
        })
    }
}

/// Whether a material's normal map uses the UV set n of `TEXCOORD_n`.
fn uses_set(material: &Material, uv_set: usize) -> bool {
    material.normal_texture.as_ref().is_some_and(|texture| {
        let of_transform = texture.extensions.transform.as_ref().and_then(|transform| transform.tex_coord);
        of_transform.unwrap_or(texture.tex_coord) == uv_set
    })
}

const UNLIT: &str = "KHR_materials_unlit";

/// Makes a material unlit, with a texture as its colour that uses the UVs of the normal map, if it has a normal map.
fn paint(material: &mut Value, texture: usize) {
    let Some(normal) = material.get("normalTexture") else { return };
    let mut color = normal.clone();
    color["index"] = texture.into();
    if let Some(color) = color.as_object_mut() {
        color.shift_remove("scale");
    }
    *material = json!({
        "doubleSided": material.get("doubleSided").unwrap_or(&Value::Bool(false)),
        "extensions": { UNLIT: {} },
        "pbrMetallicRoughness": { "baseColorTexture": color, "metallicFactor": 0, "roughnessFactor": 0.9 },
    });
}
