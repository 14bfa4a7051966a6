//! Gives materials a normal map, and paints them.

use std::collections::BTreeMap;

use serde_json::value::RawValue;

use super::document::Document;
use super::json_text::{member, quoted, set_member};
use super::primitives::name::PrimitiveName;
use super::schema::{Material, TextureInfo};
use crate::Error;
use crate::error::ContentError;

/// A primitive that gets a normal map, and the UV set n of `TEXCOORD_n` that the map uses.
type MappedPrimitive = (PrimitiveName, usize);

impl Document {
    /// Gives the materials of primitives one new normal map, embedded as a PNG. Primitives without a material get a new one.
    ///
    /// The scale of an existing normal map is dropped. Its texture transform is kept where the UV set stays. A material that other primitives
    /// have, too, changes for all of them. [`Document::appearances`] shows the materials as they were read. Errors: a primitive that does not
    /// exist; a material that cannot be edited.
    pub fn set_normal_map(
        &mut self,
        png: Vec<u8>,
        name: &str,
        primitives: &[MappedPrimitive],
    ) -> Result<(), Error> {
        let broken = |error: serde_json::Error| {
            ContentError::invalid("materials", format!("cannot be edited: {error}; export it again"))
        };
        let texture = self.push_texture(png, name).map_err(broken);
        let texture = texture.map_err(|error| error.in_file(self.name()))?;
        let mut without_material = BTreeMap::new();
        for (primitive, uv_set) in primitives {
            let stored = self.root.meshes.get(primitive.mesh);
            let stored = stored.and_then(|mesh| mesh.primitives.get(primitive.primitive));
            let Some(stored) = stored else {
                return Err(self.invalid(primitive.path(), "does not exist; name one of the document"));
            };
            match stored.material {
                Some(material) => {
                    let edited = self.edit_normal_texture(material, texture, *uv_set).map_err(broken);
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

    /// Paints primitives: replaces their materials by matte ones with their normal map and a new base colour, embedded as a PNG, which uses the
    /// UVs of the normal map.
    ///
    /// Primitives whose material has no normal map stay as they are. A material that other primitives have, too, changes for all of them.
    /// Errors: a primitive that does not exist; a material that cannot be edited.
    pub fn paint(&mut self, png: Vec<u8>, name: &str, primitives: &[PrimitiveName]) -> Result<(), Error> {
        let broken = |error: serde_json::Error| {
            ContentError::invalid("materials", format!("cannot be edited: {error}; export it again"))
        };
        let texture = self.push_texture(png, name).map_err(broken);
        let texture = texture.map_err(|error| error.in_file(self.name()))?;
        for primitive in primitives {
            let stored = self.root.meshes.get(primitive.mesh);
            let stored = stored.and_then(|mesh| mesh.primitives.get(primitive.primitive));
            let Some(stored) = stored else {
                return Err(self.invalid(primitive.path(), "does not exist; name one of the document"));
            };
            if let Some(material) = stored.material {
                let painted = self.paint_material(material, texture).map_err(broken);
                painted.map_err(|error| error.in_file(self.name()))?;
            }
        }
        Ok(())
    }

    fn paint_material(&mut self, material: usize, texture: usize) -> serde_json::Result<()> {
        let Some(text) = self.material_text(material)? else { return Ok(()) };
        let Some(normal) = member(&text, "normalTexture")? else { return Ok(()) };
        let color = set_member(normal, "index", Some(&texture.to_string()))?;
        let color = set_member(&color, "scale", None)?;
        let two_sided = member(&text, "doubleSided")?.unwrap_or("false");
        let painted = format!(
            "{{\"normalTexture\":{normal},\"doubleSided\":{two_sided},\"pbrMetallicRoughness\":{{\"baseColorTexture\":{color},\"metallicFactor\":0}}}}"
        );
        let stored = self.stored_materials()?.len();
        match material.checked_sub(stored) {
            Some(appended) => self.edits.appended.entry("materials").or_default()[appended] = painted,
            None => {
                self.edits.scene.entry("materials").or_default().insert(material, painted);
            }
        }
        Ok(())
    }

    /// The materials as they were read.
    fn stored_materials(&self) -> serde_json::Result<Vec<&RawValue>> {
        serde_json::from_str(member(self.text(), "materials")?.unwrap_or("[]"))
    }

    /// A material with the edits so far; `None` if it does not exist.
    fn material_text(&self, material: usize) -> serde_json::Result<Option<String>> {
        if let Some(edited) = self.edits.scene.get("materials").and_then(|edited| edited.get(&material)) {
            return Ok(Some(edited.clone()));
        }
        let stored = self.stored_materials()?;
        let appended = self.edits.appended.get("materials").map(Vec::as_slice).unwrap_or_default();
        Ok(match material.checked_sub(stored.len()) {
            Some(place) => appended.get(place).cloned(),
            None => Some(stored[material].get().to_owned()),
        })
    }

    /// Appends an image and a texture with it. Returns the index of the texture.
    fn push_texture(&mut self, png: Vec<u8>, name: &str) -> serde_json::Result<usize> {
        let view = self.push_view(png, 1, 1, None);
        let image = format!("{{\"name\":{},\"mimeType\":\"image/png\",\"bufferView\":{view}}}", quoted(name));
        let image = self.append("images", image)?;
        self.append("textures", format!("{{\"source\":{image}}}"))
    }

    /// Appends a material with a normal map. Returns its index.
    fn push_material(&mut self, texture: usize, uv_set: usize) -> usize {
        let text = format!("{{\"normalTexture\":{{\"index\":{texture},\"texCoord\":{uv_set}}}}}");
        self.edits.appended.entry("materials").or_default().push(text);
        let info = TextureInfo { tex_coord: uv_set, ..TextureInfo::default() };
        let material = Material { normal_texture: Some(Box::new(info)), ..Material::default() };
        self.root.materials.push(material);
        self.root.materials.len() - 1
    }

    /// Appends an element to an array of the root object. Returns its index.
    fn append(&mut self, key: &'static str, element: String) -> serde_json::Result<usize> {
        let stored: Vec<&RawValue> = serde_json::from_str(member(self.text(), key)?.unwrap_or("[]"))?;
        let count = stored.len();
        let appended = self.edits.appended.entry(key).or_default();
        appended.push(element);
        Ok(count + appended.len() - 1)
    }

    fn edit_normal_texture(
        &mut self,
        material: usize,
        texture: usize,
        uv_set: usize,
    ) -> serde_json::Result<()> {
        let Some(text) = self.material_text(material)? else { return Ok(()) };
        let old = self.root.materials[material].normal_texture.take();
        let keeps_transform = old.as_ref().is_some_and(|old| {
            let of_transform = old.extensions.transform.as_ref().and_then(|transform| transform.tex_coord);
            of_transform.unwrap_or(old.tex_coord) == uv_set
        });
        let extensions = match member(&text, "normalTexture")? {
            Some(info) if keeps_transform => member(info, "extensions")?.map(str::to_owned),
            _ => None,
        };
        let mut info = format!("{{\"index\":{texture},\"texCoord\":{uv_set}}}");
        if let Some(extensions) = extensions {
            info = set_member(&info, "extensions", Some(&extensions))?;
        }
        let text = set_member(&text, "normalTexture", Some(&info))?;
        self.edits.scene.entry("materials").or_default().insert(material, text);
        let extensions = old.filter(|_| keeps_transform).map(|old| old.extensions).unwrap_or_default();
        let info = TextureInfo { tex_coord: uv_set, extensions };
        self.root.materials[material].normal_texture = Some(Box::new(info));
        Ok(())
    }
}
