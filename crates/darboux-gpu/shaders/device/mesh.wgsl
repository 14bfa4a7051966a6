// A mesh in buffers of others, read word by word: no vector type of WGSL has a stride of 12 bytes, as positions in vertex buffers do.

struct Mesh {
    vertex_count: u32,
    triangle_count: u32,
    // Counted in indices.
    first_index: u32,
    // 1 where indices have 16 bits, two in a word.
    index_shift: u32,
    // Words, from here on.
    vertex_stride: u32,
    position: u32,
    normal: u32,
    uv: u32,
    frame_stride: u32,
    tangent: u32,
    // ABSENT for a bitangent or sign that nobody wants.
    bitangent: u32,
    sign: u32,
    // 0, which compilers do not know.
    zero: u32,
}

const ABSENT: u32 = 0xffffffffu;

@group(0) @binding(0) var<uniform> mesh: Mesh;
@group(0) @binding(1) var<storage, read> indices: array<u32>;

fn zero() -> u32 {
    return mesh.zero;
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

// The number of a thread. Groups are laid out in two dimensions, as one cannot count far enough.
fn number_of_thread(thread: vec3u, groups: vec3u) -> u32 {
    return thread.x + thread.y * groups.x * WORKGROUP;
}
