//! Describes where positions, normals, UVs, indices and frames lie in the caller's buffers, and checks that
//! description once.

use bytemuck::Zeroable;
use wgpu::{Buffer, BufferUsages, Device, IndexFormat};

use crate::device::buffers::{buffer_with_contents, check_size};
use crate::error::GpuError;

/// A triangle mesh in the caller's buffers, all of which have `BufferUsages::STORAGE`.
///
/// The values themselves are not checked. A triangle with an index out of range is ignored.
#[derive(Clone, Copy, Debug)]
pub struct MeshBuffers<'a> {
    /// Interleaved positions, normals and UVs.
    pub vertices: &'a Buffer,
    /// The layout of a vertex.
    pub layout: VertexLayout,
    /// The number of vertices.
    pub vertex_count: u32,
    /// The vertex of every corner, three corners per triangle.
    pub indices: &'a Buffer,
    /// The width of an index.
    pub index_format: IndexFormat,
    /// The position of the first index, counted in indices.
    pub first_index: u32,
    /// The number of indices.
    pub index_count: u32,
}

/// Byte offsets of the attributes of a vertex, all multiples of 4. They count from the start of the buffer to
/// the first vertex's attribute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VertexLayout {
    /// Bytes from one vertex to the next.
    pub stride: u32,
    /// Offset of the position, three floats.
    pub position: u32,
    /// Offset of the normal, three floats.
    pub normal: u32,
    /// Offset of the UV, two floats.
    pub uv: u32,
}

/// Where frames are written.
#[derive(Clone, Copy, Debug)]
pub enum Destination<'a> {
    /// Into the vertices of the mesh, with their stride.
    Vertices(FrameLayout),
    /// Into another buffer.
    Buffer {
        /// The buffer, which has `BufferUsages::STORAGE`.
        buffer: &'a Buffer,
        /// Bytes from one frame to the next.
        stride: u32,
        /// The layout of a frame.
        layout: FrameLayout,
    },
}

/// Byte offsets of the parts of a frame, all multiples of 4, from the start of the buffer. For a tangent of
/// four floats, the offset of the sign is that of the tangent plus 12.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameLayout {
    /// Offset of the tangent, three floats of unit length.
    pub tangent: u32,
    /// Offset of the bitangent, three floats of unit length; none if it is not written.
    pub bitangent: Option<u32>,
    /// Offset of the sign, one float of +1 or -1; none if it is not written.
    pub sign: Option<u32>,
}

/// The largest number of corners, which is that of the core.
const MAX_CORNERS: u32 = (1 << 30) - 1;
/// In [`MeshUniform`]: this part of the frame is not written.
const ABSENT: u32 = u32::MAX;

/// The uniform `Mesh` of `shaders/device/mesh.wgsl`. Offsets and strides are in words.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct MeshUniform {
    pub vertex_count: u32,
    pub triangle_count: u32,
    first_index: u32,
    index_shift: u32,
    vertex_stride: u32,
    position: u32,
    normal: u32,
    uv: u32,
    frame_stride: u32,
    tangent: u32,
    bitangent: u32,
    sign: u32,
    opaque_zero: u32,
}

impl MeshUniform {
    /// A mesh with tightly packed vertices of position, normal and UV, and with 32-bit indices.
    pub fn packed(vertex_count: u32, triangle_count: u32) -> Self {
        let [vertex_stride, position, normal, uv] = [8, 0, 3, 6];
        Self { vertex_count, triangle_count, vertex_stride, position, normal, uv, ..Self::zeroed() }
    }

    /// The description of `mesh` and `destination`. Errors: everything that can be checked without reading
    /// the buffers.
    pub fn checked(
        device: &Device,
        mesh: &MeshBuffers<'_>,
        destination: &Destination<'_>,
    ) -> Result<Self, GpuError> {
        check_indices(device, mesh)?;
        let (stride, count) = (mesh.layout.stride, mesh.vertex_count);
        check_fields(device, ("vertices", mesh.vertices), stride, count, mesh.layout.fields())?;
        let (frames, frame_stride) = match *destination {
            Destination::Vertices(layout) => {
                check_fields(device, ("vertices", mesh.vertices), stride, count, layout.fields())?;
                check_overlap(stride, layout.fields(), &mesh.layout.fields())?;
                (layout, stride)
            }
            Destination::Buffer { buffer, stride, layout } => {
                check_distinct(mesh, buffer)?;
                check_fields(device, ("frames", buffer), stride, count, layout.fields())?;
                check_overlap(stride, layout.fields(), &[])?;
                (layout, stride)
            }
        };
        let optional = |offset: Option<u32>| offset.map_or(ABSENT, |offset| offset / 4);
        Ok(Self {
            vertex_count: mesh.vertex_count,
            triangle_count: mesh.index_count / 3,
            first_index: mesh.first_index,
            index_shift: u32::from(mesh.index_format == IndexFormat::Uint16),
            vertex_stride: stride / 4,
            position: mesh.layout.position / 4,
            normal: mesh.layout.normal / 4,
            uv: mesh.layout.uv / 4,
            frame_stride: frame_stride / 4,
            tangent: frames.tangent / 4,
            bitangent: optional(frames.bitangent),
            sign: optional(frames.sign),
            opaque_zero: 0,
        })
    }

    /// The same mesh with at most `count` triangles, starting at triangle `first`.
    pub fn triangle_range(&self, first: u32, count: u32) -> Self {
        let triangle_count = (self.triangle_count - first).min(count);
        Self { triangle_count, first_index: self.first_index + 3 * first, ..*self }
    }

    pub fn upload(&self, device: &Device) -> Buffer {
        buffer_with_contents(device, "mesh", bytemuck::bytes_of(self), BufferUsages::UNIFORM)
    }
}

/// A field of an element: its name for messages, its byte offset and its byte length.
type Field = (&'static str, u32, u32);

impl VertexLayout {
    fn fields(&self) -> [Field; 3] {
        [("positions", self.position, 12), ("normals", self.normal, 12), ("UVs", self.uv, 8)]
    }
}

impl FrameLayout {
    fn fields(&self) -> impl Iterator<Item = Field> + Clone {
        let optional =
            [("bitangents", self.bitangent, 12), ("signs", self.sign, 4)].into_iter().filter_map(present);
        [("tangents", self.tangent, 12)].into_iter().chain(optional)
    }
}

fn present((what, offset, size): (&'static str, Option<u32>, u32)) -> Option<Field> {
    Some((what, offset?, size))
}

fn check_indices(device: &Device, mesh: &MeshBuffers<'_>) -> Result<(), GpuError> {
    if !mesh.index_count.is_multiple_of(3) {
        return Err(GpuError::PartialTriangle { indices: mesh.index_count });
    }
    if mesh.index_count > MAX_CORNERS {
        return Err(GpuError::TooManyCorners { corners: mesh.index_count, limit: MAX_CORNERS });
    }
    if mesh.indices == mesh.vertices {
        let remedy = "copy the indices into a buffer of their own";
        return Err(GpuError::SharedBuffer { what: "indices", other: "vertices", remedy });
    }
    let end = u64::from(mesh.first_index) + u64::from(mesh.index_count);
    // The shader reads whole words, so the other half of the last word must exist too.
    let needed = (end * mesh.index_format.byte_size() as u64).next_multiple_of(4);
    check_buffer(device, "indices", mesh.indices, needed)
}

/// Errors: frames are written into a buffer that the mesh is read from.
fn check_distinct(mesh: &MeshBuffers<'_>, frames: &Buffer) -> Result<(), GpuError> {
    let shared = |other, remedy| Err(GpuError::SharedBuffer { what: "frames", other, remedy });
    if frames == mesh.vertices {
        return shared("vertices", "use Destination::Vertices");
    }
    if frames == mesh.indices {
        return shared("indices", "write the frames into a buffer of their own");
    }
    Ok(())
}

/// Errors: a field of the `count` elements is not aligned to words, or does not lie inside the buffer.
pub(crate) fn check_fields(
    device: &Device,
    (what, buffer): (&'static str, &Buffer),
    stride: u32,
    count: u32,
    fields: impl IntoIterator<Item = Field> + Clone,
) -> Result<(), GpuError> {
    check_alignment(what, stride)?;
    let mut needed = 0;
    for (field, offset, size) in fields {
        check_alignment(field, offset)?;
        let last = u64::from(count.saturating_sub(1)) * u64::from(stride);
        needed = needed.max(last + u64::from(offset) + u64::from(size));
    }
    check_buffer(device, what, buffer, needed)
}

fn check_alignment(what: &'static str, bytes: u32) -> Result<(), GpuError> {
    if bytes.is_multiple_of(4) { Ok(()) } else { Err(GpuError::UnalignedLayout { what, bytes }) }
}

fn check_buffer(device: &Device, what: &'static str, buffer: &Buffer, needed: u64) -> Result<(), GpuError> {
    let found = buffer.size();
    if needed > found {
        return Err(GpuError::BufferTooSmall { what, needed, found });
    }
    if !buffer.usage().contains(BufferUsages::STORAGE) {
        return Err(GpuError::MissingStorageUsage { what });
    }
    check_size(device, what, found)
}

/// Errors: in an element of `stride` bytes, a written field overlaps another written field or a read field.
pub(crate) fn check_overlap(
    stride: u32,
    written: impl Iterator<Item = Field> + Clone,
    read: &[Field],
) -> Result<(), GpuError> {
    // Offsets are taken modulo the stride, because a read field may reach into the next element.
    let words = |offset: u32, size: u32| (0..size).step_by(4).map(move |k| (offset.wrapping_add(k)) % stride);
    for (index, (what, offset, size)) in written.clone().enumerate() {
        let overlap = Err(GpuError::Overlap { what, offset, stride });
        if stride < size || offset % stride > stride - size {
            return overlap;
        }
        let others = written.clone().take(index).chain(read.iter().copied());
        for (_, other, size_of_other) in others {
            if words(other, size_of_other).any(|word| words(offset, size).any(|own| own == word)) {
                return overlap;
            }
        }
    }
    Ok(())
}
