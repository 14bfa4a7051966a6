//! MikkTSpace in f64 by brute force: every stage is the loop that its definition is.
//!
//! The oracle of the fast versions, never their equal in bits: where an f32 comparison decides (quads' diagonals, thresholds,
//! zero areas) meshes near the decision may come out otherwise. Quadratic time; a few thousand corners are fine.
//! Source: M. S. Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008, and his mikktspace.c. We deviate: vertices weld
//! to their first corner, and every edge finds its neighbour (the C misses some at the largest vertex number).

mod angle_area;
mod methods;
mod normals;

use std::array::from_fn;

use darboux::{Faces, Frame, Mesh};

pub use angle_area::angle_area;
pub use methods::{area, average, face, from_normal, lengyel, lengyel_per_vertex};
pub use normals::normals;

type Vec3 = [f64; 3];

struct Corner {
    position: Vec3,
    normal: Vec3,
    uv: [f64; 2],
    vertex: usize,
}

struct Triangle {
    face: usize,
    corners: [usize; 3],
    space: Space,
    /// The UVs give no direction: joins groups of either orientation and weighs nothing.
    any: bool,
    neighbours: [Option<usize>; 3],
    groups: [Option<usize>; 3],
}

struct Group {
    vertex: usize,
    members: Vec<usize>,
}

#[derive(Clone, Copy)]
struct Space {
    s: Vec3,
    t: Vec3,
    magnitude: [f64; 2],
    keeps_orientation: bool,
}

/// Computes the frame of every corner, as [`darboux::generate_frames`] does before it repairs.
///
/// `threshold`: degrees. Corners of faces other than triangles and quads, and those that nothing reaches, get tangent
/// (1, 0, 0), bitangent (0, 1, 0), magnitudes 1 and sign -1.
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

/// Every corner, with the first corner of equal position, normal and UV as its vertex.
fn weld(mesh: &Mesh<'_>) -> Vec<Corner> {
    let mut corners: Vec<Corner> = Vec::new();
    for number in 0..mesh.corner_count() {
        let v = mesh.vertex_of_corner(number);
        let position = mesh.positions().get(v).map(f64::from);
        let normal = mesh.normals().get(v).map(f64::from);
        let uv = mesh.uvs().get(v).map(f64::from);
        let same = |other: &Corner| (other.position, other.normal, other.uv) == (position, normal, uv);
        let vertex = corners.iter().position(same).unwrap_or(number);
        corners.push(Corner { position, normal, uv, vertex });
    }
    corners
}

/// Triangles as they are; quads cut along the shorter diagonal, in UV space, if that ties in space, else from 0 to 2.
fn triangulate(mesh: &Mesh<'_>, corners: &[Corner]) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    let mut first = 0;
    for face in 0..mesh.face_count() {
        let size = match mesh.faces() {
            Faces::Triangles => 3,
            Faces::Quads => 4,
            Faces::Mixed(sizes) => sizes[face] as usize,
        };
        let diagonal = |a: usize, b: usize| {
            let (a, b) = (&corners[first + a], &corners[first + b]);
            [f64::hypot(b.uv[0] - a.uv[0], b.uv[1] - a.uv[1]), length(sub(b.position, a.position))]
        };
        let halves: &[[usize; 3]] = match size {
            3 => &[[0, 1, 2]],
            4 if diagonal(1, 3) < diagonal(0, 2) => &[[0, 1, 3], [1, 2, 3]],
            4 => &[[0, 1, 2], [0, 2, 3]],
            _ => &[],
        };
        triangles.extend(halves.iter().map(|half| Triangle::new(face, half.map(|i| first + i), corners)));
        first += size;
    }
    triangles
}

impl Triangle {
    /// The directions in which u and v grow (Mikkelsen's equations 18 and 19) and by how much.
    fn new(face: usize, corners: [usize; 3], all: &[Corner]) -> Self {
        let [a, b, c] = corners.map(|corner| &all[corner]);
        let (e1, e2) = (sub(b.position, a.position), sub(c.position, a.position));
        let [du1, dv1]: [f64; 2] = from_fn(|i| b.uv[i] - a.uv[i]);
        let [du2, dv2]: [f64; 2] = from_fn(|i| c.uv[i] - a.uv[i]);
        let area = uv_area([a, b, c]);
        let s = sub(scale(dv2, e1), scale(dv1, e2));
        let t = sub(scale(du1, e2), scale(du2, e1));
        let magnitude = [s, t].map(|v| if area == 0.0 { 0.0 } else { length(v) / area.abs() });
        let [s, t] = [s, t].map(|v| normalize(scale(area.signum(), v)));
        Self {
            face,
            corners,
            space: Space { s, t, magnitude, keeps_orientation: area > 0.0 },
            any: magnitude.contains(&0.0),
            neighbours: [None; 3],
            groups: [None; 3],
        }
    }

    fn vertices(&self, corners: &[Corner]) -> [usize; 3] {
        self.corners.map(|corner| corners[corner].vertex)
    }
}

/// Twice the signed area in UV space.
fn uv_area([a, b, c]: [&Corner; 3]) -> f64 {
    (b.uv[0] - a.uv[0]) * (c.uv[1] - a.uv[1]) - (b.uv[1] - a.uv[1]) * (c.uv[0] - a.uv[0])
}

fn is_degenerate(triangle: &Triangle, corners: &[Corner]) -> bool {
    let [a, b, c] = triangle.corners.map(|corner| corners[corner].position);
    a == b || b == c || a == c
}

/// Two halves of one quad take the orientation of the one with more UV area.
fn force_quads_to_agree(triangles: &mut [Triangle], corners: &[Corner]) {
    for second in 1..triangles.len() {
        let [a, b] = [second - 1, second].map(|half| &triangles[half]);
        if a.face == b.face {
            let [area_a, area_b] = [a, b].map(|half| uv_area(half.corners.map(|c| &corners[c])).abs());
            let larger = if b.any || area_a >= area_b { a } else { b };
            let keeps_orientation = larger.space.keeps_orientation;
            triangles[second - 1].space.keeps_orientation = keeps_orientation;
            triangles[second].space.keeps_orientation = keeps_orientation;
        }
    }
}

/// Every edge that has no neighbour takes the first later triangle with the same edge, opposite and free.
fn find_neighbours(triangles: &mut [Triangle], corners: &[Corner]) {
    let edge = |triangle: &Triangle, i: usize| {
        let vertices = triangle.vertices(corners);
        (vertices[i], vertices[(i + 1) % 3])
    };
    for (a, i) in (0..triangles.len()).flat_map(|a| [(a, 0), (a, 1), (a, 2)]) {
        let (from, to) = edge(&triangles[a], i);
        let mut later = (a + 1..triangles.len()).flat_map(|b| [(b, 0), (b, 1), (b, 2)]);
        let fits = |&(b, j): &(usize, usize)| {
            triangles[b].neighbours[j].is_none() && edge(&triangles[b], j) == (to, from)
        };
        if triangles[a].neighbours[i].is_none()
            && let Some((b, j)) = later.find(fits)
        {
            triangles[a].neighbours[i] = Some(b);
            triangles[b].neighbours[j] = Some(a);
        }
    }
}

/// Triangles around a vertex that are connected by edges at that vertex and have one orientation, in the order of their seeds.
fn build_groups(triangles: &mut [Triangle], corners: &[Corner]) -> Vec<Group> {
    let mut groups = Vec::new();
    for (seed, i) in (0..triangles.len()).flat_map(|seed| [(seed, 0), (seed, 1), (seed, 2)]) {
        if !triangles[seed].any && triangles[seed].groups[i].is_none() {
            let vertex = triangles[seed].vertices(corners)[i];
            let mut members = flood(seed, vertex, groups.len(), triangles, corners);
            members.sort_unstable();
            groups.push(Group { vertex, members });
        }
    }
    groups
}

/// Gives `group` to every triangle that it reaches from `seed` around `vertex`. A triangle without direction that no group
/// has taken yet adopts the group's orientation.
fn flood(
    seed: usize,
    vertex: usize,
    group: usize,
    triangles: &mut [Triangle],
    corners: &[Corner],
) -> Vec<usize> {
    let keeps_orientation = triangles[seed].space.keeps_orientation;
    let (mut members, mut pending) = (Vec::new(), vec![seed]);
    while let Some(number) = pending.pop() {
        let triangle = &mut triangles[number];
        let Some(i) = triangle.vertices(corners).iter().position(|&v| v == vertex) else { continue };
        if triangle.groups[i].is_some() {
            continue;
        }
        if triangle.any && triangle.groups == [None; 3] {
            triangle.space.keeps_orientation = keeps_orientation;
        }
        if triangle.space.keeps_orientation == keeps_orientation {
            triangle.groups[i] = Some(group);
            members.push(number);
            pending.extend([triangle.neighbours[i], triangle.neighbours[(i + 2) % 3]].into_iter().flatten());
        }
    }
    members
}

/// Gives each member the average over those that lie within the threshold of it; the halves of a quad average once more.
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
            a.any || b.any || a.face == b.face || close()
        };
        let members = group.members.iter().filter(within).map(|&t| &triangles[t]);
        let space = weighted_mean(members, group.vertex, normal, corners);
        let space = Space { keeps_orientation: triangles[f].space.keeps_orientation, ..space };
        let i = triangles[f].vertices(corners).iter().position(|&v| v == group.vertex);
        let slot = &mut spaces[triangles[f].corners[i.expect("members touch the vertex")]];
        *slot = Some(slot.map_or(space, |first: Space| first.midway(space)));
    }
}

/// The sum weighted by the triangles' angles at the vertex, in the plane of its normal.
fn weighted_mean<'a>(
    members: impl Iterator<Item = &'a Triangle>,
    vertex: usize,
    normal: Vec3,
    corners: &[Corner],
) -> Space {
    let (mut s, mut t, mut magnitude, mut weights) = ([0.0; 3], [0.0; 3], [0.0; 2], 0.0);
    for triangle in members.filter(|triangle| !triangle.any) {
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

/// Corners of degenerate triangles take what others have: in a quad with a good half the corner of equal position, elsewhere
/// the first good corner of the same vertex.
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

impl Space {
    const UNREACHED: Self =
        Self { s: [1.0, 0.0, 0.0], t: [0.0, 1.0, 0.0], magnitude: [1.0; 2], keeps_orientation: false };

    /// The average of two, with the orientation of the second.
    fn midway(self, second: Self) -> Self {
        Self {
            s: normalize(add(self.s, second.s)),
            t: normalize(add(self.t, second.t)),
            magnitude: from_fn(|i| 0.5 * (self.magnitude[i] + second.magnitude[i])),
            keeps_orientation: second.keeps_orientation,
        }
    }

    fn to_frame(self) -> Frame {
        Frame {
            tangent: self.s.map(|x| x as f32),
            bitangent: self.t.map(|x| x as f32),
            magnitude: self.magnitude.map(|x| x as f32),
            sign: if self.keeps_orientation { 1.0 } else { -1.0 },
        }
    }
}

fn add(a: Vec3, b: Vec3) -> Vec3 {
    from_fn(|i| a[i] + b[i])
}

fn sub(a: Vec3, b: Vec3) -> Vec3 {
    from_fn(|i| a[i] - b[i])
}

fn scale(factor: f64, v: Vec3) -> Vec3 {
    v.map(|x| factor * x)
}

fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn length(v: Vec3) -> f64 {
    dot(v, v).sqrt()
}

/// `v` at unit length; zero stays zero.
fn normalize(v: Vec3) -> Vec3 {
    if length(v) > 0.0 { scale(1.0 / length(v), v) } else { v }
}

/// `v` without its part along `normal`.
fn flatten(v: Vec3, normal: Vec3) -> Vec3 {
    sub(v, scale(dot(normal, v), normal))
}
