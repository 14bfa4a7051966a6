//! The colours of the high surface's vertices.

use crate::color_texture::Color;
use crate::found::Found;
use crate::vector::weighted;

/// The interpolated colour; white where there is none.
pub fn color(found: &Found<'_>) -> Color {
    let surface = found.group.surface(&found.high);
    let vertices = surface.vertices(found.high.triangle);
    let weights = found.hit.weights.map(f64::from);
    surface.colors.map_or([1.0; 4], |colors| weighted(weights, vertices.map(|vertex| colors.get(vertex))))
}
