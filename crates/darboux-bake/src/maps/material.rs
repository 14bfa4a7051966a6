//! What the materials of the high surface show, as glTF 2.0 defines it (3.9.2 to 3.9.4), over the footprint
//! of the sample.
//!
//! The sides of the sample's area on the low surface are moved along the ray into the plane of the high
//! triangle. There they change the weights of its corners, and with them the UVs: the footprint in the
//! texture.

use super::vertex_color;
use crate::MaterialProperty;
use crate::color_texture::Color;
use crate::found::Found;
use crate::material::TrianglePlace;
use crate::vector::{Vector, add_scaled, cross, dot, length, sub, unit, wide};

/// The least cosine between the ray and the normal of the plane with which sides are moved: at grazing angles
/// footprints would have no end.
const LEAST_COSINE: f64 = 0.1;

/// Red, green and blue, times the vertex colours.
pub fn base_color(found: &Found<'_>) -> Vector {
    let (shown, vertex) = (mean(found, MaterialProperty::BaseColor), vertex_color::color(found));
    [0, 1, 2].map(|i| shown[i] * vertex[i])
}

/// What alpha, times the vertices' alpha, means for the material.
pub fn opacity(found: &Found<'_>) -> f64 {
    let alpha = mean(found, MaterialProperty::BaseColor)[3] * vertex_color::color(found)[3];
    found.group.surface(&found.high).material.opacity(alpha)
}

/// The roughness, and the metalness.
pub fn roughness_and_metalness(found: &Found<'_>) -> [f64; 2] {
    found.group.surface(&found.high).material.roughness_and_metalness(&place(found))
}

/// Red, green and blue.
pub fn emission(found: &Found<'_>) -> Vector {
    let [red, green, blue, _] = mean(found, MaterialProperty::Emission);
    [red, green, blue]
}

/// All channels of the texture that was chosen.
pub fn texture(found: &Found<'_>) -> Color {
    mean(found, MaterialProperty::Texture)
}

fn mean(found: &Found<'_>, property: MaterialProperty) -> Color {
    found.group.surface(&found.high).material.mean(property, &place(found))
}

fn place(found: &Found<'_>) -> TrianglePlace {
    let surface = found.group.surface(&found.high);
    let vertices = surface.vertices(found.high.triangle);
    TrianglePlace {
        vertices,
        weights: found.hit.weights.map(f64::from),
        changes: changes(surface.corners(vertices).map(wide), found),
    }
}

/// How the weights of a triangle's corners change along the sides of the sample's area.
fn changes([a, b, c]: [Vector; 3], found: &Found<'_>) -> [[f64; 3]; 2] {
    let plane = cross(sub(b, a), sub(c, a));
    let square = dot(plane, plane);
    let direction = unit(sub(found.position, found.low.position));
    let direction = direction.filter(|direction| dot(*direction, plane).abs() > LEAST_COSINE * length(plane));
    found.low.sides.map(|side| {
        let moved = match direction {
            Some(direction) => add_scaled(side, -dot(side, plane) / dot(direction, plane), direction),
            None => add_scaled(side, -dot(side, plane) / square, plane),
        };
        let of_b = dot(moved, cross(sub(c, a), plane)) / -square;
        let of_c = dot(moved, cross(sub(b, a), plane)) / square;
        [-of_b - of_c, of_b, of_c]
    })
}
