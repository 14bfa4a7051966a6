//! Which tangents are usable, and what takes the place of those that are not.
//!
//! Everything here is computed in double precision with additions, products, quotients and square roots only: the same bits
//! everywhere.

use std::collections::{HashMap, HashSet};

use crate::math::V3;
use crate::triangles::Triangulation;
use crate::{Frame, Mesh};

use super::evaluate::RawFrames;

type D3 = [f64; 3];

/// Replaces what is unusable in `raw`, in place, at the corners of `needs`.
///
/// A tangent is replaced by the mean of its subgroup's; without one by its triangle's own dP/du; without that by a perpendicular of
/// the normal; without a normal by (1, 0, 0). The sign stays. Corners at one vertex whose raw tangents are equal get one
/// replacement, the first's, so that a repair never adds a split.
pub(crate) fn repair(mesh: &Mesh<'_>, triangulation: &Triangulation, raw: &mut RawFrames, needs: &[u32]) {
    let places = places(triangulation, needs);
    let mut site_of_vertex = HashMap::new();
    let mut known = HashMap::new();
    for &corner in needs {
        let place = places.get(&corner);
        let vertex = mesh.vertex_of_corner(corner as usize);
        let normal = unit(mesh.normals().get(vertex).map(f64::from));
        let site = *site_of_vertex.entry(vertex).or_insert(place.map_or(corner, |place| place.vertex));
        let frame = &mut raw.of_corner[corner as usize];
        let replacement = || {
            let Some(normal) = normal else { return [1.0, 0.0, 0.0] };
            // A corner of a quad may have its mean from another corner, with another normal.
            let mean = raw.mean_of_corner.get(&corner).and_then(|mean| in_plane(mean.map(f64::from), normal));
            let own = || place.and_then(|place| in_plane(u_direction(mesh, place.triangle), normal));
            mean.or_else(own).unwrap_or_else(|| perpendicular(normal)).map(|x| x as f32)
        };
        frame.tangent =
            *known.entry((site, bits(frame.tangent), frame.sign > 0.0)).or_insert_with(replacement);
        frame.magnitude =
            frame.magnitude.map(|magnitude| if magnitude.is_finite() { magnitude } else { 1.0 });
    }
}

/// Replaces unusable bitangents by sign * cross(normal, tangent), or, without a normal, by a perpendicular of the tangent.
pub(crate) fn repair_bitangents(mesh: &Mesh<'_>, frames: &mut [Frame]) {
    for (corner, frame) in frames.iter_mut().enumerate() {
        let normal = mesh.normals().get(mesh.vertex_of_corner(corner));
        if !is_usable(frame.bitangent, normal) {
            let [tangent, normal] = [frame.tangent, normal].map(|v| v.map(f64::from));
            let across = unit(normal).and_then(|normal| unit(cross(normal, tangent)));
            let bitangent = across.unwrap_or_else(|| perpendicular(tangent));
            frame.bitangent = bitangent.map(|x| (f64::from(frame.sign) * x) as f32);
        }
    }
}

/// Where a corner is: its welded vertex and the corners of its first triangle.
struct Place {
    vertex: u32,
    triangle: [u32; 3],
}

/// The places of `corners`; none for corners of unsupported faces.
fn places(triangulation: &Triangulation, corners: &[u32]) -> HashMap<u32, Place> {
    let wanted: HashSet<u32> = corners.iter().copied().collect();
    let mut places = HashMap::with_capacity(corners.len());
    if corners.is_empty() {
        return places;
    }
    for list in [&triangulation.good, &triangulation.degenerate] {
        for (&triangle, vertices) in list.corners.iter().zip(&list.vertices) {
            for (corner, &vertex) in triangle.iter().zip(vertices) {
                if wanted.contains(corner) {
                    places.entry(*corner).or_insert(Place { vertex, triangle });
                }
            }
        }
    }
    places
}

/// Bits for comparing: every NaN is one.
fn bits(v: V3) -> [u32; 3] {
    v.map(|x| if x.is_nan() { f32::NAN.to_bits() } else { x.to_bits() })
}

/// The direction of dP/du on a triangle, as long as it may be; zero or NaN where UVs or positions give none.
fn u_direction(mesh: &Mesh<'_>, corners: [u32; 3]) -> D3 {
    let vertices = corners.map(|corner| mesh.vertex_of_corner(corner as usize));
    let [p0, p1, p2] = vertices.map(|vertex| mesh.positions().get(vertex).map(f64::from));
    let [t0, t1, t2] = vertices.map(|vertex| mesh.uvs().get(vertex).map(f64::from));
    let [dv1, dv2] = [t1[1] - t0[1], t2[1] - t0[1]];
    let area = (t1[0] - t0[0]) * dv2 - dv1 * (t2[0] - t0[0]);
    [0, 1, 2].map(|i| (dv2 * (p1[i] - p0[i]) - dv1 * (p2[i] - p0[i])) * 1f64.copysign(area))
}

/// True for a finite tangent of unit length to 1e-3 that is not along the normal (|cos| < 0.999, if there is a normal).
pub(crate) fn is_usable(tangent: V3, normal: V3) -> bool {
    let (tangent, normal) = (tangent.map(f64::from), normal.map(f64::from));
    let (length, normal_length) = (length(tangent), length(normal));
    // Written so that NaN and infinity fail.
    (length - 1.0).abs() < 1e-3
        && (normal_length == 0.0 || dot(tangent, normal).abs() < 0.999 * length * normal_length)
}

/// The mean of the directions in the plane of `normal`, each with the same weight; none where they have or leave no direction.
pub(crate) fn mean_in_plane(directions: impl Iterator<Item = V3>, normal: V3) -> Option<V3> {
    let normal = unit(normal.map(f64::from))?;
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for direction in directions {
        if let Some(direction) = in_plane(direction.map(f64::from), normal) {
            sum = [sum[0] + direction[0], sum[1] + direction[1], sum[2] + direction[2]];
            count += 1.0;
        }
    }
    // What is left of vectors that cancel is rounding error.
    if length(sum) > 1e-6 * count { Some(in_plane(sum, normal)?.map(|x| x as f32)) } else { None }
}

/// The unit vector along the part of `v` that is perpendicular to the unit `normal`; none where that part is rounding error.
fn in_plane(v: D3, normal: D3) -> Option<D3> {
    let v = unit(v)?;
    let along = dot(v, normal);
    let rest = [0, 1, 2].map(|i| v[i] - along * normal[i]);
    if length(rest) > 1e-6 { unit(rest) } else { None }
}

/// A unit vector perpendicular to the unit `normal` (Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3).
fn perpendicular(normal: D3) -> D3 {
    let [x, y, z] = normal;
    let sign = 1f64.copysign(z);
    let a = -1.0 / (sign + z);
    [1.0 + sign * x * x * a, sign * (x * y * a), -sign * x]
}

fn unit(v: D3) -> Option<D3> {
    // Floats' squares neither overflow nor vanish in double precision.
    let length = length(v);
    (length > 0.0 && length.is_finite()).then(|| v.map(|x| x / length))
}

fn dot(a: D3, b: D3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: D3, b: D3) -> D3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn length(v: D3) -> f64 {
    dot(v, v).sqrt()
}
