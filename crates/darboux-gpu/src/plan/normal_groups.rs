//! Groups the corners of a planned mesh whose vertices share a normal.

use std::collections::HashMap;

use darboux::Mesh;
use darboux::internal::stage_arrays::NONE;

use crate::device::kernel::MAX_ITERATIONS;
use crate::error::GpuError;

/// The corners that each normal is computed from, and the vertices that it is written to.
///
/// Two vertices are in one group if they have one position and one normal in the planned mesh.
pub(crate) struct NormalGroups {
    pub count: u32,
    /// The number of groups; the end of each group's range of members; the members, which are corners `3 t +
    /// k` of triangles `t`.
    pub words: Vec<u32>,
    /// For each vertex, its group; none for unused vertices.
    pub group_of_vertex: Vec<u32>,
}

impl NormalGroups {
    /// `triangles`: five words per triangle; the first three have the vertices of its corners in the bits of
    /// `vertex_bits`.
    ///
    /// Errors: a group has more members than one thread can add up.
    pub fn new(mesh: &Mesh<'_>, triangles: &[u32], vertex_bits: u32) -> Result<Self, GpuError> {
        let mut group_of_key = HashMap::new();
        let mut group_of_vertex = vec![NONE; mesh.vertex_count()];
        let mut members: Vec<Vec<u32>> = Vec::new();
        for (t, triangle) in triangles.as_chunks::<5>().0.iter().enumerate() {
            for (k, corner) in triangle[..3].iter().enumerate() {
                let vertex = (corner & vertex_bits) as usize;
                // Adding zero turns -0 into +0.
                let bits = |v: [f32; 3]| v.map(|x| (x + 0.0).to_bits());
                let key = (bits(mesh.positions().get(vertex)), bits(mesh.normals().get(vertex)));
                let group = *group_of_key.entry(key).or_insert(members.len());
                if group == members.len() {
                    members.push(Vec::new());
                }
                group_of_vertex[vertex] = group as u32;
                members[group].push((3 * t + k) as u32);
            }
        }
        let largest = members.iter().map(Vec::len).max().unwrap_or(0);
        let limit = MAX_ITERATIONS as usize;
        if largest > limit {
            return Err(GpuError::TooManyMembers { members: largest, limit });
        }
        let count = members.len() as u32;
        let ends = members.iter().scan(0, |end, group| {
            *end += group.len() as u32;
            Some(*end)
        });
        let words = [count].into_iter().chain(ends).chain(members.iter().flatten().copied()).collect();
        Ok(Self { count, words, group_of_vertex })
    }
}
