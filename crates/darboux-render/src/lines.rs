//! Computes the lines over a model: tangents, bitangents and normals at its vertices, and mirrored edges.

use std::collections::HashSet;

use darboux::Transform;

use crate::algebra::{Matrix, cross, direction_columns};
use crate::camera::ViewTransform;
use crate::mirrored_edges::mirrored_edges;
use crate::options::{LINE_COLORS, LINE_DASHES, Lines, Mistakes, RenderOptions, SEAM_COLOR};
use crate::part::Part;
use crate::vertex::{Segment, SurfaceVertex};

/// The most vertices of a part that have lines. Of larger parts every n-th vertex has lines, because more
/// would hide each other.
const MAX_LINE_VERTICES: usize = 50_000;

/// The part of a dash's length that is drawn.
const DRAWN_PART: f64 = 0.6;

/// The most lines, which take 151 MB of the 256 MB that every adapter allows a buffer. Small files can ask
/// for any number.
pub const MAX_SEGMENTS: usize = 1 << 22;

/// The first `limit` lines over the parts, and whether these are all. `color`: converts an sRGB colour to the
/// format of the target.
pub fn segments(
    parts: &[Part],
    mistakes: Mistakes,
    transform: &ViewTransform,
    options: &RenderOptions,
    limit: usize,
    color: impl Fn([u8; 3]) -> [f32; 3],
) -> (Vec<Segment>, bool) {
    let color = &color;
    let of_part = |part| {
        let vectors = vector_segments(part, mistakes, transform, options, color);
        vectors.into_iter().chain(edge_segments(part, transform, options, color))
    };
    let mut all = parts.iter().flat_map(of_part);
    let first = all.by_ref().take(limit).collect();
    (first, all.next().is_none())
}

/// The lines along the vectors at the vertices of a part.
fn vector_segments(
    part: &Part,
    mistakes: Mistakes,
    transform: &ViewTransform,
    options: &RenderOptions,
    color: &impl Fn([u8; 3]) -> [f32; 3],
) -> Vec<Segment> {
    let Lines { tangent, bitangent, normal, length } = options.lines;
    let matrices = &part.matrices;
    let is_drawn = [tangent, bitangent, normal];
    let mut out = Vec::new();
    let roots = if is_drawn.contains(&true) { distinct_vertices(&part.corners) } else { Vec::new() };
    let step = (roots.len() * matrices.len()).div_ceil(MAX_LINE_VERTICES).max(1);
    let instances = matrices.iter().flat_map(|matrix| roots.iter().map(move |root| (matrix, root)));
    for (matrix, corner) in instances.step_by(step) {
        let from = transform.point(matrix, corner.position);
        let vectors = vectors(matrix, corner, if mistakes.w { -1.0 } else { 1.0 });
        for (at, vector) in vectors.into_iter().enumerate().filter(|&(at, _)| is_drawn[at]) {
            let along = transform.direction(vector.map(f64::from));
            let point = |part: f64| [0, 1, 2].map(|i| from[i] + part * length * along[i]);
            let dashes = f64::from(LINE_DASHES[at]);
            let drawn = if LINE_DASHES[at] > 1 { DRAWN_PART } else { 1.0 };
            out.extend((0..LINE_DASHES[at]).map(f64::from).map(|dash| {
                segment([dash, dash + drawn].map(|end| point(end / dashes)), color(LINE_COLORS[at]))
            }));
        }
    }
    out
}

/// The lines along the mirrored edges of a part at all its places.
fn edge_segments(
    part: &Part,
    transform: &ViewTransform,
    options: &RenderOptions,
    color: &impl Fn([u8; 3]) -> [f32; 3],
) -> impl Iterator<Item = Segment> {
    let edges = if options.seams { mirrored_edges(&part.corners) } else { Vec::new() };
    let color = color(SEAM_COLOR);
    (0..part.matrices.len().saturating_mul(edges.len())).map(move |at| {
        let matrix = &part.matrices[at / edges.len()];
        segment(edges[at % edges.len()].map(|end| transform.point(matrix, end)), color)
    })
}

fn segment(ends: [[f64; 3]; 2], color: [f32; 3]) -> Segment {
    Segment { ends: ends.map(|end| end.map(|x| x as f32)), color }
}

/// One corner of each distinct position, normal and tangent.
fn distinct_vertices(corners: &[SurfaceVertex]) -> Vec<&SurfaceVertex> {
    let bits = |corner: &SurfaceVertex| {
        (corner.position.map(f32::to_bits), corner.normal.map(f32::to_bits), corner.tangent.map(f32::to_bits))
    };
    let mut seen = HashSet::new();
    corners.iter().filter(|corner| seen.insert(bits(corner))).collect()
}

/// The unit tangent, bitangent and normal in the scene; zero if there is none. As in shading, the tangent is
/// not made perpendicular to the normal.
fn vectors(matrix: &Matrix, corner: &SurfaceVertex, w_factor: f32) -> [[f32; 3]; 3] {
    let columns = direction_columns(matrix);
    let transform = Transform::new(columns);
    let [x, y, z, w] = corner.tangent;
    let normal = transform.normal(corner.normal);
    let tangent = unit([0, 1, 2].map(|i| x * columns[0][i] + y * columns[1][i] + z * columns[2][i]));
    let bitangent = unit(cross(normal, tangent)).map(|x| w_factor * transform.orientation() * w * x);
    [tangent, bitangent, unit(normal)]
}

fn unit(v: [f32; 3]) -> [f32; 3] {
    let size = v.iter().map(|x| x * x).sum::<f32>().sqrt();
    if size > 0.0 && size.is_finite() { v.map(|x| x / size) } else { [0.0; 3] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bytemuck::Zeroable;

    use crate::algebra::IDENTITY;
    use crate::camera;
    use crate::heat::HeatScale;
    use crate::options::View;

    /// Two triangles that share an edge, across which the sign changes.
    fn mirrored() -> Vec<SurfaceVertex> {
        let at = |[x, y]: [f32; 2], w: f32| SurfaceVertex {
            position: [x, y, 0.0],
            tangent: [1.0, 0.0, 0.0, w],
            ..SurfaceVertex::zeroed()
        };
        let [left, right] = [[[0.0, 0.0], [0.0, 1.0], [-1.0, 0.0]], [[0.0, 1.0], [0.0, 0.0], [1.0, 0.0]]];
        [left.map(|place| at(place, -1.0)), right.map(|place| at(place, 1.0))].concat()
    }

    #[test]
    fn the_lines_of_all_parts_are_limited() {
        let parts = [(); 2].map(|()| Part::of(mirrored(), &[IDENTITY; 3]));
        let transform = camera::flat([[-1.0, 0.0, 0.0], [1.0, 1.0, 0.0]], 1.0);
        let drawn = |limit: usize, tangent: bool| {
            let heat = HeatScale { ends: [0.01, 180.0], ramp: [[0; 3]; 9], flip: [0; 3], none: [0; 3] };
            let options = RenderOptions::new(View::Sign, [8; 2], heat)
                .with_lines(Lines::default().with_tangent(tangent))
                .with_seams(true);
            let color = |color: [u8; 3]| color.map(f32::from);
            let (lines, are_all) = segments(&parts, Mistakes::default(), &transform, &options, limit, color);
            (lines.len(), are_all)
        };
        // Two parts with a mirrored edge at each of three places; six vertices per place.
        assert_eq!([5, 6, 7].map(|limit| drawn(limit, false)), [(5, false), (6, true), (6, true)]);
        assert_eq!([2, 20, 41, 42].map(|limit| drawn(limit, true).1), [false, false, false, true]);
        assert_eq!([0, 20, 42].map(|limit| drawn(limit, true).0), [0, 20, 42]);
    }
}
