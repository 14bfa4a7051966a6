// Writes the tangents of corners, and defers the vertices whose tangents the CPU has to compute.

@group(0) @binding(4) var<storage, read> vertices: array<u32>;
// Eight words per corner: tangent, bitangent, magnitudes.
@group(0) @binding(3) var<storage, read> frame_of_corner: array<u32>;
@group(0) @binding(5) var<storage, read> adjacent_triangles: array<u32>;
@group(0) @binding(6) var<storage, read> triangle_flags: array<u32>;
@group(0) @binding(7) var<storage, read_write> is_deferred: array<atomic<u32>>;
// Four words per corner: tangent and sign. The sign is 0 for deferred corners.
@group(0) @binding(8) var<storage, read_write> tangent_of_corner: array<u32>;

const EXPONENT: u32 = 0x7f800000u;

fn tangent(corner: u32) -> vec3u {
    let word = 8u * corner;
    return vec3u(frame_of_corner[word], frame_of_corner[word + 1u], frame_of_corner[word + 2u]);
}

fn normal(vertex: u32) -> vec3f {
    let word = vertex * mesh.vertex_stride + mesh.normal;
    return bitcast<vec3f>(vec3u(vertices[word], vertices[word + 1u], vertices[word + 2u]));
}

// True only if the core finds the tangent usable, whatever the rounding here. False if that is uncertain. Normals are finite.
fn is_surely_usable(tangent: vec3u, normal: vec3f) -> bool {
    if any((tangent & vec3u(EXPONENT)) == vec3u(EXPONENT)) {
        return false;
    }
    let unit = bitcast<vec3f>(tangent);
    let square = dot(unit, unit);
    if square < 0.999 || square > 1.001 {
        return false;
    }
    if all((bitcast<vec3u>(normal) & vec3u(0x7fffffffu)) == vec3u(0u)) {
        return true;
    }
    let of_normal = dot(normal, normal);
    let along = dot(unit, normal);
    return of_normal > 1e-18 && of_normal < 1e18 && along * along < 0.99 * of_normal;
}

// Defers vertices whose corners have different tangents, or a tangent that may have to be repaired.
@compute @workgroup_size(WORKGROUP)
fn check_frames(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let corner = thread_index(thread, groups);
    if corner >= 3u * mesh.triangle_count {
        return;
    }
    let vertex = vertex_of_corner(corner);
    if vertex == NONE || atomicLoad(&is_deferred[vertex]) != 0u {
        return;
    }
    let first = corner_at(adjacent_triangles[adjacency_range(vertex).x], vertex);
    let own = tangent(corner);
    if any(own != tangent(first)) || !is_surely_usable(own, normal(vertex)) {
        atomicStore(&is_deferred[vertex], 1u);
    }
}

@compute @workgroup_size(WORKGROUP)
fn store_tangents(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let corner = thread_index(thread, groups);
    if corner >= 3u * mesh.triangle_count {
        return;
    }
    let vertex = vertex_of_corner(corner);
    var own = vec3u(0u);
    var sign = 0u;
    if vertex != NONE && atomicLoad(&is_deferred[vertex]) == 0u {
        own = tangent(corner);
        sign = bitcast<u32>(select(-1.0, 1.0, (triangle_flags[corner / 3u] & 1u) != 0u));
    }
    tangent_of_corner[4u * corner] = own.x;
    tangent_of_corner[4u * corner + 1u] = own.y;
    tangent_of_corner[4u * corner + 2u] = own.z;
    tangent_of_corner[4u * corner + 3u] = sign;
}
