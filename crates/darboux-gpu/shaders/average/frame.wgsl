// Computes and writes the frame of a vertex from its sums.

// The unit vector along `v`; zero if `v` is zero or not finite.
fn unit(v: vec3f) -> vec3f {
    let largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
    let bits = bitcast<vec3u>(v);
    if !(is_finite(bits.x) && is_finite(bits.y) && is_finite(bits.z) && not_zero(largest)) {
        return vec3f();
    }
    // The largest component is 1 now, so the squares neither overflow nor underflow.
    let scaled = v / largest;
    return scaled / sqrt(dot(scaled, scaled));
}

// The unit vector along the part of `v` perpendicular to `normal`; without a normal, along `v`; zero if there is none.
fn direction_across(v: vec3f, normal: vec3f) -> vec3f {
    let square = dot(normal, normal);
    if square >= 0.25 && square < 4.0 {
        let rest = v - (dot(normal, v) * (1.0 / square)) * normal;
        let left = dot(rest, rest);
        if left > 1e-2 * dot(v, v) && left > 1e-24 && left < 1e24 {
            return (1.0 / sqrt(left)) * rest;
        }
    }
    let n = unit(normal);
    let direction = unit(v);
    let once = direction - dot(n, direction) * n;
    // Project twice: the rounding error along the normal after one projection may be as large as the result.
    let rest = once - dot(n, once) * n;
    return select(vec3f(), unit(rest), dot(rest, rest) > 1e-12);
}

// A unit vector perpendicular to `normal` (T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017, listing 3);
// (1, 0, 0) without one.
fn perpendicular(normal: vec3f) -> vec3f {
    let n = unit(normal);
    let sign = select(1.0, -1.0, n.z < 0.0);
    let a = -1.0 / (sign + n.z);
    return vec3f(1.0 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x);
}

fn store_vector(word: u32, v: vec3f) {
    store(word, v.x);
    store(word + 1u, v.y);
    store(word + 2u, v.z);
}

// The orientation with more triangles determines the frame.
fn store_frame(vertex: u32, sums: Sums) {
    let mirrored = sums.mirrored.count > sums.unmirrored.count;
    var sum = sums.unmirrored;
    if mirrored {
        sum = sums.mirrored;
    }
    let sign = select(1.0, -1.0, mirrored);
    let normal = bitcast<vec3f>(load_normal(vertex));
    var tangent = direction_across(sum.tangent, normal);
    // If the tangents cancel out, only rounding error is left.
    let shortest = 1e-5 * sum.size;
    if dot(sum.tangent, sum.tangent) < shortest * shortest || all(tangent == vec3f()) {
        tangent = perpendicular(normal);
        atomicAdd(&counts.without_direction, 1u);
    }
    if sums.unmirrored.count > 0.0 && sums.mirrored.count > 0.0 {
        atomicAdd(&counts.of_both_orientations, 1u);
    }
    let start = vertex * mesh.frame_stride;
    store_vector(start + mesh.tangent, tangent);
    if mesh.sign != ABSENT {
        store(start + mesh.sign, sign);
    }
    if mesh.bitangent != ABSENT {
        var bitangent = direction_across(sum.bitangent, normal);
        if all(bitangent == vec3f()) {
            bitangent = sign * bitangent_across(normal, tangent);
        }
        store_vector(start + mesh.bitangent, bitangent);
    }
}

// The unit vector along cross(normal, tangent); without a normal, a vector perpendicular to the tangent.
fn bitangent_across(normal: vec3f, tangent: vec3f) -> vec3f {
    let across = unit(cross(unit(normal), tangent));
    return select(across, perpendicular(tangent), all(across == vec3f()));
}
