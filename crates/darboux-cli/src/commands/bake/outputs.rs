//! The files that a run writes: their names, and why some are refused.

use std::path::{Path, PathBuf};

use darboux::{Choice, Convention};
use darboux_bake::{IdSource, MapKind};

use super::arguments::{BakeArguments, OwnOutputs, Pack};
use super::cage_file::is_glb;
use super::encode::FileKind;
use super::tile_names;
use crate::batch::one_file::foreign;
use crate::html_page::refuse_other_ending;
use crate::paths::{is_png, refuse_missing_folder};

/// The chosen maps, each once, with their files.
pub fn maps_of(arguments: &BakeArguments) -> Vec<(MapKind, PathBuf)> {
    let maps = arguments.maps();
    match maps[..] {
        [map] if arguments.pack.is_empty() => vec![(map, arguments.output.clone())],
        _ => maps.iter().map(|&map| (map, named(arguments, map.name()))).collect(),
    }
}

/// The output with a name before its ending.
pub fn named(arguments: &BakeArguments, name: &str) -> PathBuf {
    let ending = arguments.output.extension().unwrap_or_default().to_string_lossy();
    arguments.output.with_extension(format!("{name}.{ending}"))
}

/// The packed images, with their files.
pub fn packs_of(arguments: &BakeArguments) -> impl Iterator<Item = (&Pack, PathBuf)> {
    arguments.pack.iter().map(|pack| (pack, named(arguments, &pack.name)))
}

/// Refuses outputs that are not PNGs, exist, or lie in no folder.
pub fn refuse_outputs(arguments: &BakeArguments) -> Result<(), String> {
    if !arguments.makes_folders {
        all_outputs(arguments).iter().try_for_each(|path| refuse_missing_folder(path))?;
    }
    let shown = arguments.output.display();
    let kind = FileKind::of(&arguments.output).ok_or_else(|| {
        let hint =
            if is_glb(&arguments.output) { "; --write-model writes a model with its maps" } else { "" };
        format!("{shown}: the map is an image; its name must end in .png, .exr or .tif{hint}")
    })?;
    if let Some(bits) = arguments.bits.filter(|bits| !kind.bits().contains(bits)) {
        let [few, many] = kind.bits();
        return Err(format!("{shown}: cannot have {bits} bits per channel; choose {few} or {many}"));
    }
    if arguments.verify && kind != FileKind::Png {
        return Err(format!("{shown}: --verify reads the map as renderers do; choose a PNG"));
    }
    refuse_other_results(arguments)?;
    tile_names::check(arguments)?;
    if tile_names::has_place(&arguments.output) {
        // The tiles are known when the low model was read.
        return Ok(());
    }
    refuse_existing(arguments)
}

/// Refuses to write over files that exist, and over what cannot be replaced by a file.
pub fn refuse_existing(arguments: &BakeArguments) -> Result<(), String> {
    for path in all_outputs(arguments) {
        refuse_irreplaceable(&path)?;
        if path.exists() && !arguments.may_replace(&path) {
            return Err(match arguments.own_outputs {
                OwnOutputs::None => {
                    format!("{}: exists; use --force to replace it, or choose another name", path.display())
                }
                _ => foreign(&path),
            });
        }
    }
    Ok(())
}

/// Refuses folders, FIFOs, devices, broken links and read-only files.
fn refuse_irreplaceable(path: &Path) -> Result<(), String> {
    let shown = path.display();
    match path.metadata() {
        Ok(metadata) if metadata.is_dir() => Err(format!("{shown} is a folder; choose a file in it")),
        Ok(metadata) if !metadata.is_file() => {
            Err(format!("{shown}: exists and is not a regular file; name another output"))
        }
        Ok(metadata) if metadata.permissions().readonly() => {
            Err(format!("{shown}: is read-only; make it writable, or name another output"))
        }
        Err(_) if path.is_symlink() => Err(format!("{shown}: is a broken link; remove it")),
        _ => Ok(()),
    }
}

/// Refuses a model and a heat map that cannot be what was asked for.
fn refuse_other_results(arguments: &BakeArguments) -> Result<(), String> {
    let BakeArguments { write_model, heat_map, heat_model, verify, .. } = arguments;
    let map = arguments.maps();
    if *verify && !map.contains(&MapKind::Normal) {
        return Err("--verify needs a normal map; add normal to --map".to_owned());
    }
    if write_model.is_some() && !arguments.baked_maps().kinds().any(is_of_gltf) {
        return Err("--write-model needs a map that materials have; add normal to --map".to_owned());
    }
    arguments.high_options().check().map_err(|error| error.to_string())?;
    for model in write_model.iter().chain(heat_model) {
        if !is_glb(model) {
            return Err(format!("{}: the model is a GLB; its name must end in .glb", model.display()));
        }
    }
    if let Some(page) = &arguments.report {
        refuse_other_ending(page)?;
    }
    if let Some(cage) = arguments.write_cage.as_ref().filter(|cage| !is_glb(cage)) {
        return Err(format!("{}: the cage is a GLB; its name must end in .glb", cage.display()));
    }
    if write_model.is_some() {
        let conversion = arguments.map_convention().to(Convention::GLTF);
        if conversion.inverts_red() || conversion.inverts_green() {
            return Err(
                "--write-model needs a map in glTF's convention; leave --convention out, or convert the map \
                 afterwards"
                    .to_owned(),
            );
        }
    }
    if let Some(picture) = heat_map.as_ref().filter(|picture| !is_png(picture)) {
        return Err(format!("{}: the heat map is a PNG; its name must end in .png", picture.display()));
    }
    Ok(())
}

/// Every file that the arguments name for writing.
pub fn all_outputs(arguments: &BakeArguments) -> Vec<PathBuf> {
    let maps = maps_of(arguments).into_iter().map(|(_, path)| path).chain(legends_of(arguments));
    let maps = maps.chain(packs_of(arguments).map(|(_, path)| path));
    let BakeArguments { write_model, heat_map, heat_model, write_cage, report, .. } = arguments;
    let scale = heat_model.as_deref().map(scale_of);
    let others = [write_model, heat_map, heat_model, write_cage, report].into_iter().flatten().cloned();
    maps.chain(others).chain(scale).collect()
}

/// The picture of texels without a hit, which is written where they are many.
pub fn picture_of_misses(arguments: &BakeArguments) -> PathBuf {
    arguments.output.with_extension("misses.png")
}

/// The picture of the scale beside a painted model.
pub fn scale_of(heat_model: &Path) -> PathBuf {
    heat_model.with_extension("scale.png")
}

/// The legends that a run writes: beside each map whose colours stand for something.
pub fn legends_of(arguments: &BakeArguments) -> Vec<PathBuf> {
    maps_with_legends(arguments).into_iter().map(|(_, path)| path.with_extension("json")).collect()
}

/// The maps with legends, and their files.
pub fn maps_with_legends(arguments: &BakeArguments) -> Vec<(MapKind, PathBuf)> {
    let has_legend = |map: MapKind| match map {
        MapKind::Id => arguments.content.id_from != IdSource::VertexColor,
        _ => map == MapKind::UvIslands,
    };
    maps_of(arguments).into_iter().filter(|(map, _)| has_legend(*map)).collect()
}

/// Whether materials of glTF can have a map.
pub fn is_of_gltf(map: MapKind) -> bool {
    matches!(
        map,
        MapKind::Normal
            | MapKind::Occlusion
            | MapKind::BaseColor
            | MapKind::Opacity
            | MapKind::Roughness
            | MapKind::Metalness
            | MapKind::Emission
    )
}
