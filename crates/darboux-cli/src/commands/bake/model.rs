//! `--write-model`: the low model with maps in its materials and the tangents in its vertices;
//! `--heat-model`: painted with errors.

use std::path::Path;

use darboux_bake::{Images, LowModel, MapKind};
use darboux_io::Outputs;
use darboux_io::gltf::schema::Primitive;
use darboux_io::gltf::{AddTangentsOptions, Document, MaterialTexture, add_tangents};
use darboux_io::image::{PngImage, linear_to_srgb};

use super::arguments::BakeArguments;
use super::open::open_low;
use super::write::WrittenMaps;

/// Refuses, before the bake, a model whose tangents `--write-model` cannot write. The error is one sentence.
pub fn refuse_model(arguments: &BakeArguments, low: &LowModel<'_>) -> Result<(), String> {
    if arguments.write_model.is_some() && has_mixed_tangents(low) {
        return Err(format!(
            "{}: some primitives were baked with their own tangents and others with computed ones; add \
             --method, which computes all",
            arguments.low.display()
        ));
    }
    Ok(())
}

/// What the materials and colours of the models make of the model that is written, one warning each.
pub fn warn_of_materials(arguments: &BakeArguments, low: &Document, highs: &[Document]) -> Vec<String> {
    let maps = arguments.maps();
    let of_material = [MapKind::BaseColor, MapKind::Roughness, MapKind::Metalness];
    let any = |document: &Document, is: fn(&Primitive) -> bool| {
        document.meshes().iter().flat_map(|mesh| &mesh.primitives).any(is)
    };
    let mut warnings = Vec::new();
    let writes =
        |wanted: &[MapKind]| arguments.write_model.is_some() && maps.iter().any(|map| wanted.contains(map));
    if writes(&of_material) && !highs.iter().any(|high| any(high, |primitive| primitive.material.is_some())) {
        warnings.push(
            "the high models have no materials, and glTF's own is white metal; --map normal,ao leaves the \
             colours of the low model"
                .to_owned(),
        );
    }
    if writes(&of_material[..1]) && any(low, |primitive| primitive.attributes.contains_key("COLOR_0")) {
        warnings.push(format!(
            "{}: has vertex colours, by which renderers multiply the baked base colour; remove them from the \
             low model",
            low.name()
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
    low: &LowModel<'_>,
    images: &Images,
    written: &WrittenMaps,
    warnings: &mut Vec<String>,
    outputs: &mut Outputs,
) -> Result<Option<String>, String> {
    let Some(path) = &arguments.write_model else { return Ok(None) };
    let name = path.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let document = baked_model(arguments, low, images, written.normal.as_ref(), &name, warnings)?;
    document.stage(path, &arguments.save_options(path), outputs).map_err(sentence)?;
    Ok(Some(path.display().to_string()))
}

/// The low model with the maps in its materials and the tangents in its vertices. `normal`: in glTF's
/// convention; `name`: of the images. Errors are one sentence each.
///
/// The model is read again, because the bake still borrows the first one.
pub fn baked_model(
    arguments: &BakeArguments,
    low: &LowModel<'_>,
    images: &Images,
    normal: Option<&PngImage>,
    name: &str,
    warnings: &mut Vec<String>,
) -> Result<Document, String> {
    let mut document = open_low(arguments, &mut Vec::new())?;
    let primitives: Vec<_> = low.primitives().map(|(name, uv_set)| (name.clone(), uv_set)).collect();
    if let Some(map) = normal {
        document.set_normal_map(map.to_bytes().map_err(sentence)?, name, &primitives).map_err(sentence)?;
    }
    for texture in textures_of_material(images)? {
        let name = format!("{name} {}", texture.name);
        let png = texture.png.to_bytes().map_err(sentence)?;
        document.set_texture(&texture.uses, png, &name, &primitives).map_err(sentence)?;
    }
    let options = AddTangentsOptions::default().with_overwrite(low.with_unused_tangents > 0);
    let options = match arguments.method {
        Some(method) => options.with_tangents(method.into()),
        None => options,
    };
    let tangents = add_tangents(&mut document, &options, &mut |_| {}).map_err(sentence)?;
    warnings.extend(tangents.warnings);
    Ok(document)
}

/// A texture of the low model's materials.
struct BakedTexture {
    name: &'static str,
    uses: Vec<MaterialTexture>,
    png: PngImage,
}

/// The textures that materials of glTF have, of the maps that were baked: occlusion, roughness and metalness
/// share one.
fn textures_of_material(images: &Images) -> Result<Vec<BakedTexture>, String> {
    let mut textures = Vec::new();
    let has = |map| images.numbers(map).is_some();
    if has(MapKind::BaseColor) || has(MapKind::Opacity) {
        let colors = images.numbers(MapKind::BaseColor);
        let alphas =
            images.numbers(MapKind::Opacity).filter(|alphas| alphas.iter().any(|alpha| *alpha != 1.0));
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
        let uses = vec![MaterialTexture::BaseColor { alpha: alphas.is_some() }];
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
    if let Some(light) = images.numbers(MapKind::Emission) {
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
    let mut document = open_low(arguments, &mut Vec::new())?;
    let primitives: Vec<_> = low.primitives().map(|(name, uv_set)| (name.clone(), uv_set)).collect();
    let names: Vec<_> = primitives.iter().map(|(name, _)| name.clone()).collect();
    let flat = PngImage::from_rgb("flat", [1, 1], &[[128u8, 128, 255]]).and_then(|flat| flat.to_bytes());
    document.set_normal_map(flat.map_err(sentence)?, "flat", &primitives).map_err(sentence)?;
    document.paint(texture.to_bytes().map_err(sentence)?, "errors", &names).map_err(sentence)?;
    document.stage(path, &arguments.save_options(path), outputs).map_err(sentence)?;
    Ok(path.display().to_string())
}
