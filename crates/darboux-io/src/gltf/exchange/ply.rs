//! A binary PLY with one list of vertices and one of faces.

use super::surfaces::Surface;
use crate::image::linear_to_srgb;

/// The file. A vertex property that only some surfaces have is zero at the vertices of the others.
pub fn text(surfaces: &[Surface]) -> Vec<u8> {
    let has = Properties::of(surfaces);
    let vertices: usize = surfaces.iter().map(|surface| surface.positions.len()).sum();
    let faces: usize = surfaces.iter().map(|surface| surface.sizes.len()).sum();
    let corners: usize = surfaces.iter().map(|surface| surface.corners.len()).sum();
    let header = header(&has, vertices, faces);
    let mut out = Vec::with_capacity(header.len() + vertices * has.vertex_bytes() + faces + 4 * corners);
    out.extend_from_slice(header.as_bytes());
    surfaces.iter().for_each(|surface| has.write_vertices(surface, &mut out));
    let mut first = 0;
    for surface in surfaces {
        write_faces(surface, first, &mut out);
        first += surface.positions.len() as u32;
    }
    out
}

/// The properties of vertices beside positions.
struct Properties {
    normals: bool,
    uvs: bool,
    tangents: bool,
    colors: bool,
}

impl Properties {
    fn of(surfaces: &[Surface]) -> Self {
        let any = |has: fn(&Surface) -> bool| surfaces.iter().any(has);
        Self {
            normals: any(|surface| surface.normals.is_some()),
            uvs: any(|surface| surface.uvs.is_some()),
            tangents: any(|surface| surface.tangents.is_some()),
            colors: any(|surface| surface.colors.is_some()),
        }
    }

    fn vertex_bytes(&self) -> usize {
        let floats = [(self.normals, 3), (self.uvs, 2), (self.tangents, 4), (self.colors, 1)];
        12 + floats.iter().map(|&(has, floats)| if has { 4 * floats } else { 0 }).sum::<usize>()
    }

    fn write_vertices(&self, surface: &Surface, out: &mut Vec<u8>) {
        let floats = |values: &[f32], out: &mut Vec<u8>| {
            values.iter().for_each(|value| out.extend_from_slice(&value.to_le_bytes()));
        };
        for (vertex, position) in surface.positions.iter().enumerate() {
            floats(position, out);
            if self.normals {
                floats(&surface.normals.as_ref().map_or([0.0; 3], |values| values[vertex]), out);
            }
            if self.uvs {
                let [u, v] = surface.uvs.as_ref().map_or([0.0, 1.0], |values| values[vertex]);
                floats(&[u, 1.0 - v], out);
            }
            if self.tangents {
                floats(&surface.tangents.as_ref().map_or([0.0; 4], |values| values[vertex]), out);
            }
            if self.colors {
                let color = surface.colors.as_ref().map_or([1.0; 4], |values| values[vertex]);
                out.extend_from_slice(&bytes_of_color(color));
            }
        }
    }
}

/// sRGB with a linear alpha.
fn bytes_of_color([r, g, b, a]: [f32; 4]) -> [u8; 4] {
    let byte = |value: f64| (255.0 * value.clamp(0.0, 1.0)).round() as u8;
    let [r, g, b] = [r, g, b].map(|channel| byte(linear_to_srgb(f64::from(channel))));
    [r, g, b, byte(f64::from(a))]
}

fn header(has: &Properties, vertices: usize, faces: usize) -> String {
    let mut header = format!(
        "ply\nformat binary_little_endian 1.0\ncomment Created by Darboux {}\nelement vertex {vertices}\n",
        env!("CARGO_PKG_VERSION")
    );
    let properties: [(bool, &str, &[&str]); 5] = [
        (true, "float", &["x", "y", "z"]),
        (has.normals, "float", &["nx", "ny", "nz"]),
        (has.uvs, "float", &["s", "t"]),
        (has.tangents, "float", &["tangent_x", "tangent_y", "tangent_z", "tangent_w"]),
        (has.colors, "uchar", &["red", "green", "blue", "alpha"]),
    ];
    for (_, kind, names) in properties.iter().filter(|(has, ..)| *has) {
        names.iter().for_each(|name| header.push_str(&format!("property {kind} {name}\n")));
    }
    header.push_str(&format!("element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"));
    header
}

/// Faces of three and four corners, whose vertices are numbered from `first` on.
fn write_faces(surface: &Surface, first: u32, out: &mut Vec<u8>) {
    let mut corners = surface.corners.as_slice();
    for &size in &surface.sizes {
        let (face, rest) = corners.split_at(size as usize);
        out.push(size as u8);
        face.iter().for_each(|&vertex| out.extend_from_slice(&(first + vertex).to_le_bytes()));
        corners = rest;
    }
}
