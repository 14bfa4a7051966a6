//! The summing methods, the face method and the normal method in f64: for every corner a loop over all
//! triangles.

use darboux::{Frame, Mesh};

use super::triangles::{
    Corner, Space, Triangle, force_quads_to_agree, is_degenerate, triangulate, uv_area, weld,
};
use super::vectors::{Vec3, add, cross, dot, flatten, length, normalize, scale, sub};

/// The weight of a triangle's unit tangent and bitangent.
#[derive(Clone, Copy, PartialEq)]
enum Weight {
    /// The lengths of dP/du and dP/dv.
    Length,
    One,
    Area,
}

/// Like [`Method::Lengyel`](darboux::Method::Lengyel) without repairs: none where the sum has no direction.
pub fn lengyel(mesh: &Mesh<'_>) -> Vec<Option<Frame>> {
    sums(mesh, true, Weight::Length)
}

/// Like [`Method::LengyelPerVertex`](darboux::Method::LengyelPerVertex) without repairs.
pub fn lengyel_per_vertex(mesh: &Mesh<'_>) -> Vec<Option<Frame>> {
    sums(mesh, false, Weight::Length)
}

/// Like [`Method::Average`](darboux::Method::Average) without repairs.
pub fn average(mesh: &Mesh<'_>) -> Vec<Option<Frame>> {
    sums(mesh, true, Weight::One)
}

/// Like [`Method::Area`](darboux::Method::Area) without repairs.
pub fn area(mesh: &Mesh<'_>) -> Vec<Option<Frame>> {
    sums(mesh, true, Weight::Area)
}

/// Like [`Method::Face`](darboux::Method::Face) without repairs. A quad has the mean of its halves, weighted
/// by signed UV area.
pub fn face(mesh: &Mesh<'_>) -> Vec<Option<Frame>> {
    let scene = Scene::new(mesh);
    let of_corner = |number: usize| {
        let (mut s, mut t, mut total) = ([0.0; 3], [0.0; 3], 0.0);
        for half in scene.triangles.iter().filter(|half| half.face == scene.face_of_corner[number]) {
            let area = uv_area(half.corners.map(|corner| &scene.corners[corner]));
            s = add(s, scale(area * half.space.magnitude[0], half.space.s));
            t = add(t, scale(area * half.space.magnitude[1], half.space.t));
            total += area;
        }
        let [s, t] = [s, t].map(|v| scale(1.0 / total, v));
        let space = Space {
            s: normalize(s),
            t: normalize(t),
            magnitude: [length(s), length(t)],
            keeps_orientation: total > 0.0,
        };
        (total != 0.0 && length(s) > 0.0 && length(t) > 0.0).then(|| space.to_frame())
    };
    (0..scene.corners.len()).map(of_corner).collect()
}

/// Like [`Method::FromNormal`](darboux::Method::FromNormal): (1, 0, 0), turned by the shortest rotation from
/// the pole (0, 0, ±1) on the normal's side to the normal. That is Duff's basis.
pub fn from_normal(mesh: &Mesh<'_>) -> Vec<Option<Frame>> {
    let of_corner = |number: usize| {
        let normal = normalize(mesh.normals().get(mesh.vertex_of_corner(number)).map(f64::from));
        let pole = [0.0, 0.0, 1f64.copysign(normal[2])];
        // The rotation is two reflections: by the pole, then by the direction half-way to the normal.
        let half = normalize(add(pole, normal));
        let reflect = |v: Vec3, by: Vec3| sub(scale(2.0 * dot(by, v), by), v);
        let s = reflect(reflect([1.0, 0.0, 0.0], pole), half);
        let space = Space { s, t: cross(normal, s), magnitude: [1.0; 2], keeps_orientation: true };
        (length(normal) > 0.0).then(|| space.to_frame())
    };
    (0..mesh.corner_count()).map(of_corner).collect()
}

struct Scene {
    /// The corners, not welded: each has the mesh's vertex.
    corners: Vec<Corner>,
    face_of_corner: Vec<usize>,
    triangles: Vec<Triangle>,
}

impl Scene {
    fn new(mesh: &Mesh<'_>) -> Self {
        let mut corners = weld(mesh);
        for (number, corner) in corners.iter_mut().enumerate() {
            corner.vertex = mesh.vertex_of_corner(number);
        }
        let mut triangles = triangulate(mesh, &corners);
        force_quads_to_agree(&mut triangles, &corners);
        let mut face_of_corner = vec![usize::MAX; corners.len()];
        for triangle in &triangles {
            triangle.corners.iter().for_each(|&corner| face_of_corner[corner] = triangle.face);
        }
        Self { corners, face_of_corner, triangles }
    }

    fn contributes(&self, triangle: &Triangle) -> bool {
        !triangle.is_uv_degenerate && !is_degenerate(triangle, &self.corners)
    }

    /// The triangles at a vertex that contribute to sums.
    fn around(&self, vertex: usize) -> impl Iterator<Item = &Triangle> {
        let touches = move |triangle: &&Triangle| triangle.vertices(&self.corners).contains(&vertex);
        self.triangles.iter().filter(move |triangle| self.contributes(triangle)).filter(touches)
    }

    /// The orientation of a corner's face. A face without one takes the orientation that is present at more
    /// of its corners.
    fn keeps_orientation(&self, corner: usize) -> bool {
        let face = self.face_of_corner[corner];
        let own = self.triangles.iter().find(|triangle| triangle.face == face && self.contributes(triangle));
        own.map_or_else(
            || {
                let of_face = (0..self.corners.len()).filter(|&other| self.face_of_corner[other] == face);
                let vertices: Vec<usize> = of_face.map(|other| self.corners[other].vertex).collect();
                let count = |keeps: bool| {
                    let has = |&&v: &&usize| self.around(v).any(|t| t.space.keeps_orientation == keeps);
                    vertices.iter().filter(has).count()
                };
                count(true) >= count(false)
            },
            |triangle| triangle.space.keeps_orientation,
        )
    }
}

fn sums(mesh: &Mesh<'_>, splits: bool, weight: Weight) -> Vec<Option<Frame>> {
    let scene = Scene::new(mesh);
    (0..scene.corners.len()).map(|number| sum(&scene, number, splits, weight)).collect()
}

fn sum(scene: &Scene, number: usize, splits: bool, weight: Weight) -> Option<Frame> {
    let corner = &scene.corners[number];
    let keeps_orientation = scene.keeps_orientation(number);
    let (mut s, mut t, mut normal) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    let (mut magnitude, mut weights, mut count) = ([0.0; 2], 0.0, 0.0);
    for triangle in scene.around(corner.vertex) {
        if splits && triangle.space.keeps_orientation != keeps_orientation {
            continue;
        }
        let area_vector = area_vector(triangle, &scene.corners);
        let [of_s, of_t] = match weight {
            Weight::Length => triangle.space.magnitude,
            Weight::One => [1.0; 2],
            Weight::Area => [length(area_vector); 2],
        };
        s = add(s, scale(of_s, triangle.space.s));
        t = add(t, scale(of_t, triangle.space.t));
        normal = add(normal, area_vector);
        magnitude = [0, 1].map(|i| magnitude[i] + of_s * triangle.space.magnitude[i]);
        (weights, count) = (weights + of_s, count + 1.0);
    }
    let magnitude = match weight {
        Weight::Length => [length(s) / count, length(t) / count],
        _ => magnitude.map(|sum| sum / weights),
    };
    let cancels = length(s) < 1e-5 * weights;
    let normal = normalize(if length(corner.normal) > 0.0 { corner.normal } else { normal });
    let [s, flat_t] = [s, t].map(|v| normalize(flatten(v, normal)));
    let keeps_orientation = if splits { keeps_orientation } else { dot(cross(normal, s), t) >= 0.0 };
    let space = Space { s, t: flat_t, magnitude, keeps_orientation };
    (length(s) > 0.0 && !cancels).then(|| space.to_frame())
}

/// Half the cross product of a triangle's edges.
fn area_vector(triangle: &Triangle, corners: &[Corner]) -> Vec3 {
    let [a, b, c] = triangle.corners.map(|corner| corners[corner].position);
    scale(0.5, cross(sub(b, a), sub(c, a)))
}
