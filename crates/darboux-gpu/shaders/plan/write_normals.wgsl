// Copies the normal of each group to its vertices. One thread per vertex.

// NONE for unused vertices.
@group(0) @binding(1) var<storage, read> group_of_vertex: array<u32>;
@group(0) @binding(2) var<storage, read> normal_of_group: array<u32>;
@group(0) @binding(3) var<storage, read_write> normals: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn write(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let vertex = thread.x + thread.y * groups.x * WORKGROUP;
    if vertex >= plan.vertex_count || group_of_vertex[vertex] == NONE {
        return;
    }
    let first = 4u * group_of_vertex[vertex];
    let word = vertex * plan.normal_stride + plan.normal;
    normals[word] = normal_of_group[first];
    normals[word + 1u] = normal_of_group[first + 1u];
    normals[word + 2u] = normal_of_group[first + 2u];
}
