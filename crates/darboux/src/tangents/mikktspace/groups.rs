//! Groups: the triangles around one vertex that are connected by edges and have one UV orientation.
//!
//! ```text
//! for each corner of each triangle, in order:
//!     unless the triangle is UV-degenerate or the corner has a group:
//!         flood fill from the triangle, across the edges at the vertex, to triangles of the same orientation
//! ```
//!
//! A UV-degenerate triangle never starts a group, and adopts the orientation of the first group that reaches
//! it. This is the only place where the order of the triangles decides which triangles share a frame.
//!
//! Source: mikktspace.c, `Build4RuleGroups`.

use crate::exec::limits::RunLimits;
use crate::topology::triangles::{NONE, Triangles};

use crate::tangents::mikktspace::derivatives::Derivative;

/// All groups, in the order of their first triangles.
#[derive(Clone, Debug, Default)]
pub struct Groups {
    members: Vec<u32>,
    ends: Vec<u32>,
    preserves: Vec<bool>,
}

impl Groups {
    /// The number of groups.
    pub(crate) fn len(&self) -> usize {
        self.ends.len()
    }

    /// The members of a group, corner `k` of triangle `t` as `3 t + k`, in the order of the flood fill, which
    /// is the order of the writes.
    pub fn members(&self, group: usize) -> &[u32] {
        let start = if group == 0 { 0 } else { self.ends[group - 1] };
        &self.members[start as usize..self.ends[group] as usize]
    }

    /// The end of each group in the concatenated member lists.
    pub fn ends(&self) -> &[u32] {
        &self.ends
    }

    /// True when the UV map preserves the orientation of the group's triangles.
    pub fn preserves(&self, group: usize) -> bool {
        self.preserves[group]
    }
}

/// Builds the groups.
///
/// `is_wanted`: vertices for which it returns false get no group. `derivatives`: receives the orientations
/// that UV-degenerate triangles adopt. Groups are absent after cancellation.
pub(crate) fn build_groups(
    triangles: &Triangles,
    neighbours: &[[u32; 3]],
    is_wanted: impl Fn(u32) -> bool,
    limits: RunLimits<'_>,
    derivatives: &mut [Derivative],
) -> Groups {
    let mut groups = Groups::default();
    let mut grouped = vec![[false; 3]; triangles.len()];
    let mut pending = Vec::new();
    for t in 0..triangles.len() {
        if limits.check_at(t).is_err() {
            break;
        }
        for k in 0..3 {
            let (vertex, preserves) = (triangles.vertices[t][k], derivatives[t].preserves);
            if derivatives[t].joins_any || grouped[t][k] || !is_wanted(vertex) {
                continue;
            }
            pending.push(t as u32);
            while let Some(t) = pending.pop() {
                let reached = t as usize;
                let k = corner_at(triangles.vertices[reached], vertex);
                if joins(&mut derivatives[reached], grouped[reached], k, preserves) {
                    grouped[reached][k] = true;
                    groups.members.push(3 * t + k as u32);
                    // A stack: the neighbour across the edge that starts at the corner is visited first, as
                    // in the reference.
                    let around = [neighbours[reached][(k + 2) % 3], neighbours[reached][k]];
                    pending.extend(around.into_iter().filter(|&neighbour| neighbour != NONE));
                }
            }
            groups.ends.push(groups.members.len() as u32);
            groups.preserves.push(preserves);
        }
    }
    groups
}

fn corner_at(vertices: [u32; 3], vertex: u32) -> usize {
    (0..2).find(|&k| vertices[k] == vertex).unwrap_or(2)
}

/// True when a triangle joins a group of the given orientation at corner `k`. A UV-degenerate triangle
/// without groups adopts the orientation.
fn joins(derivative: &mut Derivative, grouped: [bool; 3], k: usize, preserves: bool) -> bool {
    if grouped[k] {
        return false;
    }
    if derivative.joins_any && grouped == [false; 3] {
        derivative.preserves = preserves;
    }
    derivative.preserves == preserves
}
