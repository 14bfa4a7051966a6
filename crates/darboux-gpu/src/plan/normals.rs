//! Computes smooth normals of a planned mesh whose vertices have moved.

use wgpu::CommandEncoder;

use crate::device::buffers::storage_buffer;
use crate::device::kernel::Dispatch;
use crate::device::precision::PrecisionDispatch;
use crate::error::GpuError;
use crate::plan::moving_mesh::MovingMesh;
use crate::plan::planner::{Layout, Plan};

/// Writes the normals of moved vertices, before their tangents are computed.
#[derive(Clone, Debug)]
pub struct PlanNormals {
    sums: PrecisionDispatch,
    write: Dispatch,
}

impl Plan {
    /// Smooth normals in the buffers that were given to [`Plan::bind`], with its errors.
    ///
    /// A normal is the mean of the normals of adjacent triangles, weighted by their angles. Vertices share a
    /// normal if they had one position and one normal in the planned mesh. The rounding is the device's.
    pub fn bind_normals(&self, mesh: &MovingMesh<'_>) -> Result<PlanNormals, GpuError> {
        let Layout { uniform, .. } = &self.layout(mesh)?;
        let device = &self.planner.device;
        let group_count = self.normals.group_count;
        let normal_of_group = storage_buffer(device, "normals", (4 * group_count).max(1));
        let sum_buffers = [
            (0, uniform),
            (1, mesh.positions.buffer),
            (3, &self.triangles),
            (4, &self.representatives),
            (5, &self.normals.groups),
            (6, &normal_of_group),
        ];
        let write_buffers = [
            (0, uniform),
            (1, &self.normals.group_of_vertex),
            (2, &normal_of_group),
            (3, mesh.normals.buffer),
        ];
        Ok(PlanNormals {
            sums: PrecisionDispatch::new(device, &self.planner.normals, &sum_buffers, group_count),
            write: Dispatch::new(device, &self.planner.write_normals, &write_buffers, mesh.vertex_count),
        })
    }
}

impl PlanNormals {
    /// Records the normals. Record [`BoundPlan::record`](super::bound_plan::BoundPlan::record) of the same
    /// buffers afterwards.
    pub fn record(&self, encoder: &mut CommandEncoder) {
        self.sums.record(encoder);
        self.write.record(encoder);
    }
}
