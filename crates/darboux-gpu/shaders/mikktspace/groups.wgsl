// Groups: corners of one vertex whose triangles are connected by edges at that vertex and have one UV orientation. The core's
// tangents/mikktspace/groups.rs finds them by flood fill from the first triangle.
//
// A triangle has two edges at a vertex, and so at most two neighbours there: a group is a ring or a chain. Each thread walks along the
// group of its corner and finds the lowest corner, which is the core's starting point. A UV-degenerate triangle takes the orientation of the
// first group that reaches it, which depends on the order; its vertices are deferred to the CPU.

// The flags of every triangle, from derivatives.wgsl.
@group(0) @binding(3) var<storage, read> triangle_flags: array<u32>;
@group(0) @binding(4) var<storage, read> neighbours: array<u32>;
// The lowest corner of each corner's group; NONE without a group.
@group(0) @binding(5) var<storage, read_write> seed_of_corner: array<u32>;
@group(0) @binding(6) var<storage, read_write> is_deferred: array<atomic<u32>>;

// The UV map keeps the orientation of the triangle.
const KEEPS_ORIENTATION: u32 = 1u;
// The triangle is UV-degenerate.
const UV_DEGENERATE: u32 = 2u;

// Defers the vertices of UV-degenerate triangles.
@compute @workgroup_size(WORKGROUP)
fn defer_vertices(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let corner = thread_index(thread, groups);
    if corner >= 3u * mesh.triangle_count {
        return;
    }
    let vertex = vertex_of_corner(corner);
    if vertex != NONE && (triangle_flags[corner / 3u] & UV_DEGENERATE) != 0u {
        atomicStore(&is_deferred[vertex], 1u);
    }
}

// The result of a walk. `length` excludes the first corner.
struct Walk {
    lowest: u32,
    length: u32,
    is_ring: bool,
}

// Walks around a vertex from corner `first`, across the edges that leave the vertex (`leaving` = 0) or arrive there (2).
fn walk(first: u32, vertex: u32, leaving: u32) -> Walk {
    let keeps_orientation = triangle_flags[first / 3u] & KEEPS_ORIENTATION;
    var met = Walk(first, 0u, false);
    var corner = first;
    for (var step = 0u; step < MAX_ITERATIONS; step++) {
        let triangle = corner / 3u;
        let next = neighbours[3u * triangle + (corner + leaving) % 3u];
        if next == NONE || (triangle_flags[next] & KEEPS_ORIENTATION) != keeps_orientation {
            break;
        }
        corner = corner_at(next, vertex);
        if corner == first {
            met.is_ring = true;
            break;
        }
        met.lowest = min(met.lowest, corner);
        met.length++;
    }
    return met;
}

@compute @workgroup_size(WORKGROUP)
fn find_groups(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let corner = thread_index(thread, groups);
    if corner >= 3u * mesh.triangle_count {
        return;
    }
    seed_of_corner[corner] = NONE;
    let vertex = vertex_of_corner(corner);
    if vertex == NONE || (triangle_flags[corner / 3u] & UV_DEGENERATE) != 0u {
        return;
    }
    let range = adjacency_range(vertex);
    let count = range.y - range.x;
    if count > MAX_ITERATIONS {
        atomicStore(&is_deferred[vertex], 1u);
        return;
    }
    var met = walk(corner, vertex, 0u);
    if !met.is_ring {
        let back = walk(corner, vertex, 2u);
        met.lowest = min(met.lowest, back.lowest);
        met.length += back.length;
    }
    seed_of_corner[corner] = met.lowest;
    // The vertex has several groups, which may have different tangents.
    if met.length + 1u < count {
        atomicStore(&is_deferred[vertex], 1u);
    }
}
