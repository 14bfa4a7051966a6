// The uniform of a plan. Positions and normals are read word by word from the caller's buffers.

struct Plan {
    vertex_count: u32,
    // Without degenerate triangles, which come after the others.
    triangle_count: u32,
    degenerate_count: u32,
    sum_count: u32,
    output_count: u32,
    // Offsets and strides, in words.
    position: u32,
    position_stride: u32,
    normal: u32,
    normal_stride: u32,
    tangent: u32,
    tangent_stride: u32,
    // 1 if unusable tangents are replaced.
    repairs: u32,
    // The bits of the cosine of half the angular threshold. Two directions within half the threshold of a third are within the threshold.
    half_threshold: u32,
    // 0, but unknown to the compiler.
    opaque_zero: u32,
}

@group(0) @binding(0) var<uniform> plan: Plan;

fn opaque_zero() -> u32 {
    return plan.opaque_zero;
}

const NONE: u32 = 0xffffffffu;
