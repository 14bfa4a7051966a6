//! Gives materials textures, and paints them.

use std::collections::{BTreeMap, BTreeSet};

use crate::json::{Map, Value, object, remove_extension};

use crate::Error;
use crate::error::ContentError;
use crate::gltf::schema::{Material, Primitive};
use crate::gltf::{Alpha, Document, PrimitiveName};

/// A primitive that gets a map, and the UV set n of `TEXCOORD_n` that the map uses.
type MappedPrimitive = (PrimitiveName, usize);

/// A texture of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum MaterialTexture {
    /// The normal map. The scale of an existing one is dropped.
    Normal,
    /// Ambient occlusion in red.
    Occlusion,
    /// Roughness in green and metalness in blue. The factors of those that the texture has become 1.
    MetallicRoughness {
        /// Whether the texture has roughness.
        roughness: bool,
        /// Whether the texture has metalness.
        metalness: bool,
    },
    /// The base colour. Its factor becomes 1, but for alpha without a mode. The primitives lose their vertex
    /// colours, which multiply the base colour (glTF 2.0, 3.9.2).
    BaseColor {
        /// How the alpha of the texture counts; none to keep the mode and the factor of the material.
        alpha: Option<Alpha>,
    },
    /// The emitted light, times a strength (`KHR_materials_emissive_strength` where it is not 1).
    Emissive {
        /// The light of white texels.
        strength: f32,
    },
}

impl Document {
    /// Gives the materials of primitives one new normal map, as [`Document::set_texture`].
    pub fn set_normal_map(
        &mut self,
        png: Vec<u8>,
        name: &str,
        primitives: &[MappedPrimitive],
    ) -> Result<(), Error> {
        self.set_texture(&[MaterialTexture::Normal], png, name, primitives)
    }

    /// Gives the materials of primitives one new texture, embedded as a PNG, which can have several uses.
    /// Primitives without a material get a new one.
    ///
    /// The texture transform of the material's normal map is kept where the UV set stays. A material that
    /// other primitives have, too, stays as it is, and these get a copy of it; primitives of one material
    /// with several UV sets get a copy for each set after the first. A material that was unlit, or had
    /// specular and glossiness, loses the extension that says so where renderers would leave the texture
    /// out with it. Errors: a primitive that does not exist; a material that cannot be edited.
    pub fn set_texture(
        &mut self,
        uses: &[MaterialTexture],
        png: Vec<u8>,
        name: &str,
        primitives: &[MappedPrimitive],
    ) -> Result<(), Error> {
        let texture = self.push_texture(png, name);
        if uses.iter().any(|&used| matches!(used, MaterialTexture::Emissive { strength } if strength != 1.0))
        {
            self.use_extension(EMISSIVE_STRENGTH);
        }
        for (material, uv_set) in self.materials_by_uv_set(primitives)? {
            for &used in uses {
                let edited = self.set_texture_of_material(material, used, texture, uv_set);
                edited.map_err(|error| error.in_file(self.name()))?;
            }
        }
        if uses.iter().any(|used| matches!(used, MaterialTexture::BaseColor { .. })) {
            for (name, _) in primitives {
                self.edit_primitive(name.mesh, name.primitive, remove_vertex_colors)?;
            }
        }
        Ok(())
    }

    /// Takes the emitted light from the materials of primitives.
    ///
    /// A material that other primitives have, too, changes for all of them. Errors: a primitive that does not
    /// exist; a material that cannot be edited.
    pub fn remove_emission(&mut self, primitives: &[MappedPrimitive]) -> Result<(), Error> {
        for (primitive, _) in primitives {
            let Some(material) = self.primitive(primitive)?.material else { continue };
            let edited = self.edit_element("materials", material, |material| {
                remove_extension(material, EMISSIVE_STRENGTH);
                if let Some(members) = material.as_object_mut() {
                    members.remove("emissiveTexture");
                    members.remove("emissiveFactor");
                }
            });
            edited.map_err(|error| error.in_file(self.name()))?;
        }
        Ok(())
    }

    /// Gives primitives without a material a new one per UV set, and copies materials of several UV sets and
    /// of other primitives. Returns the materials of all primitives, with their UV sets.
    fn materials_by_uv_set(&mut self, primitives: &[MappedPrimitive]) -> Result<Vec<(usize, usize)>, Error> {
        let mut material_of = BTreeMap::new();
        let mut has_one_set = BTreeSet::new();
        let listed = primitives.iter().map(|(name, _)| (name.mesh, name.primitive)).collect();
        for (primitive, uv_set) in primitives {
            let old = self.primitive(primitive)?.material;
            let material = *material_of.entry((old, *uv_set)).or_insert_with(|| match old {
                Some(old) if has_one_set.insert(old) && !self.has_other_users(old, &listed) => old,
                _ => self.push_material(old),
            });
            if Some(material) != old {
                self.edit_primitive(primitive.mesh, primitive.primitive, |json| {
                    json.insert("material", material.into());
                })?;
            }
        }
        Ok(material_of.into_iter().map(|((_, uv_set), material)| (material, uv_set)).collect())
    }

    /// Paints primitives: replaces their materials by unlit ones (`KHR_materials_unlit`) with a new base
    /// colour, embedded as a PNG, which uses the UVs of the normal map. Light would change the colours,
    /// and the normal map more so.
    ///
    /// Primitives whose material has no normal map stay as they are. A material that other primitives have,
    /// too, changes for all of them. Errors: a primitive that does not exist; a material that cannot be
    /// edited.
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
        let image =
            self.push_element("images", object! { "name": name, "mimeType": media_type, "bufferView": view });
        self.push_element("textures", object! { "source": image })
    }

    /// Appends a copy of a material, or one without members. Returns its index.
    fn push_material(&mut self, original: Option<usize>) -> usize {
        let json = original.map(|original| self.element("materials", original).clone());
        self.push_element("materials", json.unwrap_or(object! {}))
    }

    /// Whether a primitive that is not among these has a material.
    fn has_other_users(&self, material: usize, listed: &BTreeSet<(usize, usize)>) -> bool {
        let all = self.root.meshes.iter().enumerate().flat_map(|(mesh, stored)| {
            stored.primitives.iter().enumerate().map(move |(primitive, stored)| ((mesh, primitive), stored))
        });
        all.filter(|(_, stored)| stored.material == Some(material)).any(|(place, _)| !listed.contains(&place))
    }

    fn set_texture_of_material(
        &mut self,
        material: usize,
        used: MaterialTexture,
        texture: usize,
        uv_set: usize,
    ) -> Result<bool, ContentError> {
        let keeps_transform =
            self.root.materials.get(material).is_some_and(|stored| uses_set(stored, uv_set));
        self.edit_element("materials", material, |material| {
            let extensions = material["normalTexture"].get("extensions").filter(|_| keeps_transform).cloned();
            let mut new = object! { "index": texture, "texCoord": uv_set };
            if let Some(extensions) = extensions {
                new["extensions"] = extensions;
            }
            put_texture(material, used, new);
            remove_other_models(material, used);
        })
    }
}

const SPECULAR_GLOSSINESS: &str = "KHR_materials_pbrSpecularGlossiness";
const EMISSIVE_STRENGTH: &str = "KHR_materials_emissive_strength";

/// Puts a texture into the JSON of a material, with the factors that show it as it is.
fn put_texture(material: &mut Value, used: MaterialTexture, texture: Value) {
    match used {
        MaterialTexture::Normal => material["normalTexture"] = texture,
        MaterialTexture::Occlusion => material["occlusionTexture"] = texture,
        MaterialTexture::MetallicRoughness { roughness, metalness } => {
            let metallic = &mut material["pbrMetallicRoughness"];
            metallic["metallicRoughnessTexture"] = texture;
            if roughness {
                metallic["roughnessFactor"] = 1.into();
            }
            if metalness {
                metallic["metallicFactor"] = 1.into();
            }
        }
        MaterialTexture::BaseColor { alpha } => {
            let metallic = &mut material["pbrMetallicRoughness"];
            metallic["baseColorTexture"] = texture;
            let old = metallic["baseColorFactor"].get(3).filter(|_| alpha.is_none()).cloned();
            metallic["baseColorFactor"] = {
                let one = Value::from(1u32);
                vec![one.clone(), one.clone(), one.clone(), old.unwrap_or(one)].into()
            };
            if let (Some(alpha), Some(members)) = (alpha, material.as_object_mut()) {
                put_alpha(members, alpha);
            }
        }
        MaterialTexture::Emissive { strength } => {
            material["emissiveTexture"] = texture;
            material["emissiveFactor"] = vec![1u32; 3].into();
            if strength == 1.0 {
                remove_extension(material, EMISSIVE_STRENGTH);
            } else {
                material["extensions"][EMISSIVE_STRENGTH] = object! { "emissiveStrength": strength };
            }
        }
    }
}

/// Puts a mode of alpha into the JSON of a material.
fn put_alpha(material: &mut Map, alpha: Alpha) {
    let (mode, cutoff) = match alpha {
        Alpha::Opaque => (None, None),
        Alpha::Mask(cutoff) => (Some("MASK"), Some(cutoff)),
        Alpha::Blend => (Some("BLEND"), None),
    };
    set(material, "alphaMode", mode.map(Value::from));
    set(material, "alphaCutoff", cutoff.map(Value::from));
}

/// Sets a member, or removes it.
fn set(object: &mut Map, name: &str, value: Option<Value>) {
    match value {
        Some(value) => _ = object.insert(name, value),
        None => _ = object.remove(name),
    }
}

/// Removes the extensions with which renderers leave a texture out.
fn remove_other_models(material: &mut Value, used: MaterialTexture) {
    match used {
        MaterialTexture::BaseColor { .. } => _ = remove_extension(material, SPECULAR_GLOSSINESS),
        MaterialTexture::MetallicRoughness { .. } => {
            remove_extension(material, SPECULAR_GLOSSINESS);
            remove_extension(material, UNLIT);
        }
        MaterialTexture::Normal | MaterialTexture::Occlusion => _ = remove_extension(material, UNLIT),
        MaterialTexture::Emissive { .. } => {}
    }
}

/// Whether a material's normal map uses the UV set n of `TEXCOORD_n`.
fn uses_set(material: &Material, uv_set: usize) -> bool {
    material.normal_texture.as_ref().is_some_and(|texture| {
        let of_transform = texture.extensions.transform.as_ref().and_then(|transform| transform.tex_coord);
        of_transform.unwrap_or(texture.tex_coord) == uv_set
    })
}

/// Removes the vertex colours of a primitive and of its morph targets.
fn remove_vertex_colors(primitive: &mut Map) {
    const COLORS: &str = "COLOR_0";
    let attributes = primitive.get_mut("attributes").and_then(Value::as_object_mut);
    if let Some(attributes) = attributes {
        attributes.remove(COLORS);
    }
    let targets = primitive.get_mut("targets").and_then(Value::as_array_mut);
    for target in targets.into_iter().flatten().filter_map(Value::as_object_mut) {
        target.remove(COLORS);
    }
}

const UNLIT: &str = "KHR_materials_unlit";

/// Makes a material unlit, with a texture as its colour that uses the UVs of the normal map, if it has a
/// normal map.
fn paint(material: &mut Value, texture: usize) {
    let Some(normal) = material.get("normalTexture") else { return };
    let mut color = normal.clone();
    color["index"] = texture.into();
    if let Some(color) = color.as_object_mut() {
        color.remove("scale");
    }
    *material = object! {
        "doubleSided": material.get("doubleSided").cloned().unwrap_or(false.into()),
        "extensions": object! { UNLIT: object! {} },
        "pbrMetallicRoughness":
            object! { "baseColorTexture": color, "metallicFactor": 0u32, "roughnessFactor": 0.9 },
    };
}
