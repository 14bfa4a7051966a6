//! Lines over a model: frames at its vertices, and seams.

use std::collections::HashSet;

use bytemuck::{Pod, Zeroable};
use darboux::Transform;

use crate::algebra::{Matrix, cross, direction_columns};
use crate::camera::Sight;
use crate::model::{Corner, Part};
use crate::seams::seams;
use crate::{Mistakes, RenderOptions};

/// The vectors of frames that are drawn as lines, at every vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lines {
    /// Tangents.
    pub tangent: bool,
    /// Bitangents.
    pub bitangent: bool,
    /// Normals.
    pub normal: bool,
    /// Their length, as a part of the model's radius.
    pub length: f64,
}

/// The colours of tangents, bitangents and normals as lines, in sRGB; the viewer's.
pub const LINE_COLORS: [[u8; 3]; 3] = [[255, 77, 77], [77, 210, 77], [92, 140, 255]];

/// The colour of mirrored seams, in sRGB.
pub const SEAM_COLOR: [u8; 3] = [255, 77, 216];

/// More lines of a part than this show nothing more: every so-many-th vertex is drawn then.
const MOST_LINES: usize = 50_000;

/// Small files can ask for any number, as of triangles: 151 MB of the 256 MB that every adapter gives a buffer.
pub const MOST_STROKES: usize = 1 << 22;

/// A line in the eye's space, as the shader takes it.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct Stroke {
    pub ends: [[f32; 3]; 2],
    pub color: [f32; 3],
}

/// The lines over the parts of a side, the first `most` of them, and whether these are all. `color`: gives a colour as the target takes it.
pub fn strokes(
    parts: &[Part],
    mistakes: Mistakes,
    sight: &Sight,
    options: &RenderOptions,
    most: usize,
    color: impl Fn([u8; 3]) -> [f32; 3],
) -> (Vec<Stroke>, bool) {
    let color = &color;
    let of_part = |part| {
        frames(part, mistakes, sight, options, color).into_iter().chain(seams_of(part, sight, options, color))
    };
    let mut all = parts.iter().flat_map(of_part);
    let first = all.by_ref().take(most).collect();
    (first, all.next().is_none())
}

/// The vectors at the vertices of a part.
fn frames(
    part: &Part,
    mistakes: Mistakes,
    sight: &Sight,
    options: &RenderOptions,
    color: &impl Fn([u8; 3]) -> [f32; 3],
) -> Vec<Stroke> {
    let Lines { tangent, bitangent, normal, length } = options.lines;
    let places = &part.places;
    let asked = [tangent, bitangent, normal];
    let mut out = Vec::new();
    let roots = if asked.contains(&true) { vertices(&part.corners) } else { Vec::new() };
    let step = (roots.len() * places.len()).div_ceil(MOST_LINES).max(1);
    let placed = places.iter().flat_map(|matrix| roots.iter().map(move |root| (matrix, root)));
    for (matrix, corner) in placed.step_by(step) {
        let from = sight.place(matrix, corner.position);
        let vectors = vectors(matrix, corner, if mistakes.w { -1.0 } else { 1.0 });
        for (at, vector) in vectors.into_iter().enumerate().filter(|&(at, _)| asked[at]) {
            let along = sight.turned(vector.map(f64::from));
            let to = [0, 1, 2].map(|i| from[i] + length * along[i]);
            out.push(stroke([from, to], color(LINE_COLORS[at])));
        }
    }
    out
}

/// The seams of a part at all its places.
fn seams_of(
    part: &Part,
    sight: &Sight,
    options: &RenderOptions,
    color: &impl Fn([u8; 3]) -> [f32; 3],
) -> impl Iterator<Item = Stroke> {
    let seams = if options.seams { seams(&part.corners) } else { Vec::new() };
    let color = color(SEAM_COLOR);
    (0..part.places.len().saturating_mul(seams.len())).map(move |at| {
        let matrix = &part.places[at / seams.len()];
        stroke(seams[at % seams.len()].map(|end| sight.place(matrix, end)), color)
    })
}

fn stroke(ends: [[f64; 3]; 2], color: [f32; 3]) -> Stroke {
    Stroke { ends: ends.map(|end| end.map(|x| x as f32)), color }
}

/// Corners of different places and frames, each once.
fn vertices(corners: &[Corner]) -> Vec<&Corner> {
    let bits = |corner: &Corner| {
        (corner.position.map(f32::to_bits), corner.normal.map(f32::to_bits), corner.tangent.map(f32::to_bits))
    };
    let mut known = HashSet::new();
    corners.iter().filter(|corner| known.insert(bits(corner))).collect()
}

/// The unit tangent, bitangent and normal in the scene; zero where there is none. As the surface is shaded: the tangent is not made
/// perpendicular to the normal.
fn vectors(matrix: &Matrix, corner: &Corner, side: f32) -> [[f32; 3]; 3] {
    let columns = direction_columns(matrix);
    let transform = Transform::new(columns);
    let [x, y, z, w] = corner.tangent;
    let normal = transform.normal(corner.normal);
    let tangent = unit([0, 1, 2].map(|i| x * columns[0][i] + y * columns[1][i] + z * columns[2][i]));
    let bitangent = unit(cross(normal, tangent)).map(|part| side * transform.orientation() * w * part);
    [tangent, bitangent, unit(normal)]
}

fn unit(v: [f32; 3]) -> [f32; 3] {
    let size = v.iter().map(|x| x * x).sum::<f32>().sqrt();
    if size > 0.0 && size.is_finite() { v.map(|x| x / size) } else { [0.0; 3] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::IDENTITY;
    use crate::{Camera, HeatScale, View, camera};

    /// Two triangles that share an edge, across which the sign changes.
    fn mirrored() -> Vec<Corner> {
        let at = |[x, y]: [f32; 2], w: f32| Corner {
            position: [x, y, 0.0],
            tangent: [1.0, 0.0, 0.0, w],
            ..Corner::zeroed()
        };
        let [left, right] = [[[0.0, 0.0], [0.0, 1.0], [-1.0, 0.0]], [[0.0, 1.0], [0.0, 0.0], [1.0, 0.0]]];
        [left.map(|place| at(place, -1.0)), right.map(|place| at(place, 1.0))].concat()
    }

    #[test]
    fn lines_and_seams_of_all_parts_end_at_a_limit() {
        let parts = [(); 2].map(|()| Part::of(mirrored(), &[IDENTITY; 3]));
        let sight = camera::flat([[-1.0, 0.0, 0.0], [1.0, 1.0, 0.0]], 1.0);
        let drawn = |most: usize, tangent: bool| {
            let options = RenderOptions {
                view: View::Sign,
                lines: Lines { tangent, ..Lines::default() },
                seams: true,
                layout: None,
                size: [8; 2],
                camera: Camera::default(),
                background: [0; 3],
                heat: HeatScale { ends: [0.01, 180.0], ramp: [[0; 3]; 9], flip: [0; 3], none: [0; 3] },
            };
            let color = |color: [u8; 3]| color.map(f32::from);
            let (strokes, are_all) = strokes(&parts, Mistakes::default(), &sight, &options, most, color);
            (strokes.len(), are_all)
        };
        // A seam at each of three places, twice; with it six vertices.
        assert_eq!([5, 6, 7].map(|most| drawn(most, false)), [(5, false), (6, true), (6, true)]);
        assert_eq!([2, 20, 41, 42].map(|most| drawn(most, true).1), [false, false, false, true]);
        assert_eq!([0, 20, 42].map(|most| drawn(most, true).0), [0, 20, 42]);
    }
}
