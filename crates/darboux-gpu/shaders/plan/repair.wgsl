// Replaces unusable tangents, as the core's tangents/repair.rs does in double precision. One thread per listed tangent.

@group(0) @binding(6) var<storage, read_write> tangent_of_sum: array<u32>;
@group(0) @binding(8) var<storage, read_write> repair_count: atomic<u32>;

fn all_finite(v: vec3f) -> bool {
    let words = bitcast<vec3u>(v) & vec3u(0x7f800000u);
    return all(words != vec3u(0x7f800000u));
}

// The unit vector along `v`; zero if `v` is zero or not finite. Scaling its largest component to 1 keeps the squares in range.
fn unit(v: vec3f) -> vec3f {
    let largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
    if !all_finite(v) || !not_zero(largest) {
        return vec3f();
    }
    let scaled = v / largest;
    return scaled / sqrt(dot(scaled, scaled));
}

// The unit vector along the part of `v` perpendicular to the unit vector `normal`; zero if only rounding error is left.
fn across(normal: vec3f, v: vec3f) -> vec3f {
    let direction = unit(v);
    let once = direction - dot(normal, direction) * normal;
    let rest = once - dot(normal, once) * normal;
    return select(vec3f(), unit(rest), dot(rest, rest) > 1e-12);
}

// A unit vector perpendicular to the unit vector `n`. T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017, listing 3.
fn perpendicular(n: vec3f) -> vec3f {
    let sign = select(1.0, -1.0, n.z < 0.0);
    let a = -1.0 / (sign + n.z);
    return vec3f(1.0 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x);
}

fn is_usable(tangent: vec3f, normal: vec3f) -> bool {
    let squared = dot(tangent, tangent);
    return all_finite(tangent) && abs(sqrt(squared) - 1.0) < 1e-3 && abs(dot(unit(tangent), normal)) < 0.999;
}

// The unweighted mean of the directions of the members.
fn mean(sum: u32, normal: vec3f) -> vec3f {
    var total = vec3f();
    var count = 0.0;
    for (var place = start_of_sum(sum); place < sums[sum]; place++) {
        let triangle = load_triangle(member(place) / 3u);
        let a = load_position(triangle.vertices.x);
        let e1 = load_position(triangle.vertices.y) - a;
        let e2 = load_position(triangle.vertices.z) - a;
        let s = triangle.dv.y * e1 - triangle.dv.x * e2;
        let direction = across(normal, select(s, -s, (triangle.flags.x & MIRRORS) != 0u));
        total += direction;
        count += dot(direction, direction);
    }
    return select(vec3f(), across(normal, total), dot(total, total) > 1e-10 * count * count);
}

fn run(sum: u32) {
    let vertex = vertex_of_sum(sum);
    let normal = unit(load_normal(vertex & ~IS_FORCED));
    let word = 4u * sum;
    let old = vec3u(tangent_of_sum[word], tangent_of_sum[word + 1u], tangent_of_sum[word + 2u]);
    if (vertex & IS_FORCED) == 0u && is_usable(bitcast<vec3f>(old), normal) {
        return;
    }
    atomicAdd(&repair_count, 1u);
    var tangent = vec3f(1.0, 0.0, 0.0);
    if any(normal != vec3f()) {
        tangent = mean(sum, normal);
        if all(tangent == vec3f()) {
            tangent = perpendicular(normal);
        }
    }
    tangent_of_sum[word] = bitcast<u32>(tangent.x);
    tangent_of_sum[word + 1u] = bitcast<u32>(tangent.y);
    tangent_of_sum[word + 2u] = bitcast<u32>(tangent.z);
}
