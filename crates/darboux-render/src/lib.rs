//! Pictures of models and their tangent frames, drawn without a window.
//!
//! A [`Model`] is read from a document that has its tangents; [`render`] draws one [`View`] of it.

mod camera;
mod error;
mod heat;
mod model;
mod painter;
mod target;
mod textures;

use darboux_gpu::Gpu;

pub use camera::Camera;
pub use error::RenderError;
pub use heat::HeatScale;
pub use model::Model;

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// The surface, its normal map lit from above right.
    Shaded,
    /// The tangent as a colour, 0.5 + 0.5 of each component, in the scene's directions.
    Tangent,
    /// The bitangent, likewise.
    Bitangent,
    /// The normal of the mesh, likewise.
    Normal,
    /// The sign w.
    Sign,
    /// The angle to the tangents that the model is compared with.
    Heat,
    /// The UV layout in the colours of [`View::Tangent`]: u to the right, v down.
    Uv,
}

/// How a picture is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderOptions {
    /// What is drawn.
    pub view: View,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Where the model is seen from.
    pub camera: Camera,
    /// The colour behind the model, in sRGB.
    pub background: [u8; 3],
    /// The colours of [`View::Heat`].
    pub heat: HeatScale,
}

/// A picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Their colours in sRGB, row after row.
    pub pixels: Vec<[u8; 3]>,
    /// What was drawn otherwise than the file says, such as images that cannot be decoded: one sentence each.
    pub warnings: Vec<String>,
}

/// Draws a model.
///
/// Errors: a size that the adapter cannot draw; nothing to draw; what stops the adapter.
pub fn render(gpu: &Gpu, model: &Model<'_>, options: &RenderOptions) -> Result<Picture, RenderError> {
    target::check_size(gpu, options.size)?;
    let Some(bounds) = model.bounds(options.view) else { return Err(RenderError::Nothing) };
    let [width, height] = options.size.map(f64::from);
    let sight = match options.view {
        View::Uv => camera::flat(bounds, width / height),
        _ => options.camera.facing(bounds, width / height),
    };
    let mut warnings = model.warnings(options.view);
    let pixels = gpu.guarded(|| painter::paint(gpu, model, &sight, options, &mut warnings))?;
    Ok(Picture { size: options.size, pixels, warnings })
}
