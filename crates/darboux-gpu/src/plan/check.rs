//! Counts what has changed in a moved mesh so that its plan may no longer have the tangents of a fresh run.

use wgpu::{Buffer, CommandEncoder};

use crate::device::buffers::{check_size, storage_buffer};
use crate::device::precision::PrecisionDispatch;
use crate::error::GpuError;
use crate::plan::moving_mesh::MovingMesh;
use crate::plan::planner::Plan;

/// A check of a moved mesh against its plan.
#[derive(Clone, Debug)]
pub struct PlanCheck {
    hash_slots: Buffer,
    triangles: PrecisionDispatch,
    vertices: PrecisionDispatch,
    counts: Buffer,
}

impl Plan {
    /// A check of the buffers that were given to [`Plan::bind`]. Errors: those of that function; the mesh has
    /// faces other than triangles.
    pub fn bind_check(&self, mesh: &MovingMesh<'_>) -> Result<PlanCheck, GpuError> {
        if self.has_quads {
            return Err(GpuError::NotTriangles);
        }
        let uniform = &self.layout(mesh)?.uniform;
        let (sizes, device) = (&self.uniform, &self.planner.device);
        // At most half of the slots are used.
        let slot_count = (2 * sizes.vertex_count.max(1)).next_power_of_two();
        check_size(device, "hash table of vertices", 4 * u64::from(slot_count))?;
        let hash_slots = storage_buffer(device, "hash_slots", slot_count);
        let counts = storage_buffer(device, "changes", 5);
        let shared = [
            (0, uniform),
            (1, mesh.positions.buffer),
            (2, mesh.normals.buffer),
            (4, &self.representatives),
            (8, &counts),
        ];
        let triangle_buffers = [
            (3, &self.triangles),
            (5, &self.tangents),
            (6, &self.check.sum_of_corner),
            (7, &self.check.u_differences),
        ];
        let vertex_buffers = [(5, &self.check.uvs), (6, &hash_slots)];
        let dispatch = |kernel, others: &[(u32, &Buffer)], items| {
            PrecisionDispatch::new(device, kernel, &[&shared[..], others].concat(), items)
        };
        let triangle_count = sizes.triangle_count + sizes.degenerate_count;
        Ok(PlanCheck {
            triangles: dispatch(&self.planner.check_triangles, &triangle_buffers, triangle_count),
            vertices: dispatch(&self.planner.check_vertices, &vertex_buffers, sizes.vertex_count),
            hash_slots,
            counts,
        })
    }
}

impl PlanCheck {
    /// Records the check. Record [`BoundPlan::record`](super::bound_plan::BoundPlan::record) of the same
    /// buffers before.
    pub fn record(&self, encoder: &mut CommandEncoder) {
        encoder.clear_buffer(&self.counts, 0, None);
        encoder.clear_buffer(&self.hash_slots, 0, None);
        self.triangles.record(encoder);
        self.vertices.record(encoder);
    }

    /// A buffer of five counts, with `BufferUsages::COPY_SRC`. They may be too large, but never too small:
    ///
    /// 0. triangles that have become degenerate,
    /// 1. triangles that were degenerate and are no longer,
    /// 2. vertices that no longer equal the vertex they were welded with,
    /// 3. vertices that have become equal to another vertex,
    /// 4. triangles whose tangent or bitangent direction at a corner is so far from the corner's tangent that
    ///    they may no longer share it.
    ///
    /// If all counts are 0, a fresh run in [`Mode::Corrected`](darboux::Mode::Corrected) gives the tangents
    /// of the plan. In the other modes it does so too, unless the reference's unsorted last edges change
    /// its result, which depends on the positions.
    pub fn counts(&self) -> &Buffer {
        &self.counts
    }
}
