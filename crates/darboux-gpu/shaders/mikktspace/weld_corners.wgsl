// The welded vertex of every corner; NONE at degenerate triangles, which have two equal positions. As in the core's
// topology/triangulate.rs, for meshes of triangles.

@group(0) @binding(2) var<storage, read> vertices: array<u32>;
@group(0) @binding(3) var<storage, read> welded_vertex: array<u32>;
// NONE at degenerate triangles.
@group(0) @binding(4) var<storage, read_write> welded_vertex_of_corner: array<u32>;

fn position(vertex: u32) -> vec3u {
    let word = vertex * mesh.vertex_stride + mesh.position;
    let p = vec3u(vertices[word], vertices[word + 1u], vertices[word + 2u]);
    return vec3u(without_sign_of_zero(p.x), without_sign_of_zero(p.y), without_sign_of_zero(p.z));
}

// Compares the bits of numbers that are not NaN and not -0.
fn are_equal(a: vec3u, b: vec3u) -> bool {
    return all(a == b);
}

@compute @workgroup_size(WORKGROUP)
fn weld_corners(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let triangle = thread_index(thread, groups);
    if triangle >= mesh.triangle_count {
        return;
    }
    let own = vertices_of_triangle(triangle);
    var corners = vec3u(NONE);
    if all(own < vec3u(mesh.vertex_count)) {
        corners = vec3u(welded_vertex[own.x], welded_vertex[own.y], welded_vertex[own.z]);
        let a = position(own.x);
        let b = position(own.y);
        let c = position(own.z);
        if are_equal(a, b) || are_equal(b, c) || are_equal(c, a) {
            corners = vec3u(NONE);
        }
    }
    welded_vertex_of_corner[3u * triangle] = corners.x;
    welded_vertex_of_corner[3u * triangle + 1u] = corners.y;
    welded_vertex_of_corner[3u * triangle + 2u] = corners.z;
}
