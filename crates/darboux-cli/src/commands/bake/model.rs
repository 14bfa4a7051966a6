//! `--write-model`: the low model with maps in its materials and the tangents in its vertices;
//! `--heat-model`: painted with errors.

use std::collections::{BTreeSet, HashSet};
use std::path::Path;

use darboux::Context;
use darboux_bake::{AlphaMode, HighModel, Images, LowModel, MapKind, MapSet, Models};
use darboux_io::Outputs;
use darboux_io::gltf::{
    AddTangentsOptions, Alpha, Document, Generate, MaterialTexture, PrimitiveName, add_tangents_to,
};
use darboux_io::image::{PngImage, linear_to_srgb};
use darboux_io::json::Value;

use super::arguments::BakeArguments;
use super::map_choice::has_vertex_colors;
use super::open::reopen_low;
use super::write::WrittenMaps;

/// Refuses, before the bake, a model whose tangents `--write-model` cannot write, and maps that would take
/// channels from the textures of the low model. The error is one sentence.
pub fn refuse_model(
    arguments: &BakeArguments,
    document: &Document,
    low: &LowModel<'_>,
) -> Result<(), String> {
    if arguments.write_model.is_none() {
        return Ok(());
    }
    let file = document.name();
    if has_mixed_tangents(low) {
        return Err(format!(
            "{file}: some primitives were baked with their own tangents and others with computed ones; add \
             --method, which computes all"
        ));
    }
    let maps = arguments.baked_maps();
    let missing = materials_of(document, low)
        .find_map(|(index, material)| Some((index, missing_channel(material, maps)?)));
    match missing {
        Some((index, [what, map])) => Err(format!(
            "{file}: the texture of materials[{index}] has {what} beside what is baked, which would be lost; \
             add {map} to --map"
        )),
        None => Ok(()),
    }
}

/// The materials of the baked primitives, each once, with their indices.
fn materials_of<'a>(document: &'a Document, low: &LowModel<'_>) -> impl Iterator<Item = (usize, &'a Value)> {
    let materials = &document.json()["materials"];
    low.materials.iter().flatten().filter_map(|&index| Some((index, materials.get(index)?)))
}

/// What a texture of a material has that is not baked although the rest of it is, and the map of that.
fn missing_channel(material: &Value, maps: MapSet) -> Option<[&'static str; 2]> {
    let has_texture =
        |name: &str| material.get("pbrMetallicRoughness").is_some_and(|all| all.get(name).is_some());
    let packed = [MapKind::Roughness, MapKind::Metalness].map(|map| maps.has(map));
    let colors = [MapKind::BaseColor, MapKind::Opacity].map(|map| maps.has(map));
    let is_opaque = material.get("alphaMode").is_none_or(|mode| mode.as_str() == Some("OPAQUE"));
    match (has_texture("metallicRoughnessTexture"), packed, has_texture("baseColorTexture"), colors) {
        (true, [true, false], ..) => Some(["metalness", "metalness"]),
        (true, [false, true], ..) => Some(["roughness", "roughness"]),
        (.., true, [false, true]) => Some(["colours", "base-color"]),
        (.., true, [true, false]) if !is_opaque => Some(["alpha", "opacity"]),
        _ => None,
    }
}

/// The extensions of materials that go with any baked texture.
const HARMLESS: [&str; 2] = ["KHR_materials_emissive_strength", "KHR_materials_ior"];

/// What the written model keeps of the low one beside the maps, or loses for them, one warning each.
pub fn warn_of_materials(arguments: &BakeArguments, document: &Document, low: &LowModel<'_>) -> Vec<String> {
    if arguments.write_model.is_none() {
        return Vec::new();
    }
    let extensions =
        materials_of(document, low).filter_map(|(_, material)| material.get("extensions")?.as_object());
    let names: BTreeSet<&str> = extensions.flat_map(|all| all.iter().map(|(name, _)| &**name)).collect();
    let is_replaced =
        |name: &str| ["KHR_materials_unlit", "KHR_materials_pbrSpecularGlossiness"].contains(&name);
    let (replaced, kept): (Vec<_>, Vec<_>) = names.into_iter().partition(|name| is_replaced(name));
    let kept: Vec<_> = kept
        .into_iter()
        .filter(|name| name.starts_with("KHR_materials_") && !HARMLESS.contains(name))
        .collect();
    let file = document.name();
    let mut warnings = Vec::new();
    if !replaced.is_empty() {
        warnings.push(format!(
            "{file}: the written model is without {}, with which renderers would leave the baked maps out",
            replaced.join(" and ")
        ));
    }
    if !kept.is_empty() {
        warnings.push(format!(
            "{file}: the written model keeps {} of its materials, which shows what the high models may not; \
             remove it there if they have none",
            kept.join(", ")
        ));
    }
    let has_variants = |name: &PrimitiveName| {
        let primitive = &document.json()["meshes"][name.mesh]["primitives"][name.primitive];
        primitive.get("extensions").is_some_and(|all| all.get("KHR_materials_variants").is_some())
    };
    if low.primitives().any(|(name, _)| has_variants(name)) {
        warnings.push(format!(
            "{file}: the maps are in the materials that are shown first, not in those of KHR_materials_variants"
        ));
    }
    if arguments.baked_maps().has(MapKind::BaseColor) && has_vertex_colors(document) {
        warnings.push(format!(
            "{file}: the written model is without its vertex colours, by which renderers would multiply the baked \
             base colour"
        ));
    }
    warnings
}

/// Whether some primitives were baked with the tangents of the file and others, which have some too, with
/// computed ones.
pub fn has_mixed_tangents(low: &LowModel<'_>) -> bool {
    low.with_own_tangents > 0 && low.with_unused_tangents > 0
}

/// Stages the model and returns its path; none if it was not asked for. Errors are one sentence each.
pub fn stage_model(
    arguments: &BakeArguments,
    models: &Models<'_>,
    images: &Images,
    written: &WrittenMaps,
    warnings: &mut Vec<String>,
    outputs: &mut Outputs,
) -> Result<Option<String>, String> {
    let Some(path) = &arguments.write_model else { return Ok(None) };
    let name = path.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let document = baked_model(arguments, models, images, written.normal.as_ref(), &name, warnings)?;
    document.stage(path, &arguments.save_options(path), outputs).map_err(sentence)?;
    Ok(Some(path.display().to_string()))
}

/// The low model with the maps in its materials and the tangents in its vertices. `normal`: in glTF's
/// convention; `name`: of the images. Errors are one sentence each.
///
/// The model is read again, because the bake still borrows the first one.
pub fn baked_model(
    arguments: &BakeArguments,
    models: &Models<'_>,
    images: &Images,
    normal: Option<&PngImage>,
    name: &str,
    warnings: &mut Vec<String>,
) -> Result<Document, String> {
    let low = &models.low;
    let mut document = reopen_low(arguments, low)?;
    let primitives: Vec<_> = low.primitives().map(|(name, uv_set)| (name.clone(), uv_set)).collect();
    if let Some(map) = normal {
        document.set_normal_map(map.to_bytes().map_err(sentence)?, name, &primitives).map_err(sentence)?;
    }
    if has_no_light(images) {
        document.remove_emission(&primitives).map_err(sentence)?;
    }
    for texture in textures_of_material(images, alpha_of(models))? {
        let name = format!("{name} {}", texture.name);
        let png = texture.png.to_bytes().map_err(sentence)?;
        document.set_texture(&texture.uses, png, &name, &primitives).map_err(sentence)?;
    }
    if normal.is_some() {
        warnings.extend(add_baked_tangents(&mut document, arguments, low)?);
    }
    Ok(document)
}

/// Adds the tangents that the normal map was baked for to its primitives. Returns the warnings. Errors are
/// one sentence each.
fn add_baked_tangents(
    document: &mut Document,
    arguments: &BakeArguments,
    low: &LowModel<'_>,
) -> Result<Vec<String>, String> {
    let options = AddTangentsOptions::default().with_overwrite(low.with_unused_tangents > 0);
    let options = match arguments.method {
        Some(method) => options.with_tangents(method.into()),
        None => options,
    };
    let baked: HashSet<_> = low.primitives().map(|(name, _)| (name.mesh, name.primitive)).collect();
    let is_baked = |name: &PrimitiveName| baked.contains(&(name.mesh, name.primitive));
    let (context, generate) = (&mut Context::new(), Generate::OnCpu);
    let added = add_tangents_to(document, &options, &is_baked, context, generate, &mut |_| {});
    Ok(added.map_err(sentence)?.warnings)
}

/// A texture of the low model's materials.
struct BakedTexture {
    name: &'static str,
    uses: Vec<MaterialTexture>,
    png: PngImage,
}

/// How an alpha counts that is that of all high models.
fn alpha_of(models: &Models<'_>) -> Alpha {
    match models.highs.iter().map(HighModel::alpha_mode).max() {
        Some(AlphaMode::Blend) => Alpha::Blend,
        Some(AlphaMode::Mask) => Alpha::Mask(0.5),
        _ => Alpha::Opaque,
    }
}

/// The textures that materials of glTF have, of the maps that were baked: occlusion, roughness and metalness
/// share one. `alpha`: how that of the high models counts.
fn textures_of_material(images: &Images, alpha: Alpha) -> Result<Vec<BakedTexture>, String> {
    let mut textures = Vec::new();
    let has = |map| images.numbers(map).is_some();
    if has(MapKind::BaseColor) || has(MapKind::Opacity) {
        let colors = images.numbers(MapKind::BaseColor);
        let baked = images.numbers(MapKind::Opacity);
        let alphas = baked.filter(|alphas| alphas.iter().any(|alpha| code(*alpha) != 255));
        let texel = |at: usize| {
            let color = colors.map_or([255; 3], |colors| [0, 1, 2].map(|i| srgb_code(colors[3 * at + i])));
            (color, alphas.map_or(255, |alphas| code(alphas[at])))
        };
        let texels = 0..images.states.len();
        let png = match alphas {
            Some(_) => {
                let rgba = |at| {
                    let ([red, green, blue], alpha) = texel(at);
                    [red, green, blue, alpha]
                };
                PngImage::from_rgba("base colour", images.size, &texels.map(rgba).collect::<Vec<_>>())
            }
            None => PngImage::from_rgb(
                "base colour",
                images.size,
                &texels.map(|at| texel(at).0).collect::<Vec<_>>(),
            ),
        };
        let alpha = baked.map(|_| alphas.map_or(Alpha::Opaque, |_| alpha));
        let uses = vec![MaterialTexture::BaseColor { alpha }];
        textures.push(BakedTexture { name: "base colour", uses, png: png.map_err(sentence)? });
    }
    let (roughness, metalness) = (has(MapKind::Roughness), has(MapKind::Metalness));
    let mut uses = Vec::new();
    if has(MapKind::Occlusion) {
        uses.push(MaterialTexture::Occlusion);
    }
    if roughness || metalness {
        uses.push(MaterialTexture::MetallicRoughness { roughness, metalness });
    }
    if !uses.is_empty() {
        let packed = [MapKind::Occlusion, MapKind::Roughness, MapKind::Metalness];
        let channels = packed.map(|map| images.numbers(map));
        let texel = |at: usize| channels.map(|channel| channel.map_or(255, |numbers| code(numbers[at])));
        let texels: Vec<_> = (0..images.states.len()).map(texel).collect();
        let png = PngImage::from_rgb("occlusion, roughness and metalness", images.size, &texels);
        let png = png.map_err(sentence)?;
        textures.push(BakedTexture { name: "occlusion, roughness, metalness", uses, png });
    }
    if let Some(light) = images.numbers(MapKind::Emission).filter(|_| !has_no_light(images)) {
        let strength = light.iter().fold(1f32, |most, x| most.max(*x));
        let texels: Vec<_> =
            light.as_chunks::<3>().0.iter().map(|light| light.map(|x| srgb_code(x / strength))).collect();
        let png = PngImage::from_rgb("emission", images.size, &texels).map_err(sentence)?;
        textures.push(BakedTexture {
            name: "emission",
            uses: vec![MaterialTexture::Emissive { strength }],
            png,
        });
    }
    Ok(textures)
}

/// Whether emission was baked, and all of it is black.
fn has_no_light(images: &Images) -> bool {
    images.numbers(MapKind::Emission).is_some_and(|light| light.iter().all(|&x| x == 0.0))
}

/// The 8-bit code of a share.
fn code(share: f32) -> u8 {
    (255.0 * share).round().clamp(0.0, 255.0) as u8
}

/// The 8-bit code of linear light in sRGB.
fn srgb_code(light: f32) -> u8 {
    code(linear_to_srgb(f64::from(light).clamp(0.0, 1.0)) as f32)
}

fn sentence(error: darboux_io::Error) -> String {
    error.to_string()
}

/// Stages the low model with a texture as its colour and without detail; returns the path. Errors are one
/// sentence each.
pub fn stage_painted(
    arguments: &BakeArguments,
    low: &LowModel<'_>,
    texture: &PngImage,
    path: &Path,
    outputs: &mut Outputs,
) -> Result<String, String> {
    let mut document = reopen_low(arguments, low)?;
    let primitives: Vec<_> = low.primitives().map(|(name, uv_set)| (name.clone(), uv_set)).collect();
    let names: Vec<_> = primitives.iter().map(|(name, _)| name.clone()).collect();
    let flat = PngImage::from_rgb("flat", [1, 1], &[[128u8, 128, 255]]).and_then(|flat| flat.to_bytes());
    document.set_normal_map(flat.map_err(sentence)?, "flat", &primitives).map_err(sentence)?;
    document.paint(texture.to_bytes().map_err(sentence)?, "errors", &names).map_err(sentence)?;
    document.stage(path, &arguments.save_options(path), outputs).map_err(sentence)?;
    Ok(path.display().to_string())
}
