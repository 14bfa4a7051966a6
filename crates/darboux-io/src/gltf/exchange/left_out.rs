//! What a PLY or an OBJ does not hold of a document.

use std::collections::BTreeSet;

use super::format::ExchangeFormat;
use crate::Error;
use crate::gltf::Document;
use crate::json::Value;

/// Counts of what is left out.
pub struct LeftOut {
    format: ExchangeFormat,
    tangents: usize,
    some_surfaces_lack: Vec<&'static str>,
    materials: usize,
    textures: usize,
    clamped_textures: usize,
    uv_sets: usize,
    morph_targets: usize,
    skins: usize,
    animations: usize,
    cameras: usize,
    extensions: Vec<String>,
    unused_meshes: usize,
    points_and_lines: usize,
}

/// The attributes that a PLY has for all vertices or for none.
const SHARED: [(&str, &str); 4] =
    [("NORMAL", "normals"), ("TEXCOORD_0", "UVs"), ("TANGENT", "tangents"), ("COLOR_0", "colours")];

/// Extensions of documents and primitives that say nothing about surfaces, or whose data is plain here.
const HARMLESS: [&str; 7] = [
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "KHR_draco_mesh_compression",
    "KHR_materials_emissive_strength",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "EXT_texture_webp",
];

impl LeftOut {
    pub fn of(document: &Document, format: ExchangeFormat) -> Result<Self, Error> {
        let json = document.json();
        let length = |array: &str| json[array].as_array().map_or(0, Vec::len);
        let placed = document.mesh_instances()?.meshes;
        let used: BTreeSet<usize> = placed.iter().map(|instance| instance.mesh).collect();
        let primitives: Vec<_> = used.iter().flat_map(|&mesh| &document.meshes()[mesh].primitives).collect();
        let surfaces: Vec<_> = primitives.iter().filter(|primitive| primitive.mode >= TRIANGLES).collect();
        let having = |semantic: &str| {
            surfaces.iter().filter(|primitive| primitive.attributes.contains_key(semantic)).count()
        };
        let is_partial = |semantic: &str| (1..surfaces.len()).contains(&having(semantic));
        let partial = SHARED.into_iter().filter(|(semantic, _)| is_partial(semantic)).map(|(_, name)| name);
        let mut extensions: BTreeSet<&str> = json["extensionsUsed"]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(|name| name.as_str())
            .collect();
        HARMLESS.iter().for_each(|name| _ = extensions.remove(name));
        let is_ply = format == ExchangeFormat::Ply;
        Ok(Self {
            format,
            tangents: if is_ply { 0 } else { having("TANGENT") },
            some_surfaces_lack: if is_ply { partial.collect() } else { Vec::new() },
            materials: if is_ply { length("materials") } else { 0 },
            textures: if is_ply { length("textures") } else { unspelt_textures(document)? },
            clamped_textures: if is_ply { 0 } else { clamped_textures(document) },
            uv_sets: (1..).take_while(|set| having(&format!("TEXCOORD_{set}")) > 0).count(),
            morph_targets: primitives.iter().map(|primitive| primitive.targets.len()).max().unwrap_or(0),
            skins: length("skins"),
            animations: length("animations"),
            cameras: length("cameras"),
            extensions: extensions.into_iter().map(str::to_owned).collect(),
            unused_meshes: document.meshes().len() - used.len(),
            points_and_lines: primitives.len() - surfaces.len(),
        })
    }

    /// A noun phrase for each.
    pub fn phrases(self) -> Vec<String> {
        let counted = |count: usize, one: &str, many: &str| match count {
            0 => None,
            1 => Some(format!("1 {one}")),
            _ => Some(format!("{count} {many}")),
        };
        let mut phrases = Vec::new();
        if self.tangents > 0 {
            phrases.push("the tangents, for which OBJ has no place: an importer computes its own".to_owned());
        }
        phrases.extend(
            self.some_surfaces_lack
                .iter()
                .map(|name| format!("the lack of {name} on some surfaces, where they are 0")),
        );
        let elsewhere =
            if self.format == ExchangeFormat::Ply { "" } else { " that MTL has no statement for" };
        phrases.extend(
            [
                counted(self.materials, "material", "materials"),
                counted(self.textures, &format!("texture{elsewhere}"), &format!("textures{elsewhere}")),
                counted(
                    self.clamped_textures,
                    "choice to clamp or mirror a texture",
                    "choices to clamp or mirror textures",
                ),
                counted(self.uv_sets, "further UV set", "further UV sets"),
                counted(self.morph_targets, "morph target", "morph targets"),
                counted(self.skins, "skin", "skins"),
                counted(self.animations, "animation", "animations"),
                counted(self.cameras, "camera", "cameras"),
                counted(self.unused_meshes, "mesh outside the scene", "meshes outside the scene"),
                counted(
                    self.points_and_lines,
                    "primitive of points or lines",
                    "primitives of points or lines",
                ),
            ]
            .into_iter()
            .flatten(),
        );
        phrases.extend(self.extensions);
        phrases
    }
}

/// The mode of the first kind of primitive that has faces.
const TRIANGLES: u32 = 4;

/// Occlusion and clear coat have no statement in MTL.
fn unspelt_textures(document: &Document) -> Result<usize, Error> {
    let materials = document.materials()?;
    let own = materials
        .iter()
        .flat_map(|material| [&material.occlusion_texture, &material.clearcoat_normal_texture]);
    Ok(own.flatten().count())
}

/// The textures that do not repeat.
fn clamped_textures(document: &Document) -> usize {
    const REPEAT: u64 = 10497;
    let json = document.json();
    let repeats = |texture: &Value| {
        let sampler = texture["sampler"].as_u64().map_or(&Value::Null, |at| &json["samplers"][at as usize]);
        ["wrapS", "wrapT"].iter().all(|&wrap| sampler[wrap].as_u64().is_none_or(|wrap| wrap == REPEAT))
    };
    json["textures"].as_array().into_iter().flatten().filter(|texture| !repeats(texture)).count()
}
