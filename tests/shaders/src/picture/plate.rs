//! The vertices and the normal map of the plate.

use darboux::encode::{
    frame_to_quaternion, normal_from_octahedral, normal_to_octahedral, tangent_to_diamond,
    tangent_to_octahedral, tangent_to_snorm8, tangent_to_snorm10, tangent_to_snorm16,
};

use crate::picture::encoding::{Encoding, SIDE};
use crate::vector::{cross, doubles, singles, unit};

/// The width of the normal map in texels. Both halves of the plate use the same texels.
pub const MAP_WIDTH: usize = SIDE / 2;

/// A corner of one of the quads.
#[derive(Clone, Copy)]
pub struct Vertex {
    /// The position, from -1 to 1. x points right, y up.
    pub position: [f32; 2],
    /// The UV, from 0 to 1. v points up.
    pub uv: [f32; 2],
    /// A unit vector.
    pub normal: [f32; 3],
    /// A unit vector and the sign.
    pub tangent: [f32; 4],
}

/// The corners of the triangles of the left quad, then of the right quad.
pub const TRIANGLES: [[usize; 3]; 4] = [[0, 1, 2], [2, 1, 3], [4, 5, 6], [6, 5, 7]];

/// The corners of the left quad, where u points right, then of the right quad, where u points left.
pub fn vertices() -> Vec<Vertex> {
    let corner = |x: f32, y: f32, w: f32| {
        let normal = unit(doubles([0.5 * x, 0.5 * y, 1.0]));
        // The vector perpendicular to the normal and to y: the direction of u in the plane of the normal.
        let right = unit(cross([0.0, 1.0, 0.0], normal));
        let [a, b, c] = singles(right).map(|component| w * component);
        let uv = [1.0 - x.abs(), (1.0 + y) / 2.0];
        Vertex { position: [x, y], uv, normal: singles(normal), tangent: [a, b, c, w] }
    };
    let quad = |left: f32, w: f32| {
        [(0.0, -1.0), (1.0, -1.0), (0.0, 1.0), (1.0, 1.0)].map(|(x, y)| corner(left + x, y, w))
    };
    [quad(-1.0, 1.0), quad(0.0, -1.0)].concat()
}

/// A grid of domes as 8-bit texels, top row first.
pub fn normal_map() -> Vec<[u8; 4]> {
    let dome = SIDE as f32 / 4.0;
    let texel = |column: usize, row: usize| {
        let place = |k: usize| 2.0 * ((k as f32 + 0.5) / dome).fract() - 1.0;
        let (x, y) = (place(column), -place(row));
        let height = (1.0 - x * x - y * y).max(0.0);
        let slopes = [1.2 * x * height.sqrt(), 1.2 * y * height.sqrt(), 1.0];
        let [r, g, b] =
            unit(doubles(slopes)).map(|component| ((component + 1.0) / 2.0 * 255.0).round() as u8);
        [r, g, b, 255]
    };
    (0..SIDE).flat_map(|row| (0..MAP_WIDTH).map(move |column| texel(column, row))).collect()
}

/// The encoded tangent or frame as bytes of a vertex buffer, little-endian, at most four words.
pub fn code(encoding: Encoding, vertex: &Vertex) -> Vec<u8> {
    let Vertex { normal, tangent, .. } = *vertex;
    let shorts = |code: &[i16]| code.iter().flat_map(|short| short.to_le_bytes()).collect();
    match encoding {
        Encoding::Floats => tangent.iter().flat_map(|float| float.to_le_bytes()).collect(),
        Encoding::Snorm16 => shorts(&tangent_to_snorm16(tangent)),
        Encoding::Snorm10 => tangent_to_snorm10(tangent).to_le_bytes().to_vec(),
        Encoding::Snorm8 => tangent_to_snorm8(tangent).iter().flat_map(|byte| byte.to_le_bytes()).collect(),
        Encoding::Octahedral => shorts(&tangent_to_octahedral(tangent)),
        Encoding::Diamond => {
            let normal = normal_from_octahedral(normal_to_octahedral(normal));
            u32::from(tangent_to_diamond(normal, tangent)).to_le_bytes().to_vec()
        }
        Encoding::Quaternion => shorts(&frame_to_quaternion(normal, tangent)),
    }
}
