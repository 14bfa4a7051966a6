//! Fuzzes the baker: any model, baked onto itself, gives an error or normals that are finite.

#![no_main]

use darboux::Context;
use darboux_bake::{
    BakeOptions, HighModel, HighModelOptions, LowModel, LowModelOptions, MapKind, MapSet, bake,
    default_cage_offset,
};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use libfuzzer_sys::fuzz_target;

/// The texels of a side: the model is what varies, not the image.
const SIDE: u32 = 16;

fuzz_target!(|bytes: &[u8]| {
    let _refused = bake_onto_itself(bytes);
});

/// Errors: one sentence.
fn bake_onto_itself(bytes: &[u8]) -> Result<(), String> {
    let sentence = |error: darboux_io::Error| error.to_string();
    let document =
        Document::from_bytes("input", bytes.to_vec(), None, &LoadOptions::default()).map_err(sentence)?;
    let corners = document.corners().map_err(sentence)?;
    let low = LowModel::read(&document, &corners, &LowModelOptions::default()).map_err(sentence)?;
    let (documents, all_corners) = (std::slice::from_ref(&document), std::slice::from_ref(&corners));
    let highs =
        HighModel::read_all(documents, all_corners, &HighModelOptions::default()).map_err(sentence)?;
    let low_surfaces = low.surfaces().map_err(sentence)?;
    let high_surfaces = HighModel::surfaces_of_all(&highs).map_err(sentence)?;
    let options = BakeOptions::new([SIDE; 2], [default_cage_offset(low.diagonal()); 2])
        .with_maps(MapSet::of(&[MapKind::Normal, MapKind::Height, MapKind::Occlusion, MapKind::Position]))
        .with_occlusion(2, f32::INFINITY);
    let baked = bake(&low_surfaces, &high_surfaces, &options, &mut Context::new(), &mut |_| {})
        .map_err(|error| error.to_string())?;
    let normals = baked.images.numbers(MapKind::Normal).unwrap_or_default();
    assert!(normals.iter().all(|x| x.is_finite()), "a normal that is not finite");
    Ok(())
}
