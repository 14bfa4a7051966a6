// Reads a mesh in the caller's buffers word by word, because no vector type of WGSL has the 12-byte stride of positions in vertex buffers.

struct Mesh {
    vertex_count: u32,
    triangle_count: u32,
    // In indices.
    first_index: u32,
    // 1 if indices have 16 bits, two per word.
    index_shift: u32,
    // Strides and offsets, in words.
    vertex_stride: u32,
    position: u32,
    normal: u32,
    uv: u32,
    frame_stride: u32,
    tangent: u32,
    // ABSENT if bitangents or signs are not written.
    bitangent: u32,
    sign: u32,
    // 0, but unknown to the compiler.
    opaque_zero: u32,
}

const ABSENT: u32 = 0xffffffffu;

@group(0) @binding(0) var<uniform> mesh: Mesh;
@group(0) @binding(1) var<storage, read> indices: array<u32>;

fn opaque_zero() -> u32 {
    return mesh.opaque_zero;
}

fn vertex_of_corner(corner: u32) -> u32 {
    let index = mesh.first_index + corner;
    if mesh.index_shift == 0u {
        return indices[index];
    }
    return (indices[index >> 1u] >> (16u * (index & 1u))) & 0xffffu;
}

fn vertices_of_triangle(triangle: u32) -> vec3u {
    let corner = 3u * triangle;
    return vec3u(vertex_of_corner(corner), vertex_of_corner(corner + 1u), vertex_of_corner(corner + 2u));
}

// The index of a thread. Workgroups have two dimensions, because one dimension is limited to 65,535.
fn thread_index(thread: vec3u, groups: vec3u) -> u32 {
    return thread.x + thread.y * groups.x * WORKGROUP;
}
