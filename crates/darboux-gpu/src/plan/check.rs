//! Whether a plan still says what a fresh run would.

use wgpu::{Buffer, CommandEncoder};

use super::{MovingMesh, Plan};
use crate::GpuError;
use crate::device::kernel::buffer;
use crate::device::mesh_buffers::check_size;
use crate::device::precision::RealStep;

/// Counts how far a moved mesh is from the one that a plan was made of.
#[derive(Clone, Debug)]
pub struct PlanCheck {
    table: Buffer,
    triangles: RealStep,
    vertices: RealStep,
    counts: Buffer,
}

impl Plan {
    /// A check of the same buffers as those of [`Plan::of_buffers`], with its errors, and one for faces that are not triangles.
    pub fn check_of_buffers(&self, mesh: &MovingMesh<'_>) -> Result<PlanCheck, GpuError> {
        if self.has_quads {
            return Err(GpuError::NotTriangles);
        }
        let (_, outputs) = self.sum_of_output[mesh.per as usize].clone()?;
        self.check(mesh, outputs)?;
        let (words, device) = (&self.words, &self.planner.device);
        // At most half full.
        let places = (2 * words.vertex_count.max(1)).next_power_of_two();
        check_size(device, "places of vertices", 4 * u64::from(places))?;
        let (table, counts) = (buffer(device, "table", places), buffer(device, "changes", 5));
        let plan = &self.uniform(mesh, outputs);
        let of_mesh = [(0, plan), (1, mesh.positions.buffer), (2, mesh.normals.buffer)];
        let of_all = [(4, &self.representatives), (8, &counts)];
        let [sums, differences, uvs] = &self.of_check;
        let of_triangles = [(3, &self.triangles), (5, &self.tangents), (6, sums), (7, differences)];
        let of_vertices = [(5, uvs), (6, &table)];
        let step = |kernel, others: &[(u32, &Buffer)], items| {
            RealStep::new(device, kernel, &[&of_mesh[..], &of_all, others].concat(), items)
        };
        let count = words.triangle_count + words.degenerate_count;
        Ok(PlanCheck {
            triangles: step(&self.planner.check_triangles, &of_triangles, count),
            vertices: step(&self.planner.check_vertices, &of_vertices, words.vertex_count),
            table,
            counts,
        })
    }
}

impl PlanCheck {
    /// Records the check, after [`PlanOfBuffers::record`](super::PlanOfBuffers::record) of the same buffers.
    pub fn record(&self, encoder: &mut CommandEncoder) {
        encoder.clear_buffer(&self.counts, 0, None);
        encoder.clear_buffer(&self.table, 0, None);
        self.triangles.record(encoder);
        self.vertices.record(encoder);
    }

    /// Five words to copy from, of which none is too small:
    /// triangles that have collapsed and that have opened, vertices that left those they were welded with and that met others, triangles
    /// whose directions at a corner turned so far from the tangent there that they may not share it any more.
    ///
    /// Where all are 0, a fresh run in [`Mode::Corrected`](darboux::Mode::Corrected) finds the tangents of the plan. In the other modes
    /// so does a run that does not meet the reference's defect in the order of its last edges, which depends on where vertices are.
    pub fn counts(&self) -> &Buffer {
        &self.counts
    }
}
