//! Edges across which the sign of the tangents changes: where a texture meets its mirror image.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use crate::model::Corner;

/// The mirrored seams of a part: the ends of each edge.
///
/// Edges are between positions, whatever the vertices; of more than two triangles at one edge each is compared with the first.
pub fn seams(corners: &[Corner]) -> Vec<[[f32; 3]; 2]> {
    let mut position_ids = HashMap::new();
    let ids: Vec<u32> = corners
        .iter()
        .map(|corner| {
            let next = position_ids.len() as u32;
            *position_ids.entry(bits(corner.position)).or_insert(next)
        })
        .collect();
    let mut first_at = HashMap::new();
    let mut found = Vec::new();
    for (at, corner) in corners.iter().enumerate() {
        let end = if at % 3 == 2 { at - 2 } else { at + 1 };
        let edge = [ids[at].min(ids[end]), ids[at].max(ids[end])];
        if edge[0] == edge[1] {
            continue;
        }
        let sign = corner.tangent[3];
        match first_at.entry(edge) {
            Entry::Vacant(entry) => _ = entry.insert(sign),
            Entry::Occupied(entry) if entry.get() * sign < 0.0 => {
                found.push([corner.position, corners[end].position]);
            }
            Entry::Occupied(_) => {}
        }
    }
    found
}

/// Zeros of both signs are one position.
fn bits(position: [f32; 3]) -> [u32; 3] {
    position.map(|x| (x + 0.0).to_bits())
}
