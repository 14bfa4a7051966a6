// The tangent of every sum: its members' terms in the order of triangles. One thread per sum.

@group(0) @binding(2) var<storage, read> normals: array<u32>;
@group(0) @binding(3) var<storage, read> term_of_corner: array<u32>;
// Four words each, of which the last is not used.
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
    let x = (word_of(v.x) & infinity) != infinity;
    let y = (word_of(v.y) & infinity) != infinity;
    return x && y && (word_of(v.z) & infinity) != infinity;
}

fn estimates(v: V3) -> vec3f {
    return vec3f(estimate_of(v.x), estimate_of(v.y), estimate_of(v.z));
}

// True for a tangent that the core finds usable; false where it does not, and for few where it does.
fn is_surely_usable(tangent: V3, normal: V3) -> bool {
    if !is_finite(tangent) || !is_finite(normal) {
        return false;
    }
    let t = estimates(tangent);
    let n = estimates(normal);
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
        watch_wide(term.x);
        watch_wide(term.y);
        watch_wide(term.z);
        total = added(total, term);
    }
    // What no group reaches has a tangent of its own.
    var tangent = V3(real(ONE), real(0u), real(0u));
    if start < end {
        watch_vector(total);
        tangent = direction(total);
    }
    tangent_of_sum[4u * sum] = stored(tangent.x);
    tangent_of_sum[4u * sum + 1u] = stored(tangent.y);
    tangent_of_sum[4u * sum + 2u] = stored(tangent.z);
    if plan.repairs == 0u || is_left() {
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
