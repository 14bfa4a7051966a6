// Leaves the vertices of what is listed to the CPU. Here `indices` are the welded vertices of corners, NONE at degenerate triangles. Needs
// CORNERS_OF_ITEM.

@group(0) @binding(2) var<storage, read_write> left_vertices: array<atomic<u32>>;

const NONE: u32 = 0xffffffffu;

fn run(item: u32) {
    for (var k = 0u; k < CORNERS_OF_ITEM; k++) {
        let vertex = vertex_of_corner(CORNERS_OF_ITEM * item + k);
        if vertex != NONE {
            atomicStore(&left_vertices[vertex], 1u);
        }
    }
}
