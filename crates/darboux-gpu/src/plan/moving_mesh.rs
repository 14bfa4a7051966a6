//! Where the moving vertices of a planned mesh and their tangents lie in the caller's buffers.

use wgpu::{Buffer, BufferUsages, Device};

use crate::device::buffers::buffer_with_contents;
use crate::device::mesh_buffers::{check_fields, check_overlap};
use crate::error::GpuError;

/// An attribute in the caller's buffer, which has `BufferUsages::STORAGE`.
#[derive(Clone, Copy, Debug)]
pub struct Attribute<'a> {
    /// The buffer.
    pub buffer: &'a Buffer,
    /// Bytes from one element to the next, a multiple of 4.
    pub stride: u32,
    /// Bytes before the first element, a multiple of 4.
    pub offset: u32,
}

/// Whether tangents are written per vertex or per corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TangentsPer {
    /// One tangent per vertex. Unused vertices are not written.
    Vertex,
    /// One tangent per corner of the index list.
    Corner,
}

/// The moving vertices of a planned mesh, and where their tangents are written. All attributes may lie in one
/// buffer.
#[derive(Clone, Copy, Debug)]
pub struct MovingMesh<'a> {
    /// The number of vertices.
    pub vertex_count: u32,
    /// Three floats per vertex.
    pub positions: Attribute<'a>,
    /// Three floats per vertex.
    pub normals: Attribute<'a>,
    /// Four floats per vertex or corner: the unit tangent and the sign.
    pub tangents: Attribute<'a>,
    /// What the tangents are per.
    pub per: TangentsPer,
}

/// The uniform `Plan` of `shaders/plan/uniforms.wgsl`. Offsets and strides are in words.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct PlanUniform {
    pub vertex_count: u32,
    pub triangle_count: u32,
    pub degenerate_count: u32,
    pub sum_count: u32,
    pub output_count: u32,
    pub position: u32,
    pub position_stride: u32,
    pub normal: u32,
    pub normal_stride: u32,
    pub tangent: u32,
    pub tangent_stride: u32,
    pub repairs: u32,
    pub half_threshold: u32,
    pub opaque_zero: u32,
}

impl PlanUniform {
    /// The uniform with the layout of `mesh`.
    pub fn with_layout(&self, mesh: &MovingMesh<'_>, output_count: u32) -> Self {
        Self {
            output_count,
            position: mesh.positions.offset / 4,
            position_stride: mesh.positions.stride / 4,
            normal: mesh.normals.offset / 4,
            normal_stride: mesh.normals.stride / 4,
            tangent: mesh.tangents.offset / 4,
            tangent_stride: mesh.tangents.stride / 4,
            ..*self
        }
    }

    pub fn upload(&self, device: &Device) -> Buffer {
        buffer_with_contents(device, "plan", bytemuck::bytes_of(self), BufferUsages::UNIFORM)
    }
}

impl MovingMesh<'_> {
    /// Checks the layout for a plan of `vertex_count` vertices that writes `output_count` tangents.
    pub(crate) fn check(
        &self,
        device: &Device,
        vertex_count: u32,
        output_count: u32,
    ) -> Result<(), GpuError> {
        let (expected, found) = (vertex_count, self.vertex_count);
        if expected != found {
            return Err(GpuError::VertexCountMismatch { expected, found });
        }
        let check = |what, attribute: &Attribute<'_>, count, size| {
            let field = [(what, attribute.offset, size)];
            check_fields(device, (what, attribute.buffer), attribute.stride, count, field)
        };
        check("positions", &self.positions, found, 12)?;
        check("normals", &self.normals, found, 12)?;
        check("tangents", &self.tangents, output_count, 16)?;
        // Attributes in one buffer may be interleaved if they have one stride.
        let Attribute { buffer, stride, offset } = self.tangents;
        let others = [("positions", self.positions), ("normals", self.normals)];
        let others = others.into_iter().filter(|(_, other)| other.buffer == buffer && other.stride == stride);
        let others: Vec<_> = others.map(|(what, other)| (what, other.offset, 12)).collect();
        check_overlap(stride, [("tangents", offset, 16)].into_iter(), &others)
    }
}
