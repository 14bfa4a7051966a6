//! The first stages of MikkTSpace as loops over all corners or triangles: welding, triangulation, neighbours
//! and groups.

use std::array::from_fn;

use darboux::{Faces, Frame, Mesh};

use super::vectors::{Vec3, add, length, normalize, scale, sub};

/// One corner of a face.
pub struct Corner {
    pub position: Vec3,
    pub normal: Vec3,
    pub uv: [f64; 2],
    /// The first corner that welds to the same vertex.
    pub vertex: usize,
}

/// A triangle, or one half of a quad.
pub struct Triangle {
    pub face: usize,
    pub corners: [usize; 3],
    pub space: Space,
    /// The UV triangle has no area. Such a triangle joins groups of either orientation and adds nothing to
    /// sums.
    pub is_uv_degenerate: bool,
    /// The triangle across each edge; edge i begins at corner i.
    pub neighbours: [Option<usize>; 3],
    /// The group of each corner.
    pub groups: [Option<usize>; 3],
}

/// Triangles around a vertex that share a tangent before the threshold splits them.
pub struct Group {
    pub vertex: usize,
    pub members: Vec<usize>,
}

/// A tangent space: unit tangent `s`, unit bitangent `t`, the lengths of both before normalisation, and the
/// orientation of the UVs.
#[derive(Clone, Copy)]
pub struct Space {
    pub s: Vec3,
    pub t: Vec3,
    pub magnitude: [f64; 2],
    pub keeps_orientation: bool,
}

/// Lists the corners of a mesh. Corners of equal position, normal and UV weld to one vertex, which is the
/// first of them.
pub fn weld(mesh: &Mesh<'_>) -> Vec<Corner> {
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

/// Lists the triangles. A quad is cut along its shorter diagonal in UV space, on a tie in space, and on a
/// second tie from corner 0 to 2.
pub fn triangulate(mesh: &Mesh<'_>, corners: &[Corner]) -> Vec<Triangle> {
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
    /// Computes the directions in which u and v grow, and how fast (Mikkelsen's equations 18 and 19).
    pub fn new(face: usize, corners: [usize; 3], all: &[Corner]) -> Self {
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
            is_uv_degenerate: magnitude.contains(&0.0),
            neighbours: [None; 3],
            groups: [None; 3],
        }
    }

    /// The vertices of its corners.
    pub fn vertices(&self, corners: &[Corner]) -> [usize; 3] {
        self.corners.map(|corner| corners[corner].vertex)
    }
}

/// Twice the signed area in UV space.
pub fn uv_area([a, b, c]: [&Corner; 3]) -> f64 {
    (b.uv[0] - a.uv[0]) * (c.uv[1] - a.uv[1]) - (b.uv[1] - a.uv[1]) * (c.uv[0] - a.uv[0])
}

/// True where two corners have one position.
pub fn is_degenerate(triangle: &Triangle, corners: &[Corner]) -> bool {
    let [a, b, c] = triangle.corners.map(|corner| corners[corner].position);
    a == b || b == c || a == c
}

/// Gives both halves of a quad the orientation of the half with the larger UV area.
pub fn force_quads_to_agree(triangles: &mut [Triangle], corners: &[Corner]) {
    for second in 1..triangles.len() {
        let [a, b] = [second - 1, second].map(|half| &triangles[half]);
        if a.face == b.face {
            let [area_a, area_b] = [a, b].map(|half| uv_area(half.corners.map(|c| &corners[c])).abs());
            let larger = if b.is_uv_degenerate || area_a >= area_b { a } else { b };
            let keeps_orientation = larger.space.keeps_orientation;
            triangles[second - 1].space.keeps_orientation = keeps_orientation;
            triangles[second].space.keeps_orientation = keeps_orientation;
        }
    }
}

/// Gives every edge without a neighbour the first later triangle that has the same edge in the opposite
/// direction and without a neighbour.
pub fn find_neighbours(triangles: &mut [Triangle], corners: &[Corner]) {
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

/// Groups the triangles around each vertex that edges at the vertex connect and that have one orientation.
/// Groups are in the order of their first triangles.
pub fn build_groups(triangles: &mut [Triangle], corners: &[Corner]) -> Vec<Group> {
    let mut groups = Vec::new();
    for (seed, i) in (0..triangles.len()).flat_map(|seed| [(seed, 0), (seed, 1), (seed, 2)]) {
        if !triangles[seed].is_uv_degenerate && triangles[seed].groups[i].is_none() {
            let vertex = triangles[seed].vertices(corners)[i];
            let mut members = flood(seed, vertex, groups.len(), triangles, corners);
            members.sort_unstable();
            groups.push(Group { vertex, members });
        }
    }
    groups
}

/// Assigns `group` to every triangle that a flood fill around `vertex` reaches from `seed`. A UV-degenerate
/// triangle without a group takes the group's orientation.
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
        if triangle.is_uv_degenerate && triangle.groups == [None; 3] {
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

impl Space {
    /// The space of corners that no group reaches.
    pub const UNREACHED: Self =
        Self { s: [1.0, 0.0, 0.0], t: [0.0, 1.0, 0.0], magnitude: [1.0; 2], keeps_orientation: false };

    /// The average of two spaces, with the orientation of the second.
    pub fn midway(self, second: Self) -> Self {
        Self {
            s: normalize(add(self.s, second.s)),
            t: normalize(add(self.t, second.t)),
            magnitude: from_fn(|i| 0.5 * (self.magnitude[i] + second.magnitude[i])),
            keeps_orientation: second.keeps_orientation,
        }
    }

    /// The space as a frame in f32.
    pub fn to_frame(self) -> Frame {
        Frame {
            tangent: self.s.map(|x| x as f32),
            bitangent: self.t.map(|x| x as f32),
            magnitude: self.magnitude.map(|x| x as f32),
            sign: if self.keeps_orientation { 1.0 } else { -1.0 },
        }
    }
}
