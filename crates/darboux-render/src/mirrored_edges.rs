//! Finds mirrored edges: edges between two triangles whose tangents have different signs, where a texture
//! meets its mirror image.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use crate::vertex::SurfaceVertex;

/// The end points of the mirrored edges of a list of triangles.
///
/// Two corners are at one vertex if they have one position. If an edge has more than two triangles, each is
/// compared with the first.
pub fn mirrored_edges(corners: &[SurfaceVertex]) -> Vec<[[f32; 3]; 2]> {
    let mut vertex_of_position = HashMap::new();
    let vertices: Vec<u32> = corners
        .iter()
        .map(|corner| {
            let next = vertex_of_position.len() as u32;
            *vertex_of_position.entry(position_bits(corner.position)).or_insert(next)
        })
        .collect();
    let mut sign_of_edge = HashMap::new();
    let mut edges = Vec::new();
    for (start, corner) in corners.iter().enumerate() {
        let end = if start % 3 == 2 { start - 2 } else { start + 1 };
        let edge = [vertices[start].min(vertices[end]), vertices[start].max(vertices[end])];
        if edge[0] == edge[1] {
            continue;
        }
        let sign = corner.tangent[3];
        match sign_of_edge.entry(edge) {
            Entry::Vacant(entry) => _ = entry.insert(sign),
            Entry::Occupied(entry) if entry.get() * sign < 0.0 => {
                edges.push([corner.position, corners[end].position]);
            }
            Entry::Occupied(_) => {}
        }
    }
    edges
}

/// The bits of a position. Adding zero turns -0 into +0.
fn position_bits(position: [f32; 3]) -> [u32; 3] {
    position.map(|x| (x + 0.0).to_bits())
}
