//! A caller's buffers: where in them what lies, checked once.

use bytemuck::Zeroable;
use wgpu::{Buffer, BufferUsages, Device, IndexFormat, Limits};

use crate::GpuError;
use crate::device::kernel::filled;

/// A triangle mesh in buffers of the caller's, all with `BufferUsages::STORAGE`.
///
/// Values may be anything. An index that names no vertex cannot be seen from here: its triangle counts for nothing.
#[derive(Clone, Copy, Debug)]
pub struct MeshBuffers<'a> {
    /// Positions, normals and UVs, interleaved.
    pub vertices: &'a Buffer,
    /// Where they lie.
    pub layout: VertexLayout,
    /// The number of vertices.
    pub vertex_count: u32,
    /// The vertex of each corner, three corners to a triangle.
    pub indices: &'a Buffer,
    /// The width of an index.
    pub index_format: IndexFormat,
    /// The place of the first index, counted in indices.
    pub first_index: u32,
    /// The number of indices.
    pub index_count: u32,
}

/// Where a vertex has its attributes, in bytes: multiples of 4. Offsets count from the start of the buffer, those of the first vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VertexLayout {
    /// From one vertex to the next.
    pub stride: u32,
    /// Three floats.
    pub position: u32,
    /// Three floats.
    pub normal: u32,
    /// Two floats.
    pub uv: u32,
}

/// Where frames go.
#[derive(Clone, Copy, Debug)]
pub enum Destination<'a> {
    /// Into the vertices that they are of, with their stride.
    Vertices(FrameLayout),
    /// Into another buffer, which also has `BufferUsages::STORAGE`.
    Buffer {
        /// That buffer.
        buffer: &'a Buffer,
        /// Bytes from one frame to the next.
        stride: u32,
        /// Where a frame lies.
        layout: FrameLayout,
    },
}

/// Where a frame has its parts, in bytes: multiples of 4, from the start of the buffer. A tangent of four floats has its sign 12 bytes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameLayout {
    /// Three floats, unit length.
    pub tangent: u32,
    /// Three floats, unit length, if wanted.
    pub bitangent: Option<u32>,
    /// One float, +1 or -1, if wanted.
    pub sign: Option<u32>,
}

/// Corners are counted in 32 bits, and the core takes no more either.
const MAX_CORNERS: u32 = (1 << 30) - 1;
/// In [`Description`]: not wanted.
const ABSENT: u32 = u32::MAX;

/// The shaders' `Mesh`, in words.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct Description {
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
    zero: u32,
}

impl Description {
    /// A mesh of positions, normals and UVs in this order without gaps, and 32-bit indices.
    pub fn packed(vertex_count: u32, triangle_count: u32) -> Self {
        let [vertex_stride, position, normal, uv] = [8, 0, 3, 6];
        Self { vertex_count, triangle_count, vertex_stride, position, normal, uv, ..Self::zeroed() }
    }

    pub fn uniform(&self, device: &Device) -> Buffer {
        filled(device, "mesh", bytemuck::bytes_of(self), BufferUsages::UNIFORM)
    }

    /// The same with triangles from `first` on, `count` at most.
    pub fn piece(&self, first: u32, count: u32) -> Self {
        let triangle_count = (self.triangle_count - first).min(count);
        Self { triangle_count, first_index: self.first_index + 3 * first, ..*self }
    }
}

/// A part of an element: its name, its offset and its size in bytes.
type Part = (&'static str, u32, u32);

impl VertexLayout {
    fn parts(&self) -> [Part; 3] {
        [("positions", self.position, 12), ("normals", self.normal, 12), ("UVs", self.uv, 8)]
    }
}

impl FrameLayout {
    fn parts(&self) -> impl Iterator<Item = Part> + Clone {
        let optional =
            [("bitangents", self.bitangent, 12), ("signs", self.sign, 4)].into_iter().filter_map(of_optional);
        [("tangents", self.tangent, 12)].into_iter().chain(optional)
    }
}

fn of_optional((what, offset, size): (&'static str, Option<u32>, u32)) -> Option<Part> {
    Some((what, offset?, size))
}

/// Checks all that can be seen from here.
pub(crate) fn describe(
    device: &Device,
    mesh: &MeshBuffers<'_>,
    destination: &Destination<'_>,
) -> Result<Description, GpuError> {
    check_indices(device, mesh)?;
    let stride = mesh.layout.stride;
    check_elements(device, ("vertices", mesh.vertices), stride, mesh.vertex_count, mesh.layout.parts())?;
    let (frames, frame_stride) = match *destination {
        Destination::Vertices(layout) => {
            check_elements(device, ("vertices", mesh.vertices), stride, mesh.vertex_count, layout.parts())?;
            check_places(stride, layout.parts(), &mesh.layout.parts())?;
            (layout, stride)
        }
        Destination::Buffer { buffer, stride, layout } => {
            check_apart(mesh, buffer)?;
            check_elements(device, ("frames", buffer), stride, mesh.vertex_count, layout.parts())?;
            check_places(stride, layout.parts(), &[])?;
            (layout, stride)
        }
    };
    let optional = |offset: Option<u32>| offset.map_or(ABSENT, |offset| offset / 4);
    Ok(Description {
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
        zero: 0,
    })
}

fn check_indices(device: &Device, mesh: &MeshBuffers<'_>) -> Result<(), GpuError> {
    if !mesh.index_count.is_multiple_of(3) {
        return Err(GpuError::PartialTriangle { indices: mesh.index_count });
    }
    if mesh.index_count > MAX_CORNERS {
        return Err(GpuError::TooManyCorners { corners: mesh.index_count, limit: MAX_CORNERS });
    }
    if mesh.indices == mesh.vertices {
        let cure = "copy the indices into one of their own";
        return Err(GpuError::SharedBuffer { what: "indices", other: "vertices", cure });
    }
    let end = u64::from(mesh.first_index) + u64::from(mesh.index_count);
    // Whole words are read: half of the last may be another's, but it must be there.
    let needed = (end * mesh.index_format.byte_size() as u64).next_multiple_of(4);
    check_buffer(device, "indices", mesh.indices, needed)
}

fn check_apart(mesh: &MeshBuffers<'_>, frames: &Buffer) -> Result<(), GpuError> {
    let shared = |other, cure| Err(GpuError::SharedBuffer { what: "frames", other, cure });
    if frames == mesh.vertices {
        return shared("vertices", "use Destination::Vertices");
    }
    if frames == mesh.indices {
        return shared("indices", "give the frames one of their own");
    }
    Ok(())
}

/// That all parts of `count` elements are whole words inside of the buffer.
pub(crate) fn check_elements(
    device: &Device,
    (what, buffer): (&'static str, &Buffer),
    stride: u32,
    count: u32,
    parts: impl IntoIterator<Item = Part> + Clone,
) -> Result<(), GpuError> {
    check_alignment(what, stride)?;
    let mut needed = 0;
    for (part, offset, size) in parts {
        check_alignment(part, offset)?;
        let last = u64::from(count.saturating_sub(1)) * u64::from(stride);
        needed = needed.max(last + u64::from(offset) + u64::from(size));
    }
    check_buffer(device, what, buffer, needed)
}

fn check_alignment(what: &'static str, bytes: u32) -> Result<(), GpuError> {
    if bytes.is_multiple_of(4) { Ok(()) } else { Err(GpuError::Unaligned { what, bytes }) }
}

fn check_buffer(device: &Device, what: &'static str, buffer: &Buffer, needed: u64) -> Result<(), GpuError> {
    let found = buffer.size();
    if needed > found {
        return Err(GpuError::PastBuffer { what, needed, found });
    }
    if !buffer.usage().contains(BufferUsages::STORAGE) {
        return Err(GpuError::NotStorage { what });
    }
    check_size(device, what, found)
}

/// The bytes of the largest buffer that can be made and bound, and whose bytes 32 bits count.
pub(crate) fn largest_buffer(limits: &Limits) -> u64 {
    limits.max_storage_buffer_binding_size.min(limits.max_buffer_size).min(u64::from(u32::MAX))
}

/// That a buffer of this size is no larger.
pub(crate) fn check_size(device: &Device, what: &'static str, bytes: u64) -> Result<(), GpuError> {
    let limit = largest_buffer(&device.limits());
    if bytes > limit { Err(GpuError::PastLimit { what, bytes, limit }) } else { Ok(()) }
}

/// That what is written has a place of its own in every element, apart from what is read.
pub(crate) fn check_places(
    stride: u32,
    written: impl Iterator<Item = Part> + Clone,
    read: &[Part],
) -> Result<(), GpuError> {
    // Within a stride; what is read may reach into the next.
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
