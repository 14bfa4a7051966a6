//! The u directions of triangles: where the position goes as u grows.
//!
//! All methods sum the u directions of the triangles around a vertex with positive weights, so that the sum
//! lies between them. A tangent that is far from all of them, on the same side, is wrong, whatever the
//! method.

use std::collections::{BTreeSet, HashMap};

use crate::measure::expected::is_measured;
use crate::surface::{Surface, cross, dot, length, sub, uv_area, xyz};

/// Compression stores UVs with 12 bits or more: a triangle is thin only if its height is a smaller part of
/// the extent of all UVs than this, and than 1 in 50 of its longest edge.
const THIN: f64 = 1.0 / 4096.0;

/// The most vertices at one place that are compared with the triangles there, which bounds the time.
const MAX_AT_ONE_PLACE: usize = 8;

/// The derivative of the position along u, up to a positive factor; none where a triangle has no area.
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

/// Of some vertices, ascending, those whose tangents are more than `degrees` from all that lies between the u
/// directions around them. Vertices at one place with one normal count as one, as methods and exporters weld
/// them. A vertex of a thin triangle is left out.
pub fn beside_u_directions(surface: &Surface, mut vertices: Vec<usize>, degrees: f64) -> Vec<usize> {
    let Surface { tangents: Some(tangents), normals: Some(normals), uv_sets, uv_set, .. } = surface else {
        return Vec::new();
    };
    let Some(uvs) = uv_sets.get(uv_set) else { return Vec::new() };
    // Positive and negative zeros are equal.
    let bits = |of: [f32; 3]| of.map(|x| (x + 0.0).to_bits());
    let place = |vertex: usize| [bits(surface.positions[vertex]), bits(normals[vertex])];
    let mut at_places: HashMap<_, Vec<usize>> = HashMap::new();
    vertices.iter().for_each(|&vertex| at_places.entry(place(vertex)).or_default().push(vertex));
    at_places.retain(|_, vertices| vertices.len() <= MAX_AT_ONE_PLACE);
    let (mut around, mut in_doubt) = (HashMap::<usize, Angles>::new(), BTreeSet::new());
    let thin = Thin::among(uvs);
    for triangle in surface.triangles().filter(|triangle| is_measured(surface, uvs, *triangle)) {
        let along_u = u_direction(surface, uvs, triangle).filter(|_| !thin.contains(triangle));
        for &vertex in triangle.iter().filter_map(|&corner| at_places.get(&place(corner))).flatten() {
            let Some(along_u) = along_u else {
                in_doubt.insert(vertex);
                continue;
            };
            let angle = angle_around(normals[vertex], xyz(tangents[vertex]), along_u);
            let angles = around.entry(vertex).or_insert(Angles { least: angle, greatest: angle });
            (angles.least, angles.greatest) = (angles.least.min(angle), angles.greatest.max(angle));
        }
    }
    let is_beside = |angles: &Angles| angles.least > degrees || angles.greatest < -degrees;
    vertices.retain(|vertex| !in_doubt.contains(vertex) && around.get(vertex).is_some_and(is_beside));
    vertices
}

/// The angle from one direction to another around a normal, in degrees from -180 to 180.
fn angle_around(normal: [f32; 3], from: [f32; 3], to: [f32; 3]) -> f64 {
    let in_plane = dot(from, to) * dot(normal, normal) - dot(normal, from) * dot(normal, to);
    (dot(cross(from, to), normal) * length(normal)).atan2(in_plane).to_degrees()
}
