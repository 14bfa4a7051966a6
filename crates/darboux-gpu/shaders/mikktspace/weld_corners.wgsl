// The welded vertex of every corner, and which triangles are degenerate: the twin of the core's triangles.rs, for meshes of triangles.

@group(0) @binding(2) var<storage, read> vertices: array<u32>;
@group(0) @binding(3) var<storage, read> welded: array<u32>;
// NONE at degenerate triangles, which have no neighbours.
@group(0) @binding(4) var<storage, read_write> welded_corners: array<u32>;

fn position(vertex: u32) -> vec3u {
    let word = vertex * mesh.vertex_stride + mesh.position;
    let p = vec3u(vertices[word], vertices[word + 1u], vertices[word + 2u]);
    return vec3u(without_sign_of_zero(p.x), without_sign_of_zero(p.y), without_sign_of_zero(p.z));
}

// Numbers, none of them NaN.
fn are_equal(a: vec3u, b: vec3u) -> bool {
    return all(a == b);
}

@compute @workgroup_size(WORKGROUP)
fn triangulate(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let triangle = number_of_thread(thread, groups);
    if triangle >= mesh.triangle_count {
        return;
    }
    let own = vertices_of_triangle(triangle);
    var corners = vec3u(NONE);
    if all(own < vec3u(mesh.vertex_count)) {
        corners = vec3u(welded[own.x], welded[own.y], welded[own.z]);
        let a = position(own.x);
        let b = position(own.y);
        let c = position(own.z);
        if are_equal(a, b) || are_equal(b, c) || are_equal(c, a) {
            corners = vec3u(NONE);
        }
    }
    welded_corners[3u * triangle] = corners.x;
    welded_corners[3u * triangle + 1u] = corners.y;
    welded_corners[3u * triangle + 2u] = corners.z;
}
