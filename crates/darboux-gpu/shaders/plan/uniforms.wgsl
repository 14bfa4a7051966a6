// A mesh whose vertices move and whose topology stays: positions and normals in buffers of others, read word by word.

struct Plan {
    vertex_count: u32,
    // Those that degenerate triangles come after.
    triangle_count: u32,
    degenerate_count: u32,
    sum_count: u32,
    output_count: u32,
    // Words.
    position: u32,
    position_stride: u32,
    normal: u32,
    normal_stride: u32,
    tangent: u32,
    tangent_stride: u32,
    // 1 where unusable tangents are replaced.
    repairs: u32,
    // sqrt((1 + c) / 2) of the threshold's cosine c, as a word: directions nearer than this to one direction are near each other.
    half_threshold: u32,
    // 0, which compilers do not know.
    zero: u32,
}

@group(0) @binding(0) var<uniform> plan: Plan;

fn zero() -> u32 {
    return plan.zero;
}

const NONE: u32 = 0xffffffffu;
