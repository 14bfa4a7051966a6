//! Computes the tangents of a planned mesh every frame.
//!
//! ```text
//! terms            per triangle: dP/du in the plane of each corner's normal, times the angle of the corner
//! gather           per sum: adds the terms of its members in order, normalises, lists unusable tangents
//! repair           per listed sum: replaces the unusable tangent, if the mode asks for it
//! write_tangents   per vertex or corner: copies the tangent of its sum
//! ```

use wgpu::{Buffer, CommandEncoder};

use crate::device::buffers::storage_buffer;
use crate::device::kernel::Dispatch;
use crate::device::precision::{PrecisionDispatch, WORK_LIST_BINDING, WorkList};
use crate::error::GpuError;
use crate::plan::moving_mesh::MovingMesh;
use crate::plan::planner::{Layout, Plan, Planner};

/// A [`Plan`] with the buffers of a moving mesh. It can be recorded every frame, without allocation.
#[derive(Clone, Debug)]
pub struct BoundPlan {
    terms: PrecisionDispatch,
    gather: PrecisionDispatch,
    unusable: WorkList,
    repair: Option<Dispatch>,
    write_tangents: Dispatch,
    counts: Buffer,
    repair_count: Buffer,
}

impl Plan {
    /// Checks the buffers and creates everything that recording needs.
    ///
    /// A plan may be used for several moving meshes one after the other, but not at the same time, because
    /// they share scratch memory.
    ///
    /// Errors: another number of vertices; an offset or stride that is not a multiple of 4; attributes that
    /// overlap or do not lie in their buffer; a buffer without `BufferUsages::STORAGE` or past a limit of
    /// the device; tangents per vertex where the corners of a vertex have different tangents.
    pub fn bind(&self, mesh: &MovingMesh<'_>) -> Result<BoundPlan, GpuError> {
        let Layout { uniform, sum_of_output, output_count } = &self.layout(mesh)?;
        let Planner { device, terms, gather, repair, write_tangents, .. } = &self.planner;
        let (positions, normals) = (mesh.positions.buffer, mesh.normals.buffer);
        let unusable = WorkList::new(device, "unusable tangents", self.uniform.sum_count);
        let repair_count = storage_buffer(device, "repair_count", 1);
        let triangle_buffers =
            [(0, uniform), (1, positions), (2, normals), (3, &self.triangles), (4, &self.representatives)];
        let terms_buffers = [&triangle_buffers[..], &[(5, &self.terms)]].concat();
        let gather_buffers = [
            (0, uniform),
            (2, normals),
            (3, &self.terms),
            (5, &self.sums),
            (6, &self.tangents),
            (7, &unusable.buffer),
        ];
        let repair_buffers = [
            &triangle_buffers[..],
            &[
                (5, &self.sums),
                (6, &self.tangents),
                (8, &repair_count),
                (WORK_LIST_BINDING, &unusable.buffer),
            ],
        ]
        .concat();
        let write_buffers =
            [(0, uniform), (1, sum_of_output), (2, &self.tangents), (3, mesh.tangents.buffer)];
        let repair = (self.uniform.repairs == 1)
            .then(|| Dispatch::indirect(device, repair, &repair_buffers, &unusable.buffer));
        Ok(BoundPlan {
            terms: PrecisionDispatch::new(device, terms, &terms_buffers, self.uniform.triangle_count),
            gather: PrecisionDispatch::new(device, gather, &gather_buffers, self.uniform.sum_count),
            repair,
            write_tangents: Dispatch::new(device, write_tangents, &write_buffers, *output_count),
            counts: storage_buffer(device, "counts", 3),
            unusable,
            repair_count,
        })
    }
}

impl BoundPlan {
    /// Records the tangents for the positions and normals that the buffers hold when the device executes the
    /// commands.
    pub fn record(&self, encoder: &mut CommandEncoder) {
        self.unusable.record_clear(encoder);
        encoder.clear_buffer(&self.repair_count, 0, None);
        self.terms.record(encoder);
        self.gather.record(encoder);
        if let Some(repair) = &self.repair {
            repair.record(encoder);
        }
        self.write_tangents.record(encoder);
        self.terms.record_count(encoder, &self.counts, 0);
        self.gather.record_count(encoder, &self.counts, 4);
        encoder.copy_buffer_to_buffer(&self.repair_count, 0, &self.counts, 8, 4);
    }

    /// A buffer of three counts, with `BufferUsages::COPY_SRC`: triangles that integer arithmetic computed;
    /// tangents that integer arithmetic computed; unusable tangents that were replaced. The replacements
    /// are close to those of the core, but do not have their bits.
    pub fn counts(&self) -> &Buffer {
        &self.counts
    }
}
