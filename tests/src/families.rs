//! Generates regular meshes: grids, spheres, fans, boxes.

use std::f32::consts::{PI, TAU};

use crate::OwnedMesh;

const UP: [f32; 3] = [0.0, 0.0, 1.0];

/// A bumpy height field of `width` by `height` quads, each one quad or two triangles; `mirrored` repeats u
/// backwards from the middle on, so that the seam's two sides share their UVs but not their orientation.
pub fn grid(width: usize, height: usize, quads: bool, mirrored: bool) -> OwnedMesh {
    let mut mesh = OwnedMesh::default();
    for y in 0..=height {
        for x in 0..=width {
            let (fx, fy) = (x as f32 / width as f32, y as f32 / height as f32);
            let u = if mirrored { 0.5 - (fx - 0.5).abs() } else { fx };
            let slope = 0.6 * sin_cos(7.0 * fx).1;
            let normal = normalized([-slope, 0.0, 1.0]);
            mesh.push(([fx, fy, sin_cos(slope).0 / 7.0], normal, [u, fy]));
        }
    }
    let at = |x: usize, y: usize| (y * (width + 1) + x) as u32;
    let mut faces = Vec::new();
    for y in 0..height {
        for x in 0..width {
            push_quad(&mut faces, [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)], quads);
        }
    }
    mesh.with_face_list(&faces)
}

/// A UV sphere: triangles at the poles, where every segment has a pole vertex of its own UV.
pub fn sphere(rings: usize, segments: usize, quads: bool) -> OwnedMesh {
    let mut mesh = OwnedMesh::default();
    for ring in 0..=rings {
        for segment in 0..=segments {
            let (v, u) = (ring as f32 / rings as f32, segment as f32 / segments as f32);
            let ((z, r), (y, x)) = (sin_cos(PI * v), sin_cos(TAU * u));
            let normal = match ring {
                0 => UP,
                _ if ring == rings => [0.0, 0.0, -1.0],
                _ => [z * x, z * y, r],
            };
            mesh.push((normal, normal, [u, v]));
        }
    }
    let at = |ring: usize, segment: usize| (ring * (segments + 1) + segment) as u32;
    let mut faces = Vec::new();
    for ring in 0..rings {
        for s in 0..segments {
            let [a, b, c, d] = [at(ring, s), at(ring + 1, s), at(ring + 1, s + 1), at(ring, s + 1)];
            match ring {
                0 => faces.push(vec![a, b, c]),
                _ if ring + 1 == rings => faces.push(vec![a, b, d]),
                _ => push_quad(&mut faces, [a, b, c, d], quads),
            }
        }
    }
    mesh.with_face_list(&faces)
}

/// A disc of `count` triangles around one vertex; `polar` unrolls its UVs (u along the angle, v along the
/// radius).
pub fn fan(count: usize, polar: bool) -> OwnedMesh {
    let mut mesh = OwnedMesh::default();
    mesh.push(([0.0; 3], UP, if polar { [0.5, 0.0] } else { [0.0; 2] }));
    for i in 0..=count {
        let turn = i as f32 / count as f32;
        let (y, x) = if i == count { (0.0, 1.0) } else { sin_cos(TAU * turn) };
        mesh.push(([x, y, 0.0], UP, if polar { [turn, 1.0] } else { [x, y] }));
    }
    let faces: Vec<Vec<u32>> = (1..=count as u32).map(|i| vec![0, i, i + 1]).collect();
    mesh.with_face_list(&faces)
}

/// A sector of 73 degrees of `count` triangles around one vertex. All tangents are within 89 degrees of each
/// other, from -44 to 44 degrees of the x axis; some are far from their mean, because the triangles of the
/// last 53 degrees are few and wide. So at a threshold of 90 degrees all of them join, which neither a
/// bounding box of the tangents nor their mean can show.
pub fn sector(count: usize) -> OwnedMesh {
    let mut mesh = OwnedMesh::default();
    mesh.push(([0.0; 3], UP, [0.0; 2]));
    let narrow = count - count / 16;
    for i in 0..=count {
        let degrees = if i < narrow {
            20.0 * i as f32 / narrow as f32
        } else {
            20.0 + 53.0 * (i - narrow) as f32 / (count - narrow) as f32
        };
        let ((y, x), (v, u)) =
            (sin_cos((44.0 + degrees).to_radians()), sin_cos((2.0 * degrees).to_radians()));
        mesh.push(([x, y, 0.0], UP, [u, v]));
    }
    let faces: Vec<Vec<u32>> = (1..=count as u32).map(|i| vec![0, i, i + 1]).collect();
    mesh.with_face_list(&faces)
}

/// A straight band of `count` triangles.
pub fn strip(count: usize) -> OwnedMesh {
    let mut mesh = OwnedMesh::default();
    for i in 0..count + 2 {
        let (x, y) = ((i / 2) as f32, (i % 2) as f32);
        mesh.push(([x, y, 0.1 * x * y], UP, [0.25 * x, 0.5 * y]));
    }
    let triangle = |i: u32| if i.is_multiple_of(2) { vec![i, i + 2, i + 1] } else { vec![i, i + 1, i + 2] };
    let faces: Vec<Vec<u32>> = (0..count as u32).map(triangle).collect();
    mesh.with_face_list(&faces)
}

/// A Möbius band of `count` quads, which cannot be oriented consistently.
pub fn moebius(count: usize, quads: bool) -> OwnedMesh {
    let mut mesh = OwnedMesh::default();
    for i in 0..count {
        for side in [-0.4f32, 0.4] {
            let turn = TAU * i as f32 / count as f32;
            let ((sin, cos), (lift, lean)) = (sin_cos(turn), sin_cos(0.5 * turn));
            let radius = 1.0 + side * lean;
            let position = [radius * cos, radius * sin, side * lift];
            mesh.push((position, normalized([lift * cos, lift * sin, -lean]), [i as f32, side]));
        }
    }
    let mut faces = Vec::new();
    for i in 0..count as u32 {
        let [a, b] = [2 * i, 2 * i + 1];
        let [c, d] = if i + 1 == count as u32 { [1, 0] } else { [a + 2, b + 2] };
        push_quad(&mut faces, [a, c, d, b], quads);
    }
    mesh.with_face_list(&faces)
}

/// A box with flat sides, each with the whole UV square.
pub fn cube(quads: bool) -> OwnedMesh {
    let mut mesh = OwnedMesh::default();
    let mut faces = Vec::new();
    for axis in 0..3 {
        for sign in [-1.0f32, 1.0] {
            let corner = |u: f32, v: f32| {
                let mut position = [0.0; 3];
                position[axis] = sign;
                position[(axis + 1) % 3] = sign * u;
                position[(axis + 2) % 3] = v;
                position
            };
            let mut normal = [0.0; 3];
            normal[axis] = sign;
            let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
            let side = square.map(|[u, v]| mesh.push((corner(u, v), normal, [0.5 + 0.5 * u, 0.5 + 0.5 * v])));
            push_quad(&mut faces, side, quads);
        }
    }
    mesh.with_face_list(&faces)
}

/// `count` triangles with one position and normal in common, whose UVs differ there, so that none welds.
pub fn unwelded_fan(count: usize) -> OwnedMesh {
    let mut mesh = fan(count, false).unindexed();
    for (i, uv) in mesh.uvs.iter_mut().enumerate() {
        uv[0] += (i / 3) as f32;
    }
    mesh
}

/// `mesh` with `count` additional triangles, each with two equal corners and not connected to anything.
pub fn with_lone_degenerates(mut mesh: OwnedMesh, count: usize) -> OwnedMesh {
    let mut faces = mesh.face_list();
    for i in 0..count {
        let x = 2.0 + i as f32;
        let a = mesh.push(([x, 0.0, 5.0], UP, [0.0, 0.0]));
        let b = mesh.push(([x, 1.0, 5.0], UP, [0.0, 1.0]));
        faces.push(vec![a, b, b]);
    }
    mesh.with_face_list(&faces)
}

fn push_quad(faces: &mut Vec<Vec<u32>>, [a, b, c, d]: [u32; 4], quads: bool) {
    if quads {
        faces.push(vec![a, b, c, d]);
    } else {
        faces.extend([vec![a, b, c], vec![a, c, d]]);
    }
}

/// Sine and cosine in single precision, rounded from double precision. The single-precision functions of
/// platforms differ in the last bit.
fn sin_cos(angle: f32) -> (f32, f32) {
    let (sin, cos) = f64::from(angle).sin_cos();
    (sin as f32, cos as f32)
}

fn normalized(v: [f32; 3]) -> [f32; 3] {
    let length = v.iter().map(|x| x * x).sum::<f32>().sqrt();
    v.map(|x| x / length)
}
