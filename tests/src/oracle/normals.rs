//! Normals in f64: for every corner a flood fill over all corners at its position.

use darboux::{Mesh, NormalOptions, NormalWeight, Shading, SmoothingSeams};

use super::vectors::{Vec3, add, cross, dot, length, normalize, scale, sub};

/// A corner of a face; `around` are the corners before and after it in the face.
struct Corner {
    face: usize,
    vertex: usize,
    position: Vec3,
    around: [usize; 2],
}

/// Like [`generate_normals`](darboux::generate_normals) without repairs: zero where the sum is zero. Only
/// positions, indices and faces of the mesh are read.
pub fn normals(mesh: &Mesh<'_>, face_sizes: &[u32], options: &NormalOptions) -> Vec<[f32; 3]> {
    let corners = corners(mesh, face_sizes, options.seams);
    let area_vectors: Vec<Vec3> = (0..face_sizes.len()).map(|face| area_vector(face, &corners)).collect();
    let normal = |corner: usize| {
        let joined: Vec<usize> = match options.shading {
            Shading::Flat => vec![corner],
            _ => fan(corner, &corners, &area_vectors, options.crease),
        };
        let sum = joined.into_iter().fold([0.0; 3], |sum, corner| {
            let vector = area_vectors[corners[corner].face];
            let weight = match options.weight {
                NormalWeight::Angle => angle(corner, &corners),
                NormalWeight::Area => length(vector),
                _ => angle(corner, &corners) * length(vector),
            };
            add(sum, scale(weight, normalize(vector)))
        });
        normalize(sum).map(|x| x as f32)
    };
    (0..corners.len()).map(normal).collect()
}

fn corners(mesh: &Mesh<'_>, face_sizes: &[u32], seams: SmoothingSeams) -> Vec<Corner> {
    let mut corners: Vec<Corner> = Vec::new();
    for (face, size) in face_sizes.iter().map(|&size| size as usize).enumerate() {
        let start = corners.len();
        for k in 0..size {
            let v = mesh.vertex_of_corner(start + k);
            let position = mesh.positions().get(v).map(f64::from);
            let same = |other: &&Corner| other.position == position;
            let first = corners.iter().find(same).map_or(v, |other| other.vertex);
            let vertex = if seams == SmoothingSeams::Ignored { first } else { v };
            let around = [start + (k + size - 1) % size, start + (k + 1) % size];
            corners.push(Corner { face, vertex, position, around });
        }
    }
    corners
}

fn area_vector(face: usize, corners: &[Corner]) -> Vec3 {
    let of_face = corners.iter().filter(|corner| corner.face == face);
    let part = |corner: &Corner| scale(0.5, cross(corner.position, corners[corner.around[1]].position));
    of_face.map(part).fold([0.0; 3], add)
}

fn angle(corner: usize, corners: &[Corner]) -> f64 {
    let Corner { position, around, .. } = &corners[corner];
    let [a, b] = around.map(|other| normalize(sub(corners[other].position, *position)));
    dot(a, b).clamp(-1.0, 1.0).acos()
}

/// The corners at the vertex of `corner` that are connected to it by edges within the crease angle.
fn fan(corner: usize, corners: &[Corner], area_vectors: &[Vec3], crease: f32) -> Vec<usize> {
    let at_vertex: Vec<usize> =
        (0..corners.len()).filter(|&other| corners[other].vertex == corners[corner].vertex).collect();
    if crease >= 180.0 {
        return at_vertex;
    }
    let connected = |a: usize, b: usize| {
        let ends = |corner: usize| corners[corner].around.map(|other| corners[other].vertex);
        let share_an_edge = ends(a).iter().any(|end| ends(b).contains(end));
        let [a, b] = [a, b].map(|corner| normalize(area_vectors[corners[corner].face]));
        share_an_edge && dot(a, b).clamp(-1.0, 1.0).acos().to_degrees() <= f64::from(crease) + 1e-6
    };
    let mut fan = vec![corner];
    while let Some(&next) = at_vertex
        .iter()
        .find(|&&other| !fan.contains(&other) && fan.iter().any(|&member| connected(member, other)))
    {
        fan.push(next);
    }
    fan
}
