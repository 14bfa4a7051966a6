// Checks whether a triangle has become degenerate, is no longer degenerate, or may no longer share the tangents of its corners. One thread
// per triangle, degenerate ones last. The comparisons have a margin for rounding errors; uncertain triangles count as changed.

@group(0) @binding(5) var<storage, read> tangent_of_sum: array<u32>;
// The sum of each corner, with the flag IS_SPLIT.
@group(0) @binding(6) var<storage, read> sum_of_corner: array<u32>;
// Two words per triangle: the differences of u along its edges.
@group(0) @binding(7) var<storage, read> u_differences: array<u32>;

// The group of the corner had several tangents.
const IS_SPLIT: u32 = 0x80000000u;
// A margin of cosines, far more than their rounding errors.
const MARGIN: f32 = 1e-3;

fn item_count() -> u32 {
    return plan.triangle_count + plan.degenerate_count;
}

fn across(normal: vec3f, v: vec3f) -> vec3f {
    let rest = v - dot(normal, v) * normal;
    return rest / sqrt(dot(rest, rest));
}

fn is_between(x: f32, low: f32, high: f32) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u && x > low && x < high;
}

// Whether the tangent and bitangent directions of a corner are near those of its sum.
fn is_near(place: u32, representative: u32, s: vec3f, t: vec3f, sign: f32) -> bool {
    let sum = sum_of_corner[place];
    if (sum & IS_SPLIT) != 0u {
        return false;
    }
    let word = 4u * sum;
    let axis = bitcast<vec3f>(vec3u(tangent_of_sum[word], tangent_of_sum[word + 1u], tangent_of_sum[word + 2u]));
    let normal = load_normal(representative);
    let least_cosine = bitcast<f32>(plan.half_threshold) + MARGIN;
    let other = sign * cross(normal, axis);
    // The projection requires unit normals, and the projected direction must not vanish.
    let has_frame = is_between(dot(normal, normal), 0.99, 1.01) && is_between(dot(other, other), 0.9, 1.1);
    let s_cosine = dot(across(normal, s), axis);
    let t_cosine = dot(across(normal, t), other) / sqrt(dot(other, other));
    return has_frame && is_between(s_cosine, least_cosine, 1.1) && is_between(t_cosine, least_cosine, 1.1);
}

fn run(t: u32) {
    let triangle = load_triangle(t);
    let a = load_position(triangle.vertices.x);
    let b = load_position(triangle.vertices.y);
    let c = load_position(triangle.vertices.z);
    let is_degenerate = are_equal(a, b) || are_equal(b, c) || are_equal(c, a);
    if (triangle.flags.y & IS_DEGENERATE) != 0u {
        if !is_degenerate {
            atomicAdd(&changes.expanded, 1u);
        }
        return;
    }
    if is_degenerate {
        atomicAdd(&changes.collapsed, 1u);
        return;
    }
    let du = bitcast<vec2f>(vec2u(u_differences[2u * t], u_differences[2u * t + 1u]));
    let area = abs(du.x * triangle.dv.y - triangle.dv.x * du.y);
    if (triangle.flags.y & ADDS_NOTHING) != 0u {
        // UVs do not move. A triangle with a UV area was UV-degenerate because of its positions, which may have changed.
        if !is_between(area, -1.0, 1e-37) {
            atomicAdd(&changes.rotated, 1u);
        }
        return;
    }
    let sign = select(1.0, -1.0, (triangle.flags.x & MIRRORS) != 0u);
    let s = sign * (triangle.dv.y * (b - a) - triangle.dv.x * (c - a));
    let tt = sign * (du.x * (c - a) - du.y * (b - a));
    let s_size = dot(s, s);
    let t_size = dot(tt, tt);
    var is_same = is_between(area, 1e-30, 1e30) && is_between(s_size, 1e-30, 1e30) && is_between(t_size, 1e-30, 1e30);
    for (var k = 0u; k < 3u; k++) {
        is_same = is_same && is_near(3u * t + k, triangle.representatives[k], s, tt, sign);
    }
    if !is_same {
        atomicAdd(&changes.rotated, 1u);
    }
}
