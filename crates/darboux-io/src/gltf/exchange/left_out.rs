//! What a PLY or an OBJ does not hold of a document.

use std::collections::{BTreeSet, HashMap};

use super::format::ExchangeFormat;
use super::obj;
use crate::Error;
use crate::gltf::{Alpha, Document, ElementType, schema};
use crate::json::Value;
use crate::words::counted_if_any as counted;

/// Counts of what is left out.
pub struct LeftOut {
    format: ExchangeFormat,
    tangents: usize,
    some_surfaces_lack: Vec<&'static str>,
    materials: usize,
    textures: usize,
    material_losses: MaterialLosses,
    uv_sets: usize,
    color_sets: usize,
    custom_attributes: usize,
    /// Whether colours of an OBJ have an alpha below 1.
    has_color_alpha: bool,
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

/// What the materials of an OBJ say in another way than the document.
#[derive(Default)]
struct MaterialLosses {
    rotated: usize,
    mirrored: usize,
    on_other_uvs: usize,
    /// Textures whose image has no content here, such as a missing file.
    without_image: usize,
    /// Textures whose alpha is used: MTL takes it from a file of its own.
    with_alpha: usize,
    /// Textures whose magnification shows single texels.
    nearest: usize,
    /// Materials whose alpha is a mask, and those that are seen from both sides.
    masks: usize,
    double_sided: usize,
}

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
        let meshes = document.mesh_instances()?.meshes;
        let used: BTreeSet<usize> = meshes.iter().map(|instance| instance.mesh).collect();
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
        let names = surfaces.iter().flat_map(|primitive| primitive.attributes.keys());
        let custom = names.filter(|name| name.starts_with('_'));
        let is_ply = format == ExchangeFormat::Ply;
        if !is_ply {
            extensions.remove("KHR_texture_transform");
        }
        Ok(Self {
            format,
            tangents: if is_ply { 0 } else { having("TANGENT") },
            some_surfaces_lack: if is_ply { partial.collect() } else { Vec::new() },
            materials: if is_ply { length("materials") } else { 0 },
            textures: if is_ply { length("textures") } else { unspelt_textures(document)? },
            material_losses: if is_ply { MaterialLosses::default() } else { material_losses(document)? },
            uv_sets: (1..).take_while(|set| having(&format!("TEXCOORD_{set}")) > 0).count(),
            color_sets: (1..).take_while(|set| having(&format!("COLOR_{set}")) > 0).count(),
            custom_attributes: custom.collect::<BTreeSet<_>>().len(),
            has_color_alpha: !is_ply && has_color_alpha(document, &surfaces),
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
                    self.material_losses.rotated,
                    "placement of a texture, which is rotated",
                    "placements of textures, which are rotated",
                ),
                counted(
                    self.material_losses.mirrored,
                    "choice to mirror a texture, or to clamp it along one axis",
                    "choices to mirror textures, or to clamp them along one axis",
                ),
                counted(
                    self.material_losses.on_other_uvs,
                    "texture on a UV set that is not written",
                    "textures on UV sets that are not written",
                ),
                counted(
                    self.material_losses.without_image,
                    "texture whose image cannot be read",
                    "textures whose images cannot be read",
                ),
                counted(
                    self.material_losses.with_alpha,
                    "use of a texture's alpha",
                    "uses of textures' alpha",
                ),
                counted(self.uv_sets, "further UV set", "further UV sets"),
                counted(self.color_sets, "further set of colours", "further sets of colours"),
                self.has_color_alpha.then(|| "the alpha of vertex colours".to_owned()),
                counted(self.custom_attributes, "custom attribute", "custom attributes"),
                counted(
                    self.material_losses.nearest,
                    "texture filter of single texels",
                    "texture filters of single texels",
                ),
                counted(self.material_losses.masks, "alpha mask", "alpha masks"),
                counted(self.material_losses.double_sided, "double-sided material", "double-sided materials"),
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

/// Whether a vertex of a surface is not opaque.
fn has_color_alpha(document: &Document, surfaces: &[&&schema::Primitive]) -> bool {
    let accessors: BTreeSet<usize> =
        surfaces.iter().filter_map(|primitive| primitive.attributes.get("COLOR_0").copied()).collect();
    let of_four = |accessor: &usize| {
        document.accessors().get(*accessor).is_some_and(|stored| stored.element_type == ElementType::Vec4)
    };
    let is_transparent = |accessor: usize| {
        document.vectors::<4>(accessor).is_ok_and(|colors| colors.iter().any(|color| color[3] < 1.0))
    };
    accessors.into_iter().filter(of_four).any(is_transparent)
}

/// What MTL cannot say of the materials.
fn material_losses(document: &Document) -> Result<MaterialLosses, Error> {
    let mut found = MaterialLosses::default();
    let mut is_there = HashMap::new();
    for material in document.materials()? {
        let once = |(statement, _): &(&str, _)| *statement != "map_Pm";
        let all = obj::all_textures(&material).filter(once).count();
        found.on_other_uvs += all - obj::textures(&material).filter(once).count();
        found.masks += usize::from(matches!(material.alpha, Alpha::Mask(_)));
        for (_, texture) in obj::textures(&material).filter(once) {
            found.mirrored += usize::from(obj::is_clamped(texture).is_none());
            found.rotated += usize::from(texture.offset_and_scale().is_none());
            found.nearest += usize::from(texture.is_nearest);
            let has_content = |image| *is_there.entry(image).or_insert_with(|| document.has_image(image));
            found.without_image += usize::from(!texture.image.is_some_and(has_content));
        }
        let has_texture = obj::textures(&material).any(|(statement, _)| statement == "map_Kd");
        found.with_alpha += usize::from(has_texture && material.alpha != Alpha::Opaque);
    }
    let materials = document.json()["materials"].as_array();
    let is_double_sided = |material: &&Value| matches!(material["doubleSided"], Value::Bool(true));
    found.double_sided = materials.into_iter().flatten().filter(is_double_sided).count();
    Ok(found)
}
