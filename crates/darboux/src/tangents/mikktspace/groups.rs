//! Groups: the triangles around one vertex that are joined by edges and share one UV orientation.
//!
//! Source: mikktspace.c, `Build4RuleGroups`.

use crate::topology::triangles::{NONE, Triangles};

use crate::tangents::mikktspace::derivatives::Derivative;

/// All groups, in the order of the triangles that seeded them.
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

    /// The members of a group, corner `k` of triangle `t` as `3 t + k`, in the order in which the reference reaches and writes them.
    pub fn members(&self, group: usize) -> &[u32] {
        let start = if group == 0 { 0 } else { self.ends[group - 1] };
        &self.members[start as usize..self.ends[group] as usize]
    }

    /// Where the members of each group end.
    pub fn ends(&self) -> &[u32] {
        &self.ends
    }

    /// The orientation of a group's triangles.
    pub fn preserves(&self, group: usize) -> bool {
        self.preserves[group]
    }
}

/// Collects the groups around the vertices that count. A UV-degenerate triangle never seeds one, and takes the orientation of the first that reaches it:
/// the only place where the order of triangles decides.
pub(crate) fn group(
    triangles: &Triangles,
    neighbours: &[[u32; 3]],
    counts: impl Fn(u32) -> bool,
    derivatives: &mut [Derivative],
) -> Groups {
    let mut groups = Groups::default();
    let mut grouped = vec![[false; 3]; triangles.len()];
    let mut pending = Vec::new();
    for t in 0..triangles.len() {
        for k in 0..3 {
            let (vertex, preserves) = (triangles.vertices[t][k], derivatives[t].preserves);
            if derivatives[t].any || grouped[t][k] || !counts(vertex) {
                continue;
            }
            pending.push(t as u32);
            while let Some(t) = pending.pop() {
                let reached = t as usize;
                let k = corner_at(triangles.vertices[reached], vertex);
                if joins(&mut derivatives[reached], grouped[reached], k, preserves) {
                    grouped[reached][k] = true;
                    groups.members.push(3 * t + k as u32);
                    // The last pushed is the next reached: the edge that starts at the corner, with all behind it.
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

/// Whether a triangle joins, at corner `k`, a group of the given orientation; an ungrouped UV-degenerate one adopts it.
fn joins(derivative: &mut Derivative, grouped: [bool; 3], k: usize, preserves: bool) -> bool {
    if grouped[k] {
        return false;
    }
    if derivative.any && grouped == [false; 3] {
        derivative.preserves = preserves;
    }
    derivative.preserves == preserves
}
