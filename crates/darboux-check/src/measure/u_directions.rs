//! The u directions of triangles: where the position goes as u grows.
//!
//! The methods that follow UVs sum the u directions of the triangles around a vertex with positive weights,
//! so that the sum lies between them. A tangent far outside their range is wrong, whatever the method.

use std::collections::{BTreeSet, HashMap};

use crate::measure::expected::is_measured;
use crate::surface::{Surface, cross, dot, length, sub, uv_area};

/// Compression stores UVs with 12 bits or more: a triangle is thin only if its height is a smaller part of
/// the extent of all UVs than this, and than 1 in 50 of its longest edge.
const THIN: f64 = 1.0 / 4096.0;

/// The most vertices at one place that are compared with the triangles there, which bounds the time.
const MAX_AT_ONE_PLACE: usize = 8;

/// The derivative of the position along u, up to a positive factor; none where a triangle has no area in UV
/// space or no such direction.
pub fn u_direction(surface: &Surface, uvs: &[[f32; 2]], triangle: [usize; 3]) -> Option<[f32; 3]> {
    let [a, b, c] = triangle.map(|vertex| surface.positions[vertex]);
    let area = uv_area(uvs, triangle);
    let [s, t, r] = triangle.map(|vertex| f64::from(uvs[vertex][1]));
    let [to_b, to_c] = [sub(b, a), sub(c, a)];
    let along = |i: usize| ((r - s) * f64::from(to_b[i]) - (t - s) * f64::from(to_c[i])) * area.signum();
    let direction = [0, 1, 2].map(|i| along(i) as f32);
    (area != 0.0 && length(direction) > 0.0).then_some(direction)
}

/// The triangles that are so thin in UV space that rounding their UVs could flip their u directions.
pub struct Thin<'a> {
    uvs: &'a [[f32; 2]],
    /// The height below which a triangle may be thin.
    height: f64,
}

impl<'a> Thin<'a> {
    pub fn among(uvs: &'a [[f32; 2]]) -> Self {
        Self { uvs, height: THIN * extent(uvs) }
    }

    pub fn contains(&self, triangle: [usize; 3]) -> bool {
        let [a, b, c] = triangle.map(|vertex| self.uvs[vertex].map(f64::from));
        let edge = |[p, q]: [[f64; 2]; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
        let longest = [[a, b], [b, c], [c, a]].map(edge).into_iter().fold(0.0, f64::max);
        let area = uv_area(self.uvs, triangle).abs();
        area < 0.02 * longest * longest && area < self.height * longest
    }
}

/// The larger side of the bounding box of UVs.
fn extent(uvs: &[[f32; 2]]) -> f64 {
    let side = |i: usize| {
        let values = uvs.iter().map(|uv| f64::from(uv[i])).filter(|x| x.is_finite());
        let [low, high] =
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
        (high - low).max(0.0)
    };
    side(0).max(side(1))
}

/// The angles from a tangent to the u directions around its vertex, in degrees.
struct Angles {
    least: f64,
    greatest: f64,
}

/// Of some vertices, ascending, those whose tangents lie more than `degrees` outside the range of the u
/// directions around them. `tangent_of`: the direction of a vertex's tangent. Vertices at one place with one
/// normal count as one, as methods and exporters weld them. Left out are vertices of triangles that are thin
/// or have no area in UV space, and those of a place with more than [`MAX_AT_ONE_PLACE`] of the vertices.
pub fn outside_u_directions(
    surface: &Surface,
    mut vertices: Vec<usize>,
    tangent_of: impl Fn(usize) -> [f32; 3],
    degrees: f64,
) -> Vec<usize> {
    let Surface { normals: Some(normals), uv_sets, uv_set, .. } = surface else { return Vec::new() };
    let Some(uvs) = uv_sets.get(uv_set) else { return Vec::new() };
    // Positive and negative zeros are equal.
    let bits = |of: [f32; 3]| of.map(|x| (x + 0.0).to_bits());
    let place = |vertex: usize| [bits(surface.positions[vertex]), bits(normals[vertex])];
    let mut at_places: HashMap<_, Vec<usize>> = HashMap::new();
    vertices.iter().for_each(|&vertex| at_places.entry(place(vertex)).or_default().push(vertex));
    at_places.retain(|_, vertices| vertices.len() <= MAX_AT_ONE_PLACE);
    let (mut around, mut in_doubt) = (HashMap::<usize, Angles>::new(), BTreeSet::new());
    let thin = Thin::among(uvs);
    for triangle in surface.triangles() {
        let is_sure = is_measured(surface, uvs, triangle) && !thin.contains(triangle);
        let along_u = u_direction(surface, uvs, triangle).filter(|_| is_sure);
        for &vertex in triangle.iter().filter_map(|&corner| at_places.get(&place(corner))).flatten() {
            let Some(along_u) = along_u else {
                in_doubt.insert(vertex);
                continue;
            };
            let angle = angle_around(normals[vertex], tangent_of(vertex), along_u);
            let angles = around.entry(vertex).or_insert(Angles { least: angle, greatest: angle });
            (angles.least, angles.greatest) = (angles.least.min(angle), angles.greatest.max(angle));
        }
    }
    let is_outside = |angles: &Angles| angles.least > degrees || angles.greatest < -degrees;
    vertices.retain(|vertex| !in_doubt.contains(vertex) && around.get(vertex).is_some_and(is_outside));
    vertices
}

/// The angle from one direction to another around a normal, in degrees from -180 to 180.
fn angle_around(normal: [f32; 3], from: [f32; 3], to: [f32; 3]) -> f64 {
    let in_plane = dot(from, to) * dot(normal, normal) - dot(normal, from) * dot(normal, to);
    (dot(cross(from, to), normal) * length(normal)).atan2(in_plane).to_degrees()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    /// Triangles around the origin. The u directions are along x where x is positive, and turned by -45
    /// degrees where it is negative. `further`: the positions and UVs of the other corners of one more
    /// triangle.
    fn fan(further: Option<[([f32; 3], [f32; 2]); 2]>) -> Surface {
        let ring = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
        let uv = |[x, y]: [f32; 2]| [x, y + x.min(0.0)];
        let mut positions = vec![[0.0; 3]];
        let mut uvs = vec![[0.0; 2]];
        positions.extend(ring.map(|[x, y]| [x, y, 0.0]));
        uvs.extend(ring.map(uv));
        let mut indices = vec![0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1];
        if let Some(corners) = further {
            indices.extend([0, 5, 6]);
            positions.extend(corners.map(|(position, _)| position));
            uvs.extend(corners.map(|(_, uv)| uv));
        }
        let normals = vec![[0.0, 0.0, 1.0]; positions.len()];
        let mut surface = Surface { normals: Some(normals), ..Surface::of_triangles(positions, indices) };
        surface.uv_sets.insert(0, Arc::new(uvs));
        surface
    }

    /// Whether a tangent of the vertex at the origin lies more than 20 degrees outside the range.
    fn is_outside(surface: &Surface, degrees: f32) -> bool {
        let (sin, cos) = degrees.to_radians().sin_cos();
        !outside_u_directions(surface, vec![0], |_| [cos, sin, 0.0], 20.0).is_empty()
    }

    #[test]
    fn only_tangents_that_no_sum_of_u_directions_gives_are_outside_their_range() {
        let surface = fan(None);
        for degrees in [0.0, 15.0, -20.0, -45.0, -60.0, 170.0] {
            assert!(!is_outside(&surface, degrees), "{degrees}");
        }
        for degrees in [25.0, 90.0, -70.0, -130.0] {
            assert!(is_outside(&surface, degrees), "{degrees}");
        }
    }

    /// Rounding may have turned the u direction of such a triangle.
    #[test]
    fn vertices_of_thin_and_flat_triangles_are_in_doubt() {
        let corners = [[0.5, 0.2, 0.0], [0.5, 0.3, 0.0]];
        for (case, uvs) in
            [("thin", [[0.5, 0.2], [0.2501, 0.1]]), ("no area in UV space", [[0.5, 0.2], [0.25, 0.1]])]
        {
            let surface = fan(Some([(corners[0], uvs[0]), (corners[1], uvs[1])]));
            assert!(!is_outside(&surface, 90.0), "{case}");
        }
        let surface = fan(Some([(corners[0], [0.5, 0.2]), (corners[1], [0.5, 0.3])]));
        assert!(is_outside(&surface, 90.0), "neither");
    }
}
