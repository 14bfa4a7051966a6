// The tangent of every sum: adds the terms of its members in the order of triangles, and normalises. One thread per sum.

@group(0) @binding(2) var<storage, read> normals: array<u32>;
@group(0) @binding(3) var<storage, read> term_of_corner: array<u32>;
// Four words per sum, of which the last is unused.
@group(0) @binding(6) var<storage, read_write> tangent_of_sum: array<u32>;
@group(0) @binding(7) var<storage, read_write> unusable: Unusable;

struct Unusable {
    groups: atomic<u32>,
    rows: u32,
    layers: u32,
    count: atomic<u32>,
    items: array<u32>,
}

fn item_count() -> u32 {
    return plan.sum_count;
}

fn is_finite(v: V3) -> bool {
    let infinity = 0x7f800000u;
    let x = (bits_of(v.x) & infinity) != infinity;
    let y = (bits_of(v.y) & infinity) != infinity;
    return x && y && (bits_of(v.z) & infinity) != infinity;
}

fn approximate(v: V3) -> vec3f {
    return vec3f(float_of(v.x), float_of(v.y), float_of(v.z));
}

// True only if the core finds the tangent usable, whatever the rounding here. False if that is uncertain.
fn is_surely_usable(tangent: V3, normal: V3) -> bool {
    if !is_finite(tangent) || !is_finite(normal) {
        return false;
    }
    let t = approximate(tangent);
    let n = approximate(normal);
    let squared = dot(t, t);
    let has_unit_length = squared > 0.9985 && squared < 1.0015;
    let has_normal = not_zero(normal.x) || not_zero(normal.y) || not_zero(normal.z);
    let normal_squared = dot(n, n);
    let along = dot(t, n);
    let is_sized = normal_squared > 1e-30 && normal_squared < 1e30;
    return has_unit_length && (!has_normal || (is_sized && along * along < 0.99 * normal_squared));
}

fn run(sum: u32) {
    let start = start_of_sum(sum);
    let end = sums[sum];
    let vertex = vertex_of_sum(sum);
    var total = V3(real(0u));
    for (var place = start; place < end; place++) {
        let word = 3u * member(place);
        let term = V3(
            real(term_of_corner[word]),
            real(term_of_corner[word + 1u]),
            real(term_of_corner[word + 2u]),
        );
        check_wide_range(term.x);
        check_wide_range(term.y);
        check_wide_range(term.z);
        total = add3(total, term);
    }
    // A sum without members has the reference's default tangent.
    var tangent = V3(real(ONE), real(0u), real(0u));
    if start < end {
        check_range3(total);
        tangent = direction(total);
    }
    tangent_of_sum[4u * sum] = canonical_bits(tangent.x);
    tangent_of_sum[4u * sum + 1u] = canonical_bits(tangent.y);
    tangent_of_sum[4u * sum + 2u] = canonical_bits(tangent.z);
    if plan.repairs == 0u || is_postponed() {
        return;
    }
    let word = (vertex & ~IS_FORCED) * plan.normal_stride + plan.normal;
    let normal = V3(real(normals[word]), real(normals[word + 1u]), real(normals[word + 2u]));
    if (vertex & IS_FORCED) != 0u || !is_surely_usable(tangent, normal) {
        let place = atomicAdd(&unusable.count, 1u);
        if place % WORKGROUP == 0u && place / WORKGROUP < MAX_GROUPS {
            atomicAdd(&unusable.groups, 1u);
        }
        unusable.items[place] = sum;
    }
}
