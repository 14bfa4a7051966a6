//! Draws models for a page.

use darboux::{NormalOptions, Shading};
use darboux_gpu::Gpu;
use darboux_io::gltf::{AddNormalsOptions, AddTangentsOptions, Document, add_normals, add_tangents};
use darboux_render::{Camera, HeatScale, Mistakes, Model, RenderOptions, Side, View, render};

use super::raster::Raster;
use crate::commands::render::no_adapter;
use crate::gpu::without_driver_messages;
use crate::heat_scale::{ENDS, FLIP, RAMP};

const BACKGROUND: [u8; 3] = [51, 55, 62];

/// Opens an adapter. Errors: a clause that says what to do.
pub fn open_adapter() -> Result<Gpu, String> {
    without_driver_messages(|| pollster::block_on(Gpu::open())).map_err(no_adapter)
}

/// Adds the normals and tangents that are missing, as renderers do.
pub fn complete(document: &mut Document) -> Result<(), darboux_io::Error> {
    let flat = NormalOptions::new().with_shading(Shading::Flat);
    add_normals(document, &AddNormalsOptions::default().with_normals(flat), &mut |_| {})?;
    add_tangents(document, &AddTangentsOptions::default(), &mut |_| {})?;
    Ok(())
}

/// Draws a model in the light of the studio. `frame`: the model that is in view as a whole. Errors: one
/// sentence.
pub fn draw(
    gpu: &Gpu,
    model: &Model<'_>,
    frame: &Model<'_>,
    [yaw, pitch]: [f64; 2],
    size: [u32; 2],
) -> Result<Raster, String> {
    let heat = HeatScale { ends: ENDS.map(|end| end as f32), ramp: RAMP, flip: FLIP, none: [0; 3] };
    let options = RenderOptions::new(View::Shaded, size, heat)
        .with_camera(Camera { yaw, pitch, zoom: 1.0 })
        .with_background(BACKGROUND);
    let side = |model| Side { model, mistakes: Mistakes::default() };
    // The left side decides what is in view; the right one covers it whole.
    let picture = render(gpu, side(frame), Some((side(model), 0.0)), &options);
    let picture = picture.map_err(|error| error.to_string())?;
    Ok(Raster { size, pixels: picture.pixels })
}
