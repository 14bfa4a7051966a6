// Groups: the triangles around a vertex that are joined by edges and share one UV orientation. The twin of the core's
// tangents/groups.rs, which floods from the first triangle of each.
//
// Around a vertex every triangle has two edges, and so at most two neighbours: a group is a ring or a row. Every corner walks along
// its own and finds the lowest corner, which is the one that the core starts from. UV-degenerate triangles take the orientation of the first group
// that reaches them: their vertices are left to the core.

// What derivatives say of every triangle.
@group(0) @binding(3) var<storage, read> marks: array<u32>;
@group(0) @binding(4) var<storage, read> neighbours: array<u32>;
// The lowest corner of each corner's group; NONE where there is none.
@group(0) @binding(5) var<storage, read_write> seed_of_corner: array<u32>;
@group(0) @binding(6) var<storage, read_write> is_left: array<atomic<u32>>;

// The UV map keeps the triangle's orientation.
const PRESERVES: u32 = 1u;
// The triangle is UV-degenerate: it goes with any group.
const ANY: u32 = 2u;

// Leaves the vertices of triangles whose groups the order of triangles decides.
@compute @workgroup_size(WORKGROUP)
fn leave_vertices(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let corner = number_of_thread(thread, groups);
    if corner >= 3u * mesh.triangle_count {
        return;
    }
    let vertex = vertex_of_corner(corner);
    if vertex != NONE && (marks[corner / 3u] & ANY) != 0u {
        atomicStore(&is_left[vertex], 1u);
    }
}

// What a walk met.
struct Walk {
    lowest: u32,
    length: u32,
    is_ring: bool,
}

// Walks around a vertex, from a corner on, over the edges that start there (`leaving` is 0) or end there (2).
fn walk(first: u32, vertex: u32, leaving: u32) -> Walk {
    let preserves = marks[first / 3u] & PRESERVES;
    var met = Walk(first, 0u, false);
    var corner = first;
    for (var turn = 0u; turn < MAX_TURNS; turn++) {
        let triangle = corner / 3u;
        let next = neighbours[3u * triangle + (corner + leaving) % 3u];
        if next == NONE || (marks[next] & PRESERVES) != preserves {
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
    let corner = number_of_thread(thread, groups);
    if corner >= 3u * mesh.triangle_count {
        return;
    }
    seed_of_corner[corner] = NONE;
    let vertex = vertex_of_corner(corner);
    if vertex == NONE || (marks[corner / 3u] & ANY) != 0u {
        return;
    }
    let range = entries(vertex);
    let count = range.y - range.x;
    if count > MAX_TURNS {
        atomicStore(&is_left[vertex], 1u);
        return;
    }
    var met = walk(corner, vertex, 0u);
    if !met.is_ring {
        let back = walk(corner, vertex, 2u);
        met.lowest = min(met.lowest, back.lowest);
        met.length += back.length;
    }
    seed_of_corner[corner] = met.lowest;
    // Several groups: the tangents that they have may split a vertex of the mesh.
    if met.length + 1u < count {
        atomicStore(&is_left[vertex], 1u);
    }
}
