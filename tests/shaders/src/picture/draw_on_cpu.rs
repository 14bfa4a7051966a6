//! Draws the plate on the CPU, with the functions of the core instead of those of the shaders.

use darboux::TexelLayout;
use darboux::encode::{
    frame_from_quaternion, frame_to_quaternion, normal_from_octahedral, normal_to_octahedral,
    tangent_from_diamond, tangent_from_octahedral, tangent_from_snorm8, tangent_from_snorm10,
    tangent_from_snorm16, tangent_to_diamond, tangent_to_octahedral, tangent_to_snorm8, tangent_to_snorm10,
    tangent_to_snorm16,
};

use crate::picture::encoding::{Encoding, Plate, SIDE};
use crate::picture::plate::{MAP_WIDTH, TRIANGLES, Vertex, normal_map, vertices};
use crate::vector::{D3, cross, dot, doubles, product, scale, unit};

/// Draws the plate of an encoding.
pub fn draw(encoding: Encoding) -> Plate {
    let vertices: Vec<Vertex> = vertices().into_iter().map(|vertex| decoded(encoding, vertex)).collect();
    let map = normal_map();
    let pixel = |column: usize, row: usize| {
        let place = [column, SIDE - 1 - row].map(|k| (2.0 * k as f64 + 1.0) / SIDE as f64 - 1.0);
        let (corners, weights) = TRIANGLES
            .iter()
            .map(|corners| corners.map(|corner| vertices[corner]))
            .map(|corners| (corners, weights(&corners, place)))
            .find(|(_, weights)| weights.iter().all(|&weight| weight >= -1e-9))
            .expect("a triangle under every pixel");
        shaded(&map, &corners, weights)
    };
    (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (column, row))).map(|(x, y)| pixel(x, y)).collect()
}

fn decoded(encoding: Encoding, vertex: Vertex) -> Vertex {
    let (normal, tangent) = (vertex.normal, vertex.tangent);
    let short_normal = normal_from_octahedral(normal_to_octahedral(normal));
    let (normal, tangent) = match encoding {
        Encoding::Floats => (normal, tangent),
        Encoding::Snorm16 => (normal, tangent_from_snorm16(tangent_to_snorm16(tangent))),
        Encoding::Snorm10 => (normal, tangent_from_snorm10(tangent_to_snorm10(tangent))),
        Encoding::Snorm8 => (normal, tangent_from_snorm8(tangent_to_snorm8(tangent))),
        Encoding::Octahedral => (short_normal, tangent_from_octahedral(tangent_to_octahedral(tangent))),
        Encoding::Diamond => {
            (short_normal, tangent_from_diamond(short_normal, tangent_to_diamond(short_normal, tangent)))
        }
        Encoding::Quaternion => frame_from_quaternion(frame_to_quaternion(normal, tangent)),
    };
    Vertex { normal, tangent, ..vertex }
}

/// The barycentric coordinates of a point in a triangle.
fn weights(corners: &[Vertex; 3], point: [f64; 2]) -> [f64; 3] {
    let [a, b, c] = corners.map(|corner| corner.position.map(f64::from));
    let area =
        |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (r[0] - p[0]) * (q[1] - p[1]);
    [area(point, b, c), area(a, point, c), area(a, b, point)].map(|part| part / area(a, b, c))
}

/// The colour of a pixel: the normal of the texel in the interpolated frame, lit.
fn shaded(map: &[[u8; 4]], corners: &[Vertex; 3], weights: [f64; 3]) -> [u8; 4] {
    let mix = |component: &dyn Fn(&Vertex) -> f32| -> f64 {
        corners.iter().zip(weights).map(|(corner, weight)| weight * f64::from(component(corner))).sum()
    };
    let [u, v] = [0, 1].map(|k| mix(&|corner| corner.uv[k]));
    let column = (u * MAP_WIDTH as f64) as usize;
    let row = ((1.0 - v) * SIDE as f64) as usize;
    let texel = doubles(TexelLayout::RGBA.vector(map[row * MAP_WIDTH + column]));

    let normal = [0, 1, 2].map(|k| mix(&|corner| corner.normal[k]));
    let tangent = [0, 1, 2].map(|k| mix(&|corner| corner.tangent[k]));
    let bitangent = scale(mix(&|corner| corner.tangent[3]), cross(normal, tangent));
    let [r, g, b] = lit(unit(product([tangent, bitangent, normal], texel)));
    [r, g, b, 1.0].map(|channel| (channel.clamp(0.0, 1.0) * 255.0).round() as u8)
}

/// The colour of copper, lit from the upper left.
fn lit(normal: D3) -> D3 {
    let (light, half) = (unit([-1.0, 1.0, 1.0]), unit([-1.0, 1.0, 2.732]));
    let diffuse = dot(normal, light).max(0.0);
    let shine = 0.6 * dot(normal, half).max(0.0).powi(16);
    [0.85, 0.5, 0.35].map(|color| color * (0.15 + 0.85 * diffuse) + shine)
}
