//! The methods angle-area and angle-edge in f64: sums over MikkTSpace's groups; for angle-area, one fitting
//! step.

use darboux::{Frame, Mesh};

use super::triangles::{
    Corner, Group, Space, Triangle, build_groups, find_neighbours, force_quads_to_agree, is_degenerate,
    triangulate, weld,
};
use super::vectors::{Vec3, add, cross, dot, flatten, length, normalize, scale, sub};

/// Like [`Method::AngleArea`](darboux::Method::AngleArea) without repairs: none at corners without a group.
pub fn angle_area(mesh: &Mesh<'_>) -> Vec<Option<Frame>> {
    grouped(mesh, |triangle, corners, _| area(triangle, corners), fit)
}

/// Like [`Method::AngleEdge`](darboux::Method::AngleEdge) without repairs: none at corners without a group.
pub fn angle_edge(mesh: &Mesh<'_>) -> Vec<Option<Frame>> {
    grouped(mesh, |_, _, edges| length(edges[0]) * length(edges[1]), |number, _, spaces, _, _| spaces[number])
}

/// The factor of a triangle's weight beside the angle, from the corner's edges in the tangent plane.
type Factor = fn(&Triangle, &[Corner], [Vec3; 2]) -> f64;

/// The last step of a group's frame.
type Finish = fn(usize, Vec3, &[Space], &[Triangle], &[Corner]) -> Space;

fn grouped(mesh: &Mesh<'_>, factor: Factor, finish: Finish) -> Vec<Option<Frame>> {
    let corners = weld(mesh);
    let mut triangles = triangulate(mesh, &corners);
    triangles.retain(|triangle| !is_degenerate(triangle, &corners));
    force_quads_to_agree(&mut triangles, &corners);
    find_neighbours(&mut triangles, &corners);
    let groups = build_groups(&mut triangles, &corners);
    let spaces: Vec<Space> =
        groups.iter().map(|group| average(group, &triangles, &corners, factor)).collect();
    let fitted: Vec<Space> = (0..groups.len())
        .map(|number| finish(number, corners[groups[number].vertex].normal, &spaces, &triangles, &corners))
        .collect();
    let mut frames = vec![None; corners.len()];
    for triangle in &triangles {
        for (corner, group) in triangle.corners.into_iter().zip(triangle.groups) {
            let keeps_orientation = triangle.space.keeps_orientation;
            frames[corner] = group.map(|group| Space { keeps_orientation, ..fitted[group] }.to_frame());
        }
    }
    frames
}

/// The mean over a group, weighted by angle and the factor.
fn average(group: &Group, triangles: &[Triangle], corners: &[Corner], factor: Factor) -> Space {
    let normal = normalize(corners[group.vertex].normal);
    let (mut s, mut t, mut magnitude, mut weights) = ([0.0; 3], [0.0; 3], [0.0; 2], 0.0);
    for triangle in
        group.members.iter().map(|&member| &triangles[member]).filter(|triangle| !triangle.is_uv_degenerate)
    {
        let i =
            triangle.vertices(corners).iter().position(|&v| v == group.vertex).expect("a member's vertex");
        let [here, next, last] = [i, i + 1, i + 2].map(|j| corners[triangle.corners[j % 3]].position);
        let edges = [next, last].map(|end| flatten(sub(end, here), normal));
        let [a, b] = edges.map(normalize);
        let weight = dot(a, b).clamp(-1.0, 1.0).acos() * factor(triangle, corners, edges);
        s = add(s, scale(weight, normalize(flatten(triangle.space.s, normal))));
        t = add(t, scale(weight, normalize(flatten(triangle.space.t, normal))));
        magnitude = [0, 1].map(|i| magnitude[i] + weight * triangle.space.magnitude[i]);
        weights += weight;
    }
    let magnitude = magnitude.map(|sum| sum / weights);
    Space { s: normalize(s), t: normalize(t), magnitude, keeps_orientation: false }
}

/// Takes a quarter of a Jacobi step towards the tangent field that minimises the squared difference between
/// the interpolated tangent and the direction of dP/du over the surface.
fn fit(number: usize, normal: Vec3, spaces: &[Space], triangles: &[Triangle], corners: &[Corner]) -> Space {
    let space = spaces[number];
    let (mut residual, mut weight) = ([0.0; 3], 0.0);
    for triangle in triangles.iter().filter(|triangle| triangle.groups.contains(&Some(number))) {
        let [Some(a), Some(b), Some(c)] = triangle.groups else { continue };
        if triangle.is_uv_degenerate {
            continue;
        }
        let area = area(triangle, corners);
        residual = add(residual, scale(area / 3.0, triangle.space.s));
        for other in [a, b, c] {
            let share = if other == number { area / 6.0 } else { area / 12.0 };
            residual = sub(residual, scale(share, spaces[other].s));
        }
        weight += area / 6.0;
    }
    let moved = add(space.s, scale(0.25 / weight, residual));
    Space { s: normalize(flatten(moved, normalize(normal))), ..space }
}

fn area(triangle: &Triangle, corners: &[Corner]) -> f64 {
    let [a, b, c] = triangle.corners.map(|corner| corners[corner].position);
    0.5 * length(cross(sub(b, a), sub(c, a)))
}
