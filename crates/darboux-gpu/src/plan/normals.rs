//! Normals of vertices that moved.

use std::collections::HashMap;

use darboux::Mesh;
use darboux::internal::stage_arrays::NONE;
use wgpu::{Buffer, CommandEncoder};

use super::{MovingMesh, Plan, Planner};
use crate::GpuError;
use crate::device::kernel::{MAX_TURNS, Step, buffer};
use crate::device::precision::RealStep;

/// What normals need of a plan's mesh.
#[derive(Clone, Debug)]
pub(crate) struct Fans {
    count: u32,
    words: Buffer,
    of_vertex: Buffer,
}

/// Writes the normals of moved vertices before their tangents are computed.
#[derive(Clone, Debug)]
pub struct PlanNormals {
    sums: RealStep,
    write: Step,
}

impl Fans {
    /// Vertices with one position and one normal share the next, too. `triangles`: five words each, of which the first three hold the
    /// vertices of corners in `mask`.
    pub fn new(planner: &Planner, mesh: &Mesh<'_>, triangles: &[u32], mask: u32) -> Result<Self, GpuError> {
        let mut names = HashMap::new();
        let mut of_vertex = vec![NONE; mesh.vertex_count()];
        let mut members: Vec<Vec<u32>> = Vec::new();
        for (t, triangle) in triangles.as_chunks::<5>().0.iter().enumerate() {
            for (k, corner) in triangle[..3].iter().enumerate() {
                let vertex = (corner & mask) as usize;
                // Adding zero turns -0 into +0.
                let bits = |v: [f32; 3]| v.map(|x| (x + 0.0).to_bits());
                let key = (bits(mesh.positions().get(vertex)), bits(mesh.normals().get(vertex)));
                let fan = *names.entry(key).or_insert(members.len());
                if fan == members.len() {
                    members.push(Vec::new());
                }
                of_vertex[vertex] = fan as u32;
                members[fan].push((3 * t + k) as u32);
            }
        }
        let largest = members.iter().map(Vec::len).max().unwrap_or(0);
        if largest > MAX_TURNS as usize {
            return Err(GpuError::TooManyMembers { members: largest, limit: MAX_TURNS as usize });
        }
        let count = members.len() as u32;
        let ends = members.iter().scan(0, |end, fan| {
            *end += fan.len() as u32;
            Some(*end)
        });
        let words: Vec<u32> =
            [count].into_iter().chain(ends).chain(members.iter().flatten().copied()).collect();
        Ok(Self {
            count,
            words: planner.upload("fans", &words)?,
            of_vertex: planner.upload("fans of vertices", &of_vertex)?,
        })
    }
}

impl Plan {
    /// Normals of the same buffers as those of [`Plan::of_buffers`], with its errors: smooth ones, of triangles and halves of quads, weighted by
    /// angle, that vertices share where the planned mesh had one position and one normal. They are rounded as the device likes.
    pub fn normals_of_buffers(&self, mesh: &MovingMesh<'_>) -> Result<PlanNormals, GpuError> {
        let (_, outputs) = self.sum_of_output[mesh.per as usize].clone()?;
        self.check(mesh, outputs)?;
        let (device, fans) = (&self.planner.device, &self.fans);
        let found = buffer(device, "normals", (4 * fans.count).max(1));
        let plan = &self.uniform(mesh, outputs);
        let to_sums = [
            (0, plan),
            (1, mesh.positions.buffer),
            (3, &self.triangles),
            (4, &self.representatives),
            (5, &fans.words),
            (6, &found),
        ];
        let to_write = [(0, plan), (1, &fans.of_vertex), (2, &found), (3, mesh.normals.buffer)];
        Ok(PlanNormals {
            sums: RealStep::new(device, &self.planner.normals, &to_sums, fans.count),
            write: Step::new(device, &self.planner.write_normals, &to_write, mesh.vertex_count),
        })
    }
}

impl PlanNormals {
    /// Records the normals, before [`PlanOfBuffers::record`](super::PlanOfBuffers::record) of the same buffers.
    pub fn record(&self, encoder: &mut CommandEncoder) {
        self.sums.record(encoder);
        self.write.record(encoder);
    }
}
