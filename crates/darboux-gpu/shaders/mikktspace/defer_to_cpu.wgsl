// Defers the vertices of listed triangles or corners to the CPU. `indices` are the welded vertices of corners, NONE at degenerate triangles.
// Requires CORNERS_PER_ITEM.

@group(0) @binding(2) var<storage, read_write> is_deferred: array<atomic<u32>>;

const NONE: u32 = 0xffffffffu;

fn run(item: u32) {
    for (var k = 0u; k < CORNERS_PER_ITEM; k++) {
        let vertex = vertex_of_corner(CORNERS_PER_ITEM * item + k);
        if vertex != NONE {
            atomicStore(&is_deferred[vertex], 1u);
        }
    }
}
