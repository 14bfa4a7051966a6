//! Draws pictures of glTF models and of their tangent frames, without a window.
//!
//! [`Model::read`] reads a document that has its tangents. [`render`] draws one [`View`] of a model, or of
//! two models side by side.
//!
//! ```no_run
//! # use darboux_gpu::Gpu;
//! # use darboux_io::gltf::Document;
//! # use darboux_render::{HeatScale, Mistakes, Model, RenderError, RenderOptions, Side, View, render};
//! # fn picture(gpu: &Gpu, document: &Document, heat: HeatScale) -> Result<(), Box<dyn std::error::Error>> {
//! let model = Model::read(document)?;
//! let options = RenderOptions::new(View::Tangent, [800, 600], heat);
//! let picture = render(gpu, Side { model: &model, mistakes: Mistakes::default() }, None, &options)?;
//! assert_eq!(picture.pixels.len(), 800 * 600);
//! # Ok(())
//! # }
//! ```
//!
//! ```text
//! options, subject, vertex, part    plain types
//! pose, model, derivatives, heat    from a document to triangles with tangents and colours
//! mistakes                          tangents as wrong code computes them
//! camera, mirrored_edges, lines     what is in view, and lines over the surface
//! ground                            the shadow below the model
//! studio, uniforms, textures, material_textures, pipelines
//!                                   data for the shaders surface.wgsl, studio.wgsl, lines.wgsl and ground.wgsl
//! drawing, painter, ground_painter, resources, target
//!                                   one pass over a picture or a UV layout, and reading it back
//! render, uv_inset                  the entry: the model, and the UV layout in a corner
//! ```

mod algebra;
mod camera;
mod derivatives;
mod drawing;
mod error;
mod ground;
mod ground_painter;
mod heat;
mod lines;
mod material_textures;
mod mipmaps;
mod mirrored_edges;
mod mistakes;
mod model;
mod options;
mod painter;
mod part;
mod pipelines;
mod pose;
mod render;
mod resources;
mod studio;
mod subject;
mod target;
mod textures;
mod uniforms;
mod uv_inset;
mod vertex;

pub use camera::{Camera, Look};
pub use drawing::Side;
pub use error::RenderError;
pub use heat::HeatScale;
pub use mistakes::FrameMistake;
pub use model::Model;
pub use options::{
    LINE_COLORS, LINE_DASHES, LayoutPlacement, Lines, Mistakes, RenderOptions, SEAM_COLOR, SIGN_COLORS, View,
};
pub use render::{Picture, render};

/// The example of README.md compiles.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
