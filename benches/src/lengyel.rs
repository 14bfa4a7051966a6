//! Lengyel's method (Foundations of Game Engine Development, volume 2, listing 7.4) as a plain loop: a lower
//! bound for the cost of tangents per vertex.

use darboux_tests::OwnedMesh;

use crate::run::Tangent;

/// One tangent per vertex of a triangle mesh: the triangles' derivatives of position by u and v, summed
/// without weights, then made perpendicular to the normal.
pub fn lengyel(mesh: &OwnedMesh, tangents: &mut Vec<Tangent>) {
    let mut sums = vec![[[0.0; 3]; 2]; mesh.positions.len()];
    match &mesh.indices {
        Some(indices) => {
            indices
                .as_chunks()
                .0
                .iter()
                .for_each(|corners| add(mesh, corners.map(|v| v as usize), &mut sums));
        }
        None => {
            (0..mesh.positions.len() / 3).for_each(|i| add(mesh, [3 * i, 3 * i + 1, 3 * i + 2], &mut sums))
        }
    }
    tangents.clear();
    tangents.extend(sums.iter().zip(&mesh.normals).map(|(sums, normal)| finish(sums, *normal)));
}

fn add(mesh: &OwnedMesh, vertices: [usize; 3], sums: &mut [[[f32; 3]; 2]]) {
    let [a, b, c] = vertices.map(|vertex| mesh.positions[vertex]);
    let [s, t, u] = vertices.map(|vertex| mesh.uvs[vertex]);
    let (e1, e2) = (minus(b, a), minus(c, a));
    let [x1, y1, x2, y2] = [t[0] - s[0], t[1] - s[1], u[0] - s[0], u[1] - s[1]];
    let r = 1.0 / (x1 * y2 - x2 * y1);
    if !r.is_finite() {
        return;
    }
    let along_u: [f32; 3] = std::array::from_fn(|i| (e1[i] * y2 - e2[i] * y1) * r);
    let along_v: [f32; 3] = std::array::from_fn(|i| (e2[i] * x1 - e1[i] * x2) * r);
    for vertex in vertices {
        let [sum_u, sum_v] = &mut sums[vertex];
        for i in 0..3 {
            sum_u[i] += along_u[i];
            sum_v[i] += along_v[i];
        }
    }
}

fn finish([u, v]: &[[f32; 3]; 2], normal: [f32; 3]) -> Tangent {
    let along = dot(*u, normal);
    let flat: [f32; 3] = std::array::from_fn(|i| u[i] - normal[i] * along);
    let scale = 1.0 / dot(flat, flat).sqrt().max(f32::MIN_POSITIVE);
    let [x, y, z] = flat.map(|x| x * scale);
    let side = dot(cross(normal, *u), *v);
    [x, y, z, if side < 0.0 { -1.0 } else { 1.0 }]
}

fn minus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
