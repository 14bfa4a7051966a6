//! How UVs stretch a map over the faces of a surface, and how many texels they give each, compared with the
//! surface's own median.
//!
//! The derivatives of the position along u and v have a largest and a smallest length over all directions of
//! the plane, the singular values. Their ratio is the stretch, and the root of their product the length that
//! one unit of UV covers.
//!
//! Source: Sander, Snyder, Gortler, Hoppe, "Texture Mapping Progressive Meshes", 2001.

use crate::indices::Indices;
use crate::model_area::area_of;
use crate::surface::{Surface, dot, sub, uv_area};

/// Faces whose UVs differ from the UVs of the other faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Outliers {
    /// The numbers of the triangles, ascending.
    pub triangles: Indices,
    /// Their part of the surface's area, from 0 to 1.
    pub share: f64,
    /// The median over the surface's area, and the largest value of these faces: of the stretch, or of the
    /// length that a unit of UV covers.
    pub median: f64,
    pub largest: f64,
}

/// Faces that are stretched more than the others, and faces with fewer texels than the others; none where
/// they are too small a part.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UvScale {
    pub stretched: Option<Outliers>,
    pub coarse: Option<Outliers>,
}

/// How many times the median a stretch is, from which on it stands out, and the smallest stretch that is seen
/// at all.
const STRETCHED: f64 = 4.0;
const SEEN_STRETCH: f64 = 6.0;

/// How many times as long as the median a texel is, from which on a face is coarse.
const COARSE: f64 = 4.0;

/// The smallest part of the surface's area that is worth a finding.
const MIN_SHARE: f64 = 0.005;

/// A triangle with an area in space and in UV space.
struct Face {
    number: usize,
    area: f64,
    stretch: f64,
    length: f64,
}

impl UvScale {
    /// `uvs`: of the vertices.
    pub fn of(surface: &Surface, uvs: &[[f32; 2]]) -> Self {
        let faces: Vec<Face> = surface
            .triangles()
            .enumerate()
            .filter_map(|(number, triangle)| Face::new(surface, uvs, number, triangle))
            .collect();
        let all: f64 = faces.iter().map(|face| face.area).sum();
        let outliers = |value: fn(&Face) -> f64, factor: f64, least: f64| {
            let median = median(&faces, value)?;
            let found: Vec<&Face> =
                faces.iter().filter(|face| value(face) >= (factor * median).max(least)).collect();
            let share = found.iter().map(|face| face.area).sum::<f64>() / all;
            let largest = found.iter().map(|face| value(face)).fold(0.0, f64::max);
            let triangles = found.iter().map(|face| face.number).collect::<Vec<usize>>().as_slice().into();
            (share >= MIN_SHARE).then_some(Outliers { triangles, share, median, largest })
        };
        Self {
            stretched: outliers(|face| face.stretch, STRETCHED, SEEN_STRETCH),
            coarse: outliers(|face| face.length, COARSE, 0.0),
        }
    }
}

impl Face {
    fn new(surface: &Surface, uvs: &[[f32; 2]], number: usize, triangle: [usize; 3]) -> Option<Self> {
        let corners = triangle.map(|vertex| surface.positions[vertex]);
        let twice_uv_area = uv_area(uvs, triangle);
        let area = area_of(corners);
        let [origin, p, q] = triangle.map(|vertex| uvs[vertex].map(f64::from));
        let [[u1, v1], [u2, v2]] = [p, q].map(|end| [end[0] - origin[0], end[1] - origin[1]]);
        let edges = [sub(corners[1], corners[0]), sub(corners[2], corners[0])];
        let [aa, ab, bb] = [(0, 0), (0, 1), (1, 1)].map(|(i, j)| dot(edges[i], edges[j]));
        // The squared lengths of the derivatives along u and v, and their product, times the squared UV area.
        let product =
            |[p1, p2]: [f64; 2], [q1, q2]: [f64; 2]| p1 * q1 * aa + (p1 * q2 + p2 * q1) * ab + p2 * q2 * bb;
        let (along_u, along_v) = ([v2, -v1], [-u2, u1]);
        let (uu, uv, vv) = (product(along_u, along_u), product(along_u, along_v), product(along_v, along_v));
        let (sum, difference) = (uu + vv, (uu - vv).hypot(2.0 * uv));
        let (large, small) = ((sum + difference) / 2.0, (sum - difference) / 2.0);
        // The product of the squared singular values follows from the areas, which loses fewer digits than
        // the difference above.
        let exact = (2.0 * area * twice_uv_area.abs()).powi(2) / large;
        let small = if small > 1e-6 * large { small } else { exact };
        let (stretch, length) = ((large / small).sqrt(), (2.0 * area / twice_uv_area.abs()).sqrt());
        let is_usable = area > 0.0 && stretch.is_finite() && length.is_finite() && twice_uv_area != 0.0;
        is_usable.then_some(Self { number, area, stretch, length })
    }
}

/// The median of a value over the area of the faces; none without faces.
fn median(faces: &[Face], value: fn(&Face) -> f64) -> Option<f64> {
    let mut sorted: Vec<(f64, f64)> = faces.iter().map(|face| (value(face), face.area)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = sorted.iter().map(|(_, area)| area).sum::<f64>() / 2.0;
    let mut below = 0.0;
    sorted
        .into_iter()
        .find(|(_, area)| {
            below += area;
            below >= half
        })
        .map(|(value, _)| value)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Squares of side 1 beside each other, each with the sides of its UVs.
    fn squares(sides: &[[f32; 2]]) -> (Surface, Vec<[f32; 2]>) {
        let (mut positions, mut uvs, mut indices) = (Vec::new(), Vec::new(), Vec::new());
        for (number, side) in sides.iter().enumerate() {
            let first = positions.len() as u32;
            for [i, j] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
                positions.push([number as f32 + i, j, 0.0]);
                uvs.push([side[0] * i, side[1] * j]);
            }
            indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
        }
        let surface = Surface::of_triangles(positions, indices);
        (surface, uvs)
    }

    #[test]
    fn outliers_are_found_against_the_median() {
        let even = [[0.1, 0.1]; 9];
        let scale = |sides: &[[f32; 2]]| {
            let (surface, uvs) = squares(sides);
            UvScale::of(&surface, &uvs)
        };
        assert_eq!(scale(&even), UvScale::default());
        let stretched = scale(&[&even[..], &[[0.02, 0.2]]].concat()).stretched.expect("a stretched square");
        assert_eq!(stretched.triangles.iter().collect::<Vec<usize>>(), [18, 19]);
        assert!(
            (stretched.largest - 10.0).abs() < 1e-3 && (stretched.median - 1.0).abs() < 1e-3,
            "{stretched:?}"
        );
        assert!((stretched.share - 0.1).abs() < 1e-6, "{stretched:?}");
        let coarse = scale(&[&even[..], &[[0.02, 0.02]]].concat());
        assert_eq!(coarse.stretched, None);
        let coarse = coarse.coarse.expect("a coarse square");
        assert_eq!(coarse.triangles.iter().collect::<Vec<usize>>(), [18, 19]);
        // Where all are stretched, none stands out.
        assert_eq!(scale(&[[0.01, 0.2]; 9]), UvScale::default());
    }
}
