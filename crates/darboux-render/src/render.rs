//! The entry: draws the model, and the UV layout alone or in a corner.

use darboux_gpu::Gpu;

use crate::camera::{ViewTransform, flat};
use crate::drawing::{Drawing, Side};
use crate::error::RenderError;
use crate::model::Model;
use crate::options::{LayoutPlacement, RenderOptions};
use crate::painter;
use crate::subject::Subject;
use crate::target;
use crate::uv_inset::Inset;

/// A picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// The width and height in pixels.
    pub size: [u32; 2],
    /// The sRGB colours of the pixels, row by row.
    pub pixels: Vec<[u8; 3]>,
    /// What is missing in the picture, such as images that cannot be decoded. One sentence each, without the
    /// name of the file.
    pub warnings: Vec<String>,
}

/// Draws a model.
///
/// `right`: another model of the same size, which covers the picture from a fraction of its width on. The
/// left model determines the part of the scene that is in view.
///
/// Errors: the adapter cannot draw the size; there is nothing to draw; the adapter fails.
pub fn render(
    gpu: &Gpu,
    left: Side<'_>,
    right: Option<(Side<'_>, f64)>,
    options: &RenderOptions,
) -> Result<Picture, RenderError> {
    target::check_size(gpu, options.size)?;
    let mut warnings = Vec::new();
    let mut draw = |subject: Subject, size: [u32; 2]| {
        let transform =
            view_transform(options, subject, left.model, size).ok_or(RenderError::NothingToDraw)?;
        let drawing = Drawing { left, right, subject, size, transform, options };
        gpu.with_error_scopes(|| painter::paint(gpu, &drawing, &mut warnings))
    };
    let shows_surface = options.layout != Some(LayoutPlacement::Alone);
    let mut pixels = draw(if shows_surface { Subject::Surface } else { Subject::UvLayout }, options.size)?;
    match Inset::of(options).map(|inset| (draw(Subject::UvLayout, inset.size()), inset)) {
        Some((Err(RenderError::NothingToDraw), _)) => {
            warnings.push("has no finite UVs, so its UV layout is not drawn".to_owned());
        }
        Some((layout, inset)) => inset.copy_into(&layout?, &mut pixels),
        None => {}
    }
    Ok(Picture { size: options.size, pixels, warnings })
}

/// The transform that brings the whole subject into view; none if the subject is empty.
fn view_transform(
    options: &RenderOptions,
    subject: Subject,
    model: &Model<'_>,
    [width, height]: [u32; 2],
) -> Option<ViewTransform> {
    let aspect = f64::from(width) / f64::from(height);
    let bounds = model.bounds(subject)?;
    Some(match subject {
        Subject::UvLayout => flat(bounds, aspect),
        Subject::Surface => match options.look {
            Some(look) => look.transform(bounds, aspect),
            None => options.camera.frame(bounds, aspect, |visit| model.visit_points(subject, visit)),
        },
    })
}
