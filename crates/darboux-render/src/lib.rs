//! Pictures of models and their tangent frames, drawn without a window.
//!
//! A [`Model`] is read from a document that has its tangents; [`render`] draws one [`View`] of it, or of two side by side.

mod algebra;
mod camera;
mod derivatives;
mod error;
mod heat;
mod layout;
mod mipmaps;
mod model;
mod painter;
mod pipelines;
mod pose;
mod seams;
mod strokes;
mod target;
mod textures;
mod uniforms;

use darboux_gpu::Gpu;

pub use camera::Camera;
pub use error::RenderError;
pub use heat::HeatScale;
pub use layout::Layout;
pub use model::Model;
pub use strokes::{LINE_COLORS, Lines, SEAM_COLOR};

use camera::Sight;
use layout::Inset;
use painter::{Shape, Show};

/// What the surface is painted with.
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
    Angle,
}

/// Where the sign w is 1, and where it is -1, in sRGB; the viewer's.
pub const SIGN_COLORS: [[u8; 3]; 2] = [[61, 139, 217], [232, 135, 58]];

/// Mistakes that circulate, made to see what they look like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mistakes {
    /// The green channel of normal maps is flipped.
    pub green: bool,
    /// The sign of tangents is flipped.
    pub w: bool,
    /// Images are sampled at 1 - v.
    pub v: bool,
}

/// What is drawn on one side of a picture.
#[derive(Clone, Copy)]
pub struct Side<'a> {
    /// The model, with its tangents.
    pub model: &'a Model<'a>,
    /// What is done wrong with it.
    pub mistakes: Mistakes,
}

/// How a picture is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderOptions {
    /// What the surface is painted with.
    pub view: View,
    /// The vectors of frames that are drawn as lines.
    pub lines: Lines,
    /// Whether edges are drawn across which the sign changes: where a texture meets its mirror image.
    pub seams: bool,
    /// Where the UV layout is drawn, in the colours of the view; in those of [`View::Sign`] where that is shaded.
    pub layout: Option<Layout>,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Where the model is seen from.
    pub camera: Camera,
    /// The colour behind the model, in sRGB.
    pub background: [u8; 3],
    /// The colours of [`View::Angle`].
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
/// `left`: what is drawn. `right`: what is drawn in its place right of a part of the width, from 0 to 1; a model of the same size, as the
/// left one's decides what is in view. Errors: a size that the adapter cannot draw; nothing to draw; what stops the adapter.
pub fn render(
    gpu: &Gpu,
    left: Side<'_>,
    right: Option<(Side<'_>, f64)>,
    options: &RenderOptions,
) -> Result<Picture, RenderError> {
    target::check_size(gpu, options.size)?;
    let shows_model = options.layout != Some(Layout::Alone);
    let mut warnings = Vec::new();
    let mut draw = |shape: Shape, size: [u32; 2]| {
        let bounds = left.model.bounds(shape).ok_or(RenderError::Nothing)?;
        let show = Show { left, right, shape, size, sight: sight(options, shape, bounds, size), options };
        gpu.with_error_scopes(|| painter::paint(gpu, &show, &mut warnings))
    };
    let mut pixels = draw(if shows_model { Shape::Model } else { Shape::Layout }, options.size)?;
    match Inset::of(options).map(|inset| (draw(Shape::Layout, inset.size()), inset)) {
        Some((Err(RenderError::Nothing), _)) => warnings.push("has no UVs that could be laid out".to_owned()),
        Some((square, inset)) => inset.put(&square?, &mut pixels),
        None => {}
    }
    Ok(Picture { size: options.size, pixels, warnings })
}

fn sight(options: &RenderOptions, shape: Shape, bounds: camera::Bounds, [width, height]: [u32; 2]) -> Sight {
    let aspect = f64::from(width) / f64::from(height);
    match shape {
        Shape::Layout => camera::flat(bounds, aspect),
        Shape::Model => options.camera.facing(bounds, aspect),
    }
}
