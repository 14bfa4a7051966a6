//! MikkTSpace in f64: the evaluation of groups, and degenerate triangles.

use std::array::from_fn;

use darboux::{Frame, Mesh};

use super::triangles::{
    Corner, Group, Space, Triangle, build_groups, find_neighbours, force_quads_to_agree, is_degenerate,
    triangulate, weld,
};
use super::vectors::{Vec3, add, dot, flatten, normalize, scale, sub};

/// Computes the frame of every corner like [`darboux::generate_frames`] without repairs.
///
/// `threshold`: degrees. Corners of faces other than triangles and quads, and corners that no group reaches,
/// get tangent (1, 0, 0), bitangent (0, 1, 0), magnitudes 1 and sign -1.
pub fn mikktspace(mesh: &Mesh<'_>, threshold: f32) -> Vec<Frame> {
    let corners = weld(mesh);
    let (degenerate, mut triangles): (Vec<_>, Vec<_>) =
        triangulate(mesh, &corners).into_iter().partition(|triangle| is_degenerate(triangle, &corners));
    force_quads_to_agree(&mut triangles, &corners);
    find_neighbours(&mut triangles, &corners);
    let groups = build_groups(&mut triangles, &corners);
    let mut spaces = vec![None; corners.len()];
    let least_cosine = f64::from(threshold).to_radians().cos();
    groups.iter().for_each(|group| write_group(group, least_cosine, &triangles, &corners, &mut spaces));
    copy_to_degenerates(&degenerate, &triangles, &corners, &mut spaces);
    spaces.into_iter().map(|space| space.unwrap_or(Space::UNREACHED).to_frame()).collect()
}

/// Gives each member of a group the mean over the members within the threshold of it. A corner that both
/// halves of a quad share gets the average of both results.
fn write_group(
    group: &Group,
    least_cosine: f64,
    triangles: &[Triangle],
    corners: &[Corner],
    spaces: &mut [Option<Space>],
) {
    let normal = corners[group.vertex].normal;
    let directions =
        |f: usize| [triangles[f].space.s, triangles[f].space.t].map(|v| normalize(flatten(v, normal)));
    for &f in &group.members {
        let within = |&&t: &&usize| {
            let (a, b) = (&triangles[f], &triangles[t]);
            let close = || (0..2).all(|i| dot(directions(f)[i], directions(t)[i]) > least_cosine);
            a.is_uv_degenerate || b.is_uv_degenerate || a.face == b.face || close()
        };
        let members = group.members.iter().filter(within).map(|&t| &triangles[t]);
        let space = weighted_mean(members, group.vertex, normal, corners);
        let space = Space { keeps_orientation: triangles[f].space.keeps_orientation, ..space };
        let i = triangles[f].vertices(corners).iter().position(|&v| v == group.vertex);
        let slot = &mut spaces[triangles[f].corners[i.expect("members touch the vertex")]];
        *slot = Some(slot.map_or(space, |first: Space| first.midway(space)));
    }
}

/// The mean over triangles, weighted by their angles at the vertex. Directions and angles are projected onto
/// the plane of the normal.
fn weighted_mean<'a>(
    members: impl Iterator<Item = &'a Triangle>,
    vertex: usize,
    normal: Vec3,
    corners: &[Corner],
) -> Space {
    let (mut s, mut t, mut magnitude, mut weights) = ([0.0; 3], [0.0; 3], [0.0; 2], 0.0);
    for triangle in members.filter(|triangle| !triangle.is_uv_degenerate) {
        let i =
            triangle.vertices(corners).iter().position(|&v| v == vertex).expect("members touch the vertex");
        let [here, next, last] = [i, i + 1, i + 2].map(|j| corners[triangle.corners[j % 3]].position);
        let [a, b] = [next, last].map(|end| normalize(flatten(sub(end, here), normal)));
        let weight = dot(a, b).clamp(-1.0, 1.0).acos();
        let space = &triangle.space;
        s = add(s, scale(weight, normalize(flatten(space.s, normal))));
        t = add(t, scale(weight, normalize(flatten(space.t, normal))));
        magnitude = from_fn(|i| magnitude[i] + weight * space.magnitude[i]);
        weights += weight;
    }
    let magnitude = magnitude.map(|sum| if weights > 0.0 { sum / weights } else { sum });
    Space { s: normalize(s), t: normalize(t), magnitude, keeps_orientation: false }
}

/// Copies spaces to the corners of degenerate triangles. The source is the corner of equal position in the
/// good half of the same quad, or else the first good corner of the same vertex.
fn copy_to_degenerates(
    degenerate: &[Triangle],
    good: &[Triangle],
    corners: &[Corner],
    spaces: &mut [Option<Space>],
) {
    let reached: Vec<usize> = good.iter().flat_map(|triangle| triangle.corners).collect();
    let (in_half_good_quads, lone): (Vec<_>, Vec<_>) =
        degenerate.iter().partition(|triangle| good.iter().any(|half| half.face == triangle.face));
    for corner in lone.iter().flat_map(|triangle| triangle.corners) {
        let source = reached.iter().find(|&&source| corners[source].vertex == corners[corner].vertex);
        spaces[corner] = source.and_then(|&source| spaces[source]);
    }
    for triangle in in_half_good_quads {
        let half = good.iter().find(|half| half.face == triangle.face).expect("the quad's good half");
        for corner in triangle.corners.into_iter().filter(|corner| !half.corners.contains(corner)) {
            let same = |&&source: &&usize| corners[source].position == corners[corner].position;
            spaces[corner] = half.corners.iter().find(same).and_then(|&source| spaces[source]);
        }
    }
}
