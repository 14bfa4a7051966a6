//! Labels: the number of the material, mesh or part, or the code of a colour.

use super::vertex_color;
use crate::IdSource;
use crate::found::Found;

/// The label of a hit, a whole number below 2^24.
pub fn label(found: &Found<'_>) -> f64 {
    let labels = found.group.surface(&found.high).labels;
    match found.options.id_source {
        IdSource::Material => f64::from(labels.material),
        IdSource::Mesh => f64::from(labels.mesh),
        IdSource::Part => f64::from(labels.part),
        IdSource::VertexColor => {
            let [red, green, blue, _] = vertex_color::color(found).map(code);
            65_536.0 * red + 256.0 * green + blue
        }
    }
}

/// The code of a channel in 8 bits.
fn code(channel: f64) -> f64 {
    (255.0 * channel).clamp(0.0, 255.0).round()
}
